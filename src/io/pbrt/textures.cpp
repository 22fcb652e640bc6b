// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "io/pbrt/builders.h"
#include "io/pbrt/values.h"
#include "math/vec.h"

namespace lanthorn::pbrt {

namespace {

using namespace description;

// Traits of float and spectrum textures.
constexpr float grey_input = 0.5f;  // replaces a skipped input

struct FloatKind {
  using Parameter = FloatParameter;
  using Texture = FloatTexture;
  static Parameter get(const ParameterList& list, std::string_view name, float otherwise, Context& context) {
    return float_or_texture(list, name, names_lost(list, name, context) ? grey_input : otherwise, context);
  }
  static bool names_lost(const ParameterList& list, std::string_view name, const Context& context) {
    return names_lost_float_texture(list, name, context);
  }
};
struct SpectrumKind {
  using Parameter = SpectrumParameter;
  using Texture = SpectrumTexture;
  // The use of the texture determines whether its values are reflectances or light.
  static Parameter get(const ParameterList& list, std::string_view name, float otherwise, Context& context) {
    return find_spectrum_or_texture(list, name, SpectrumRole::unbounded, context)
        .value_or(Parameter{names_lost(list, name, context) ? grey_input : otherwise, {}});
  }
  static bool names_lost(const ParameterList& list, std::string_view name, const Context& context) {
    return names_lost_spectrum_texture(list, name, context);
  }
};

TextureMapping texture_mapping(const ParameterList& list, const Transform& texture_to_world) {
  const std::string mapping = list.get("mapping", "uv");
  if (mapping == "spherical") return SphericalTextureMapping{texture_to_world.inverted()};
  if (mapping == "cylindrical") return CylindricalTextureMapping{texture_to_world.inverted()};
  const Vec2 offset(list.get("udelta", 0.0f), list.get("vdelta", 0.0f));
  if (mapping == "planar")
    return PlanarTextureMapping{texture_to_world.inverted(), list.get("v1", Vec3(1, 0, 0)),
                                list.get("v2", Vec3(0, 1, 0)), offset};
  if (mapping != "uv")
    throw list.error("mapping", "must be uv, spherical, cylindrical or planar, not " + in_quotes(mapping));
  return UvMapping{Mat2(list.get("uscale", 1.0f), 0, 0, list.get("vscale", 1.0f)), offset};
}

Wrap wrap_mode(const ParameterList& list) {
  const std::string wrap = list.get("wrap", "repeat");
  if (wrap == "repeat") return Wrap::repeat;
  if (wrap == "black") return Wrap::black;
  if (wrap == "clamp") return Wrap::clamp;
  if (wrap == "octahedralsphere") return Wrap::octahedral_sphere;
  throw list.error("wrap", "must be repeat, black, clamp or octahedralsphere, not " + in_quotes(wrap));
}

// The filter does not choose a level of detail: the samples of a pixel filter the texture. Therefore all filters except
// "point" are equivalent. Where large images are averaged over footprints (`TextureGraph::evaluate_filtered`), this
// does not depend on the filter.
ImageFilter image_filter(const ParameterList& list) {
  const std::string filter = list.get("filter", "bilinear");
  list.find("maxanisotropy");
  if (filter == "point") return ImageFilter::point;
  if (filter != "bilinear" && filter != "trilinear" && filter != "ewa" && filter != "EWA")
    throw list.error("filter", "must be point, bilinear, trilinear or ewa, not " + in_quotes(filter));
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

// The arguments of every texture builder.
struct Source {
  const ParameterList& list;
  const Transform& texture_to_world;
  Context& context;

  TextureMapping mapping() const { return texture_mapping(list, texture_to_world); }
  SolidMapping solid_mapping() const { return {texture_to_world.inverted()}; }
};

ImageTexture image(const Source& from) {
  const ParameterList& list = from.list;
  ImageTexture result;
  result.filename = from.context.add_file(list.required_string("filename"), list.place()).string();
  result.mapping = from.mapping();
  result.wrap = wrap_mode(list);
  result.filter = image_filter(list);
  const ImageEncoding encoding = image_encoding(list);
  result.encoding = encoding.encoding;
  result.gamma = encoding.gamma;
  result.scale = list.get("scale", 1.0f);
  result.invert = list.get("invert", false);
  return result;
}

Octaves octaves(const ParameterList& list) {
  // The frequency doubles with every octave; higher octaves exceed single precision.
  constexpr int most = 24;
  const Octaves result{list.get("octaves", 8), list.get("roughness", 0.5f)};
  if (result.count < 1 || result.count > most) throw list.error("octaves", "must be from 1 to " + std::to_string(most));
  return result;
}

Direction mix_direction(const Source& from) {
  const Vec3 direction = from.texture_to_world.vector(from.list.get("dir", Vec3(0, 1, 0)));
  const float length = std::sqrt(length_squared(direction));
  if (!(length > 0) || !(length < infinity)) throw from.list.error("dir", "must not be zero");
  return direction / length;
}

// Makers of the textures of one kind (float or spectrum), by name.
template <class Kind>
struct Maker {
  using Parameter = typename Kind::Parameter;
  using Node = decltype(Kind::Texture::node);
  struct Entry {
    std::string_view name;
    Node (*make)(const Source&);
  };

  static Parameter get(const Source& from, std::string_view name, float otherwise) {
    return Kind::get(from.list, name, otherwise, from.context);
  }

  static Node constant(const Source& from) { return ConstantTexture<Parameter>{get(from, "value", 1)}; }
  static Node imagemap(const Source& from) { return image(from); }
  static Node checkerboard(const Source& from) {
    Checkerboard<Parameter> result;
    const int dimension = from.list.get("dimension", 2);
    if (dimension == 2)
      result.mapping = from.mapping();
    else if (dimension == 3)
      result.mapping = from.solid_mapping();
    else
      throw from.list.error("dimension", "must be 2 or 3");
    result.tex1 = get(from, "tex1", 1);
    result.tex2 = get(from, "tex2", 0);
    return result;
  }
  static Node scale(const Source& from) {
    return ScaleTexture<Parameter>{get(from, "tex", 1), float_or_texture(from.list, "scale", 1, from.context)};
  }
  static Node mix(const Source& from) {
    return MixTexture<Parameter>{get(from, "tex1", 0), get(from, "tex2", 1),
                                 float_or_texture(from.list, "amount", 0.5f, from.context)};
  }
  static Node direction_mix(const Source& from) {
    return DirectionMixTexture<Parameter>{get(from, "tex1", 0), get(from, "tex2", 1), mix_direction(from)};
  }
  static Node bilerp(const Source& from) {
    return BilerpTexture<Parameter>{from.mapping(), get(from, "v00", 0), get(from, "v01", 1), get(from, "v10", 0),
                                    get(from, "v11", 1)};
  }
  // pbrt-v4 uses "inside" around the dots and "outside" in them. Existing scenes rely on it.
  static Node dots(const Source& from) {
    return DotsTexture<Parameter>{from.mapping(), get(from, "outside", 0), get(from, "inside", 1)};
  }
  static Node fbm(const Source& from) { return FbmTexture{from.solid_mapping(), octaves(from.list)}; }
  static Node wrinkled(const Source& from) { return WrinkledTexture{from.solid_mapping(), octaves(from.list)}; }
  static Node windy(const Source& from) { return WindyTexture{from.solid_mapping()}; }
  static Node marble(const Source& from) {
    return MarbleTexture{from.solid_mapping(), octaves(from.list), from.list.get("scale", 1.0f),
                         from.list.get("variation", 0.2f)};
  }
  static Node ptex(const Source& from) {
    from.context.warn("texture ptex", from.list.place(),
                      "texture \"ptex\" is not supported: replaced by the constant 0.5");
    for (const char* name : {"filename", "encoding", "scale"}) from.list.find(name);
    return ConstantTexture<Parameter>{Parameter{0.5f, {}}};
  }

  static constexpr std::array<Entry, 9> common = {{{"constant", constant},
                                                   {"imagemap", imagemap},
                                                   {"checkerboard", checkerboard},
                                                   {"scale", scale},
                                                   {"mix", mix},
                                                   {"directionmix", direction_mix},
                                                   {"bilerp", bilerp},
                                                   {"dots", dots},
                                                   {"ptex", ptex}}};
};

constexpr std::array<Maker<FloatKind>::Entry, 3> float_only = {
    {{"fbm", Maker<FloatKind>::fbm}, {"wrinkled", Maker<FloatKind>::wrinkled}, {"windy", Maker<FloatKind>::windy}}};
constexpr std::array<Maker<SpectrumKind>::Entry, 1> spectrum_only = {{{"marble", Maker<SpectrumKind>::marble}}};

template <class Table>
auto* find_named(const Table& table, std::string_view name) {
  const auto it = std::find_if(table.begin(), table.end(), [&](const auto& entry) { return entry.name == name; });
  return it == table.end() ? nullptr : &*it;
}

template <class Kind, class Own, class Others>
typename Kind::Texture make_texture(const std::string& kind, const Source& from, const Own& own, const Others& others,
                                    const char* other_type) {
  typename Kind::Texture texture;
  texture.location = from.list.place().location();
  if (const auto* entry = find_named(Maker<Kind>::common, kind))
    texture.node = entry->make(from);
  else if (const auto* special = find_named(own, kind))
    texture.node = special->make(from);
  else if (find_named(others, kind))
    throw Error(texture.location, "texture " + in_quotes(kind) + " must be of type " + other_type);
  else
    throw Error(texture.location, "unknown texture " + in_quotes(kind));
  report_unused(from.list, from.context);
  return texture;
}

void define(std::unordered_map<std::string, Index>& names, const std::string& name, Index index,
            const ParameterList& list) {
  if (!names.emplace(name, index).second)
    throw Error(list.place().location(), "texture " + in_quotes(name) + " is defined twice");
}

// True if the texture is an image that is missing and skipped, or a scaled version of one.
template <class Kind>
bool is_lost(const typename Kind::Texture& texture, const std::string& kind, const ParameterList& list,
             const Context& context) {
  const auto* image = std::get_if<ImageTexture>(&texture.node);
  return (image != nullptr && context.leaves_out(image->filename)) ||
         (kind == "scale" && Kind::names_lost(list, "tex", context));
}

}  // namespace

void add_float_texture(const std::string& name, const std::string& kind, const ParameterList& list,
                       const Transform& texture_to_world, Context& context) {
  auto texture =
      make_texture<FloatKind>(kind, {list, texture_to_world, context}, float_only, spectrum_only, "spectrum");
  const auto index = static_cast<Index>(context.scene.float_textures.size());
  if (is_lost<FloatKind>(texture, kind, list, context)) context.lost_float_textures.insert(index);
  define(context.float_textures, name, index, list);
  context.scene.float_textures.push_back(std::move(texture));
}

void add_spectrum_texture(const std::string& name, const std::string& kind, const ParameterList& list,
                          const Transform& texture_to_world, Context& context) {
  auto texture =
      make_texture<SpectrumKind>(kind, {list, texture_to_world, context}, spectrum_only, float_only, "float");
  const auto index = static_cast<Index>(context.scene.spectrum_textures.size());
  if (is_lost<SpectrumKind>(texture, kind, list, context)) context.lost_spectrum_textures.insert(index);
  define(context.spectrum_textures, name, index, list);
  context.scene.spectrum_textures.push_back(std::move(texture));
}

}  // namespace lanthorn::pbrt
