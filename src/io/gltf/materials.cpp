// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 §3.9 and the KHR_materials extensions.
#include "io/gltf/materials.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "io/gltf/textures.h"
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
  MaterialReader(Document& document, const Value& material) : document_(document), material_(material) {}

  std::size_t uv_set() const { return uv_set_.value_or(0); }

  Index read() {
    if (const auto old = material_.extension("KHR_materials_pbrSpecularGlossiness");
        old && !material_.find("pbrMetallicRoughness"))
      read_specular_glossiness(*old);
    else
      read_metallic_roughness();
    read_specular();
    read_dielectric();
    read_clearcoat();
    read_normal_map();
    warn_of_the_rest();
    return add_material(document_.scene, result_, material_.text("name", ""), material_.location());
  }

  FloatParameter read_alpha() {
    const std::string mode = material_.text("alphaMode", "OPAQUE");
    if (mode == "OPAQUE") return {1, {}};
    if (mode != "MASK" && mode != "BLEND")
      throw material_.at("alphaMode").error("must be OPAQUE, MASK or BLEND, not " + in_quotes(mode));
    std::optional<float> cutoff;
    if (mode == "MASK") cutoff = material_.number("alphaCutoff", 0.5f);
    const auto pbr = material_.find("pbrMetallicRoughness");
    const float factor = pbr ? base_factor(*pbr)[3] : 1.0f;
    auto use = pbr ? texture(*pbr, "baseColorTexture") : std::nullopt;
    if (!use) return {cutoff ? static_cast<float>(factor >= *cutoff) : factor, {}};
    use->channel = alpha_channel;
    use->scale = factor;
    use->encoding = Encoding::srgb;  // as the colours of the same image: it is decoded once; alpha is linear anyway
    use->threshold = cutoff;
    return add(*use);
  }

  // KHR_materials_volume: white light becomes `attenuationColor` over `attenuationDistance` (metres).
  std::optional<Medium> read_medium() {
    const auto volume = material_.extension("KHR_materials_volume");
    if (!volume || result_.thin) return {};
    const auto distance = volume->find("attenuationDistance");
    const Vec3 colour = volume->vec3("attenuationColor", Vec3(1));
    if (!distance || colour == Vec3(1)) return {};
    if (!(distance->number() > 0)) throw distance->error("must be above 0");
    const auto absorption = [&](float left) {
      constexpr float least = 1e-6f;
      return -std::log(std::clamp(left, least, 1.0f)) / distance->number();
    };
    Medium medium;
    medium.sigma_a = RgbSpectrum{{absorption(colour.x), absorption(colour.y), absorption(colour.z)}};
    medium.name = material_.text("name", "");
    medium.location = volume->location();
    return medium;
  }

  std::optional<AreaLight> read_emission() {
    const Vec3 factor = material_.vec3("emissiveFactor", Vec3(0));
    const auto strength = material_.extension("KHR_materials_emissive_strength");
    const float scale = strength ? strength->number("emissiveStrength", 1) : 1.0f;
    if (!(max_component(factor) * scale > 0)) return {};
    if (min_component(factor) < 0) throw material_.at("emissiveFactor").error("must not be negative");
    AreaLight light;
    light.radiance = colour(material_, factor, "emissiveTexture");
    light.scale = scale;
    light.two_sided = material_.boolean("doubleSided", false);
    light.location = material_.location();
    return light;
  }

 private:
  static float min_component(const Vec3& v) { return std::min({v.x, v.y, v.z}); }

  std::optional<ImageTexture> texture(const Value& owner, std::string_view key) {
    const auto use = find_texture(document_, owner, key);
    if (!use) return {};
    if (uv_set_.value_or(use->uv_set) != use->uv_set)
      document_.warn("texCoord", owner,
                     "textures of one material use different texture coordinates: all get those of the first");
    uv_set_ = uv_set_.value_or(use->uv_set);
    return use->image;
  }

  FloatParameter add(const ImageTexture& image) {
    document_.scene.float_textures.push_back({image, material_.location()});
    return {0, static_cast<Index>(document_.scene.float_textures.size() - 1)};
  }

  // The number `key` times a channel of a texture.
  FloatParameter factor(const Value& owner, std::string_view key, float otherwise, std::string_view texture_key,
                        Channel channel) {
    const float value = owner.number(key, otherwise);
    auto image = texture(owner, texture_key);
    if (!image) return {value, {}};
    image->channel = channel;
    image->scale = value;
    image->encoding = Encoding::linear;
    return add(*image);
  }

  // A colour times a texture in sRGB.
  SpectrumParameter colour(const Value& owner, const Vec3& value, std::string_view texture_key) {
    auto image = texture(owner, texture_key);
    if (!image) return {RgbSpectrum{rgb_of(value)}, {}};
    image->tint = rgb_of(value);
    image->encoding = Encoding::srgb;
    document_.scene.spectrum_textures.push_back({*image, material_.location()});
    return {0.0f, static_cast<Index>(document_.scene.spectrum_textures.size() - 1)};
  }

  static std::vector<float> base_factor(const Value& pbr) {
    const auto value = pbr.find("baseColorFactor");
    return value ? value->numbers(4) : std::vector<float>{1, 1, 1, 1};
  }

  void read_metallic_roughness() {
    const auto pbr = material_.find("pbrMetallicRoughness");
    result_.metallic = {1, {}};
    if (!pbr) return;
    const std::vector<float> base = base_factor(*pbr);
    result_.base_color = colour(*pbr, {base[0], base[1], base[2]}, "baseColorTexture");
    result_.metallic = factor(*pbr, "metallicFactor", 1, "metallicRoughnessTexture", blue);
    result_.roughness = factor(*pbr, "roughnessFactor", 1, "metallicRoughnessTexture", green);
  }

  // KHR_materials_pbrSpecularGlossiness: a diffuse base under a reflection of any colour.
  void read_specular_glossiness(const Value& old) {
    const auto diffuse = old.find("diffuseFactor");
    const std::vector<float> base = diffuse ? diffuse->numbers(4) : std::vector<float>{1, 1, 1, 1};
    result_.base_color = colour(old, {base[0], base[1], base[2]}, "diffuseTexture");
    result_.specular_color = colour(old, old.vec3("specularFactor", Vec3(1)), "specularGlossinessTexture");
    result_.eta = total_reflection;
    const float glossiness = old.number("glossinessFactor", 1);
    result_.roughness = {1 - glossiness, {}};
    if (auto image = texture(old, "specularGlossinessTexture")) {
      image->channel = alpha_channel;
      image->scale = glossiness;
      image->encoding = Encoding::srgb;
      image->invert = true;
      result_.roughness = add(*image);
    }
    document_.warn("KHR_materials_pbrSpecularGlossiness", old,
                   "KHR_materials_pbrSpecularGlossiness is approximated; its alpha is not read");
  }

  void read_specular() {
    const auto specular = material_.extension("KHR_materials_specular");
    if (!specular) return;
    result_.specular = factor(*specular, "specularFactor", 1, "specularTexture", alpha_channel);
    result_.specular_color = colour(*specular, specular->vec3("specularColorFactor", Vec3(1)), "specularColorTexture");
  }

  void read_dielectric() {
    const auto ior = material_.extension("KHR_materials_ior");
    const float index = ior ? ior->number("ior", 1.5f) : 1.5f;
    if (ior && index != 0 && !(index >= 1)) throw ior->at("ior").error("must be 0 or at least 1");
    const auto dispersion = material_.extension("KHR_materials_dispersion");
    const float inverse_abbe = dispersion ? dispersion->number("dispersion", 0) / 20 : 0.0f;
    if (inverse_abbe < 0) throw dispersion->at("dispersion").error("must not be negative");
    if (ior || dispersion) {
      if (index == 0)
        result_.eta = total_reflection;
      else if (inverse_abbe > 0)
        result_.eta = cauchy(index, inverse_abbe);
      else
        result_.eta = index;
    }
    const auto transmission = material_.extension("KHR_materials_transmission");
    if (!transmission) return;
    result_.transmission = factor(*transmission, "transmissionFactor", 0, "transmissionTexture", red);
    const auto volume = material_.extension("KHR_materials_volume");
    result_.thin = !volume || !(volume->number("thicknessFactor", 0) > 0);
    warn_of_transmission();
  }

  void warn_of_transmission() {
    if (!result_.transmission.texture && result_.transmission.value == 0) return;
    const auto* colour = std::get_if<RgbSpectrum>(&result_.base_color.value);
    if (result_.base_color.texture || colour == nullptr || !(colour->rgb == Rgb{1, 1, 1}))
      document_.warn("transmission colour", material_,
                     "the base colour of transmitting materials is ignored: they are clear");
    if (result_.thin && (result_.roughness.texture || result_.roughness.value > 0.1f))
      document_.warn("thin roughness", material_, "thin sheets that transmit are smooth: their roughness is ignored");
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

  void read_clearcoat() {
    const auto coat = material_.extension("KHR_materials_clearcoat");
    if (!coat) return;
    result_.clearcoat = factor(*coat, "clearcoatFactor", 0, "clearcoatTexture", red);
    result_.clearcoat_roughness = factor(*coat, "clearcoatRoughnessFactor", 0, "clearcoatRoughnessTexture", green);
    if (result_.clearcoat.texture || result_.clearcoat.value != 0)
      document_.warn(
          "clearcoat", *coat,
          "KHR_materials_clearcoat is approximated: under the coat a dielectric has no reflection of its own");
    if (coat->find("clearcoatNormalTexture"))
      document_.warn("clearcoatNormalTexture", *coat, "normal maps of the clear coat are ignored");
  }

  void read_normal_map() {
    auto image = texture(material_, "normalTexture");
    if (!image) return;
    image->encoding = Encoding::linear;
    result_.normal_map = NormalMap{*image, material_.at("normalTexture").number("scale", 1)};
  }

  void warn_of_the_rest() {
    for (const char* const name : {"KHR_materials_sheen", "KHR_materials_anisotropy", "KHR_materials_iridescence",
                                   "KHR_materials_diffuse_transmission", "KHR_materials_subsurface"})
      if (const auto extension = material_.extension(name))
        document_.warn(name, *extension, std::string(name) + " is not supported: ignored");
    if (const auto unlit = material_.extension("KHR_materials_unlit"))
      document_.warn("KHR_materials_unlit", *unlit,
                     "KHR_materials_unlit is not supported: such surfaces are lit like others");
  }

  /// Schlick's reflectance at normal incidence is 1 to within 1e-5: KHR_materials_ior's index 0.
  static constexpr float total_reflection = 1e6f;

  Document& document_;
  const Value& material_;
  MetallicRoughness result_;
  std::optional<std::size_t> uv_set_;
};

}  // namespace

Surface Materials::make(const Value& material) {
  MaterialReader reader(document_, material);
  Surface surface;
  surface.material = reader.read();
  surface.alpha = reader.read_alpha();
  if (auto light = reader.read_emission()) {
    has_lamps_ = has_lamps_ || !light->radiance.texture;
    surface.area_light = static_cast<Index>(document_.scene.area_lights.size());
    document_.scene.area_lights.push_back(std::move(*light));
  }
  if (auto medium = reader.read_medium()) {
    surface.inside_medium = static_cast<Index>(document_.scene.media.size());
    document_.scene.media.push_back(std::move(*medium));
  }
  surface.uv_set = reader.uv_set();
  return surface;
}

const Surface& Materials::of(const Value& primitive) {
  const auto reference = primitive.find("material");
  if (!reference) {
    if (!default_) {
      static const nlohmann::json nothing = nlohmann::json::object();
      default_ = make(Value(nothing, "", document_.name()));
    }
    return *default_;
  }
  const std::size_t i = document_.index("materials", *reference);
  auto found = made_.find(i);
  if (found == made_.end()) found = made_.emplace(i, make(document_.element("materials", i))).first;
  return found->second;
}

}  // namespace lanthorn::gltf
