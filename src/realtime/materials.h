// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "realtime/gpu_scene.h"
#include "surface/bsdf.h"

namespace lanthorn {

/// The closure as shaders/bsdf.glsl knows it. Exact: Lambertian reflection and transmission, metals of one width,
/// plastics without film. Other closures become plastics by their split-sum terms; glass and mirrors have no lobe that
/// shaders evaluate.
GpuMaterial reduce(const Bsdf& bsdf);

/// Material `material` at texture coordinates (u, v); position and normal are none in particular.
GpuMaterial material_at(const Scene& scene, std::uint32_t material, const Vec2& uv);

/// `#define` lines for shaders that include bsdf.glsl: they remove the kinds of closures that no material has.
std::string closure_defines(const std::vector<GpuMaterial>& materials);

/// The material at 16 x 16 points of the unit square of (u, v).
std::vector<GpuMaterial> probe(const Scene& scene, std::uint32_t material);
/// True if textures vary it.
bool varies(const std::vector<GpuMaterial>& probes);
/// True if the GPU cannot draw what the material shows. It is glass or hair; or some of its lobes are narrow: few
/// photons meet them, and of infinite lights the few directions of a frame miss lobes that are wider still; or textures
/// vary more of it than the GPU's texture holds, as metalness does.
bool needs_eye_paths(const std::vector<GpuMaterial>& probes, bool has_infinite_lights);

/// Albedo of GGX reflection with Schlick's Fresnel term, for plastics: scale of f0 and of f90 by cosine and width, and
/// in the last column but one row by row the means over the hemisphere. RG, `plastic_cosines` + 1 texels a row.
std::vector<Vec2> plastic_albedos();
inline constexpr int plastic_cosines = 64, plastic_widths = 17;

}  // namespace lanthorn
