// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 §3.9 and the KHR_materials extensions.
#include "io/gltf/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include "lanthorn/text.h"
#include "math/vec.h"

namespace lanthorn::gltf {

namespace {

using namespace description;

enum Channel : std::uint8_t { red, green, blue, alpha_channel };

Rgb rgb_of(const Vec3& v) { return {v.x, v.y, v.z}; }

// Reads one material. All of its textures must use the same texture coordinates.
class MaterialReader {
 public:
  MaterialReader(Document& document, const Value& material, bool has_colors)
      : document_(document), material_(material), has_colors_(has_colors) {}

  std::size_t uv_set() const { return uv_set_.value_or(0); }

  bool is_unlit() const { return material_.extension("KHR_materials_unlit").has_value(); }
  float tangent_turn() const { return tangent_turn_; }
  // Very rough metal looks like a matte surface.
  bool reflects_surroundings() const {
    constexpr float rough = 0.7f;
    const auto may_exceed = [](const FloatParameter& p, float limit) { return p.texture || p.value > limit; };
    const bool is_smooth = result_.roughness.texture || result_.roughness.value < rough;
    return is_smooth && (may_exceed(result_.metallic, 0.5f) || may_exceed(result_.transmission, 0));
  }

  Index read() {
    if (is_unlit()) {
      Material& black = document_.scene.materials.emplace_back();
      black.node = DiffuseMaterial{{0.0f, {}}};
      black.name = material_.text("name", "");
      black.location = material_.location();
      return static_cast<Index>(document_.scene.materials.size() - 1);
    }
    if (const auto old = material_.extension("KHR_materials_pbrSpecularGlossiness");
        old && !material_.find("pbrMetallicRoughness"))
      read_specular_glossiness(*old);
    else
      read_metallic_roughness();
    read_specular();
    read_dielectric();
    read_diffuse_transmission();
    read_anisotropy();
    read_sheen();
    read_iridescence();
    read_clearcoat();
    read_normal_map();
    return add_material(document_.scene, result_, material_.text("name", ""), material_.location());
  }

  FloatParameter read_alpha() {
    const std::string_view mode = alpha_mode();
    if (mode == "OPAQUE") return {1, {}};
    const auto pbr = material_.find("pbrMetallicRoughness");
    FloatParameter alpha{pbr ? base_factor(*pbr)[3] : 1.0f, {}};
    if (auto use = pbr ? texture(*pbr, "baseColorTexture").image : std::nullopt) {
      use->channel = alpha_channel;
      use->scale = alpha.value;
      use->encoding = Encoding::srgb;  // as for colours of the image: decoded once; alpha is linear
      alpha = add(*use);
    }
    if (has_colors_) alpha = times_vertex_alpha(alpha);
    if (mode == "BLEND") return alpha;
    const float cutoff = material_.number("alphaCutoff", 0.5f);
    if (alpha.texture) return add(ThresholdTexture<FloatParameter>{alpha, cutoff});
    return {alpha.value >= cutoff ? 1.0f : 0.0f, {}};
  }

  // KHR_materials_volume: `attenuationColor` is the transmittance over `attenuationDistance` (metres).
  std::optional<Medium> read_medium() {
    const auto volume = material_.extension("KHR_materials_volume");
    if (!volume || result_.thin) return {};
    const float distance = volume->number("attenuationDistance", infinity, Range::above(0));
    const Vec3 colour = volume->colour("attenuationColor", Vec3(1));
    if (distance == infinity || colour == Vec3(1)) return {};
    const auto absorption = [&](float left) {
      constexpr float least = 1e-6f;
      return -std::log(std::clamp(left, least, 1.0f)) / distance;
    };
    Medium medium;
    medium.sigma_a = RgbSpectrum{{absorption(colour.x), absorption(colour.y), absorption(colour.z)}};
    medium.name = material_.text("name", "");
    medium.location = volume->location();
    return medium;
  }

  std::optional<AreaLight> read_emission() {
    if (is_unlit()) return read_unlit();
    const Vec3 factor = material_.colour("emissiveFactor", Vec3(0));
    const auto strength = material_.extension("KHR_materials_emissive_strength");
    const float scale = strength ? strength->number("emissiveStrength", 1, Range::at_least(0)) : 1.0f;
    if (!(max_component(factor) * scale > 0)) return {};
    AreaLight light;
    light.radiance = colour(material_, factor, "emissiveTexture", neutral_effect);
    const auto* constant = std::get_if<RgbSpectrum>(&light.radiance.value);
    if (!light.radiance.texture && constant != nullptr && constant->rgb == Rgb{}) return {};
    light.scale = scale;
    light.two_sided = material_.boolean("doubleSided", false);
    light.location = material_.location();
    return light;
  }

 private:
  // KHR_materials_unlit: the base colour becomes radiance, on both sides, since nothing is culled.
  AreaLight read_unlit() {
    const auto pbr = material_.find("pbrMetallicRoughness");
    AreaLight light;
    light.radiance = pbr ? base_color(*pbr) : times_vertex_color({RgbSpectrum{{1, 1, 1}}, {}});
    light.two_sided = true;
    light.location = material_.location();
    document_.scene.view.film.display_emission = true;
    document_.warn("KHR_materials_unlit", material_,
                   "KHR_materials_unlit: unlit surfaces emit their colour, which slightly illuminates other surfaces");
    return light;
  }

  std::string_view alpha_mode() const {
    constexpr std::string_view otherwise = "OPAQUE";
    const auto mode = material_.find("alphaMode");
    if (!mode) return otherwise;
    if (const auto known = mode->name_among({otherwise, "MASK", "BLEND"})) return *known;
    mode->warn("alphaMode",
               "alphaMode must be OPAQUE, MASK or BLEND, not " + in_quotes(mode->text()) + ": OPAQUE is used");
    return otherwise;
  }

  /// Result of looking up a texture.
  struct Found {
    std::optional<ImageTexture> image;
    bool is_lost = false;  ///< the texture exists but is missing on disk or unreadable
  };
  Found texture(const Value& owner, std::string_view key) {
    const auto use = find_texture(document_, owner, key);
    if (!use) return {};
    if (!use->image) return {{}, true};
    if (uv_set_.value_or(use->uv_set) != use->uv_set)
      document_.warn("texCoord", owner,
                     "textures of one material use different texture coordinates: all use those of the first");
    uv_set_ = uv_set_.value_or(use->uv_set);
    return {use->image};
  }

  FloatParameter add(decltype(FloatTexture::node) node) {
    document_.scene.float_textures.push_back({std::move(node), material_.location()});
    return {0, static_cast<Index>(document_.scene.float_textures.size() - 1)};
  }
  SpectrumParameter add_spectrum(decltype(SpectrumTexture::node) node) {
    document_.scene.spectrum_textures.push_back({std::move(node), material_.location()});
    return {0.0f, static_cast<Index>(document_.scene.spectrum_textures.size() - 1)};
  }

  FloatParameter times_vertex_alpha(const FloatParameter& alpha) {
    const FloatParameter vertices = add(VertexColorTexture{});
    return add(ScaleTexture<FloatParameter>{alpha, vertices});
  }
  SpectrumParameter times_vertex_color(const SpectrumParameter& colour) {
    if (!has_colors_) return colour;
    const SpectrumParameter vertices = add_spectrum(VertexColorTexture{});
    return add_spectrum(ScaleTexture<SpectrumParameter, SpectrumParameter>{colour, vertices});
  }

  // A texture that is missing or unreadable is replaced by the neutral value of its role: properties of every surface
  // keep their factors, and colours become grey. Effects that only some surfaces or places have are switched off:
  // emission, transmission, coats, sheen and films.
  static constexpr float neutral_property = 1, neutral_grey = 0.5f, neutral_effect = 0;

  // The number `key` times a channel of a texture.
  FloatParameter factor(const Value& owner, std::string_view key, float otherwise, std::string_view texture_key,
                        Channel channel, float neutral = neutral_property) {
    const float value = owner.number(key, otherwise, zero_to_one);
    if (value == 0) return {0, {}};
    auto [image, is_lost] = texture(owner, texture_key);
    if (!image) return {is_lost ? neutral * value : value, {}};
    image->channel = channel;
    image->scale = value;
    image->encoding = Encoding::linear;
    return add(*image);
  }

  // A colour times an sRGB texture.
  SpectrumParameter colour(const Value& owner, const Vec3& value, std::string_view texture_key, float neutral) {
    auto [image, is_lost] = texture(owner, texture_key);
    if (!image) return {RgbSpectrum{rgb_of(is_lost ? neutral * value : value)}, {}};
    image->tint = rgb_of(value);
    image->encoding = Encoding::srgb;
    return add_spectrum(*image);
  }

  static std::vector<float> base_factor(const Value& pbr) {
    return pbr.numbers("baseColorFactor", {1, 1, 1, 1}, Range::at_least(0));
  }

  // Factor times texture times vertex colours.
  SpectrumParameter base_color(const Value& pbr) {
    const std::vector<float> base = base_factor(pbr);
    return times_vertex_color(colour(pbr, {base[0], base[1], base[2]}, "baseColorTexture", neutral_grey));
  }

  void read_metallic_roughness() {
    const auto pbr = material_.find("pbrMetallicRoughness");
    result_.metallic = {1, {}};
    if (!pbr) {
      result_.base_color = times_vertex_color(result_.base_color);
      return;
    }
    warn_of_lost_shader(*pbr);
    result_.base_color = base_color(*pbr);
    result_.metallic = factor(*pbr, "metallicFactor", 1, "metallicRoughnessTexture", blue);
    result_.roughness = factor(*pbr, "roughnessFactor", 1, "metallicRoughnessTexture", green);
  }

  // Exporters that cannot express a shader leave everything out.
  void warn_of_lost_shader(const Value& pbr) {
    constexpr std::array pbr_keys{"baseColorFactor", "baseColorTexture", "metallicFactor", "roughnessFactor",
                                  "metallicRoughnessTexture"};
    constexpr std::array keys{"extensions", "emissiveFactor", "emissiveTexture", "normalTexture"};
    const auto has_any = [](const Value& value, const auto& names) {
      return std::any_of(names.begin(), names.end(), [&](const char* name) { return value.find(name).has_value(); });
    };
    if (has_any(pbr, pbr_keys) || has_any(material_, keys)) return;
    document_.warn("empty material", pbr,
                   fmt::format("nothing is set, so material {} is rough white metal, the default of glTF; Blender "
                               "exports the Principled BSDF, but neither the Glass nor the Glossy BSDF",
                               in_quotes(material_.text("name", ""))));
  }

  // KHR_materials_pbrSpecularGlossiness: a diffuse base under a coloured reflection.
  void read_specular_glossiness(const Value& old) {
    const std::vector<float> base = old.numbers("diffuseFactor", {1, 1, 1, 1}, Range::at_least(0));
    result_.base_color = times_vertex_color(colour(old, {base[0], base[1], base[2]}, "diffuseTexture", neutral_grey));
    constexpr float dielectric = 0.04f;  // reflectance at normal incidence
    result_.dielectric.specular_color =
        colour(old, old.colour("specularFactor", Vec3(1)), "specularGlossinessTexture", dielectric);
    result_.dielectric.eta = total_reflection;
    const float glossiness = old.number("glossinessFactor", 1, zero_to_one);
    result_.roughness = {1 - glossiness, {}};
    if (auto image = texture(old, "specularGlossinessTexture").image) {
      image->channel = alpha_channel;
      image->scale = glossiness;
      image->encoding = Encoding::srgb;
      image->invert = true;
      result_.roughness = add(*image);
    }
    document_.warn("KHR_materials_pbrSpecularGlossiness", old,
                   "KHR_materials_pbrSpecularGlossiness is approximated; its alpha is ignored");
  }

  void read_specular() {
    const auto specular = material_.extension("KHR_materials_specular");
    if (!specular) return;
    result_.dielectric.specular = factor(*specular, "specularFactor", 1, "specularTexture", alpha_channel);
    result_.dielectric.specular_color =
        colour(*specular, specular->colour("specularColorFactor", Vec3(1)), "specularColorTexture", neutral_property);
  }

  void read_dielectric() {
    const auto ior = material_.extension("KHR_materials_ior");
    const float index = ior ? index_of(*ior) : 1.5f;
    const auto dispersion = material_.extension("KHR_materials_dispersion");
    const float inverse_abbe = dispersion ? dispersion->number("dispersion", 0, Range::at_least(0)) / 20 : 0.0f;
    if (ior || dispersion) {
      if (index == 0)
        result_.dielectric.eta = total_reflection;
      else if (inverse_abbe > 0)
        result_.dielectric.eta = cauchy(index, inverse_abbe);
      else
        result_.dielectric.eta = index;
    }
    const auto transmission = material_.extension("KHR_materials_transmission");
    if (!transmission) return;
    result_.transmission = factor(*transmission, "transmissionFactor", 0, "transmissionTexture", red, neutral_effect);
    const auto volume = material_.extension("KHR_materials_volume");
    result_.thin = !volume || !(volume->number("thicknessFactor", 0) > 0);
    // For a thin sheet, files rarely give an index. Blender writes gems and water like this.
    if (!volume && ior && (result_.transmission.texture || result_.transmission.value > 0))
      document_.warn("thin sheet", *transmission,
                     fmt::format("material {} has no KHR_materials_volume, so it is a thin sheet, which does not bend "
                                 "light; solid glass needs a thickness (in Blender, the socket Thickness of the group "
                                 "\"glTF Settings\")",
                                 in_quotes(material_.text("name", ""))));
  }

  // 0 stands for total reflection.
  static float index_of(const Value& ior) {
    const auto given = ior.find("ior");
    return given && given->is_zero() ? 0 : ior.number("ior", 1.5f, Range::at_least(1));
  }

  void read_diffuse_transmission() {
    const auto diffuse = material_.extension("KHR_materials_diffuse_transmission");
    if (!diffuse) return;
    result_.diffuse_transmission =
        factor(*diffuse, "diffuseTransmissionFactor", 0, "diffuseTransmissionTexture", alpha_channel, neutral_effect);
    result_.diffuse_transmission_color = colour(*diffuse, diffuse->colour("diffuseTransmissionColorFactor", Vec3(1)),
                                                "diffuseTransmissionColorTexture", neutral_grey);
    if (result_.diffuse_transmission.texture || result_.diffuse_transmission.value != 0)
      document_.warn("KHR_materials_diffuse_transmission", *diffuse,
                     "KHR_materials_diffuse_transmission is approximated: parts that transmit do not reflect");
  }

  void read_anisotropy() {
    const auto anisotropy = material_.extension("KHR_materials_anisotropy");
    if (!anisotropy) return;
    result_.anisotropy = factor(*anisotropy, "anisotropyStrength", 0, "anisotropyTexture", blue, neutral_effect);
    tangent_turn_ = anisotropy->number("anisotropyRotation", 0);
    if (anisotropy->find("anisotropyTexture"))
      document_.warn("anisotropyTexture", *anisotropy,
                     "KHR_materials_anisotropy: the textures' directions are ignored, their strengths are used");
    if (result_.metallic.texture || result_.metallic.value < 1)
      document_.warn("KHR_materials_anisotropy", *anisotropy,
                     "KHR_materials_anisotropy is approximated: it affects metal and glass, not opaque dielectrics");
  }

  // Cauchy's formula n(lambda) = a + b / lambda^2 with the given index at the d line (587.6 nm) and the Abbe number
  // (n_d - 1) / (n_F - n_C), F at 486.1 and C at 656.3 nm.
  static SampledSpectrum cauchy(float index, float inverse_abbe) {
    const auto inverse_square = [](double nm) { return 1 / (nm * nm); };
    const double b = (static_cast<double>(index) - 1) * static_cast<double>(inverse_abbe) /
                     (inverse_square(486.1) - inverse_square(656.3));
    SampledSpectrum result;
    for (int nm = 360; nm <= 830; nm += 5) {
      result.nm.push_back(static_cast<float>(nm));
      result.values.push_back(static_cast<float>(index + b * (inverse_square(nm) - inverse_square(587.6))));
    }
    return result;
  }

  void read_sheen() {
    const auto sheen = material_.extension("KHR_materials_sheen");
    if (!sheen) return;
    const Vec3 factor_of_color = sheen->colour("sheenColorFactor", Vec3(0));
    if (!(max_component(factor_of_color) > 0)) return;
    result_.dielectric.sheen_color = colour(*sheen, factor_of_color, "sheenColorTexture", neutral_effect);
    result_.dielectric.sheen_roughness =
        factor(*sheen, "sheenRoughnessFactor", 0, "sheenRoughnessTexture", alpha_channel);
    if (result_.metallic.texture || result_.metallic.value > 0)
      document_.warn("KHR_materials_sheen", *sheen, "KHR_materials_sheen is ignored on metal");
  }

  void read_iridescence() {
    const auto iridescence = material_.extension("KHR_materials_iridescence");
    if (!iridescence) return;
    result_.iridescence = factor(*iridescence, "iridescenceFactor", 0, "iridescenceTexture", red, neutral_effect);
    if (!result_.iridescence.texture && result_.iridescence.value == 0) return;
    result_.film.eta = iridescence->number("iridescenceIor", 1.3f, Range::at_least(1));
    result_.film.thickness = {thickness(*iridescence, "iridescenceThicknessMaximum", 400), {}};
    const float least = thickness(*iridescence, "iridescenceThicknessMinimum", 100);
    if (auto image = texture(*iridescence, "iridescenceThicknessTexture").image) {
      image->channel = green;
      image->encoding = Encoding::linear;
      result_.film.thickness = add(MixTexture<FloatParameter>{{least, {}}, result_.film.thickness, add(*image)});
    }
  }

  // Converts to nanometres.
  static float thickness(const Value& iridescence, std::string_view key, float otherwise) {
    return iridescence.number(key, otherwise, Range::at_least(0));
  }

  void read_clearcoat() {
    const auto coat = material_.extension("KHR_materials_clearcoat");
    if (!coat) return;
    result_.clearcoat = factor(*coat, "clearcoatFactor", 0, "clearcoatTexture", red, neutral_effect);
    result_.clearcoat_roughness = factor(*coat, "clearcoatRoughnessFactor", 0, "clearcoatRoughnessTexture", green);
    if (material_.extension("KHR_materials_sheen"))
      document_.warn("sheen", *coat, "KHR_materials_sheen is ignored under a clear coat");
    if (coat->find("clearcoatNormalTexture"))
      document_.warn("clearcoatNormalTexture", *coat, "normal maps of the clear coat are ignored");
  }

  void read_normal_map() {
    auto image = texture(material_, "normalTexture").image;
    if (!image) return;
    image->encoding = Encoding::linear;
    result_.normal_map = NormalMap{*image, material_.at("normalTexture").number("scale", 1)};
  }

  Document& document_;
  const Value& material_;
  bool has_colors_;
  MetallicRoughness result_;
  std::optional<std::size_t> uv_set_;
  float tangent_turn_ = 0;
};

}  // namespace

bool Materials::reads_extension(std::string_view name) {
  constexpr std::string_view prefix = "KHR_materials_";
  constexpr auto known = std::to_array<std::string_view>(
      {"anisotropy", "clearcoat", "diffuse_transmission", "dispersion", "emissive_strength", "ior", "iridescence",
       "pbrSpecularGlossiness", "sheen", "specular", "transmission", "unlit", "variants", "volume"});
  return name.starts_with(prefix) && std::find(known.begin(), known.end(), name.substr(prefix.size())) != known.end();
}

Surface Materials::make(const Value& material, bool has_colors) {
  MaterialReader reader(document_, material, has_colors);
  Surface surface;
  surface.material = reader.read();
  if (!material.boolean("doubleSided", false)) one_sided_.insert(surface.material);
  reflect_surroundings_ = reflect_surroundings_ || reader.reflects_surroundings();
  surface.alpha = reader.read_alpha();
  if (auto light = reader.read_emission()) {
    surface.area_light = static_cast<Index>(document_.scene.area_lights.size());
    if (!light->radiance.texture && !reader.is_unlit()) lamps_.push_back(*surface.area_light);
    document_.scene.area_lights.push_back(std::move(*light));
  }
  if (auto medium = reader.read_medium()) {
    surface.inside_medium = static_cast<Index>(document_.scene.media.size());
    document_.scene.media.push_back(std::move(*medium));
  }
  surface.uv_set = reader.uv_set();
  surface.tangent_turn = reader.tangent_turn();
  return surface;
}

// Primitives without a mapping for the variant keep their own material.
std::optional<Value> Materials::reference_of(const Value& primitive) const {
  const auto variants = variant_ ? primitive.extension("KHR_materials_variants") : std::nullopt;
  const auto mappings = variants ? variants->find_array("mappings") : std::nullopt;
  for (std::size_t i = 0; mappings && i < mappings->size(); ++i) {
    const Value mapping = mappings->element(i), chosen = mapping.at("variants");
    for (std::size_t k = 0; k < chosen.size(); ++k)
      if (chosen.element(k).integer() == *variant_) return mapping.at("material");
  }
  return primitive.find("material");
}

const Surface& Materials::of(const Value& primitive) {
  const auto reference = reference_of(primitive);
  const bool has_colors = primitive.at("attributes").find("COLOR_0").has_value();
  const std::int64_t i = reference ? static_cast<std::int64_t>(document_.index("materials", *reference)) : -1;
  auto found = made_.find({i, has_colors});
  if (found == made_.end()) {
    const Value material = reference ? document_.follow("materials", *reference) : document_.nothing();
    found = made_.emplace(std::pair(i, has_colors), make(material, has_colors)).first;
  }
  return found->second;
}

}  // namespace lanthorn::gltf
