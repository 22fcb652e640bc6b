// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "io/pbrt/tokenizer.h"
#include "math/vec.h"
#include "spectrum/curve.h"

namespace lanthorn::pbrt {

enum class ParameterType : std::uint8_t {
  boolean,
  integer,
  real,
  string,
  point2,
  vector2,
  point3,
  vector3,
  normal,
  spectrum,
  rgb,
  blackbody,
  texture
};
/// The type's name as written in files ("point" and "vector" are read as "point3" and "vector3").
std::string_view name_of(ParameterType type);
std::optional<ParameterType> parameter_type(std::string_view name);

/// One `"type name" [ values ]`.
struct Parameter {
  using Values =
      std::variant<std::vector<float>, std::vector<std::int32_t>, std::vector<bool>, std::vector<std::string>>;

  ParameterType type = ParameterType::real;
  std::string name;
  Place place;
  Values values;
  ColorSpace color_space = ColorSpace::srgb;  ///< the colour space current at the parameter
  mutable bool used = false;
};
using Parameters = std::vector<Parameter>;

/// The parameters of one directive, with the defaults that `Attribute` has set for its kind. A getter marks the
/// parameter as used, and throws Error at it if its type or number of values is wrong.
class ParameterList {
 public:
  ParameterList() = default;
  /// `entity` names the owner in messages, such as `Shape "sphere"`.
  ParameterList(std::string entity, Place place, Parameters own, std::shared_ptr<const Parameters> defaults = nullptr);

  const std::string& entity() const { return entity_; }
  const Place& place() const { return place_; }
  /// In file order, without the defaults.
  const Parameters& own() const { return own_; }

  /// The last parameter of this name, otherwise the default; null if there is neither.
  const Parameter* find(std::string_view name) const;
  bool has(std::string_view name) const { return find(name) != nullptr; }

  std::optional<float> find_float(std::string_view name) const;
  std::optional<std::int32_t> find_integer(std::string_view name) const;
  std::optional<bool> find_bool(std::string_view name) const;
  std::optional<std::string> find_string(std::string_view name) const;
  std::optional<Vec3> find_vec3(std::string_view name) const;
  float get(std::string_view name, float otherwise) const { return find_float(name).value_or(otherwise); }
  int get(std::string_view name, int otherwise) const { return find_integer(name).value_or(otherwise); }
  bool get(std::string_view name, bool otherwise) const { return find_bool(name).value_or(otherwise); }
  Vec3 get(std::string_view name, const Vec3& otherwise) const { return find_vec3(name).value_or(otherwise); }
  std::string get(std::string_view name, const char* otherwise) const;
  /// Throws Error at the directive if the parameter is missing.
  std::string required_string(std::string_view name) const;

  /// Arrays: empty if the parameter is missing. Points, vectors and normals are interchangeable.
  std::vector<float> floats(std::string_view name) const;
  std::vector<std::int32_t> integers(std::string_view name) const;
  std::vector<std::string> strings(std::string_view name) const;
  std::vector<Vec2> vec2s(std::string_view name) const;
  std::vector<Vec3> vec3s(std::string_view name) const;
  /// Exactly four floats.
  std::optional<std::array<float, 4>> find_float4(std::string_view name) const;

  /// An Error at the parameter, or at the directive if the parameter is missing. The message names both.
  Error error(std::string_view name, const std::string& message) const;

 private:
  std::string entity_;
  Place place_;
  Parameters own_;
  std::shared_ptr<const Parameters> defaults_;
};

}  // namespace lanthorn::pbrt
