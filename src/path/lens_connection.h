// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Vertices of light walks, seen by the camera.
#pragma once

#include <optional>

#include "camera/view.h"
#include "path/path_context.h"
#include "path/vertex.h"

namespace lanthorn {

/// Light that a vertex of a light walk sends through the lens.
struct LensLight {
  Vec2 raster{0};  ///< film position, pixels
  Spectrum light;  ///< contribution to the sum over pixels: a pixel's value is what falls on it, times the filter
  bool dispersed = false;
  Ray from_lens;       ///< the way back
  float distance = 0;  ///< along it, metres
};

/// Connects the vertex to the lens; empty if nothing gets there. Draws from the visitor's dimensions.
std::optional<LensLight> connect_to_lens(const PathContext& path, const View& view, const SurfaceVertex& vertex);
std::optional<LensLight> connect_to_lens(const PathContext& path, const View& view, const MediumVertex& vertex);

}  // namespace lanthorn
