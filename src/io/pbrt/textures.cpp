// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "io/pbrt/builders.h"
#include "io/pbrt/values.h"

namespace lanthorn::pbrt {

namespace {

using namespace description;

// What float and spectrum textures do differently.
struct FloatKind {
  using Parameter = FloatParameter;
  using Texture = FloatTexture;
  static Parameter get(const ParameterList& list, std::string_view name, float otherwise, Context& context) {
    return float_or_texture(list, name, otherwise, context);
  }
};
struct SpectrumKind {
  using Parameter = SpectrumParameter;
  using Texture = SpectrumTexture;
  // Whether the numbers are reflectances or light is known where the texture is used.
  static Parameter get(const ParameterList& list, std::string_view name, float otherwise, Context& context) {
    return find_spectrum_or_texture(list, name, SpectrumRole::unbounded, context).value_or(Parameter{otherwise, {}});
  }
};

UvMapping uv_mapping(const ParameterList& list, Context& context) {
  const std::string mapping = list.get("mapping", "uv");
  if (mapping != "uv") {
    if (mapping != "spherical" && mapping != "cylindrical" && mapping != "planar")
      throw list.error("mapping", "must be uv, spherical, cylindrical or planar, not " + in_quotes(mapping));
    context.warn("mapping " + mapping, list.place(),
                 "texture mapping " + in_quotes(mapping) + " is not supported yet: replaced by \"uv\"");
    list.find("v1");
    list.find("v2");
  }
  return {{list.get("uscale", 1.0f), list.get("vscale", 1.0f)}, {list.get("udelta", 0.0f), list.get("vdelta", 0.0f)}};
}

Wrap wrap_mode(const ParameterList& list, Context& context) {
  const std::string wrap = list.get("wrap", "repeat");
  if (wrap == "repeat") return Wrap::repeat;
  if (wrap == "black") return Wrap::black;
  if (wrap == "clamp") return Wrap::clamp;
  if (wrap != "octahedralsphere")
    throw list.error("wrap", "must be repeat, black, clamp or octahedralsphere, not " + in_quotes(wrap));
  context.warn("wrap " + wrap, list.place(),
               "texture wrap \"octahedralsphere\" is not supported yet: replaced by \"clamp\"");
  return Wrap::clamp;
}

ImageFilter image_filter(const ParameterList& list, Context& context) {
  const std::string filter = list.get("filter", "bilinear");
  list.find("maxanisotropy");
  if (filter == "point") return ImageFilter::point;
  if (filter == "bilinear") return ImageFilter::bilinear;
  if (filter != "trilinear" && filter != "ewa" && filter != "EWA")
    throw list.error("filter", "must be point, bilinear, trilinear or ewa, not " + in_quotes(filter));
  context.warn("filter " + filter, list.place(),
               "texture filter " + in_quotes(filter) + " is not supported yet: replaced by \"bilinear\"");
  return ImageFilter::bilinear;
}

struct ImageEncoding {
  Encoding encoding = Encoding::automatic;
  float gamma = 1;
};
ImageEncoding image_encoding(const ParameterList& list) {
  const std::string text = list.get("encoding", "");
  if (!list.has("encoding")) return {};
  if (text == "sRGB") return {Encoding::srgb};
  if (text == "linear") return {Encoding::linear};
  constexpr std::string_view prefix = "gamma ";
  if (!text.starts_with(prefix))
    throw list.error("encoding", "must be sRGB, linear or \"gamma NUMBER\", not " + in_quotes(text));
  ImageEncoding result{Encoding::gamma};
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data() + prefix.size(), last, result.gamma);
  if (error != std::errc{} || end != last || !(result.gamma > 0) || !(result.gamma < infinity))
    throw list.error("encoding", "needs a positive number after \"gamma\"");
  return result;
}

ImageTexture image(const ParameterList& list, Context& context) {
  ImageTexture result;
  result.filename = context.add_file(list.required_string("filename")).string();
  result.mapping = uv_mapping(list, context);
  result.wrap = wrap_mode(list, context);
  result.filter = image_filter(list, context);
  const ImageEncoding encoding = image_encoding(list);
  result.encoding = encoding.encoding;
  result.gamma = encoding.gamma;
  result.scale = list.get("scale", 1.0f);
  result.invert = list.get("invert", false);
  return result;
}

template <class Kind>
Checkerboard<typename Kind::Parameter> checkerboard(const ParameterList& list, const Transform& texture_to_world,
                                                    Context& context) {
  Checkerboard<typename Kind::Parameter> result;
  const int dimension = list.get("dimension", 2);
  if (dimension == 2)
    result.mapping = CheckerboardTexture2d{uv_mapping(list, context)};
  else if (dimension == 3)
    result.mapping = CheckerboardTexture3d{texture_to_world.inverted()};
  else
    throw list.error("dimension", "must be 2 or 3");
  result.tex1 = Kind::get(list, "tex1", 1, context);
  result.tex2 = Kind::get(list, "tex2", 0, context);
  return result;
}

template <class Kind>
MixTexture<typename Kind::Parameter> mix(const ParameterList& list, FloatParameter amount, Context& context) {
  return {Kind::get(list, "tex1", 0, context), Kind::get(list, "tex2", 1, context), amount};
}

constexpr std::array<std::string_view, 7> procedural = {"bilerp", "dots", "fbm", "wrinkled", "windy", "marble", "ptex"};

template <class Kind>
typename Kind::Texture make_texture(const std::string& kind, const ParameterList& list,
                                    const Transform& texture_to_world, Context& context) {
  using Parameter = typename Kind::Parameter;
  typename Kind::Texture texture;
  texture.location = list.place().location();
  const auto substitute = [&](const char* what) {
    context.warn("texture " + kind, list.place(),
                 "texture " + in_quotes(kind) + " is not supported yet: replaced by " + what);
  };
  if (kind == "constant") {
    texture.node = ConstantTexture<Parameter>{Kind::get(list, "value", 1, context)};
  } else if (kind == "imagemap") {
    texture.node = image(list, context);
  } else if (kind == "checkerboard") {
    texture.node = checkerboard<Kind>(list, texture_to_world, context);
  } else if (kind == "scale") {
    texture.node =
        ScaleTexture<Parameter>{Kind::get(list, "tex", 1, context), float_or_texture(list, "scale", 1, context)};
  } else if (kind == "mix") {
    texture.node = mix<Kind>(list, float_or_texture(list, "amount", 0.5f, context), context);
  } else if (kind == "directionmix") {
    substitute("an even mix of its parts");
    list.find("dir");
    texture.node = mix<Kind>(list, {0.5f, {}}, context);
  } else if (std::find(procedural.begin(), procedural.end(), kind) != procedural.end()) {
    substitute("the constant 0.5");
    texture.node = ConstantTexture<Parameter>{Parameter{0.5f, {}}};
    return texture;
  } else {
    throw Error(texture.location, "unknown texture " + in_quotes(kind));
  }
  report_unused(list, context);
  return texture;
}

void define(std::unordered_map<std::string, Index>& names, const std::string& name, std::size_t index,
            const ParameterList& list) {
  if (!names.emplace(name, static_cast<Index>(index)).second)
    throw Error(list.place().location(), "texture " + in_quotes(name) + " is defined twice");
}

}  // namespace

void add_float_texture(const std::string& name, const std::string& kind, const ParameterList& list,
                       const Transform& texture_to_world, Context& context) {
  auto texture = make_texture<FloatKind>(kind, list, texture_to_world, context);
  define(context.float_textures, name, context.scene.float_textures.size(), list);
  context.scene.float_textures.push_back(std::move(texture));
}

void add_spectrum_texture(const std::string& name, const std::string& kind, const ParameterList& list,
                          const Transform& texture_to_world, Context& context) {
  auto texture = make_texture<SpectrumKind>(kind, list, texture_to_world, context);
  define(context.spectrum_textures, name, context.scene.spectrum_textures.size(), list);
  context.scene.spectrum_textures.push_back(std::move(texture));
}

}  // namespace lanthorn::pbrt
