// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Relief that is in the shading normals alone: normal maps and bump mapping.
#pragma once

#include <optional>

#include "math/frame.h"
#include "shape/geometry_record.h"
#include "texture/textures.h"

namespace lanthorn {

/// The normal map where there is one, else the displacement.
struct Relief {
  std::optional<NormalMapInput> normal_map;
  FloatInput displacement;  ///< metres along the shading normal
  TextureDetail detail;     ///< of the displacement
};

/// The shading frame of a surface with relief; its normal stays in the hemisphere of the geometric one. `surface` must
/// have its tangents, in world space.
///
/// Normal map: x along the tangent, y along dp/dv, both made perpendicular to the smooth shading normal, so that a
/// relief stays what it is where a transformation or a parametrisation mirrors. Displacement h (Blinn 1978): the normal
/// of p + h n, with n the smooth normal, whose own change is left out (h small against the radius of curvature). The
/// derivatives of h are central differences over its finest detail.
Frame shading_frame(const Relief& relief, const TextureGraph& textures, const SurfaceGeometry& surface,
                    const TexturePoint& at);

}  // namespace lanthorn
