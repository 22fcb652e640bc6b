// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Connections of light vertices to the camera's lens.
#pragma once

#include <optional>

#include "camera/view.h"
#include "film/film.h"
#include "path/path_context.h"
#include "path/vertex.h"

namespace lanthorn {

/// Light that a vertex of a light walk sends through the lens.
struct LensLight {
  Vec2 raster{0};  ///< film position, pixels
  Spectrum light;  ///< times the filter's value, the contribution to a pixel
  bool dispersed = false;
  Ray from_lens;            ///< from the lens to the vertex
  float distance = 0;       ///< from the lens to the vertex, metres
  float optical_depth = 0;  ///< of the way (`Passage`)
};

/// Connects the vertex to the lens. Empty if no light arrives. Draws from the visitor's dimensions. `film`: where the
/// light will be splatted, if it will; its memory is fetched meanwhile.
std::optional<LensLight> connect_to_lens(const PathContext& path, const View& view, const SurfaceVertex& vertex,
                                         const Film* film = nullptr);
std::optional<LensLight> connect_to_lens(const PathContext& path, const View& view, const MediumVertex& vertex,
                                         const Film* film = nullptr);

}  // namespace lanthorn
