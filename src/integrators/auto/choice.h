// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "integrators/auto/pilot.h"
#include "integrators/vcm/effort.h"
#include "integrators/vcm/eye_path_log.h"
#include "path/render_job.h"

namespace lanthorn {

/// The pilot's forecast for one choice, used for the whole picture.
struct UniformEffort {
  double light_paths_per_pixel = 0;
  PlaceEffort place;
  double variance = 0;  ///< of one pass: relative to the squared pixel values, mean over the picture
  double work = 0;      ///< of one pass, per pixel, in units of a ray
};

/// The pilot's findings, for the user.
struct EffortReport {
  double light_by_light_paths = 0;  ///< share of the light that light paths find: by the lens, connections and merging
  double caustic_light = 0;         ///< share of the light that is caustics
  double caustic_part = 0;          ///< share of the picture where they are visible
  double merged_part = 0, connected_part = 0;  ///< share of the picture where merging, or connections, are used
  double short_part = 0;  ///< share of the picture where eye paths are short (`PlaceEffort::goes_on`)
  double light_paths_per_pixel = 0;
  double variance = 0, work = 0;  ///< as in UniformEffort, of the chosen effort
  std::vector<UniformEffort> uniform;
  EyeWork work_of_eye_path{};                 ///< with one connection at each vertex and one light path a pixel
  double light_rays = 0, light_vertices = 0;  ///< of a light path

  /// One line for the user: findings and choice.
  std::string describe() const;
  /// All numbers, as the text of a JSON object.
  std::string as_json() const;
};

struct EffortChoice {
  Effort effort;
  EffortReport report;
};
/// The effort with the least product of variance and work: a function of the job alone.
EffortChoice choose_effort(const RenderJob& job, const EffortMeasurement& measured);

}  // namespace lanthorn
