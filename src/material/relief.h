// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Relief in the shading normals only: normal maps and bump mapping.
#pragma once

#include <optional>

#include "math/frame.h"
#include "shape/geometry_record.h"
#include "texture/textures.h"

namespace lanthorn {

/// The normal map if there is one, else the displacement.
struct Relief {
  std::optional<NormalMapInput> normal_map;
  FloatInput displacement;  ///< metres along the shading normal
  TextureDetail detail;     ///< of the displacement
};

/// The shading frame of a surface with relief; its normal stays in the hemisphere of the geometric normal. `surface`
/// must have its tangents, in world space.
///
/// Normal map: x along the tangent, y along dp/dv, both made perpendicular to the smooth shading normal, so that the
/// relief is not inverted where a transformation or a parametrisation mirrors. Displacement h (Blinn 1978): the normal
/// of p + h n, with n the smooth normal. The change of n itself is neglected (h small compared with the radius of
/// curvature). The derivatives of h are central differences over its finest detail.
Frame shading_frame(const Relief& relief, const TextureGraph& textures, const SurfaceGeometry& surface,
                    const TexturePoint& at);

}  // namespace lanthorn
