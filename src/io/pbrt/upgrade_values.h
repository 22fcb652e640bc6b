// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Parameters of pbrt-v3's directives during their translation to pbrt-v4.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "io/pbrt/parameters.h"

namespace lanthorn::pbrt {

Parameter float_parameter(std::string name, float value, Place place);
Parameter integer_parameter(std::string name, int value, Place place);
Parameter bool_parameter(std::string name, bool value, Place place);
Parameter string_parameter(std::string name, std::string value, Place place);
Parameter rgb_parameter(std::string name, const Rgb& value, Place place);
Parameter texture_parameter(std::string name, std::string texture, Place place);
Parameter renamed(Parameter parameter, std::string name);

/// The colour of an "rgb" or "float" parameter; nullopt for textures and tabulated spectra. Throws Error for any other
/// type or a wrong number of values.
std::optional<Rgb> constant_colour(const Parameter& parameter);
/// The name of the texture; empty if the parameter is not a texture.
std::string texture_of(const Parameter& parameter);

/// A number, or a float texture.
struct Factor {
  float value = 1;
  std::string texture = {};  ///< empty: use `value`

  bool is(float number) const { return texture.empty() && value == number; }
};
Parameter factor_parameter(std::string name, const Factor& factor, Place place);

/// The parameters of a pbrt-v3 directive, from which its translation takes one after the other. Parameters that are
/// left over are unknown to it.
class OldParameters {
 public:
  OldParameters(std::string entity, Place place, Parameters parameters);

  const Place& place() const { return place_; }
  const std::string& entity() const { return entity_; }
  bool has(std::string_view name) const;
  /// The last parameter of this name.
  const Parameter* find(std::string_view name) const;

  /// Take the last parameter of this name; earlier ones are discarded, as in pbrt-v3. Throw Error for a wrong type or
  /// number of values.
  std::optional<Parameter> take(std::string_view name);
  std::optional<float> take_float(std::string_view name);
  std::optional<int> take_integer(std::string_view name);
  std::optional<bool> take_bool(std::string_view name);
  std::optional<std::string> take_string(std::string_view name);
  std::optional<Factor> take_factor(std::string_view name);
  /// The parameters that have not been taken.
  Parameters rest() { return std::move(parameters_); }

 private:
  template <class T>
  std::optional<T> take_one(std::string_view name, ParameterType type);

  std::string entity_;
  Place place_;
  Parameters parameters_;
};

}  // namespace lanthorn::pbrt
