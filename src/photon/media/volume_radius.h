// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "base/parameters.h"
#include "path/render_job.h"
#include "photon/gather/kernels.h"
#include "photon/guides/guide_photons.h"
#include "photon/media/volume_gather.h"

namespace lanthorn {

/// The parameter "volume-radius".
inline ParameterInfo volume_radius_info() {
  return {"volume-radius", "auto", "first radius of estimates in media: auto, or a length in metres"};
}
/// Empty: automatic.
std::optional<float> volume_radius_parameter(const Parameters& parameters);

/// The first radius of a volume estimator, m. 0 if the estimator finds no photons in this scene. If `given` is empty, a
/// pilot pass measures the radius with the least error, by blur and by noise, in the visible light: at most a tenth of
/// the scene's radius, and half of the mean free path (a quarter in three dimensions). Depends on scene, view, seed and
/// photon count only. `kernel`, `guide`: those of the passes, `guide` may be null; `first_depth`: as in `PhotonRule`.
float first_volume_radius(const RenderJob& job, VolumeEstimator estimator, std::optional<float> given,
                          const Kernel& kernel, const LightGuide* guide, int first_depth = 2);

}  // namespace lanthorn
