// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/hash.h"
#include "surface/metal_rgb.h"

namespace lanthorn {

namespace {

using description::SpectrumRole;

Spectrum clamped_albedo(const Spectrum& s) {
  return map(s, [](float x) { return std::clamp(x, 0.0f, 1.0f); });
}

// The path's index of refraction: the value at the hero wavelength if it varies.
float index_at_hero(const SpectrumCurve& eta, const Wavelengths& w) {
  const float value = eta.at(w.lambda[0]);
  return value > 0 ? value : 1.0f;
}

// Fraunhofer's d line (nm), for which indices of refraction are specified.
constexpr float d_line = 587.6f;

float width_of(float roughness, bool remap) {
  return remap ? roughness_to_alpha(roughness) : std::max(0.0f, roughness);
}

float coat_thickness(float thickness) { return std::fmax(thickness, std::numeric_limits<float>::min()); }

bool is_constant(const FloatInput& input) { return !input.node; }
bool is_constant(const SpectrumInput& input) { return !input.node; }

}  // namespace

// Compiles one description::Material and records its traits.
struct MaterialTable::Compiler {
  const SceneDescription& description;
  TextureGraph& textures;
  SpectrumStore& spectra;
  std::map<description::Index, std::shared_ptr<const LoadedBrdf>>& measured;
  CoatPassages& coat_passages;
  const SourceLocation& location;
  Traits traits;
  bool constant = true;

  FloatInput compile(const description::FloatParameter& p) {
    FloatInput input = textures.compile(p);
    constant = constant && is_constant(input);
    return input;
  }
  SpectrumInput compile(const description::SpectrumParameter& p, SpectrumRole role) {
    SpectrumInput input = textures.compile(p, role, location);
    constant = constant && is_constant(input);
    traits.has_tables = traits.has_tables || input.curve.table != nullptr;
    return input;
  }
  SpectrumCurve index(const description::SpectrumValue& eta) {
    const SpectrumCurve curve = spectra.curve(eta, SpectrumRole::unbounded, description.color_space, location);
    traits.is_dispersive = traits.is_dispersive || curve.varies();
    constant = constant && !curve.varies();
    return curve;
  }
  RoughnessInput roughness(const description::Roughness& r) {
    RoughnessInput input{compile(r.u), compile(r.v), r.remap};
    if (input.u.node != input.v.node || (!input.u.node && input.u.value != input.v.value)) traits.is_anisotropic = true;
    const auto may_be_smooth = [&](const FloatInput& x) {
      return x.node || effectively_smooth(width_of(x.value, r.remap), 0);
    };
    traits.may_be_specular = traits.may_be_specular || (may_be_smooth(input.u) && may_be_smooth(input.v));
    return input;
  }
  MetalInput metal(const std::optional<description::SpectrumParameter>& reflectance,
                   const description::SpectrumParameter& eta, const description::SpectrumParameter& k,
                   const description::Roughness& r) {
    MetalInput input;
    if (reflectance) {
      input.reflectance = compile(*reflectance, SpectrumRole::albedo);
    } else {
      const bool had_tables = traits.has_tables;
      input.eta = compile(eta, SpectrumRole::unbounded);
      input.k = compile(k, SpectrumRole::unbounded);
      if (traits.has_tables != had_tables && is_constant(input.eta) && is_constant(input.k)) {
        fit_metal_rgb(input.eta.curve, input.k.curve);
        traits.has_tables = had_tables;  // its colour needs no spectral rendering
      }
    }
    input.roughness = roughness(r);
    return input;
  }
  std::optional<FilmInput> film(const std::optional<description::ThinFilm>& f) {
    if (!f) return {};
    if (!(f->eta >= 1)) throw Error(location, "a film's index of refraction must be at least 1");
    return FilmInput{compile(f->thickness), f->eta};
  }
  CoatInput coat(const description::Coat& c) {
    return {roughness(c.roughness), compile(c.thickness), index(c.eta), compile(c.albedo, SpectrumRole::albedo),
            compile(c.g),           c.max_depth,          c.samples};
  }
  /// Null if the coat is not clear or not the same everywhere, in all directions and at all wavelengths.
  const CoatPassage* passage(const CoatInput& c) {
    const RoughnessInput& r = c.roughness;
    if (r.u.node || r.v.node || r.u.value != r.v.value || c.thickness.node || c.eta.varies() || c.albedo.node ||
        !c.albedo.curve.is_black())
      return nullptr;
    const float eta = index_at_hero(c.eta, Wavelengths::rgb(0.5f)), alpha = width_of(r.u.value, r.remap),
                thickness = coat_thickness(c.thickness.value);
    std::shared_ptr<const CoatPassage>& known = coat_passages[{eta, alpha, thickness}];
    if (!known) known = std::make_shared<const CoatPassage>(Dielectric{eta, alpha, alpha}, thickness);
    return known.get();
  }

  std::optional<Relief> relief(const description::Material& m) {
    Relief relief;
    if (m.displacement) relief.displacement = textures.compile(*m.displacement);
    if (m.normal_map) relief.normal_map = textures.compile(*m.normal_map, location, !relief.displacement.node);
    return relief.normal_map || relief.displacement.node ? std::optional(relief) : std::nullopt;
  }

  void operator()(const description::DiffuseMaterial& m, Material& out) {
    out.node = DiffuseMaterial{compile(m.reflectance, SpectrumRole::albedo)};
  }
  void operator()(const description::DiffuseTransmissionMaterial& m, Material& out) {
    out.node = TransmissionMaterial{compile(m.reflectance, SpectrumRole::albedo),
                                    compile(m.transmittance, SpectrumRole::albedo), m.scale};
  }
  void operator()(const description::ConductorMaterial& m, Material& out) {
    out.node = ConductorMaterial{metal(m.reflectance, m.eta, m.k, m.roughness)};
  }
  void operator()(const description::DielectricMaterial& m, Material& out) {
    const DielectricMaterial glass{index(m.eta), roughness(m.roughness), compile(m.tint, SpectrumRole::albedo),
                                   film(m.film)};
    // Without refraction, rough surfaces are smooth, too.
    traits.may_be_specular = traits.may_be_specular || glass.eta.varies() || glass.eta.at(d_line) == 1;
    out.node = glass;
  }
  void operator()(const description::ThinDielectricMaterial& m, Material& out) {
    out.node = ThinMaterial{index(m.eta), roughness(m.roughness), compile(m.tint, SpectrumRole::albedo), film(m.film)};
  }
  void operator()(const description::CoatedDiffuseMaterial& m, Material& out) {
    CoatedDiffuseMaterial coated{compile(m.reflectance, SpectrumRole::albedo), coat(m.coat)};
    coated.coat.passage = passage(coated.coat);
    out.node = coated;
  }
  void operator()(const description::CoatedConductorMaterial& m, Material& out) {
    out.node = CoatedConductorMaterial{metal(m.reflectance, m.eta, m.k, m.conductor_roughness), coat(m.coat)};
  }
  void operator()(const description::HairMaterial& m, Material& out) {
    HairMaterial hair;
    if (m.sigma_a) hair.sigma_a = compile(*m.sigma_a, SpectrumRole::unbounded);
    if (m.color) hair.color = compile(*m.color, SpectrumRole::albedo);
    hair.eumelanin = compile(m.eumelanin);
    hair.pheomelanin = compile(m.pheomelanin);
    // Values of d'Eon et al. 2011, §6.1.
    hair.eumelanin_absorption = SpectrumCurve::unbounded({0.419f, 0.697f, 1.37f});
    hair.pheomelanin_absorption = SpectrumCurve::unbounded({0.187f, 0.4f, 1.05f});
    hair.eta = compile(m.eta);
    hair.beta_m = compile(m.beta_m);
    hair.beta_n = compile(m.beta_n);
    hair.alpha = compile(m.alpha);
    traits.is_anisotropic = true;
    traits.is_hair = true;
    constant = false;  // depends on the offset across the hair
    out.node = hair;
  }
  PlasticMaterial plastic(const description::PlasticMaterial& m) {
    PlasticMaterial plastic;
    plastic.reflectance = compile(m.reflectance, SpectrumRole::albedo);
    plastic.roughness = roughness(m.roughness);
    plastic.eta = spectra.curve(m.eta, SpectrumRole::unbounded, description.color_space, location);
    plastic.specular = compile(m.specular);
    plastic.specular_color = compile(m.specular_color, SpectrumRole::unbounded);
    const auto* sheen = std::get_if<float>(&m.sheen_color.value);
    if (m.sheen_color.texture || sheen == nullptr || *sheen != 0) {
      plastic.sheen_color = compile(m.sheen_color, SpectrumRole::albedo);
      plastic.sheen_roughness = compile(m.sheen_roughness);
    }
    plastic.film = film(m.film);
    return plastic;
  }
  void operator()(const description::PlasticMaterial& m, Material& out) { out.node = plastic(m); }
  void operator()(const description::CoatedPlasticMaterial& m, Material& out) {
    out.node = CoatedPlasticMaterial{plastic(m.base), coat(m.coat)};
  }
  void operator()(const description::MeasuredMaterial& m, Material& out) {
    std::shared_ptr<const LoadedBrdf>& loaded = measured[m.brdf];
    if (!loaded) loaded = std::make_shared<const LoadedBrdf>(LoadedBrdf{description.measured_brdfs.at(m.brdf)});
    out.node = MeasuredMaterial{&loaded->brdf};
    traits.has_tables = traits.has_tables || !loaded->data->wavelengths.empty();
    traits.is_anisotropic = traits.is_anisotropic || !loaded->data->is_isotropic();
  }
  void operator()(const description::MixMaterial& m, Material& out) {
    out.mix = Mix{m.materials, compile(m.amount)};
    constant = false;
  }
  void operator()(const description::InterfaceMaterial&, Material&) {
    traits.is_interface = true;
    constant = false;
  }
};

namespace {

// For each material, true if some shape uses it, directly or in a mix.
std::vector<bool> used_materials(const SceneDescription& description) {
  std::vector<bool> used(description.materials.size(), false);
  const auto mark = [&](const std::vector<description::Shape>& shapes) {
    for (const description::Shape& shape : shapes)
      if (shape.material < used.size()) used[shape.material] = true;
  };
  mark(description.shapes);
  for (const description::Object& object : description.objects) mark(object.shapes);
  for (std::size_t i = used.size(); i-- > 0;)
    if (const auto* mix = std::get_if<description::MixMaterial>(&description.materials[i].node); mix && used[i])
      for (const std::uint32_t part : mix->materials)
        if (part < i) used[part] = true;
  return used;
}

}  // namespace

MaterialTable::MaterialTable(const SceneDescription& description, TextureGraph& textures, SpectrumStore& spectra,
                             std::vector<description::Warning>& warnings, const MaterialTable* loaded)
    : textures_(&textures) {
  if (loaded != nullptr) {
    measured_ = loaded->measured_;
    coat_passages_ = loaded->coat_passages_;
  }
  const Wavelengths rgb = Wavelengths::rgb(0.5f);
  const std::vector<bool> used = used_materials(description);
  for (const description::Material& source : description.materials) {
    if (!used[materials_.size()]) {
      materials_.emplace_back();
      continue;
    }
    Compiler compiler{description, textures, spectra, measured_, coat_passages_, source.location, {}, true};
    Material material;
    std::visit([&](const auto& node) { compiler(node, material); }, source.node);
    compiler.traits.interior = source.interior;
    if (material.mix) compiler.traits = settle(*material.mix, source.location, warnings);
    if (const std::optional<Relief> relief = compiler.relief(source)) {
      material.relief = static_cast<std::uint32_t>(reliefs_.size());
      reliefs_.push_back(*relief);
      compiler.traits.has_relief = true;
    }
    compiler.traits.varies = !compiler.constant;
    if (compiler.constant) material.constant_rgb = evaluate(material, {}, rgb);
    material.traits = compiler.traits;
    materials_.push_back(material);
  }
  textures.load_images();
  for (Relief& relief : reliefs_) {
    if (relief.normal_map && relief.displacement.node && !relief.normal_map->image.image->has_colours_of_normals())
      relief.normal_map.reset();
    relief.detail = textures.detail(relief.displacement);
  }
}

MaterialTable::Traits MaterialTable::settle(Mix& mix, const SourceLocation& location,
                                            std::vector<description::Warning>& warnings) const {
  for (const std::uint32_t part : mix.materials)
    if (part >= materials_.size()) throw Error(location, "a mix must name materials defined before it");
  if (!mix.amount.node && !(mix.amount.value > 0)) mix.materials[1] = mix.materials[0];
  if (!mix.amount.node && mix.amount.value >= 1) mix.materials[0] = mix.materials[1];
  const Traits& a = materials_[mix.materials[0]].traits;
  const Traits& b = materials_[mix.materials[1]].traits;
  if (a.is_interface || b.is_interface) {
    warnings.push_back({location, "a mix with an interface material is not supported: the other one is used"});
    const std::uint32_t other = mix.materials[a.is_interface ? 1 : 0];
    mix.materials = {other, other};
  }
  mix.cost = cost_of(mix, location);
  if (a.interior && b.interior && a.interior != b.interior)
    warnings.push_back({location, "the parts of a mix have different media inside: the first one's is used"});
  return {.is_interface = a.is_interface && b.is_interface,
          .is_anisotropic = a.is_anisotropic || b.is_anisotropic,
          .is_dispersive = a.is_dispersive || b.is_dispersive,
          .has_tables = a.has_tables || b.has_tables,
          .varies = true,
          .has_relief = a.has_relief || b.has_relief,
          .may_be_specular = a.may_be_specular || b.may_be_specular,
          .is_hair = a.is_hair && b.is_hair,
          .interior = a.interior ? a.interior : b.interior};
}

TextureGraph::Cost MaterialTable::cost_of(const Mix& mix, const SourceLocation& location) const {
  constexpr TextureGraph::Cost most = TextureGraph::most;
  TextureGraph::Cost cost{0, 1 + textures_->cost(mix.amount).lookups};
  const bool shows_one = !mix.amount.node && (!(mix.amount.value > 0) || mix.amount.value >= 1);
  for (const std::uint32_t part : {mix.materials[0], mix.materials[1]}) {
    const std::optional<Mix>& inner = materials_[part].mix;
    if (!inner) continue;
    cost.depth = std::max(cost.depth, inner->cost.depth);
    cost.lookups += inner->cost.lookups;
    if (shows_one) break;
  }
  if (++cost.depth > most.depth)
    throw Error(location, "mixes of materials name each other more than " + std::to_string(most.depth) + " deep");
  if (cost.lookups > most.lookups)
    throw Error(location, "this mix takes more than " + std::to_string(most.lookups) +
                              " lookups: each part counts as often as others name it");
  return cost;
}

Frame MaterialTable::shading_frame(std::uint32_t resolved, const SurfaceGeometry& surface,
                                   const TexturePoint& at) const {
  const std::optional<std::uint32_t>& relief = materials_[resolved].relief;
  if (relief) return lanthorn::shading_frame(reliefs_[*relief], *textures_, surface, at);
  return Frame::from_normal_tangent(surface.shading_normal, surface.tangent);
}

std::optional<Normal> MaterialTable::mapped_normal(std::uint32_t resolved, const TexturePoint& at) const {
  const std::optional<std::uint32_t>& relief = materials_[resolved].relief;
  if (!relief || !reliefs_[*relief].normal_map) return std::nullopt;
  return TextureGraph::evaluate(*reliefs_[*relief].normal_map, at);
}

std::uint32_t MaterialTable::choose(const Mix& mix, const TexturePoint& at, const Direction& towards) const {
  const float amount = textures_->evaluate(mix.amount, at);
  if (!(amount > 0)) return mix.materials[0];
  if (amount >= 1) return mix.materials[1];
  const std::uint64_t seed = hash_words({mix.materials[0], mix.materials[1]});
  return unit_float(hash_vec(towards, hash_vec(at.position, seed))) < amount ? mix.materials[1] : mix.materials[0];
}

Bsdf MaterialTable::evaluate(const Material& material, const TexturePoint& at, const Wavelengths& w) const {
  return std::visit([&](const auto& node) { return evaluate_node(node, at, w); }, material.node);
}

Vec2 MaterialTable::alpha(const RoughnessInput& roughness, const TexturePoint& at) const {
  const Vec2 r(textures_->evaluate(roughness.u, at), textures_->evaluate(roughness.v, at));
  return {width_of(r.x, roughness.remap), width_of(r.y, roughness.remap)};
}

ThinFilm MaterialTable::film(const std::optional<FilmInput>& film, const TexturePoint& at, const Wavelengths& w) const {
  if (!film) return {};
  return {film->eta, std::fmax(textures_->evaluate(film->thickness, at), 0.0f), w};
}

Conductor MaterialTable::metal(const MetalInput& m, const TexturePoint& at, const Wavelengths& w) const {
  const Vec2 a = alpha(m.roughness, at);
  if (m.reflectance) return conductor_from_reflectance(textures_->evaluate(*m.reflectance, at, w), a.x, a.y);
  return {textures_->evaluate(m.eta, at, w), textures_->evaluate(m.k, at, w), a.x, a.y};
}

template <class Base>
Coated<Base> MaterialTable::coated(const CoatInput& coat, const Base& base, const TexturePoint& at,
                                   const Wavelengths& w) const {
  const Vec2 a = alpha(coat.roughness, at);
  Coated<Base> c;
  c.coat = {index_at_hero(coat.eta, w), a.x, a.y, coat.eta.varies()};
  c.base = base;
  c.thickness = coat_thickness(textures_->evaluate(coat.thickness, at));
  c.albedo = clamped_albedo(textures_->evaluate(coat.albedo, at, w));
  c.g = std::clamp(textures_->evaluate(coat.g, at), -0.999f, 0.999f);
  c.max_depth = coat.max_depth;
  c.n_samples = coat.samples;
  return c;
}

Bsdf MaterialTable::evaluate_node(const DiffuseMaterial& m, const TexturePoint& at, const Wavelengths& w) const {
  return Diffuse{clamped_albedo(textures_->evaluate(m.reflectance, at, w))};
}

Bsdf MaterialTable::evaluate_node(const TransmissionMaterial& m, const TexturePoint& at, const Wavelengths& w) const {
  return DiffuseTransmission{clamped_albedo(m.scale * textures_->evaluate(m.reflectance, at, w)),
                             clamped_albedo(m.scale * textures_->evaluate(m.transmittance, at, w))};
}

Bsdf MaterialTable::evaluate_node(const ConductorMaterial& m, const TexturePoint& at, const Wavelengths& w) const {
  return metal(m.metal, at, w);
}

Bsdf MaterialTable::evaluate_node(const DielectricMaterial& m, const TexturePoint& at, const Wavelengths& w) const {
  const Vec2 a = alpha(m.roughness, at);
  const Spectrum both = clamped_albedo(textures_->evaluate(m.tint, at, w));
  const Spectrum each = map(both, [](float x) { return std::sqrt(x); });
  return Dielectric{index_at_hero(m.eta, w), a.x, a.y, m.eta.varies(), each, film(m.film, at, w)};
}

Bsdf MaterialTable::evaluate_node(const ThinMaterial& m, const TexturePoint& at, const Wavelengths& w) const {
  const Vec2 a = alpha(m.roughness, at);
  return ThinDielectric{index_at_hero(m.eta, w), a.x, a.y, clamped_albedo(textures_->evaluate(m.tint, at, w)),
                        film(m.film, at, w)};
}

Bsdf MaterialTable::evaluate_node(const CoatedDiffuseMaterial& m, const TexturePoint& at, const Wavelengths& w) const {
  const Diffuse base{clamped_albedo(textures_->evaluate(m.reflectance, at, w))};
  if (m.coat.passage != nullptr) return ClearCoated{m.coat.passage, base.reflectance, m.coat.max_depth / 2};
  return coated(m.coat, base, at, w);
}

Plastic MaterialTable::plastic(const PlasticMaterial& m, const TexturePoint& at, const Wavelengths& w) const {
  Plastic p;
  p.reflectance = clamped_albedo(textures_->evaluate(m.reflectance, at, w));
  p.alpha = std::min(alpha(m.roughness, at).x, 1.0f);
  p.f90 = std::clamp(textures_->evaluate(m.specular, at), 0.0f, 1.0f);
  const float n = m.eta.at(d_line);
  p.f0 = p.f90 * clamped_albedo(sqr((n - 1) / (n + 1)) * textures_->evaluate(m.specular_color, at, w));
  p.film = film(m.film, at, w);
  return p;
}

Bsdf MaterialTable::evaluate_node(const PlasticMaterial& m, const TexturePoint& at, const Wavelengths& w) const {
  const Plastic p = plastic(m, at, w);
  if (!m.sheen_color) return p;
  const float width = sqr(textures_->evaluate(m.sheen_roughness, at));
  return Cloth{p, clamped_albedo(textures_->evaluate(*m.sheen_color, at, w)),
               std::clamp(width, Cloth::least_alpha, 1.0f)};
}

Bsdf MaterialTable::evaluate_node(const CoatedPlasticMaterial& m, const TexturePoint& at, const Wavelengths& w) const {
  return coated(m.coat, plastic(m.base, at, w), at, w);
}

Bsdf MaterialTable::evaluate_node(const MeasuredMaterial& m, const TexturePoint&, const Wavelengths& w) const {
  return Bsdf(std::in_place_type<Measured>, Measured{m.brdf, w});
}

Bsdf MaterialTable::evaluate_node(const CoatedConductorMaterial& m, const TexturePoint& at,
                                  const Wavelengths& w) const {
  return coated(m.coat, under_coat(metal(m.metal, at, w), index_at_hero(m.coat.eta, w)), at, w);
}

Spectrum MaterialTable::absorption(const HairMaterial& m, float beta_n, const TexturePoint& at,
                                   const Wavelengths& w) const {
  if (m.sigma_a) return textures_->evaluate(*m.sigma_a, at, w);
  if (m.color) {
    Spectrum sigma = map(clamped_albedo(textures_->evaluate(*m.color, at, w)),
                         [&](float reflectance) { return hair_absorption(reflectance, beta_n); });
    if (w.mode == ColorMode::rgb) sigma[3] = 0;
    return sigma;
  }
  return textures_->evaluate(m.eumelanin, at) * m.eumelanin_absorption.evaluate(w) +
         textures_->evaluate(m.pheomelanin, at) * m.pheomelanin_absorption.evaluate(w);
}

Bsdf MaterialTable::evaluate_node(const HairMaterial& m, const TexturePoint& at, const Wavelengths& w) const {
  const float beta_n = std::clamp(textures_->evaluate(m.beta_n, at), 0.0f, 1.0f);
  return Hair{absorption(m, beta_n, at, w),
              2 * at.uv.y - 1,
              std::fmax(textures_->evaluate(m.eta, at), 1.0001f),
              std::clamp(textures_->evaluate(m.beta_m, at), 0.0f, 1.0f),
              beta_n,
              textures_->evaluate(m.alpha, at)};
}

}  // namespace lanthorn
