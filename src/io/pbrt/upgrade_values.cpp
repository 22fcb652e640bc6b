// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/upgrade_values.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace lanthorn::pbrt {

namespace {

Parameter parameter(ParameterType type, std::string name, Parameter::Values values, Place place) {
  Parameter result;
  result.type = type;
  result.name = std::move(name);
  result.place = place;
  result.values = std::move(values);
  return result;
}

}  // namespace

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
