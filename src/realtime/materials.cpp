// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <variant>

#include "scene/scene_data.h"
#include "surface/plastic.h"
#include "surface/sample.h"
#include "surface/split_terms.h"

namespace lanthorn {

namespace {

glm::vec4 rgba(const Spectrum& s, float a) { return {s[0], s[1], s[2], a}; }

GpuMaterial plastic_of(const Spectrum& reflectance, const Spectrum& f0, float f90, float alpha, std::uint32_t flags) {
  GpuMaterial m;
  m.kind = GpuMaterial::plastic;
  m.colour = rgba(reflectance, alpha);
  m.through = rgba(f0, 0);
  m.specular = {f90, 0, 0, 0};
  m.flags = flags | (effectively_smooth(alpha, alpha) ? GpuMaterial::is_smooth : 0u);
  return m;
}

GpuMaterial reduced(const Diffuse& d) {
  GpuMaterial m;
  m.kind = GpuMaterial::diffuse;
  m.colour = rgba(d.reflectance, 1);
  m.flags = GpuMaterial::is_exact;
  return m;
}

GpuMaterial reduced(const DiffuseTransmission& d) {
  GpuMaterial m;
  m.kind = GpuMaterial::diffuse;
  m.colour = rgba(d.reflectance, 1);
  m.through = rgba(d.transmittance, 0);
  m.flags = GpuMaterial::is_exact;
  return m;
}

GpuMaterial reduced(const Conductor& c) {
  GpuMaterial m;
  m.kind = GpuMaterial::metal;
  m.colour.w = geometric_alpha(c.alpha_x, c.alpha_y);
  m.through = rgba(c.eta, 0);
  m.specular = rgba(c.k, 0);
  m.flags = is_smooth(c) ? GpuMaterial::is_smooth : c.alpha_x == c.alpha_y ? GpuMaterial::is_exact : 0u;
  return m;
}

GpuMaterial reduced(const Plastic& p) {
  const bool smooth = is_smooth(p);
  return plastic_of(p.reflectance, p.f0, p.f90, p.alpha, p.film || smooth ? 0u : GpuMaterial::is_exact);
}

/// Of glass nothing is left but what the split sum takes: what it reflects and refracts is delta, or takes paths. Split
/// terms know nothing of hair.
template <class Closure>
GpuMaterial reduced(const Closure& closure) {
  constexpr bool is_glass = std::is_same_v<Closure, Dielectric> || std::is_same_v<Closure, ThinDielectric>;
  GpuMaterial m;
  m.flags = GpuMaterial::is_smooth;
  const SplitTerms terms = split_terms(Bsdf(closure), Vec3(0, 0, 1));
  if (is_glass) {
    m.colour.w = terms.alpha;
    m.through = rgba(terms.f0, 0);
    m.specular.x = max_component(terms.f90);
    return m;
  }
  return plastic_of(terms.diffuse, terms.f0, max_component(terms.f90), terms.alpha,
                    Closure::traits.is_fibre ? GpuMaterial::is_traced : 0u);
}

}  // namespace

GpuMaterial reduce(const Bsdf& bsdf) {
  return std::visit([](const auto& closure) { return reduced(closure); }, bsdf);
}

GpuMaterial material_at(const Scene& scene, std::uint32_t material, const Vec2& uv) {
  const MaterialTable& table = scene.data()->materials;
  TexturePoint at;
  at.uv = uv;
  at.position = scene.bounding_sphere().centre;
  return reduce(table.evaluate(table.resolve(material, at, at.normal), at, Wavelengths::rgb(0.5f)));
}

std::string closure_defines(const std::vector<GpuMaterial>& materials) {
  const auto has = [&](GpuMaterial::Kind kind) {
    return std::any_of(materials.begin(), materials.end(), [&](const GpuMaterial& m) { return m.kind == kind; });
  };
  std::string lines;
  if (!has(GpuMaterial::metal)) lines += "#define NO_METAL\n";
  if (!has(GpuMaterial::plastic)) lines += "#define NO_PLASTIC\n";
  return lines;
}

std::vector<GpuMaterial> probe(const Scene& scene, std::uint32_t material) {
  constexpr int points = 16;
  std::vector<GpuMaterial> probes;
  for (int y = 0; y < points; ++y)
    for (int x = 0; x < points; ++x)
      probes.push_back(
          material_at(scene, material, (Vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) / float{points}));
  return probes;
}

bool varies(const std::vector<GpuMaterial>& probes) {
  return std::any_of(probes.begin(), probes.end(),
                     [&](const GpuMaterial& m) { return m.colour != probes[0].colour || m.kind != probes[0].kind; });
}

bool needs_eye_paths(const std::vector<GpuMaterial>& probes, bool has_infinite_lights) {
  constexpr float least_alpha_under_sky = 0.3f;
  const float least_alpha = has_infinite_lights ? least_alpha_under_sky : half_spread_alpha;
  return std::any_of(probes.begin(), probes.end(), [&](const GpuMaterial& m) {
    const bool has_lobe = m.kind == GpuMaterial::metal || (m.kind == GpuMaterial::plastic && m.specular.x > 0);
    const bool is_narrow = has_lobe && (m.flags & GpuMaterial::is_smooth) == 0 && m.colour.w < least_alpha;
    return m.kind == GpuMaterial::none || (m.flags & GpuMaterial::is_traced) != 0 || is_narrow ||
           m.kind != probes[0].kind || m.flags != probes[0].flags || m.through != probes[0].through ||
           m.specular != probes[0].specular;
  });
}

std::vector<Vec2> plastic_albedos() {
  std::vector<Vec2> texels;
  const auto albedo = [](float f0, float f90, float alpha, float cos) {
    return specular_albedo(Plastic{.f0 = Spectrum(f0), .f90 = f90, .alpha = alpha}, cos)[0];
  };
  for (int row = 0; row < plastic_widths; ++row) {
    const float alpha = static_cast<float>(row) / (plastic_widths - 1);
    Vec2 mean(0);
    for (int column = 0; column <= plastic_cosines; ++column) {
      const float cos = static_cast<float>(column) / plastic_cosines;
      texels.emplace_back(albedo(1, 0, alpha, cos), albedo(0, 1, alpha, cos));
      if (column == 0) continue;
      // 2 ∫ E cos dcos, exact for values linear between the columns.
      const Vec2 first = texels[texels.size() - 2], second = texels.back();
      const float low = static_cast<float>(column - 1), step = 1.0f / plastic_cosines;
      mean += step * step * (low * (first + second) + (first + 2.0f * second) / 3.0f);
    }
    texels.push_back(mean);
  }
  return texels;
}

}  // namespace lanthorn
