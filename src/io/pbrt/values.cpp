// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/values.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace lanthorn::pbrt {

namespace {

using description::Index;
using description::SpectrumRole;
using description::SpectrumValue;

std::string count_error(const char* wanted, std::size_t count) {
  return std::string("needs ") + wanted + ", has " + std::to_string(count);
}

SpectrumValue rgb_value(const ParameterList& list, const Parameter& p, SpectrumRole role, Context& context) {
  const auto& v = std::get<std::vector<float>>(p.values);
  if (v.size() != 3) throw list.error(p.name, count_error("three values", v.size()));
  if (v[0] < 0 || v[1] < 0 || v[2] < 0) throw list.error(p.name, "must not be negative");
  if (role == SpectrumRole::albedo && (v[0] > 1 || v[1] > 1 || v[2] > 1))
    context.warn("albedo above 1", p.place,
                 "parameter " + in_quotes(p.name) + " of " + list.entity() + " is a reflectance above 1: clamped to 1");
  return description::RgbSpectrum{{v[0], v[1], v[2]}, p.color_space};
}

SpectrumValue sampled(const ParameterList& list, const Parameter& p, const std::vector<float>& pairs) {
  if (pairs.empty() || pairs.size() % 2 != 0)
    throw list.error(p.name, count_error("pairs of a wavelength and a value", pairs.size()) + " numbers");
  description::SampledSpectrum samples;
  for (std::size_t i = 0; i < pairs.size(); i += 2) {
    if (i > 0 && pairs[i] <= samples.nm.back()) throw list.error(p.name, "needs wavelengths in increasing order");
    samples.nm.push_back(pairs[i]);
    samples.values.push_back(pairs[i + 1]);
  }
  return samples;
}

// A text file of wavelength-value pairs with # comments.
SpectrumValue spectrum_file(const ParameterList& list, const Parameter& p, const std::string& name, Context& context) {
  const std::filesystem::path path = context.add_file(name, p.place);
  std::string bytes;
  try {
    bytes = context.read_file(path);
  } catch (const Error& problem) {
    const Error error =
        list.error(p.name, "names the spectrum " + in_quotes(name) + ", which is not built in; " + problem.what());
    if (context.defer_missing(path, error)) return 1.0f;
    throw Error(error);
  }
  if (bytes.size() > context.spectrum_bytes_left)
    throw list.error(p.name, "names a spectrum file, but all uses of spectrum files together are too large");
  context.spectrum_bytes_left -= bytes.size();
  const std::string file = path.string();
  Tokenizer tokens(bytes, &file);
  std::vector<float> pairs;
  for (Token token = tokens.next(); token.kind != TokenKind::end; token = tokens.next())
    pairs.push_back(float_value(token));
  return sampled(list, p, pairs);
}

SpectrumValue spectrum_value(const ParameterList& list, const Parameter& p, Context& context) {
  if (const auto* pairs = std::get_if<std::vector<float>>(&p.values)) return sampled(list, p, *pairs);
  const auto& names = std::get<std::vector<std::string>>(p.values);
  if (names.size() != 1) throw list.error(p.name, count_error("one name", names.size()));
  if (named_spectrum(names[0].c_str())) return description::NamedSpectrum{names[0]};
  return spectrum_file(list, p, names[0], context);
}

Index lookup(const std::unordered_map<std::string, Index>& textures, const char* kind, const ParameterList& list,
             std::string_view parameter, const std::string& name) {
  const auto it = textures.find(name);
  if (it == textures.end())
    throw list.error(parameter,
                     std::string("names the ") + kind + " texture " + in_quotes(name) + ", which is not defined");
  return it->second;
}

}  // namespace

std::optional<SpectrumValue> find_spectrum(const ParameterList& list, std::string_view name, SpectrumRole role,
                                           Context& context) {
  const Parameter* p = list.find(name);
  if (!p) return {};
  switch (p->type) {
    case ParameterType::rgb:
      return rgb_value(list, *p, role, context);
    case ParameterType::spectrum:
      return spectrum_value(list, *p, context);
    case ParameterType::blackbody: {
      const auto& kelvin = std::get<std::vector<float>>(p->values);
      if (kelvin.size() != 1) throw list.error(name, count_error("one value", kelvin.size()));
      if (!(kelvin[0] > 0)) throw list.error(name, "needs a temperature above 0 kelvin");
      return description::BlackbodySpectrum{kelvin[0]};
    }
    case ParameterType::real:
      if (role != SpectrumRole::illuminant) return *list.find_float(name);
      [[fallthrough]];
    default:
      throw list.error(name, "must be a spectrum (rgb, blackbody or spectrum), not " + std::string(name_of(p->type)));
  }
}

std::optional<std::string> texture_name(const ParameterList& list, std::string_view name) {
  const Parameter* p = list.find(name);
  if (!p || p->type != ParameterType::texture) return {};
  const auto& names = std::get<std::vector<std::string>>(p->values);
  if (names.size() != 1) throw list.error(name, count_error("one name", names.size()));
  return names[0];
}

namespace {

bool names_one_of(const std::set<Index>& lost, const std::unordered_map<std::string, Index>& textures,
                  const ParameterList& list, std::string_view name) {
  const auto texture = texture_name(list, name);
  const auto found = texture ? textures.find(*texture) : textures.end();
  return found != textures.end() && lost.count(found->second) > 0;
}

// Replaces a skipped texture: grey surfaces, no emission, else the parameter's default.
std::optional<description::SpectrumParameter> neutral_spectrum(SpectrumRole role) {
  if (role == SpectrumRole::unbounded) return {};
  return description::SpectrumParameter{role == SpectrumRole::albedo ? 0.5f : 0.0f, {}};
}

}  // namespace

bool names_lost_float_texture(const ParameterList& list, std::string_view name, const Context& context) {
  return names_one_of(context.lost_float_textures, context.float_textures, list, name);
}

bool names_lost_spectrum_texture(const ParameterList& list, std::string_view name, const Context& context) {
  return names_one_of(context.lost_spectrum_textures, context.spectrum_textures, list, name);
}

std::optional<description::SpectrumParameter> find_spectrum_or_texture(const ParameterList& list, std::string_view name,
                                                                       SpectrumRole role, Context& context) {
  if (names_lost_spectrum_texture(list, name, context)) return neutral_spectrum(role);
  if (const auto texture = texture_name(list, name))
    return description::SpectrumParameter{1.0f, lookup(context.spectrum_textures, "spectrum", list, name, *texture)};
  auto value = find_spectrum(list, name, role, context);
  if (!value) return {};
  return description::SpectrumParameter{std::move(*value), {}};
}

std::optional<description::FloatParameter> find_float_or_texture(const ParameterList& list, std::string_view name,
                                                                 Context& context) {
  if (names_lost_float_texture(list, name, context)) return {};
  if (const auto texture = texture_name(list, name))
    return description::FloatParameter{1.0f, lookup(context.float_textures, "float", list, name, *texture)};
  const auto value = list.find_float(name);
  if (!value) return {};
  return description::FloatParameter{*value, {}};
}

description::FloatParameter float_or_texture(const ParameterList& list, std::string_view name, float otherwise,
                                             Context& context) {
  return find_float_or_texture(list, name, context).value_or(description::FloatParameter{otherwise, {}});
}

float positive(const ParameterList& list, std::string_view name, float otherwise) {
  const float value = list.get(name, otherwise);
  if (!(value > 0)) throw list.error(name, "must be above 0");
  return value;
}

}  // namespace lanthorn::pbrt
