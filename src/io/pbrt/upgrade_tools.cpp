// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/upgrade_tools.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "io/pbrt/values.h"

namespace lanthorn::pbrt {

namespace {

float mean(const Rgb& colour) { return (colour.r + colour.g + colour.b) / 3; }

Parameter parameter(ParameterType type, std::string name, Parameter::Values values, Place place) {
  Parameter result;
  result.type = type;
  result.name = std::move(name);
  result.place = place;
  result.values = std::move(values);
  return result;
}

}  // namespace

void UpgradeOutput::note(const std::string& message, Place place) {
  const auto [it, is_new] = note_of_message_.try_emplace(message, notes_.size());
  if (is_new) notes_.push_back({place, message});
  ++notes_[it->second].count;
}

void UpgradeOutput::finish() {
  for (const Note& note : notes_)
    context_.scene.warnings.push_back(
        {note.place.location(),
         note.message + (note.count > 1 ? " (" + std::to_string(note.count) + " times)" : std::string())});
}

std::string UpgradeOutput::fresh_name(char space, const std::string& wanted) {
  std::string name = wanted;
  while (!names_.try_emplace({space, name}, 2).second) name = wanted + "-" + std::to_string(names_[{space, wanted}]++);
  return name;
}

void UpgradeOutput::add_texture(const std::string& name, bool is_spectrum, const std::string& kind,
                                Parameters parameters, Place place) {
  if (is_spectrum) spectrum_textures_[name] = {kind, parameters, place};
  emit("Texture", {name, is_spectrum ? "spectrum" : "float", kind}, std::move(parameters), place);
}

Parameter UpgradeOutput::scaled(Parameter spectrum, float factor) {
  static_cast<void>(constant_colour(spectrum));  // throws unless it is a spectrum
  if (factor == 1) return spectrum;
  if (auto* numbers = std::get_if<std::vector<float>>(&spectrum.values)) {
    const bool is_sampled = spectrum.type == ParameterType::spectrum;
    for (std::size_t i = is_sampled ? 1 : 0; i < numbers->size(); i += is_sampled ? 2 : 1) (*numbers)[i] *= factor;
    return spectrum;
  }
  const auto& names = std::get<std::vector<std::string>>(spectrum.values);
  const std::string base = names.empty() ? std::string() : names.front();
  auto [it, is_new] = scaled_textures_.try_emplace({base, factor});
  if (is_new) {
    it->second = fresh_name(texture_space, base + "-scaled");
    add_texture(it->second, true, "scale", {renamed(spectrum, "tex"), float_parameter("scale", factor, spectrum.place)},
                spectrum.place);
  }
  return texture_parameter(spectrum.name, it->second, spectrum.place);
}

Factor UpgradeOutput::grey(const Parameter& spectrum, const std::string& entity) {
  if (const std::string texture = texture_of(spectrum); !texture.empty())
    return {0, grey_texture(texture, spectrum.place)};
  const auto colour = constant_colour(spectrum);
  if (!colour) {
    note("a tabulated spectrum as " + in_quotes(spectrum.name) + " of " + entity + " is not supported: it is 0.5",
         spectrum.place);
    return {0.5f};
  }
  if (colour->r != colour->g || colour->g != colour->b)
    note(in_quotes(spectrum.name) + " of " + entity + " is coloured: its mean is used", spectrum.place);
  return {mean(*colour)};
}

// A float texture like this spectrum texture, with means instead of colours.
std::string UpgradeOutput::grey_texture(const std::string& name, Place place, int depth) {
  constexpr int deepest = 100;
  if (const auto known = grey_textures_.find(name); known != grey_textures_.end()) return known->second;
  const auto source = spectrum_textures_.find(name);
  if (source == spectrum_textures_.end()) return name;  // undefined: reported where it is used
  if (depth > deepest)
    throw Error(place.location(), "textures are nested more than " + std::to_string(deepest) + " levels deep");
  Texture texture = source->second;
  if (texture.kind == "marble") {
    note("texture \"marble\" as a number is not supported: it is 0.5", place);
    texture = {"constant", {float_parameter("value", 0.5f, place)}, place};
  }
  for (Parameter& p : texture.parameters) {
    if (const std::string input = texture_of(p); !input.empty() && spectrum_textures_.contains(input))
      p = texture_parameter(p.name, grey_texture(input, place, depth + 1), p.place);
    else if (p.type == ParameterType::rgb || p.type == ParameterType::spectrum)
      p = float_parameter(p.name, mean(constant_colour(p).value_or(Rgb{0.5f, 0.5f, 0.5f})), p.place);
  }
  std::string result = fresh_name(texture_space, name + "-grey");
  grey_textures_.emplace(name, result);
  add_texture(result, false, texture.kind, std::move(texture.parameters), texture.place);
  return result;
}

Factor UpgradeOutput::product(const Factor& a, const Factor& b, Place place) {
  if (a.texture.empty() && b.texture.empty()) return {a.value * b.value};
  if (a.is(1)) return b;
  if (b.is(1)) return a;
  const Factor &texture = a.texture.empty() ? b : a, &other = a.texture.empty() ? a : b;
  Factor result{0, fresh_name(texture_space, texture.texture + "-product")};
  add_texture(result.texture, false, "scale",
              {texture_parameter("tex", texture.texture, place), factor_parameter("scale", other, place)}, place);
  return result;
}

float UpgradeOutput::luminance(const Parameter& spectrum) {
  const ParameterList list("a light", spectrum.place, {spectrum});
  const auto value = find_spectrum(list, spectrum.name, description::SpectrumRole::illuminant, context_);
  const auto* samples = value ? std::get_if<description::SampledSpectrum>(&*value) : nullptr;
  if (samples == nullptr) return 1;
  return luminance_of(resample(samples->nm.data(), samples->values.data(), samples->nm.size(), true));
}

Parameter float_parameter(std::string name, float value, Place place) {
  return parameter(ParameterType::real, std::move(name), std::vector{value}, place);
}
Parameter integer_parameter(std::string name, int value, Place place) {
  return parameter(ParameterType::integer, std::move(name), std::vector<std::int32_t>{value}, place);
}
Parameter bool_parameter(std::string name, bool value, Place place) {
  return parameter(ParameterType::boolean, std::move(name), std::vector<bool>{value}, place);
}
Parameter string_parameter(std::string name, std::string value, Place place) {
  return parameter(ParameterType::string, std::move(name), std::vector{std::move(value)}, place);
}
Parameter rgb_parameter(std::string name, const Rgb& value, Place place) {
  return parameter(ParameterType::rgb, std::move(name), std::vector{value.r, value.g, value.b}, place);
}
Parameter texture_parameter(std::string name, std::string texture, Place place) {
  return parameter(ParameterType::texture, std::move(name), std::vector{std::move(texture)}, place);
}
Parameter renamed(Parameter parameter, std::string name) {
  parameter.name = std::move(name);
  return parameter;
}

std::optional<Rgb> constant_colour(const Parameter& parameter) {
  switch (parameter.type) {
    case ParameterType::spectrum:
    case ParameterType::blackbody:
    case ParameterType::texture:
      return {};
    case ParameterType::rgb:
    case ParameterType::real:
      break;
    default:
      throw Error(parameter.place.location(), "parameter " + in_quotes(parameter.name) + " must be a spectrum, not " +
                                                  std::string(name_of(parameter.type)));
  }
  const auto* v = std::get_if<std::vector<float>>(&parameter.values);
  const bool is_number = parameter.type == ParameterType::real;
  if (v->size() != (is_number ? 1 : 3))
    throw Error(parameter.place.location(), "parameter " + in_quotes(parameter.name) + " needs " +
                                                (is_number ? "one value" : "three values") + ", has " +
                                                std::to_string(v->size()));
  return is_number ? Rgb{v->front(), v->front(), v->front()} : Rgb{(*v)[0], (*v)[1], (*v)[2]};
}

std::string texture_of(const Parameter& parameter) {
  if (parameter.type != ParameterType::texture) return {};
  const auto& names = std::get<std::vector<std::string>>(parameter.values);
  if (names.size() != 1)
    throw Error(parameter.place.location(),
                "parameter " + in_quotes(parameter.name) + " needs one name, has " + std::to_string(names.size()));
  return names.front();
}

Parameter factor_parameter(std::string name, const Factor& factor, Place place) {
  return factor.texture.empty() ? float_parameter(std::move(name), factor.value, place)
                                : texture_parameter(std::move(name), factor.texture, place);
}

OldParameters::OldParameters(std::string entity, Place place, Parameters parameters)
    : entity_(std::move(entity)), place_(place), parameters_(std::move(parameters)) {}

const Parameter* OldParameters::find(std::string_view name) const {
  const auto it =
      std::find_if(parameters_.rbegin(), parameters_.rend(), [&](const Parameter& p) { return p.name == name; });
  return it == parameters_.rend() ? nullptr : &*it;
}

bool OldParameters::has(std::string_view name) const { return find(name) != nullptr; }

std::optional<Parameter> OldParameters::take(std::string_view name) {
  const Parameter* found = find(name);
  if (found == nullptr) return {};
  Parameter result = *found;
  std::erase_if(parameters_, [&](const Parameter& p) { return p.name == name; });
  return result;
}

template <class T>
std::optional<T> OldParameters::take_one(std::string_view name, ParameterType type) {
  const auto p = take(name);
  if (!p) return {};
  const auto* values = std::get_if<std::vector<T>>(&p->values);
  if (p->type != type || values == nullptr || values->size() != 1)
    throw Error(p->place.location(), "parameter " + in_quotes(name) + " of " + entity_ + " must be one value of type " +
                                         std::string(name_of(type)));
  return values->front();
}

std::optional<float> OldParameters::take_float(std::string_view name) {
  return take_one<float>(name, ParameterType::real);
}
std::optional<int> OldParameters::take_integer(std::string_view name) {
  return take_one<std::int32_t>(name, ParameterType::integer);
}
std::optional<bool> OldParameters::take_bool(std::string_view name) {
  return take_one<bool>(name, ParameterType::boolean);
}
std::optional<std::string> OldParameters::take_string(std::string_view name) {
  return take_one<std::string>(name, ParameterType::string);
}

std::optional<Factor> OldParameters::take_factor(std::string_view name) {
  const Parameter* p = find(name);
  if (p == nullptr) return {};
  if (std::string texture = texture_of(*p); !texture.empty()) {
    take(name);
    return Factor{0, std::move(texture)};
  }
  return Factor{*take_float(name)};
}

}  // namespace lanthorn::pbrt
