// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The format: Wavefront, "MTL Material Format", Advanced Visualizer manual (1995); its PBR extension: Clara.io (2014).
#include "io/obj/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/metallic_roughness.h"
#include "io/missing_files.h"
#include "io/obj/words.h"
#include "lanthorn/text.h"

namespace lanthorn::obj {

namespace {

using namespace description;

struct Source {
  std::string name;
  SourceLocation location;
  Rgb kd{0.8f, 0.8f, 0.8f}, ks{0, 0, 0}, ke{0, 0, 0}, tf{1, 1, 1};
  std::optional<float> exponent, index, opacity, roughness, metallic, clearcoat, clearcoat_roughness;
  int illumination = 2;
  std::optional<ImageTexture> map_kd, map_ks, map_ke, map_d, map_pr, map_pm, norm, bump;
  float bump_multiplier = 1;
  bool lost_colours = false, lost_emission = false;  ///< the image is missing
  std::map<std::string, File> files;
};

bool is_black(const Rgb& c) { return c.r == 0 && c.g == 0 && c.b == 0; }

// Roughness whose GGX alpha gives about the same highlight as Blinn's exponent: alpha^2 = 2 / (n + 2) (Walter et al.
// 2007, §5.2), roughness = sqrt(alpha).
float roughness_of(float exponent) { return std::sqrt(std::sqrt(2 / (std::max(exponent, 0.0f) + 2))); }
// Since 3.1, Blender writes the exponent as 1000 (1 - roughness)^2, and stores the roughness itself in map_Ns and the
// metalness in map_refl.
float roughness_by_blender(float exponent) { return 1 - std::sqrt(std::clamp(exponent / 1000, 0.0f, 1.0f)); }
constexpr std::string_view start_by_blender = "# Blender ";
bool has_blender_version(std::string_view text) {
  return text.starts_with(start_by_blender) && text.size() > start_by_blender.size() &&
         text[start_by_blender.size()] >= '0' && text[start_by_blender.size()] <= '9';
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

class MaterialFile {
 public:
  MaterialFile(std::string_view text, const std::filesystem::path& folder, const std::string& name,
               const FileAccess* access, SceneDescription& scene, Materials& materials, const Warnings& warnings)
      : words_(text, name),
        names_alpha_(text.starts_with(start_by_blender)),
        by_blender_(has_blender_version(text)),
        folder_(folder),
        access_(access),
        scene_(scene),
        materials_(materials),
        warnings_(warnings) {}

  void read() {
    std::optional<Source> current;
    while (words_.next_line()) {
      const Word key = words_.word("a keyword");
      if (lower(key.text) == "newmtl") {
        if (current) add(*current);
        current.emplace();
        current->location = words_.location(key);
        current->name = words_.rest().text;
        if (current->name.empty())
          warnings_.add("mtl name", words_.location(), "the material has no name: usemtl without a name refers to it");
      } else if (current) {
        read_line(key, *current);
      } else {
        throw Error(words_.location(key), in_quotes(key.text) + " appears before the first newmtl");
      }
    }
    if (current) add(*current);
  }

 private:
  void read_line(const Word& key, Source& m) {
    const std::string name = lower(key.text);
    if (read_colour(name, m) || read_number(name, m) || read_map(name, m)) return;
    // Ambient light has no physical meaning; sharpness belongs to reflection maps.
    if (name == "ka" || name == "map_ka" || name == "sharpness") return;
    warnings_.add_name("mtl keyword", words_.location(key), std::string(key.text), [](const auto& names) {
      return fmt::format("{} in materials {} not supported: ignored", quoted_list(names), is_or_are(names));
    });
  }

  bool read_colour(std::string_view name, Source& m) {
    const std::array<std::pair<std::string_view, Rgb*>, 4> colours = {
        {{"kd", &m.kd}, {"ks", &m.ks}, {"ke", &m.ke}, {"tf", &m.tf}}};
    const auto found = std::find_if(colours.begin(), colours.end(), [&](const auto& c) { return c.first == name; });
    if (found == colours.end()) return false;
    Rgb* const colour = found->second;
    const Word first = words_.word("a colour");
    if (first.text == "spectral" || first.text == "xyz") {
      warnings_.add("mtl " + std::string(first.text), words_.location(first),
                    "colours specified by " + in_quotes(first.text) + " are not supported: ignored");
      return true;
    }
    colour->r = colour->g = colour->b = not_negative(first);
    if (const auto second = words_.find_word()) {
      colour->g = not_negative(*second);
      colour->b = not_negative(words_.word("blue"));
    }
    return true;
  }

  float not_negative(const Word& word) const {
    const float value = words_.number(word);
    if (value < 0) throw Error(words_.location(word), "must not be negative, but is " + in_quotes(word.text));
    return value;
  }

  bool read_number(std::string_view name, Source& m) {
    const std::array<std::pair<std::string_view, std::optional<float>*>, 7> numbers = {
        {{"ns", &m.exponent},
         {"ni", &m.index},
         {"d", &m.opacity},
         {"pr", &m.roughness},
         {"pm", &m.metallic},
         {"pc", &m.clearcoat},
         {"pcr", &m.clearcoat_roughness}}};
    if (name == "illum") {
      m.illumination = static_cast<int>(std::min(not_negative(words_.word("a number")), 1000.0f));
      return true;
    }
    if (name == "tr") {
      m.opacity = 1 - not_negative(words_.word("a number"));
      return true;
    }
    for (const auto& [known, target] : numbers) {
      if (known != name) continue;
      Word value = words_.word("a number");
      if (value.text == "-halo") value = words_.word("a number");
      *target = not_negative(value);
      if (name == "ni" && m.index == 0.0f)
        warnings_.add("mtl Ni", words_.location(value), "the index of refraction Ni is 0: 1.5 is used");
      return true;
    }
    return false;
  }

  bool read_map(std::string_view name, Source& m) {
    if (name == "map_bump" || name == "bump") {
      m.bump = read_image(m, &m.bump_multiplier);
      if (is_left_out(*m.bump)) m.bump.reset();
      return true;
    }
    const std::array<std::pair<std::string_view, std::optional<ImageTexture>*>, 9> maps = {{{"map_kd", &m.map_kd},
                                                                                            {"map_ks", &m.map_ks},
                                                                                            {"map_ke", &m.map_ke},
                                                                                            {"map_d", &m.map_d},
                                                                                            {"map_pr", &m.map_pr},
                                                                                            {"map_pm", &m.map_pm},
                                                                                            {"map_ns", &m.map_pr},
                                                                                            {"map_refl", &m.map_pm},
                                                                                            {"norm", &m.norm}}};
    for (const auto& [known, target] : maps) {
      if (known != name || ((name == "map_ns" || name == "map_refl") && !by_blender_)) continue;
      *target = read_image(m, nullptr);
      if (is_left_out(**target)) lose(*target, m);
      return true;
    }
    return false;
  }

  bool is_left_out(const ImageTexture& image) const {
    return access_ != nullptr && access_->is_missing(image.filename);
  }
  // A lost image is replaced by the neutral value of its role: grey colours and no emission; otherwise it has no
  // effect.
  static void lose(std::optional<ImageTexture>& image, Source& m) {
    image.reset();
    m.lost_colours = m.lost_colours || &image == &m.map_kd;
    m.lost_emission = m.lost_emission || &image == &m.map_ke;
  }

  // Reads options, then a file name that may contain blanks. `multiplier`: for bump maps, else null.
  ImageTexture read_image(Source& m, float* multiplier) {
    ImageTexture image;
    Word word = words_.word("a file name");
    while (word.text.size() > 1 && word.text[0] == '-') {
      word = read_option(word, image, multiplier);
      if (word.text.empty()) throw Error(words_.location(word), "a file name is missing");
    }
    const Word more = words_.rest();
    std::string file(word.text);
    if (!more.text.empty()) file.assign(word.text.data(), more.text.data() + more.text.size());
    std::replace(file.begin(), file.end(), '\\', '/');
    const std::filesystem::path path = find_file(folder_, file, access_, [&](const std::string& message) {
      warnings_.add("elsewhere", words_.location(word), message);
    });
    m.files.try_emplace(file, File{path, {}, words_.location(word)});
    image.filename = path.string();
    return image;
  }

  // Reads the option's arguments and returns the word after them.
  Word read_option(const Word& option, ImageTexture& image, float* multiplier) {
    const std::string_view name = option.text.substr(1);
    if (name == "s" || name == "o") return read_mapping(name == "s", std::get<UvMapping>(image.mapping));
    if (name == "bm" && multiplier != nullptr) {
      *multiplier = words_.number("a number");
    } else if (name == "clamp") {
      if (words_.word("on or off").text == "on") image.wrap = Wrap::clamp;
    } else {
      return ignore_option(option);
    }
    return words_.word("a file name");
  }

  // The arguments of -s or -o: up to three numbers, of which the third is for volumes.
  Word read_mapping(bool is_scale, UvMapping& mapping) {
    Vec2 value(words_.number("a number"), is_scale ? 1 : 0);
    Word next = words_.word("a file name");
    for (int i = 1; i < 3 && looks_like_number(next.text); ++i) {
      if (i == 1) value.y = words_.number(next);
      next = words_.word("a file name");
    }
    if (is_scale)
      mapping.linear = Mat2(value.x, 0, 0, value.y);
    else
      mapping.offset = value;
    return next;
  }

  Word ignore_option(const Word& option) {
    warnings_.add_name("mtl option", words_.location(option), std::string(option.text), [](const auto& names) {
      return fmt::format("the option{} {} of texture maps {} not supported: ignored", names.size() > 1 ? "s" : "",
                         quoted_list(names), is_or_are(names));
    });
    const std::string_view name = option.text.substr(1);
    if (name == "colorspace" || name == "imfchan" || name == "type") words_.word("its value");
    Word next = words_.word("a file name");
    while (looks_like_number(next.text) || next.text == "on" || next.text == "off") next = words_.word("a file name");
    return next;
  }

  static bool looks_like_number(std::string_view text) {
    return !text.empty() && text.find_first_not_of("+-.0123456789eE") == text.npos &&
           text.find_first_of("0123456789") != text.npos;
  }

  FloatParameter add_float(const Source& m, const ImageTexture& image, Encoding encoding) {
    ImageTexture copy = image;
    copy.encoding = encoding;
    scene_.float_textures.push_back({copy, m.location});
    return {0, static_cast<Index>(scene_.float_textures.size() - 1)};
  }

  SpectrumParameter add_colour(const Source& m, const Rgb& colour, const std::optional<ImageTexture>& map) {
    if (!map) return {RgbSpectrum{colour}, {}};
    ImageTexture image = *map;
    // Many files leave the colour black if there is a map.
    if (!is_black(colour)) image.tint = colour;
    scene_.spectrum_textures.push_back({image, m.location});
    return {0.0f, static_cast<Index>(scene_.spectrum_textures.size() - 1)};
  }

  // Whether an image holds normals or heights is decided by its colours. Heights are metres, as in three.js.
  void add_relief(const Source& m, MetallicRoughness& material) {
    const std::optional<ImageTexture>& image = m.norm ? m.norm : m.bump;
    if (!image) return;
    NormalMap map{*image};
    map.image.encoding = Encoding::linear;
    if (!m.norm) {
      ImageTexture heights = *image;
      heights.scale = map.strength = m.bump_multiplier;
      heights.channel = 0;
      material.displacement = add_float(m, heights, Encoding::linear);
    }
    material.normal_map = map;
  }

  // Exporters leave an unused filter black.
  static DielectricMaterial glass(const Source& m, const SpectrumValue& eta) {
    DielectricMaterial result{eta, {{0, {}}, {0, {}}, false}};
    const Rgb filter{std::min(m.tf.r, 1.0f), std::min(m.tf.g, 1.0f), std::min(m.tf.b, 1.0f)};
    if (!is_black(filter) && filter != Rgb{1, 1, 1}) result.tint = {RgbSpectrum{filter}, {}};
    return result;
  }

  // If the colours' image is lost: half of the factor that it would have had, or grey.
  SpectrumParameter add_base_color(const Source& m) {
    const Rgb half = 0.5f * (is_black(m.kd) ? Rgb{1, 1, 1} : m.kd);
    return add_colour(m, m.lost_colours ? half : m.kd, m.map_kd);
  }

  Index add_material_of(const Source& m) {
    const bool physical = m.roughness || m.metallic || m.map_pr || m.map_pm;
    // Blender writes illum 9 for everything that fades by `d`, and an index for every material.
    const bool fades = m.illumination == 9 && (m.opacity.value_or(1) < 1 || m.map_d);
    const bool refracts = m.illumination == 6 || m.illumination == 7 ||
                          ((m.illumination == 4 || m.illumination == 9) && !fades && m.index.value_or(1) > 1);
    const bool mirrors = m.illumination == 3 || m.illumination == 5 || m.illumination == 8;
    MetallicRoughness material;
    material.base_color = add_base_color(m);
    add_relief(m, material);
    if (m.index && *m.index > 1) material.dielectric.eta = *m.index;
    if (refracts && !physical) return add_node(m, material, glass(m, material.dielectric.eta));
    if (mirrors && !physical && is_black(m.kd) && !m.map_kd && !m.lost_colours)
      return add_node(m, material,
                      ConductorMaterial{.reflectance = SpectrumParameter{RgbSpectrum{m.ks}, {}},
                                        .roughness = {{0, {}}, {0, {}}, false}});
    const bool is_dull = (is_black(m.ks) && !m.map_ks) || m.illumination < 2;
    if (!physical && is_dull) return add_node(m, material, DiffuseMaterial{material.base_color});
    // Ks is treated as white: its magnitude is unreliable.
    if (m.map_ks) material.dielectric.specular_color = add_colour(m, {1, 1, 1}, m.map_ks);
    const float exponent = m.exponent.value_or(0);
    const float by_exponent = by_blender_ ? roughness_by_blender(exponent) : roughness_of(exponent);
    material.roughness = {m.roughness ? *m.roughness : mirrors ? 0 : by_exponent, {}};
    material.metallic = {std::min(m.metallic.value_or(0), 1.0f), {}};
    if (m.map_pr) material.roughness = add_float(m, *m.map_pr, Encoding::linear);
    if (m.map_pm) material.metallic = add_float(m, *m.map_pm, Encoding::linear);
    material.clearcoat = {std::min(m.clearcoat.value_or(0), 1.0f), {}};
    material.clearcoat_roughness = {m.clearcoat_roughness.value_or(0), {}};
    return add_material(scene_, material, m.name, m.location);
  }

  Index add_node(const Source& m, const MetallicRoughness& relief, decltype(Material::node) node) {
    Material& material = scene_.materials.emplace_back();
    material.node = std::move(node);
    material.normal_map = relief.normal_map;
    material.displacement = relief.displacement;
    material.name = m.name;
    material.location = m.location;
    return static_cast<Index>(scene_.materials.size() - 1);
  }

  // Without map_d, uses the alpha of map_Kd, with which most programs cut out leaves and fences. Blender's files repeat
  // such an image as map_d; in other files the alpha is often a different mask, such as one for emission.
  FloatParameter alpha_of(const Source& m, float opacity) {
    if (!m.map_kd || names_alpha_) return {opacity, {}};
    ImageTexture image = *m.map_kd;
    image.channel = 3;
    image.scale = opacity;
    return add_float(m, image, image.encoding);  // as for colours of the image: decoded once; alpha is linear
  }

  void add(const Source& m) {
    Surface surface;
    surface.files = m.files;
    surface.material = add_material_of(m);
    const bool is_glass = std::holds_alternative<DielectricMaterial>(scene_.materials.back().node);
    const float opacity = std::clamp(m.opacity.value_or(1), 0.0f, 1.0f);
    if (opacity == 0 && !is_glass && !m.map_d)
      warnings_.add("mtl d", m.location,
                    "material " + in_quotes(m.name) +
                        " would be invisible because of \"d\" or \"Tr\", usually a mistake: it is opaque");
    if (m.map_d)
      surface.alpha = add_float(m, *m.map_d, Encoding::linear);
    else if (!is_glass)
      surface.alpha = alpha_of(m, opacity == 0 ? 1 : opacity);
    if ((!is_black(m.ke) || m.map_ke) && !m.lost_emission) {
      AreaLight light;
      light.radiance = add_colour(m, m.ke, m.map_ke);
      light.location = m.location;
      surface.area_light = static_cast<Index>(scene_.area_lights.size());
      scene_.area_lights.push_back(light);
    }
    if (!materials_.emplace(m.name, surface).second)
      warnings_.add("mtl twice", m.location,
                    "material " + in_quotes(m.name) + " is defined twice: the first definition is used");
  }

  Words words_;
  bool names_alpha_;  // Blender's files name an image as map_d if its alpha is opacity
  bool by_blender_;   // since 3.1
  const std::filesystem::path& folder_;
  const FileAccess* access_;
  SceneDescription& scene_;
  Materials& materials_;
  const Warnings& warnings_;
};

SpectrumParameter* reflectance_of(Material& material) {
  if (auto* diffuse = std::get_if<DiffuseMaterial>(&material.node)) return &diffuse->reflectance;
  if (auto* plastic = std::get_if<PlasticMaterial>(&material.node)) return &plastic->reflectance;
  if (auto* coated = std::get_if<CoatedPlasticMaterial>(&material.node)) return &coated->base.reflectance;
  if (auto* metal = std::get_if<ConductorMaterial>(&material.node))
    return metal->reflectance ? &*metal->reflectance : nullptr;
  if (auto* metal = std::get_if<CoatedConductorMaterial>(&material.node))
    return metal->reflectance ? &*metal->reflectance : nullptr;
  return nullptr;
}

}  // namespace

void read_materials(std::string_view text, const std::filesystem::path& folder, const std::string& name,
                    const FileAccess* access, SceneDescription& scene, Materials& materials, const Warnings& warnings) {
  MaterialFile(text, folder, name, access, scene, materials, warnings).read();
}

void add_vertex_colors(SceneDescription& scene) {
  const auto add = [&](decltype(SpectrumTexture::node) node, const SourceLocation& location) {
    scene.spectrum_textures.push_back({std::move(node), location});
    return SpectrumParameter{0.0f, static_cast<Index>(scene.spectrum_textures.size() - 1)};
  };
  for (Material& material : scene.materials)
    if (SpectrumParameter* reflectance = reflectance_of(material)) {
      const SpectrumParameter vertices = add(VertexColorTexture{}, material.location);
      *reflectance = add(ScaleTexture<SpectrumParameter, SpectrumParameter>{*reflectance, vertices}, material.location);
    }
}

}  // namespace lanthorn::obj
