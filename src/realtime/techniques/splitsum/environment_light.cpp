// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/splitsum/environment_light.h"

#include <utility>

#include "gl/context.h"
#include "integrators/environment_image.h"
#include "light/light.h"
#include "math/sampling.h"
#include "realtime/techniques/splitsum/environment_baker.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

std::vector<Vec3> environment_fingerprint(const Scene& scene) {
  constexpr int across = 16;
  std::vector<Vec3> values;
  const Wavelengths w = Wavelengths::rgb(0.5f);
  for (int i = 0; i < across * across; ++i) {
    const int column = i % across, row = i / across;
    const Vec2 u((static_cast<float>(column) + 0.5f) / across, (static_cast<float>(row) + 0.5f) / across);
    Spectrum sum;
    for (const std::uint32_t light : scene.infinite_lights())
      sum += emitted_infinite(scene.lights()[light], scene.bounding_sphere().centre, sample_uniform_sphere(u), w);
    values.emplace_back(sum[0], sum[1], sum[2]);
  }
  return values;
}

EnvironmentLight::EnvironmentLight(const gl::ShaderFiles& files)
    : files_(files), shade_(files, "screen.vert.glsl", "split_sum.frag.glsl") {}

bool EnvironmentLight::prepare(const Scene& scene) {
  std::vector<Vec3> fingerprint = environment_fingerprint(scene);
  if (fingerprint == fingerprint_) return false;
  const Image image = environment_image(scene);
  maps_ = gl::current_driver("").software ? EnvironmentMaps(SplitSum(image))
                                          : EnvironmentBaker(files_).bake(image, split_sum_settings(image));
  fingerprint_ = std::move(fingerprint);
  return true;
}

void EnvironmentLight::use(const WindowRays& rays) const {
  shade_.use();
  shade_.set("eye", rays.eye);
  shade_.set("axis", glm::vec4(rays.axis, rays.parallel ? 1 : 0));
  maps_.bind(shade_);
}

}  // namespace lanthorn
