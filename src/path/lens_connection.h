// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Connections of light vertices to the camera's lens.
#pragma once

#include <optional>

#include "camera/view.h"
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

/// Film position at which the lens would see a light vertex, ignoring occlusion; empty on shapes that are hidden from
/// the camera. Draws from the visitor's dimensions.
template <class Vertex>
std::optional<CameraConnection> find_lens(const PathContext& path, const View& view, const Vertex& vertex);

/// Connects the vertex to the lens. Empty if no light arrives. Draws after `find_lens`.
template <class Vertex>
std::optional<LensLight> connect_to_lens(const PathContext& path, const View& view, const Vertex& vertex,
                                         const CameraConnection& lens);

}  // namespace lanthorn
