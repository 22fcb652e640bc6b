// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Shared by the translators of pbrt-v3's directives: access to the old parameters, and the pbrt-v4 output.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "io/pbrt/context.h"
#include "io/pbrt/directive.h"
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
  bool has(std::string_view name) const { return find(name) != nullptr; }
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
  /// These parameters, then those that have not been taken.
  Parameters with_rest(Parameters parameters);

 private:
  template <class T>
  std::optional<T> take_one(std::string_view name, ParameterType type);

  std::string entity_;
  Place place_;
  Parameters parameters_;
};

/// Receives the pbrt-v4 directives made from a pbrt-v3 file, and provides the functions that the translators share: new
/// names, arithmetic with textures, and the list of approximations.
class UpgradeOutput {
 public:
  UpgradeOutput(Context& context, const DirectiveSink& sink) : context_(context), sink_(sink) {}

  void emit(Directive directive) { sink_(std::move(directive)); }
  void emit(std::string_view name, std::vector<std::string> strings, Parameters parameters, Place place) {
    emit({name, {}, std::move(strings), std::move(parameters), place});
  }

  /// Notes a difference of pbrt-v4 or Lanthorn from pbrt-v3. Each message becomes one warning, with its first place and
  /// the number of its places.
  void note(const std::string& message, Place place);
  /// Adds the warnings to those of the scene.
  void finish();

  /// `wanted`, or `wanted` with a number appended; never returns the same name twice within a `space` of names.
  std::string fresh_name(char space, const std::string& wanted);

  /// Emits a pbrt-v4 texture under a unique name.
  void add_texture(const std::string& name, bool is_spectrum, const std::string& kind, Parameters parameters,
                   Place place);
  /// A spectrum multiplied by a number: scales the values of colours and sampled spectra, and makes a new texture
  /// otherwise.
  Parameter scaled(Parameter spectrum, float factor);
  /// The mean of red, green and blue of a spectrum: a number, or a float texture of the same kind as the spectrum
  /// texture. Notes if a colour is lost.
  Factor grey(const Parameter& spectrum, const std::string& entity);
  /// The product of two numbers or float textures.
  Factor product(const Factor& a, const Factor& b, Place place);

  /// Luminance of a light's spectrum: wavelengths and values, or the name of a file.
  float luminance(const Parameter& spectrum);

  Context& context() { return context_; }

 private:
  struct Texture {
    std::string kind;
    Parameters parameters;
    Place place;
  };
  struct Note {
    Place place;
    std::string message;
    std::size_t count = 0;
  };

  std::string grey_texture(const std::string& name, Place place, int depth = 0);

  Context& context_;
  const DirectiveSink& sink_;
  std::vector<Note> notes_;
  std::unordered_map<std::string, std::size_t> note_of_message_;
  std::map<std::pair<char, std::string>, int> names_;  ///< with the number that the next duplicate of this name gets
  std::unordered_map<std::string, Texture> spectrum_textures_;
  std::map<std::pair<std::string, float>, std::string> scaled_textures_;
  std::unordered_map<std::string, std::string> grey_textures_;
};

/// Spaces of names.
inline constexpr char texture_space = 't', material_space = 'm', object_space = 'o';

}  // namespace lanthorn::pbrt
