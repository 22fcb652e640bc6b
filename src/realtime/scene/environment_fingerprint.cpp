// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/scene/environment_fingerprint.h"

#include "light/light.h"
#include "math/sampling.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

std::vector<Vec3> environment_fingerprint(const Scene& scene) {
  constexpr int across = 16;
  std::vector<Vec3> values;
  const Wavelengths w = Wavelengths::rgb(0.5f);
  const Point centre = scene.bounding_sphere().centre;
  for (int i = 0; i < across * across; ++i) {
    const int column = i % across, row = i / across;
    const Vec2 u((static_cast<float>(column) + 0.5f) / across, (static_cast<float>(row) + 0.5f) / across);
    Spectrum sum;
    for (const std::uint32_t light : scene.infinite_lights())
      sum += emitted_infinite(scene.lights()[light], centre, sample_uniform_sphere(u), w);
    values.emplace_back(sum[0], sum[1], sum[2]);
  }
  // Suns lie between these directions.
  for (const std::uint32_t light : scene.infinite_lights())
    if (const auto sample = sample_direct(scene.lights()[light], centre, Vec2(0.5f), w)) {
      values.push_back(sample->wi);
      values.emplace_back(sample->radiance[0], sample->radiance[1], sample->radiance[2]);
    }
  return values;
}

}  // namespace lanthorn
