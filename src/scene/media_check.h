// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace lanthorn {

/// Rays that come in one medium to where the scene says that another one is. What they then see depends on the way
/// that they went, so that integrators disagree.
struct MediaConflict {
  MediumId around, claimed;
  Ray ray;                             ///< one that meets the border of media first of all
  std::optional<std::uint32_t> light;  ///< or the light that it gets to
  std::uint32_t count = 0;
};

/// Looks for them along straight rays through glass and borders of media, from the camera and from what it sees on to
/// the lights. A few rays that slip between shapes that touch do not count.
std::vector<MediaConflict> find_media_conflicts(const Scene& scene);

}  // namespace lanthorn
