// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Maps the material model of glTF 2.0 and its extensions to Lanthorn's materials.
#pragma once

#include <optional>
#include <string>

#include "lanthorn/scene_description.h"

namespace lanthorn {

/// Parameters as in glTF 2.0 §3.9.2, KHR_materials_ior, _dispersion, _specular, _transmission, _diffuse_transmission,
/// _volume, _anisotropy, _sheen, _iridescence and _clearcoat.
struct MetallicRoughness {
  description::SpectrumParameter base_color{description::RgbSpectrum{{1, 1, 1}}, {}};
  description::FloatParameter metallic{0, {}};
  description::FloatParameter roughness{1, {}};   ///< GGX alpha is its square
  description::FloatParameter anisotropy{0, {}};  ///< strength, along the tangent; of metal and of glass
  /// The dielectric's own parameters. The members above and `film` replace its reflectance, roughness and film.
  description::PlasticMaterial dielectric;
  description::FloatParameter transmission{0, {}};
  description::FloatParameter diffuse_transmission{0, {}};
  description::SpectrumParameter diffuse_transmission_color{1.0f, {}};
  bool thin = true;  ///< a transmitting surface is an infinitely thin sheet, not the boundary of a volume
  description::FloatParameter iridescence{0, {}};  ///< fraction of rays that hit the film
  description::ThinFilm film;
  description::FloatParameter clearcoat{0, {}};
  description::FloatParameter clearcoat_roughness{0, {}};
  std::optional<description::NormalMap> normal_map;
  std::optional<description::FloatParameter> displacement;
};

/// An index of refraction so large that Schlick's reflectance at normal incidence is 1 to within 1e-5; it replaces
/// KHR_materials_ior's index 0.
inline constexpr float total_reflection = 1e6f;

/// Adds the materials that make up this mixture. Returns the index of the last one, which gets the name.
description::Index add_material(SceneDescription& scene, const MetallicRoughness& source, const std::string& name,
                                const SourceLocation& location);

}  // namespace lanthorn
