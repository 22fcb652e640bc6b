// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/light_layers.h"

#include <gtest/gtest.h>

namespace lanthorn::light_layers_test {
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
  return layers.sample(FilterPart::positive, sensor);
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

TEST(LightLayers, LightOutOfMediaIsKeptOnceMore) {
  const Wavelengths w = Wavelengths::rgb(0.5f);
  const WalkState from_camera, scattered{.depth = 1, .non_delta = 1};
  const SurfacePoint at;
  const HenyeyGreenstein phase;
  LightLayers layers(w);
  layers.add_hit(EmissionVertex{from_camera, {0, 0, 1}, Spectrum(8)}, Spectrum(8));
  layers.add_hit(EscapeVertex{from_camera, {0, 0, 1}}, Spectrum(16));  // through the medium
  layers.see(FlownSegment{from_camera, {}, 1, false, Spectrum(1), 0, {}});
  layers.add(PathClass::caustic, Spectrum(1), false);
  layers.see(SurfaceVertex{from_camera, at, {0, 0, 1}, {0, 0, 1}, true});
  layers.add(PathClass::direct, Spectrum(32), false);
  layers.see(MediumVertex{from_camera, Point(0), {0, 0, 1}, phase, 0, true});
  layers.add(PathClass::direct, Spectrum(2), false);
  layers.see(SurfaceVertex{scattered, at, {0, 0, 1}, {0, 0, 1}, true});
  layers.add(PathClass::indirect, Spectrum(4), false);
  LightLayers limited = layers;
  EXPECT_FLOAT_EQ(layers.sample(FilterPart::positive, {}).light[media_layer].g, 8 + 1 + 2 + 4);
  Sensor sensor;
  sensor.path_limit = 39.0f / 2;
  EXPECT_FLOAT_EQ(limited.sample(FilterPart::positive, sensor).light[media_layer].g, 8 + 0.5f * (1 + 2 + 4));
}

}  // namespace
}  // namespace lanthorn::light_layers_test
