// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What the pilot of `auto` has found (docs/methods/vcm.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lanthorn {

/// The effort at one place on the film.
struct PlaceEffort {
  std::uint8_t connections = 1;  ///< light paths that each eye vertex is connected to
  bool merges = true;            ///< on surfaces
  bool merges_in_media = true;
  bool sees = true;     ///< light paths are connected to the lens
  bool goes_on = true;  ///< eye paths go on after a lobe that is not delta (`Techniques::goes_on`)
};

/// The pilot's forecast for one choice, used for the whole picture.
struct UniformEffort {
  double light_paths_per_pixel = 0;
  PlaceEffort place;
  double variance = 0;  ///< of one pass: relative to the squared pixel values, mean over the picture
  double work = 0;      ///< of one pass, per pixel, in units of a ray
};

/// Counts of the costly operations of eye paths.
struct EyeWork {
  double rays = 0, next_events = 0, connections = 0;
  double lookups = 0, merges = 0;              ///< on surfaces
  double media_lookups = 0, media_merges = 0;  ///< on flights and at scatterings

  void add(const EyeWork& other, double factor = 1) {
    rays += factor * other.rays;
    next_events += factor * other.next_events;
    connections += factor * other.connections;
    lookups += factor * other.lookups;
    merges += factor * other.merges;
    media_lookups += factor * other.media_lookups;
    media_merges += factor * other.media_merges;
  }
};

struct LightWork {
  double rays = 0, vertices = 0;
};

/// The pilot's findings, for the user.
struct EffortReport {
  std::string summary{};            ///< one line: findings and choice
  double light_by_light_paths = 0;  ///< share of the light that light paths find: by the lens, connections and merging
  double caustic_light = 0;         ///< share of the light that is caustics
  double caustic_part = 0;          ///< share of the picture where they are visible
  double merged_part = 0, connected_part = 0;  ///< share of the picture where merging, or connections, are used
  double short_part = 0;  ///< share of the picture where eye paths are short (`PlaceEffort::goes_on`)
  double light_paths_per_pixel = 0;
  double variance = 0, work = 0;         ///< as in UniformEffort, of the chosen effort
  std::vector<UniformEffort> uniform{};  ///< of all choices
  EyeWork work_of_eye_path{};            ///< with one connection at each vertex and one light path a pixel
  LightWork work_of_light_path{};
};

}  // namespace lanthorn
