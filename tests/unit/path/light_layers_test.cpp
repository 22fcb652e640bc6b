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
  layers.add(PathClass::emission, Part::hit, Spectrum(10), false);
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

TEST(LightLayers, ALimitHoldsForAllButEmission) {
  const PixelSample limited = sample_of(4.0f);
  EXPECT_FLOAT_EQ(layer(limited, PathClass::emission), 10);
  EXPECT_FLOAT_EQ(layer(limited, PathClass::indirect), 1);
  EXPECT_FLOAT_EQ(layer(limited, PathClass::direct), 0.5f);
  EXPECT_FLOAT_EQ(layer(limited, PathClass::caustic), 2.5f);
  EXPECT_FLOAT_EQ(limited.parts[Part::hit].g, 11);
  EXPECT_FLOAT_EQ(limited.parts[Part::rest].g, 3);
}

TEST(LightLayers, LightBelowTheLimitIsLeftAlone) {
  for (const std::optional<float>& limit : {std::optional<float>{}, std::optional<float>{8.0f}}) {
    const PixelSample sample = sample_of(limit);
    EXPECT_EQ(layer(sample, PathClass::caustic), 5);
    EXPECT_EQ(sample.parts[Part::hit].g, 12);
  }
}

}  // namespace
}  // namespace lanthorn
