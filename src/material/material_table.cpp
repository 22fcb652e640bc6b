// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "material/material_table.h"

#include <algorithm>
#include <string>
#include <variant>

#include "lanthorn/error.h"
#include "math/hash.h"

namespace lanthorn {

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

struct ClosureMaker {
  MaterialCompiler& compiler;

  template <class Parameters>
  ClosureAt operator()(const Parameters& parameters) const {
    return compile(parameters, compiler);
  }
  // A mix has the closures of its parts.
  ClosureAt operator()(const description::MixMaterial&) const {
    compiler.is_constant = false;
    return {};
  }
  ClosureAt operator()(const description::InterfaceMaterial&) const {
    compiler.traits.is_interface = true;
    compiler.is_constant = false;
    return {};
  }
};

std::optional<Relief> make_relief(const description::Material& m, TextureGraph& textures) {
  Relief relief;
  if (m.displacement) relief.displacement = textures.compile(*m.displacement);
  if (m.normal_map) relief.normal_map = textures.compile(*m.normal_map, m.location, !relief.displacement.node);
  return relief.normal_map || relief.displacement.node ? std::optional(relief) : std::nullopt;
}

}  // namespace

MaterialTable::MaterialTable(const SceneDescription& description, TextureGraph& textures, SpectrumStore& spectra,
                             std::vector<description::Warning>& warnings, const MaterialTable* loaded)
    : textures_(&textures) {
  if (loaded != nullptr) store_ = loaded->store_;
  const std::vector<bool> used = used_materials(description);
  for (const description::Material& source : description.materials) {
    if (!used[materials_.size()]) {
      materials_.emplace_back();
      continue;
    }
    MaterialCompiler compiler(description, textures, spectra, store_, source.location);
    materials_.push_back(make(source, compiler, textures, warnings));
  }
  textures.load_images();
  note_levels();
  for (Relief& relief : reliefs_) {
    if (relief.normal_map && relief.displacement.node && !relief.normal_map->image.image->has_colours_of_normals())
      relief.normal_map.reset();
    relief.detail = textures.detail(relief.displacement);
  }
}

void MaterialTable::note_levels() {
  for (Material& m : materials_) {
    const auto has_levels = [&](std::uint32_t part) { return materials_[part].traits.has_levels; };
    m.traits.has_levels = std::any_of(m.filtered.begin(), m.filtered.end(),
                                      [&](const SpectrumInput& input) { return textures_->has_levels(input); }) ||
                          (m.mix && std::any_of(m.mix->materials.begin(), m.mix->materials.end(), has_levels));
  }
}

MaterialTable::Material MaterialTable::make(const description::Material& source, MaterialCompiler& compiler,
                                            TextureGraph& textures, std::vector<description::Warning>& warnings) {
  Material material;
  material.closure = std::visit(ClosureMaker{compiler}, source.node);
  material.traits = compiler.traits;
  material.filtered = std::move(compiler.filtered);
  material.traits.interior = source.interior;
  if (const auto* mix = std::get_if<description::MixMaterial>(&source.node)) {
    material.mix = Mix{mix->materials, compiler.number(mix->amount)};
    material.traits = settle(*material.mix, source.location, warnings);
  }
  if (const std::optional<Relief> relief = make_relief(source, textures)) {
    material.relief = static_cast<std::uint32_t>(reliefs_.size());
    material.traits.has_relief = true;
    reliefs_.push_back(*relief);
  }
  material.traits.varies = !compiler.is_constant;
  if (compiler.is_constant) material.constant_rgb = material.closure({}, Wavelengths::rgb(0.5f));
  return material;
}

MaterialTraits MaterialTable::settle(Mix& mix, const SourceLocation& location,
                                     std::vector<description::Warning>& warnings) const {
  for (const std::uint32_t part : mix.materials)
    if (part >= materials_.size()) throw Error(location, "a mix must name materials defined before it");
  if (mix.amount.is_constant() && !(mix.amount.input.value > 0)) mix.materials[1] = mix.materials[0];
  if (mix.amount.is_constant() && mix.amount.input.value >= 1) mix.materials[0] = mix.materials[1];
  const MaterialTraits& a = materials_[mix.materials[0]].traits;
  const MaterialTraits& b = materials_[mix.materials[1]].traits;
  if (a.is_interface || b.is_interface) {
    warnings.push_back({location, "a mix with an interface material is not supported: the other material is used"});
    const std::uint32_t other = mix.materials[a.is_interface ? 1 : 0];
    mix.materials = {other, other};
  }
  mix.cost = cost_of(mix, location);
  if (a.interior && b.interior && a.interior != b.interior)
    warnings.push_back({location, "the materials of a mix have different interior media: that of the first is used"});
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
  TextureGraph::Cost cost{0, 1 + textures_->cost(mix.amount.input).lookups};
  const bool shows_one = mix.amount.is_constant() && (!(mix.amount.input.value > 0) || mix.amount.input.value >= 1);
  for (const std::uint32_t part : {mix.materials[0], mix.materials[1]}) {
    const std::optional<Mix>& inner = materials_[part].mix;
    if (!inner) continue;
    cost.depth = std::max(cost.depth, inner->cost.depth);
    cost.lookups += inner->cost.lookups;
    if (shows_one) break;
  }
  if (++cost.depth > most.depth)
    throw Error(location, "mix materials are nested more than " + std::to_string(most.depth) + " deep");
  if (cost.lookups > most.lookups)
    throw Error(location, "this mix takes more than " + std::to_string(most.lookups) +
                              " lookups: a material counts once for each reference to it");
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

std::uint32_t MaterialTable::choose(const Mix& mix, const TexturePoint& at, const Direction& towards) {
  const float amount = mix.amount(at);
  if (!(amount > 0)) return mix.materials[0];
  if (amount >= 1) return mix.materials[1];
  const std::uint64_t seed = hash_words({mix.materials[0], mix.materials[1]});
  return unit_float(hash_vec(towards, hash_vec(at.position, seed))) < amount ? mix.materials[1] : mix.materials[0];
}

}  // namespace lanthorn
