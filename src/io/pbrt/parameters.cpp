// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/parameters.h"

#include <algorithm>
#include <utility>

namespace lanthorn::pbrt {

namespace {

constexpr std::array<std::string_view, 13> type_names = {"bool",    "integer",   "float",   "string", "point2",
                                                         "vector2", "point3",    "vector3", "normal", "spectrum",
                                                         "rgb",     "blackbody", "texture"};

bool is_triple(ParameterType type) {
  return type == ParameterType::point3 || type == ParameterType::vector3 || type == ParameterType::normal;
}
bool is_pair(ParameterType type) { return type == ParameterType::point2 || type == ParameterType::vector2; }

Error wrong_type(const ParameterList& list, const Parameter& p, std::string_view wanted) {
  return list.error(p.name, "must be of type " + std::string(wanted) + ", not " + std::string(name_of(p.type)));
}

// The values of a parameter of exactly this type; null if it is missing.
template <class T>
const std::vector<T>* values_of(const ParameterList& list, std::string_view name, ParameterType type) {
  const Parameter* p = list.find(name);
  if (!p) return nullptr;
  if (p->type != type) throw wrong_type(list, *p, name_of(type));
  return &std::get<std::vector<T>>(p->values);
}

template <class T>
std::optional<T> one_value(const ParameterList& list, std::string_view name, ParameterType type) {
  const auto* values = values_of<T>(list, name, type);
  if (!values) return {};
  if (values->size() != 1) throw list.error(name, "needs one value, has " + std::to_string(values->size()));
  return values->front();
}

template <class V>
std::vector<V> tuples(const ParameterList& list, std::string_view name, bool (*accepts)(ParameterType),
                      const char* wanted) {
  const Parameter* p = list.find(name);
  if (!p) return {};
  if (!accepts(p->type)) throw wrong_type(list, *p, wanted);
  constexpr std::size_t size = static_cast<std::size_t>(V::length());
  const auto& values = std::get<std::vector<float>>(p->values);
  if (values.empty() || values.size() % size != 0)
    throw list.error(name,
                     "needs a multiple of " + std::to_string(size) + " values, has " + std::to_string(values.size()));
  std::vector<V> result(values.size() / size);
  for (std::size_t i = 0; i < result.size(); ++i)
    for (std::size_t k = 0; k < size; ++k) result[i][static_cast<glm::length_t>(k)] = values[size * i + k];
  return result;
}

}  // namespace

std::string_view name_of(ParameterType type) { return type_names[static_cast<std::size_t>(type)]; }

std::optional<ParameterType> parameter_type(std::string_view name) {
  if (name == "point") return ParameterType::point3;
  if (name == "vector") return ParameterType::vector3;
  const auto it = std::find(type_names.begin(), type_names.end(), name);
  if (it == type_names.end()) return {};
  return static_cast<ParameterType>(it - type_names.begin());
}

ParameterList::ParameterList(std::string entity, Place place, Parameters own,
                             std::shared_ptr<const Parameters> defaults)
    : entity_(std::move(entity)), place_(place), own_(std::move(own)), defaults_(std::move(defaults)) {}

const Parameter* ParameterList::find(std::string_view name) const {
  const auto is_it = [name](const Parameter& p) { return p.name == name; };
  if (const auto it = std::find_if(own_.rbegin(), own_.rend(), is_it); it != own_.rend()) {
    it->used = true;
    return &*it;
  }
  if (!defaults_) return nullptr;
  const auto it = std::find_if(defaults_->rbegin(), defaults_->rend(), is_it);
  return it == defaults_->rend() ? nullptr : &*it;
}

std::optional<float> ParameterList::find_float(std::string_view name) const {
  return one_value<float>(*this, name, ParameterType::real);
}
std::optional<std::int32_t> ParameterList::find_integer(std::string_view name) const {
  return one_value<std::int32_t>(*this, name, ParameterType::integer);
}
std::optional<bool> ParameterList::find_bool(std::string_view name) const {
  return one_value<bool>(*this, name, ParameterType::boolean);
}
std::optional<std::string> ParameterList::find_string(std::string_view name) const {
  return one_value<std::string>(*this, name, ParameterType::string);
}

std::optional<Vec3> ParameterList::find_vec3(std::string_view name) const {
  const std::vector<Vec3> values = vec3s(name);
  if (values.empty()) return {};
  if (values.size() > 1) throw error(name, "needs three values, has " + std::to_string(3 * values.size()));
  return values.front();
}

std::string ParameterList::get(std::string_view name, const char* otherwise) const {
  return find_string(name).value_or(otherwise);
}

std::string ParameterList::required_string(std::string_view name) const {
  const auto value = find_string(name);
  if (!value) throw error(name, "is missing");
  return *value;
}

std::vector<float> ParameterList::floats(std::string_view name) const {
  const auto* values = values_of<float>(*this, name, ParameterType::real);
  return values ? *values : std::vector<float>();
}
std::vector<std::int32_t> ParameterList::integers(std::string_view name) const {
  const auto* values = values_of<std::int32_t>(*this, name, ParameterType::integer);
  return values ? *values : std::vector<std::int32_t>();
}
std::vector<std::string> ParameterList::strings(std::string_view name) const {
  const auto* values = values_of<std::string>(*this, name, ParameterType::string);
  return values ? *values : std::vector<std::string>();
}
std::vector<Vec2> ParameterList::vec2s(std::string_view name) const {
  return tuples<Vec2>(*this, name, is_pair, "point2");
}
std::vector<Vec3> ParameterList::vec3s(std::string_view name) const {
  return tuples<Vec3>(*this, name, is_triple, "point3");
}

std::optional<std::array<float, 4>> ParameterList::find_float4(std::string_view name) const {
  if (!has(name)) return {};
  const std::vector<float> v = floats(name);
  if (v.size() != 4) throw error(name, "needs four values, has " + std::to_string(v.size()));
  return std::array<float, 4>{v[0], v[1], v[2], v[3]};
}

Error ParameterList::error(std::string_view name, const std::string& message) const {
  const Parameter* p = find(name);
  return Error((p ? p->place : place_).location(), "parameter " + in_quotes(name) + " of " + entity_ + " " + message);
}

}  // namespace lanthorn::pbrt
