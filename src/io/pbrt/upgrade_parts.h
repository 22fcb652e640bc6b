// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Translations of pbrt-v3's directives, by subject. Texture names are already the names in the output. All throw Error
// for kinds that pbrt-v3 does not have.
#pragma once

#include <string>
#include <string_view>

#include "io/pbrt/upgrade_tools.h"

namespace lanthorn::pbrt {

/// A kind of pbrt-v4 and its parameters.
struct Upgraded {
  std::string kind;
  Parameters parameters;
};

struct UpgradedMaterial {
  Upgraded material;
  Factor opacity = {};  ///< alpha of the shapes
};
/// Emits the textures and the parts of mixes that the material needs. Names of parts begin with `name`.
UpgradedMaterial upgrade_material(const std::string& kind, OldParameters old, const std::string& name,
                                  UpgradeOutput& output);
/// True if a material of any kind has a parameter of this name, which a shape may override.
bool is_material_parameter(std::string_view name);
/// True if pbrt-v3 looks up a texture for this parameter among the spectrum textures. `owner`: kind of the material;
/// empty for textures.
bool is_spectrum_parameter(std::string_view name, std::string_view owner);

/// Emits the light.
void upgrade_light(const std::string& kind, OldParameters old, UpgradeOutput& output);
Upgraded upgrade_area_light(const std::string& kind, OldParameters old, UpgradeOutput& output);

/// Emits the texture, and further ones that it needs.
void upgrade_texture(const std::string& name, bool is_spectrum, const std::string& kind, OldParameters old,
                     UpgradeOutput& output);

/// nullopt if the shape is omitted.
std::optional<Upgraded> upgrade_shape(const std::string& kind, OldParameters old, UpgradeOutput& output);

/// The directives before WorldBegin.
Upgraded upgrade_camera(const std::string& kind, OldParameters old, UpgradeOutput& output);
Upgraded upgrade_film(const std::string& kind, OldParameters old, float exposure_time, UpgradeOutput& output);
Upgraded upgrade_filter(const std::string& kind, OldParameters old);
Upgraded upgrade_sampler(const std::string& kind, OldParameters old);
/// Removes the number of passes, which belongs to the sampler in pbrt-v4, from the parameters.
struct UpgradedIntegrator {
  Upgraded integrator;
  std::optional<int> passes;
};
UpgradedIntegrator upgrade_integrator(const std::string& kind, OldParameters old, UpgradeOutput& output);
/// Parameters for `MakeNamedMedium`.
Parameters upgrade_medium(OldParameters old);

}  // namespace lanthorn::pbrt
