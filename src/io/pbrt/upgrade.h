// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "io/pbrt/upgrade_parts.h"

namespace lanthorn::pbrt {

/// Names in pbrt-v3, whose definitions AttributeBegin and AttributeEnd scope, and their current meanings.
template <class T>
class ScopedNames {
 public:
  const T* find(const std::string& name) const {
    const auto it = values_.find(name);
    return it == values_.end() ? nullptr : &it->second;
  }
  void set(const std::string& name, T value) {
    std::optional<T>& old = changes_.emplace_back(name, std::nullopt).second;
    if (const auto it = values_.find(name); it != values_.end()) old = std::move(it->second);
    values_[name] = std::move(value);
  }
  void begin() { begins_.push_back(changes_.size()); }
  void end() {
    for (; changes_.size() > begins_.back(); changes_.pop_back()) {
      auto& [name, old] = changes_.back();
      if (old)
        values_[name] = std::move(*old);
      else
        values_.erase(name);
    }
    begins_.pop_back();
  }

 private:
  std::unordered_map<std::string, T> values_;
  std::vector<std::pair<std::string, std::optional<T>>> changes_;
  std::vector<std::size_t> begins_;
};

/// Translates the directives of a pbrt-v3 file to pbrt-v4, and of a pbrt-v2 file as far as they are the same as in
/// pbrt-v3: call `translate` for each, in file order, then `finish`. Each output directive has the place of the
/// directive it was made from. Approximations cause warnings, one per kind. Throws Error for directives that are
/// invalid or exist only in pbrt-v4.
class Upgrader {
 public:
  /// The context has the version of the file.
  Upgrader(Context& context, const DirectiveSink& sink);

  void translate(Directive d);
  void finish();

 private:
  /// A material as declared in the file: shapes may override its parameters.
  struct OldMaterial {
    std::string kind, name;
    Parameters parameters;
  };
  struct Material {
    std::shared_ptr<const OldMaterial> old;
    std::string new_name;
    Factor opacity;
  };
  struct Block {
    std::string_view end;  ///< name of the directive that ends it
    Place place;
    Material material = {};
    bool is_lamp = false;
  };
  using Handler = void (Upgrader::*)(Directive&);
  static Handler handler(std::string_view directive);

  void attribute_begin(Directive& d);
  void attribute_end(Directive& d);
  void transform_begin(Directive& d);
  void transform_end(Directive& d);
  void object_begin(Directive& d);
  void object_instance(Directive& d);
  void world_begin(Directive& d);
  void world_end(Directive& d);
  void only_in_v2(Directive& d);
  void only_in_v4(Directive& d);

  void camera(Directive& d);
  void film(Directive& d);
  void pixel_filter(Directive& d);
  void sampler(Directive& d);
  void integrator(Directive& d);

  void texture(Directive& d);
  void material(Directive& d);
  void make_named_material(Directive& d);
  void named_material(Directive& d);
  void make_named_medium(Directive& d);
  void light_source(Directive& d);
  void area_light_source(Directive& d);
  void shape(Directive& d);

  void emit(std::string_view directive, Upgraded upgraded, Place place);
  OldParameters old_parameters(Directive& d, std::string_view textures_of);
  void rename_textures(Parameters& parameters, const std::function<bool(const std::string&)>& is_spectrum);
  std::string new_material(const std::string& name) const;
  void open(std::string_view end, Place place);
  void check_open(bool is_transform, const Directive& end) const;
  UpgradedMaterial upgraded(const OldMaterial& material, Directive& d);
  bool override_material(Directive& shape);
  bool make_visible(Place place);

  UpgradeOutput output_;
  std::vector<Block> blocks_;
  std::optional<Directive> film_, filter_, sampler_;  ///< held back until WorldBegin
  std::optional<int> passes_;
  float exposure_time_ = 1;
  Material material_;     ///< current
  bool is_lamp_ = false;  ///< the current shapes emit
  ScopedNames<Material> materials_;
  ScopedNames<std::string> float_textures_, spectrum_textures_;
  std::unordered_map<std::string, std::string> objects_;
};

}  // namespace lanthorn::pbrt
