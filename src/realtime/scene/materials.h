// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Materials as the GPU has them: closures reduced to those of bsdf.glsl, and properties that vary over surfaces.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gl/texture.h"
#include "math/vec.h"
#include "realtime/scene/layouts.h"
#include "scene/scene.h"
#include "surface/bsdf.h"

namespace lanthorn {

/// The texels of a layer, as a function of (u, v) in [0,1)².
using SurfaceLayer = std::function<glm::vec4(const Vec2&)>;

inline constexpr std::size_t most_layers = 256;

/// Values in the middles of 16 x 16 equal parts of the unit square, row by row.
template <class Values>
auto probe_square(const Values& values) {
  constexpr int points = 16;
  std::vector<decltype(values(Vec2(0)))> probes;
  for (int y = 0; y < points; ++y)
    for (int x = 0; x < points; ++x)
      probes.push_back(values((Vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) / float{points}));
  return probes;
}

/// Layers of one texture over the unit square of (u, v), which repeats.
class SurfaceTextures {
 public:
  /// Takes over these layers, `most_layers` at most. Returns false, and keeps the texels, if layers of the same values
  /// are there: edits of a scene change few of them, if any.
  bool update(const std::vector<SurfaceLayer>& layers);
  /// For the sampler of bsdf.glsl.
  void bind() const { texture_.bind(gpu::unit_surfaces); }
  int side() const { return texture_.width(); }

 private:
  std::vector<glm::vec4> fingerprint_;
  gl::Texture texture_;
};

/// The closure as bsdf.glsl represents it. Exact: Lambertian reflection and transmission, metals of one width, plastics
/// without film. Other closures become plastics by their split-sum terms; glass and mirrors have no lobe that shaders
/// evaluate.
GpuMaterial reduce(const Bsdf& bsdf);

/// The closure as a plastic with the same reflectance at normal incidence.
GpuMaterial as_plastic(const GpuMaterial& m);

/// Material `material` at texture coordinates (u, v), at an arbitrary position and normal. A mix becomes one plastic:
/// shares of its parts' reflectances, and the mean of their widths.
GpuMaterial material_at(const Scene& scene, std::uint32_t material, const Vec2& uv);

/// `#define` lines for shaders that include bsdf.glsl: they remove the closures and textures that no material has.
std::string closure_defines(const std::vector<GpuMaterial>& materials);

/// A material over the unit square of (u, v).
struct SurfaceMaterial {
  GpuMaterial common;  ///< of the square's middle, with flags for the layers; of lobes that vary the largest values
  std::vector<SurfaceLayer> layers;  ///< in the order of their flags: colour, lobes, normals
};
SurfaceMaterial surface_material(const Scene& scene, std::uint32_t material);

/// Below this GGX width, a frame's few directions of infinite lights under-sample the lobe.
inline constexpr float least_alpha_under_sky = 0.3f;

/// True if the GPU cannot draw the material accurately. It is glass or hair; or it has narrow lobes, which few photons
/// meet (under infinite lights also somewhat wider lobes, which the few directions of a frame miss); or textures vary
/// the Fresnel term of its lobes, as metalness does, which the GPU approximates.
bool needs_eye_paths(const std::vector<GpuMaterial>& probes, bool has_infinite_lights);

/// Albedo of GGX reflection with Schlick's Fresnel term, for plastics: scale of f0 and of f90, by cosine (columns) and
/// width (rows). The last column has each row's mean over the hemisphere. RG, `gpu::plastic_cosines` + 2 texels a row.
std::vector<Vec2> plastic_albedos();

}  // namespace lanthorn
