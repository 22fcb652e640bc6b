// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/scene/materials.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>

#include "base/parallel.h"
#include "scene/scene_data.h"
#include "surface/closure.h"
#include "surface/fresnel.h"
#include "surface/microfacet.h"
#include "surface/plastic.h"

namespace lanthorn {

namespace {

glm::vec4 rgba(const Spectrum& s, float a) { return {s[0], s[1], s[2], a}; }

GpuMaterial plastic_of(const Spectrum& reflectance, const Spectrum& f0, float f90, float alpha, std::uint32_t flags) {
  GpuMaterial m{};
  m.kind = gpu::kind_plastic;
  m.colour = rgba(reflectance, alpha);
  m.through = rgba(f0, 0);
  m.specular = {f90, 0, 0, 0};
  m.flags = flags | (effectively_smooth(alpha, alpha) ? gpu::flag_smooth : 0u);
  return m;
}

GpuMaterial reduced(const Diffuse& d) {
  GpuMaterial m{};
  m.kind = gpu::kind_diffuse;
  m.colour = rgba(d.reflectance, 1);
  m.flags = gpu::flag_exact;
  return m;
}

GpuMaterial reduced(const DiffuseTransmission& d) {
  GpuMaterial m{};
  m.kind = gpu::kind_diffuse;
  m.colour = rgba(d.reflectance, 1);
  m.through = rgba(d.transmittance, 0);
  m.flags = gpu::flag_exact;
  return m;
}

GpuMaterial reduced(const Conductor& c) {
  GpuMaterial m{};
  m.kind = gpu::kind_metal;
  m.colour.w = geometric_alpha(c.alpha_x, c.alpha_y);
  m.through = rgba(c.eta, 0);
  m.specular = rgba(c.k, 0);
  m.flags = is_smooth(c) ? gpu::flag_smooth : c.alpha_x == c.alpha_y ? gpu::flag_exact : 0u;
  return m;
}

GpuMaterial reduced(const Plastic& p) {
  const bool smooth = is_smooth(p);
  return plastic_of(p.reflectance, p.f0, p.f90, p.alpha, p.film || smooth ? 0u : gpu::flag_exact);
}

/// Glass, which transmits, keeps only what the split sum uses: its reflection and refraction are delta or need paths.
/// Hair has no split terms.
template <class Closure>
GpuMaterial reduced(const Closure& closure) {
  GpuMaterial m{};
  m.kind = gpu::kind_none;
  m.flags = gpu::flag_smooth;
  const SplitTerms terms = split_terms(closure, Vec3(0, 0, 1));
  if (Closure::traits.transmits) {
    m.colour.w = terms.alpha;
    m.through = rgba(terms.f0, 0);
    m.specular.x = max_component(terms.f90);
    return m;
  }
  return plastic_of(terms.diffuse, terms.f0, max_component(terms.f90), terms.alpha,
                    Closure::traits.is_fibre ? gpu::flag_traced : 0u);
}

struct Part {
  GpuMaterial material;
  float share;  ///< of rays that see it
};

/// Mixes diffuse parts exactly. For other parts, sets the base's reflectance so that, at normal incidence, the blend
/// reflects as much as its parts, although its coat hides more or less of the base than their coats do.
GpuMaterial blended(const std::vector<Part>& parts) {
  if (parts.size() == 1) return parts.front().material;
  const bool are_diffuse =
      std::all_of(parts.begin(), parts.end(), [](const Part& p) { return p.material.kind == gpu::kind_diffuse; });
  GpuMaterial sum{};
  sum.kind = are_diffuse ? gpu::kind_diffuse : gpu::kind_plastic;
  sum.flags = are_diffuse ? gpu::flag_exact : gpu::flag_traced | gpu::flag_stand_in;
  glm::vec4 base(0);
  for (const Part& part : parts) {
    const GpuMaterial m = are_diffuse ? part.material : as_plastic(part.material);
    sum.colour += part.share * m.colour;
    sum.through += part.share * m.through;
    sum.specular += part.share * m.specular;
    base += part.share * m.colour * (1.0f - m.through);
  }
  if (are_diffuse) return sum;
  const glm::vec4 seen = base / glm::max(glm::vec4(1e-3f), 1.0f - sum.through);
  sum.colour = {Vec3(seen), sum.colour.w};
  if (effectively_smooth(sum.colour.w, sum.colour.w)) sum.flags |= gpu::flag_smooth;
  return sum;
}

/// The mean of the parts' mapped normals, in the frame of dp/du, dp/dv and the smooth normal; nullopt if none has one.
std::optional<Normal> normal_at(const Scene& scene, std::uint32_t material, const Vec2& uv) {
  const MaterialTable& table = scene.data()->materials->table;
  const TexturePoint at{.uv = uv};
  Normal sum(0);
  bool is_mapped = false;
  table.for_parts(material, at, 1, [&](std::uint32_t part, float share) {
    const std::optional<Normal> mapped = table.mapped_normal(part, at);
    is_mapped = is_mapped || mapped;
    sum += share * mapped.value_or(Normal(0, 0, 1));
  });
  return is_mapped ? std::optional(sum) : std::nullopt;
}

bool differs(const std::vector<GpuMaterial>& probes, const auto& property) {
  return std::any_of(probes.begin(), probes.end(),
                     [&](const GpuMaterial& m) { return property(m) != property(probes.front()); });
}

/// How varying lobes are stored: as plastics, or as reflectance and transmittance of diffuse surfaces.
GpuMaterial with_lobes(const GpuMaterial& m, bool are_diffuse) { return are_diffuse ? m : as_plastic(m); }

float least_alpha_of(bool has_infinite_lights) {
  return has_infinite_lights ? least_alpha_under_sky : half_spread_alpha;
}

/// True if the GPU can approximate a material for which `needs_eye_paths` is true: no glass or hair, and at most a
/// quarter of it bright and narrow lobes, such as those of polished metal, which would be black.
bool has_stand_in(const std::vector<GpuMaterial>& probes, bool has_infinite_lights) {
  constexpr float bright = 0.3f;
  const auto is_known = [](const GpuMaterial& m) {
    return m.kind != gpu::kind_none && (m.flags & (gpu::flag_traced | gpu::flag_stand_in)) != gpu::flag_traced;
  };
  const auto is_polished = [&](const GpuMaterial& m) {
    const GpuMaterial p = as_plastic(m);
    return max_component(Vec3(p.through)) > bright && p.colour.w < least_alpha_of(has_infinite_lights);
  };
  return std::all_of(probes.begin(), probes.end(), is_known) &&
         4 * std::count_if(probes.begin(), probes.end(), is_polished) <= static_cast<std::ptrdiff_t>(probes.size());
}

/// Lobes must not be too narrow for shaders to evaluate.
glm::vec4 colour_of(const GpuMaterial& m) { return {Vec3(m.colour), std::max(m.colour.w, smooth_alpha_limit)}; }

/// The largest side at which all layers together take about a second of processor time.
int side_for(std::size_t layers) {
  constexpr std::size_t most_texels = std::size_t{1} << 22;
  constexpr int least = 256, most = 1024;
  int side = most;
  while (side > least && layers * static_cast<std::size_t>(side) * static_cast<std::size_t>(side) > most_texels)
    side /= 2;
  return side;
}

std::vector<glm::vec4> bake(const SurfaceLayer& layer, int side) {
  constexpr float most = 65504;  // of 16-bit floats
  const auto row_length = static_cast<std::size_t>(side);
  std::vector<glm::vec4> texels(row_length * row_length);
  parallel_for(0, side, [&](int y) {
    for (int x = 0; x < side; ++x)
      texels[static_cast<std::size_t>(y) * row_length + static_cast<std::size_t>(x)] =
          glm::min(layer((Vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) / static_cast<float>(side)), most);
  });
  return texels;
}

}  // namespace

GpuMaterial as_plastic(const GpuMaterial& m) {
  switch (m.kind) {
    case gpu::kind_diffuse:
      return plastic_of(Spectrum(m.colour.x, m.colour.y, m.colour.z, 0), {}, 0, 1, 0);
    case gpu::kind_metal:
      return plastic_of({},
                        fresnel_conductor(1, Spectrum(m.through.x, m.through.y, m.through.z, 1),
                                          Spectrum(m.specular.x, m.specular.y, m.specular.z, 1)),
                        1, m.colour.w, 0);
    case gpu::kind_none:
      return plastic_of({}, Spectrum(m.through.x, m.through.y, m.through.z, 0), m.specular.x, m.colour.w, 0);
    default:
      return m;
  }
}

GpuMaterial reduce(const Bsdf& bsdf) {
  return std::visit([](const auto& closure) { return reduced(closure); }, bsdf);
}

GpuMaterial material_at(const Scene& scene, std::uint32_t material, const Vec2& uv) {
  const MaterialTable& table = scene.data()->materials->table;
  TexturePoint at;
  at.uv = uv;
  at.position = scene.bounding_sphere().centre;
  std::vector<Part> parts;
  table.for_parts(material, at, 1, [&](std::uint32_t part, float share) {
    parts.push_back({reduce(table.evaluate(part, at, Wavelengths::rgb(0.5f))), share});
  });
  return blended(parts);
}

std::string closure_defines(const std::vector<GpuMaterial>& materials) {
  const auto has = [&](std::uint32_t kind) {
    return std::any_of(materials.begin(), materials.end(), [&](const GpuMaterial& m) { return m.kind == kind; });
  };
  std::string lines;
  if (!has(gpu::kind_metal)) lines += "#define NO_METAL\n";
  if (!has(gpu::kind_plastic)) lines += "#define NO_PLASTIC\n";
  const auto has_flag = [&](std::uint32_t flag) {
    return std::any_of(materials.begin(), materials.end(), [&](const GpuMaterial& m) { return (m.flags & flag) != 0; });
  };
  if (!has_flag(gpu::flag_lobes)) lines += "#define NO_TEXTURED_LOBES\n";
  if (!has_flag(gpu::flag_normals)) lines += "#define NO_NORMAL_MAPS\n";
  return lines;
}

SurfaceMaterial surface_material(const Scene& scene, std::uint32_t material) {
  const auto at = [&scene, material](const Vec2& uv) { return material_at(scene, material, uv); };
  const std::vector<GpuMaterial> probes = probe_square(at);
  SurfaceMaterial result{at(Vec2(0.5f)), {}};
  GpuMaterial& common = result.common;
  const auto kind = [](const GpuMaterial& m) { return m.kind; };
  const bool has_one_kind = !differs(probes, kind), is_diffuse = has_one_kind && common.kind == gpu::kind_diffuse;
  const bool lobes_vary = !has_one_kind || differs(probes, [](const GpuMaterial& m) { return m.through; }) ||
                          differs(probes, [](const GpuMaterial& m) { return m.specular; });
  const bool is_glass = has_one_kind && common.kind == gpu::kind_none;
  if (lobes_vary && !is_glass) {
    common = with_lobes(common, is_diffuse);
    for (const GpuMaterial& probe : probes) {
      common.through = glm::max(common.through, with_lobes(probe, is_diffuse).through);
      common.specular = glm::max(common.specular, with_lobes(probe, is_diffuse).specular);
    }
    common.flags = (common.flags & ~gpu::flag_exact) | gpu::flag_textured | gpu::flag_lobes;
    result.layers = {[=](const Vec2& uv) { return colour_of(with_lobes(at(uv), is_diffuse)); },
                     [=](const Vec2& uv) {
                       const GpuMaterial m = with_lobes(at(uv), is_diffuse);
                       return glm::vec4(Vec3(m.through), m.specular.x);
                     }};
  } else if (differs(probes, [](const GpuMaterial& m) { return m.colour; })) {
    common.flags |= gpu::flag_textured;
    result.layers = {[=](const Vec2& uv) { return colour_of(at(uv)); }};
  }
  const auto mapped = probe_square([&](const Vec2& uv) { return normal_at(scene, material, uv); });
  if (std::any_of(mapped.begin(), mapped.end(), [](const auto& normal) { return normal.has_value(); })) {
    common.flags |= gpu::flag_normals;
    result.layers.emplace_back([&scene, material](const Vec2& uv) {
      return glm::vec4(normal_at(scene, material, uv).value_or(Normal(0, 0, 1)), 0);
    });
  }
  const bool has_infinite_lights = !scene.infinite_lights().empty();
  common.flags &= ~gpu::flag_stand_in;
  if (needs_eye_paths(probes, has_infinite_lights)) {
    common.flags |= gpu::flag_traced;
    if (has_stand_in(probes, has_infinite_lights)) common.flags |= gpu::flag_stand_in;
  }
  if (common.kind == gpu::kind_none) common.flags |= gpu::flag_glass;
  return result;
}

bool needs_eye_paths(const std::vector<GpuMaterial>& probes, bool has_infinite_lights) {
  const float least_alpha = least_alpha_of(has_infinite_lights);
  return std::any_of(probes.begin(), probes.end(), [&](const GpuMaterial& m) {
    const bool has_lobe = m.kind == gpu::kind_metal || (m.kind == gpu::kind_plastic && m.specular.x > 0);
    const bool is_narrow = has_lobe && (m.flags & gpu::flag_smooth) == 0 && m.colour.w < least_alpha;
    return m.kind == gpu::kind_none || (m.flags & gpu::flag_traced) != 0 || is_narrow || m.kind != probes[0].kind ||
           m.flags != probes[0].flags || m.through != probes[0].through || m.specular != probes[0].specular;
  });
}

std::vector<Vec2> plastic_albedos() {
  std::vector<Vec2> texels;
  const auto albedo = [](float f0, float f90, float alpha, float cos) {
    return specular_albedo(Plastic{.f0 = Spectrum(f0), .f90 = f90, .alpha = alpha}, cos)[0];
  };
  for (int row = 0; row < gpu::plastic_widths; ++row) {
    const float alpha = static_cast<float>(row) / (gpu::plastic_widths - 1);
    Vec2 mean(0);
    for (int column = 0; column <= gpu::plastic_cosines; ++column) {
      const float cos = static_cast<float>(column) / gpu::plastic_cosines;
      texels.emplace_back(albedo(1, 0, alpha, cos), albedo(0, 1, alpha, cos));
      if (column == 0) continue;
      // 2 ∫ E cos dcos, exact for values linear between the columns.
      const Vec2 first = texels[texels.size() - 2], second = texels.back();
      const float low = static_cast<float>(column - 1), step = 1.0f / gpu::plastic_cosines;
      mean += step * step * (low * (first + second) + (first + 2.0f * second) / 3.0f);
    }
    texels.push_back(mean);
  }
  return texels;
}

bool SurfaceTextures::update(const std::vector<SurfaceLayer>& layers) {
  std::vector<glm::vec4> fingerprint;
  for (const SurfaceLayer& layer : layers) {
    const std::vector<glm::vec4> values = probe_square(layer);
    fingerprint.insert(fingerprint.end(), values.begin(), values.end());
  }
  if (texture_.name() != 0 && fingerprint == fingerprint_) return false;
  fingerprint_ = std::move(fingerprint);
  const int side = layers.empty() ? 1 : side_for(layers.size());
  texture_ = gl::Texture::array(GL_RGBA16F, side, side, std::max<int>(1, static_cast<int>(layers.size())));
  texture_.filter(GL_LINEAR, GL_LINEAR, GL_REPEAT);
  for (std::size_t i = 0; i < layers.size(); ++i)
    texture_.write({}, bake(layers[i], side).data(), 0, static_cast<int>(i));
  return true;
}

}  // namespace lanthorn
