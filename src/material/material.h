// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A material in a scene: its parameters give a closure at each point of a surface. Each family of materials has a file
// in this folder, with one function for each kind X, which compiles the parameters of description::XMaterial.
#pragma once

#include <functional>
#include <optional>

#include "lanthorn/scene_description.h"
#include "spectrum/wavelengths.h"
#include "surface/bsdf.h"
#include "texture/texture_mapping.h"

namespace lanthorn {

class MaterialCompiler;

/// The closure of a material at a point.
using ClosureAt = std::function<Bsdf(const TexturePoint& at, const Wavelengths& w)>;

/// Compiles the parameters of a material, records its traits in the compiler, and returns its closure, which keeps
/// pointers to the scene's textures. Throws Error for invalid parameters. The file of a family instantiates this
/// function for each of its kinds (see kind.h); a kind for which none does is a linker error.
template <class Parameters>
ClosureAt compile(const Parameters& parameters, MaterialCompiler& compiler);

/// Properties of a material that hold at all of its points.
struct MaterialTraits {
  bool is_interface = false;                   ///< a boundary of media without a surface
  bool is_anisotropic = false;                 ///< the shading frame's tangent matters
  bool is_dispersive = false;                  ///< an index of refraction varies with wavelength
  bool has_tables = false;                     ///< some spectrum is tabulated, other than a metal's (see metal_rgb.h)
  bool varies = false;                         ///< depends on the place
  bool has_levels = false;                     ///< some texture may be averaged over footprints
  bool has_relief = false;                     ///< a normal map or a displacement modifies shading normals
  bool may_be_specular = false;                ///< has delta lobes at least in some places
  bool is_hair = false;                        ///< scatters as a hair, a ribbon that faces every ray
  std::optional<description::Index> interior;  ///< medium inside; of a mix: the interior of the part that has one
};

}  // namespace lanthorn
