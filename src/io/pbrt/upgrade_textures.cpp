// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "io/pbrt/upgrade_parts.h"

namespace lanthorn::pbrt {

namespace {

struct OldTexture {
  const std::string& name;
  bool is_spectrum;
  OldParameters& old;
  UpgradeOutput& output;

  void add(const std::string& kind, Parameters parameters) {
    output.add_texture(name, is_spectrum, kind, old.with_rest(std::move(parameters)), old.place());
  }
};

Parameters encoding(OldParameters& old) {
  const Parameter* gamma = old.find("gamma");
  if (gamma == nullptr) return {};
  if (gamma->type != ParameterType::real)
    return {string_parameter("encoding", *old.take_bool("gamma") ? "sRGB" : "linear", old.place())};
  const std::string exponent = std::to_string(*old.take_float("gamma"));
  return {string_parameter("encoding", "gamma " + exponent, old.place())};
}

void imagemap(OldTexture from) {
  Parameters parameters = encoding(from.old);
  const bool is_trilinear = from.old.take_bool("trilinear").value_or(false);
  parameters.push_back(string_parameter("filter", is_trilinear ? "trilinear" : "ewa", from.old.place()));
  from.add("imagemap", std::move(parameters));
}

void ptex(OldTexture from) { from.add("ptex", encoding(from.old)); }

bool is_grey(const Parameter& p) {
  const auto colour = constant_colour(p);
  return colour && colour->r == colour->g && colour->g == colour->b;
}

// The product of two textures of one type. In pbrt-v4 one of them is a float texture.
void scale(OldTexture from) {
  const Place place = from.old.place();
  const Parameter one = from.is_spectrum ? rgb_parameter("one", {1, 1, 1}, place) : float_parameter("one", 1, place);
  Parameter first = from.old.take("tex1").value_or(one), second = from.old.take("tex2").value_or(one);
  if (!from.is_spectrum)
    return from.add("scale", {renamed(std::move(first), "tex"), renamed(std::move(second), "scale")});
  if (is_grey(first) || (!is_grey(second) && constant_colour(first))) std::swap(first, second);
  const auto a = constant_colour(first), b = constant_colour(second);
  if (a && b) return from.add("constant", {rgb_parameter("value", *a * *b, place)});
  if (!b)
    from.output.note("the product of two textures: one of them is replaced by its mean of red, green and blue", place);
  const Factor factor = from.output.grey(second, "a texture \"scale\"");
  from.add("scale", {renamed(std::move(first), "tex"), factor_parameter("scale", factor, place)});
}

void checkerboard(OldTexture from) {
  from.old.take("aamode");
  from.add("checkerboard", {});
}

// The fractional parts of (u, v) as red and green. A bilerp is not periodic: only the first period, [0,1], is kept.
void uv(OldTexture from) {
  const Place place = from.old.place();
  Parameters parameters = {rgb_parameter("v00", {0, 0, 0}, place), rgb_parameter("v01", {0, 1, 0}, place),
                           rgb_parameter("v10", {1, 0, 0}, place), rgb_parameter("v11", {1, 1, 0}, place)};
  if (from.old.has("mapping")) return from.add("bilerp", std::move(parameters));
  for (const std::string axis : {"u", "v"}) {
    const float scale = from.old.take_float(axis + "scale").value_or(1);
    const float delta = from.old.take_float(axis + "delta").value_or(0);
    parameters.push_back(float_parameter(axis + "scale", scale, place));
    parameters.push_back(float_parameter(axis + "delta", delta - std::floor(delta + std::fmin(scale, 0.0f)), place));
    if (std::fabs(scale) > 1) from.output.note("textures \"uv\" do not repeat", place);
  }
  from.add("bilerp", std::move(parameters));
}

// A texture that pbrt-v4 provides only as a float texture: mixes black and white by it.
void noise(OldTexture from, const std::string& kind) {
  if (!from.is_spectrum) return from.add(kind, {});
  const Place place = from.old.place();
  const std::string amount = from.output.fresh_name(texture_space, from.name + "-amount");
  from.output.add_texture(amount, false, kind, from.old.rest(), place);
  from.output.add_texture(from.name, true, "mix",
                          {rgb_parameter("tex1", {0, 0, 0}, place), rgb_parameter("tex2", {1, 1, 1}, place),
                           texture_parameter("amount", amount, place)},
                          place);
}

struct TextureEntry {
  std::string_view kind;
  void (*upgrade)(OldTexture);
};
constexpr std::array<TextureEntry, 5> changed = {
    {{"imagemap", imagemap}, {"ptex", ptex}, {"scale", scale}, {"checkerboard", checkerboard}, {"uv", uv}}};

}  // namespace

void upgrade_texture(const std::string& name, bool is_spectrum, const std::string& kind, OldParameters old,
                     UpgradeOutput& output) {
  OldTexture from{name, is_spectrum, old, output};
  for (const TextureEntry& entry : changed)
    if (entry.kind == kind) return entry.upgrade(from);
  if (kind == "fbm" || kind == "wrinkled" || kind == "windy") return noise(from, kind);
  from.add(kind, {});
}

}  // namespace lanthorn::pbrt
