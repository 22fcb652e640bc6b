// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/splitsum/environment_light.h"

#include <utility>

#include "gl/context.h"
#include "integrators/environment_image.h"
#include "realtime/scene/environment_fingerprint.h"
#include "realtime/techniques/splitsum/environment_baker.h"

namespace lanthorn {

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
