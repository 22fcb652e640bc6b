// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/light_layers.h"

#include <gtest/gtest.h>

namespace lanthorn {
namespace {

enum Part : std::size_t { hit, rest };

PixelSample sample_of(const std::optional<float>& limit) {
  const Wavelengths w = Wavelengths::rgb(0.5f);
  LightLayers layers(w);
  const WalkState from_camera, from_mirror{.depth = 1};
  layers.add_hit(EscapeVertex{from_camera, {0, 0, 1}}, Spectrum(10), Part::hit);
  layers.add_hit(EscapeVertex{from_mirror, {0, 0, 1}}, Spectrum(4), Part::hit);
  layers.add(PathClass::indirect, Part::hit, Spectrum(2), false);
  layers.add(PathClass::direct, Part::rest, Spectrum(1), false);
  layers.add(PathClass::caustic, Part::rest, Spectrum(5), false);
  Sensor sensor;
  sensor.path_limit = limit;
  return layers.sample(1, sensor);
}

float layer(const PixelSample& sample, PathClass path_class) {
  return sample.light[static_cast<std::size_t>(path_class)].g;
}

TEST(LightLayers, ALimitHoldsForAllButEmissionSeenDirectly) {
  const PixelSample limited = sample_of(6.0f);
  EXPECT_FLOAT_EQ(layer(limited, PathClass::emission), 12);
  EXPECT_FLOAT_EQ(layer(limited, PathClass::indirect), 1);
  EXPECT_FLOAT_EQ(layer(limited, PathClass::direct), 0.5f);
  EXPECT_FLOAT_EQ(layer(limited, PathClass::caustic), 2.5f);
  EXPECT_FLOAT_EQ(limited.parts[Part::hit].g, 13);
  EXPECT_FLOAT_EQ(limited.parts[Part::rest].g, 3);
}

TEST(LightLayers, LightBelowTheLimitIsLeftAlone) {
  for (const std::optional<float>& limit : {std::optional<float>{}, std::optional<float>{12.0f}}) {
    const PixelSample sample = sample_of(limit);
    EXPECT_EQ(layer(sample, PathClass::caustic), 5);
    EXPECT_EQ(sample.parts[Part::hit].g, 16);
  }
}

}  // namespace
}  // namespace lanthorn
