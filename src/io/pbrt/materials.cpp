// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include "io/measured_brdf.h"
#include "io/pbrt/builders.h"
#include "io/pbrt/values.h"

namespace lanthorn::pbrt {

namespace {

using namespace description;

using MaterialNode = decltype(Material::node);

// "uroughness" and "vroughness" override "roughness". `prefix` is "interface." or "conductor." for coated conductors.
Roughness roughness(const ParameterList& list, const std::string& prefix, Context& context) {
  const FloatParameter both = float_or_texture(list, prefix + "roughness", 0, context);
  return {find_float_or_texture(list, prefix + "uroughness", context).value_or(both),
          find_float_or_texture(list, prefix + "vroughness", context).value_or(both), list.get("remaproughness", true)};
}

SpectrumParameter reflectance(const ParameterList& list, std::string_view name, float otherwise, Context& context) {
  return find_spectrum_or_texture(list, name, SpectrumRole::albedo, context).value_or(SpectrumParameter{otherwise, {}});
}

// The smallest of the values given; 0 for named and blackbody spectra.
float least(const SpectrumValue& value) {
  if (const auto* number = std::get_if<float>(&value)) return *number;
  if (const auto* rgb = std::get_if<RgbSpectrum>(&value)) return std::min({rgb->rgb.r, rgb->rgb.g, rgb->rgb.b});
  if (const auto* samples = std::get_if<SampledSpectrum>(&value))
    return *std::min_element(samples->values.begin(), samples->values.end());
  return 0;
}

bool is_given(const SpectrumValue& value) {
  return !std::holds_alternative<NamedSpectrum>(value) && !std::holds_alternative<BlackbodySpectrum>(value);
}

SpectrumValue index_of_refraction(const ParameterList& list, std::string_view name, float otherwise, Context& context) {
  auto value = find_spectrum(list, name, SpectrumRole::unbounded, context);
  if (!value) return otherwise;
  if (is_given(*value) && !(least(*value) > 0))
    throw list.error(name, "is an index of refraction and must be more than 0");
  return std::move(*value);
}

// Real or imaginary part of a metal's complex index of refraction.
std::optional<SpectrumParameter> index_of_metal(const ParameterList& list, const std::string& name, Context& context) {
  auto value = find_spectrum_or_texture(list, name, SpectrumRole::unbounded, context);
  if (value && least(value->value) < 0) throw list.error(name, "must not be negative");
  return value;
}

// The parameters common to ConductorMaterial and CoatedConductorMaterial: a reflectance, or eta and k (default:
// copper).
template <class Conductor>
Conductor metal(const ParameterList& list, const std::string& prefix, Context& context) {
  Conductor result;
  result.reflectance = find_spectrum_or_texture(list, "reflectance", SpectrumRole::albedo, context);
  auto eta = index_of_metal(list, prefix + "eta", context);
  auto k = index_of_metal(list, prefix + "k", context);
  if (result.reflectance && (eta || k))
    throw list.error("reflectance",
                     "cannot be given together with " + in_quotes(prefix + "eta") + " or " + in_quotes(prefix + "k"));
  if (eta) result.eta = std::move(*eta);
  if (k) result.k = std::move(*k);
  return result;
}

Coat coat(const ParameterList& list, const std::string& prefix, Context& context) {
  Coat result;
  result.roughness = roughness(list, prefix, context);
  result.thickness = float_or_texture(list, "thickness", 0.01f, context);
  result.eta = index_of_refraction(list, prefix + "eta", 1.5f, context);
  result.albedo = reflectance(list, "albedo", 0, context);
  result.g = float_or_texture(list, "g", 0, context);
  result.max_depth = list.get("maxdepth", 10);
  result.samples = list.get("nsamples", 1);
  if (result.max_depth < 1) throw list.error("maxdepth", "must be at least 1");
  if (result.samples < 1) throw list.error("nsamples", "must be at least 1");
  return result;
}

MaterialNode diffuse(const ParameterList& list, Context& context) {
  return DiffuseMaterial{reflectance(list, "reflectance", 0.5f, context)};
}

MaterialNode diffuse_transmission(const ParameterList& list, Context& context) {
  const SpectrumParameter transmittance = names_lost_spectrum_texture(list, "transmittance", context)
                                              ? SpectrumParameter{0.0f, {}}
                                              : reflectance(list, "transmittance", 0.25f, context);
  return DiffuseTransmissionMaterial{reflectance(list, "reflectance", 0.25f, context), transmittance,
                                     list.get("scale", 1.0f)};
}

MaterialNode conductor(const ParameterList& list, Context& context) {
  auto result = metal<ConductorMaterial>(list, "", context);
  result.roughness = roughness(list, "", context);
  return result;
}

MaterialNode dielectric(const ParameterList& list, Context& context) {
  return DielectricMaterial{index_of_refraction(list, "eta", 1.5f, context), roughness(list, "", context)};
}

MaterialNode thin_dielectric(const ParameterList& list, Context& context) {
  return ThinDielectricMaterial{.eta = index_of_refraction(list, "eta", 1.5f, context)};
}

MaterialNode coated_diffuse(const ParameterList& list, Context& context) {
  return CoatedDiffuseMaterial{reflectance(list, "reflectance", 0.5f, context), coat(list, "", context)};
}

MaterialNode coated_conductor(const ParameterList& list, Context& context) {
  auto result = metal<CoatedConductorMaterial>(list, "conductor.", context);
  result.conductor_roughness = roughness(list, "conductor.", context);
  result.coat = coat(list, "interface.", context);
  return result;
}

MaterialNode hair(const ParameterList& list, Context& context) {
  HairMaterial result;
  result.sigma_a = find_spectrum_or_texture(list, "sigma_a", SpectrumRole::unbounded, context);
  result.color =
      find_spectrum_or_texture(list, list.has("color") ? "color" : "reflectance", SpectrumRole::albedo, context);
  const auto eumelanin = find_float_or_texture(list, "eumelanin", context);
  const auto pheomelanin = find_float_or_texture(list, "pheomelanin", context);
  if (static_cast<int>(result.sigma_a.has_value()) + static_cast<int>(result.color.has_value()) +
          static_cast<int>(eumelanin || pheomelanin) >
      1)
    context.warn("hair color", list.place(),
                 "hair has more than one of \"sigma_a\", a colour and melanin: the first of these is used");
  result.eumelanin = eumelanin.value_or(FloatParameter{pheomelanin ? 0.0f : 1.3f, {}});
  result.pheomelanin = pheomelanin.value_or(FloatParameter{0, {}});
  result.eta = float_or_texture(list, "eta", 1.55f, context);
  if (!result.eta.texture && !(result.eta.value > 0))
    throw list.error("eta", "is an index of refraction and must be more than 0");
  result.beta_m = float_or_texture(list, "beta_m", 0.3f, context);
  result.beta_n = float_or_texture(list, "beta_n", 0.3f, context);
  result.alpha = float_or_texture(list, "alpha", 2, context);
  return result;
}

MaterialNode measured(const ParameterList& list, Context& context) {
  const std::string name = list.required_string("filename");
  const Place place = list.find("filename")->place;
  if (const auto known = context.measured_brdfs.find(name); known != context.measured_brdfs.end())
    return MeasuredMaterial{known->second};
  const std::filesystem::path path = context.add_file(name, place);
  const std::optional<std::string> bytes = context.read_unless_missing(path, place);
  if (!bytes) return DiffuseMaterial{};
  const auto index = static_cast<Index>(context.scene.measured_brdfs.size());
  try {
    context.scene.measured_brdfs.push_back(
        std::make_shared<const MeasuredData>(parse_measured_brdf(*bytes, path.string())));
  } catch (const Error& problem) {
    throw Error(place.location(), problem.what());
  }
  context.measured_brdfs.emplace(name, index);
  return MeasuredMaterial{index};
}

MaterialNode mix(const ParameterList& list, Context& context) {
  const std::vector<std::string> names = list.strings("materials");
  if (names.size() != 2) throw list.error("materials", "must name two materials");
  MixMaterial result;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto it = context.named_materials.find(names[i]);
    if (it == context.named_materials.end())
      throw list.error("materials", "names " + in_quotes(names[i]) + ", which is not defined before it");
    result.materials[i] = it->second;
  }
  result.amount = float_or_texture(list, "amount", 0.5f, context);
  return result;
}

MaterialNode interface(const ParameterList&, Context&) { return InterfaceMaterial{}; }

struct Builder {
  std::string_view name;
  MaterialNode (*build)(const ParameterList&, Context&);
};
constexpr std::array<Builder, 13> builders = {{{"diffuse", diffuse},
                                               {"diffusetransmission", diffuse_transmission},
                                               {"conductor", conductor},
                                               {"dielectric", dielectric},
                                               {"thindielectric", thin_dielectric},
                                               {"coateddiffuse", coated_diffuse},
                                               {"coatedconductor", coated_conductor},
                                               {"hair", hair},
                                               {"measured", measured},
                                               {"mix", mix},
                                               {"interface", interface},
                                               {"none", interface},
                                               {"", interface}}};

// A dielectric interface with the medium inside. pbrt-v4 approximates it by a diffusion profile.
MaterialNode subsurface(const ParameterList& list, Context& context, Material& material) {
  const SpectrumValue eta = index_of_refraction(list, "eta", 1.33f, context);
  context.scene.media.push_back(make_subsurface_medium(list, eta, context));
  material.interior = static_cast<Index>(context.scene.media.size() - 1);
  return DielectricMaterial{eta, roughness(list, "", context)};
}

// `mix` and `interface` have no displacement or normal map; these parameters are reported as unused.
void read_relief(const ParameterList& list, Context& context, Material& material) {
  if (std::holds_alternative<MixMaterial>(material.node) || std::holds_alternative<InterfaceMaterial>(material.node))
    return;
  material.displacement = find_float_or_texture(list, "displacement", context);
  const std::string filename = list.get("normalmap", "");
  if (filename.empty()) return;
  NormalMap& map = material.normal_map.emplace();
  map.image.filename = context.add_file(filename, list.place()).string();
  map.image.encoding = Encoding::linear;
  if (material.displacement)
    context.warn("normalmap and displacement", list.place(),
                 "a material has both \"normalmap\" and \"displacement\": the displacement is ignored");
  material.displacement.reset();
}

}  // namespace

Material make_material(const std::string& kind, const ParameterList& list, Context& context) {
  Material material;
  material.location = list.place().location();
  const auto* it = std::find_if(builders.begin(), builders.end(), [&](const Builder& b) { return b.name == kind; });
  if (it != builders.end()) {
    material.node = it->build(list, context);
  } else if (kind == "subsurface") {
    material.node = subsurface(list, context, material);
  } else {
    throw context.unknown("material", "Material", kind, list.place());
  }
  read_relief(list, context, material);
  report_unused(list, context);
  return material;
}

}  // namespace lanthorn::pbrt
