// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lanthorn/scene_description.h"
#include "material/compiler.h"
#include "material/material.h"
#include "material/relief.h"
#include "math/frame.h"
#include "math/vec.h"
#include "shape/geometry_record.h"
#include "spectrum/wavelengths.h"
#include "surface/bsdf.h"
#include "texture/spectrum_store.h"
#include "texture/textures.h"

namespace lanthorn {

/// The materials of a scene, compiled. Immutable once built.
class MaterialTable {
 public:
  /// Compiles the materials that shapes use and loads their images; other materials must not be evaluated. `textures`
  /// must outlive this table and its copies. `loaded`: shares its measured BRDFs. Throws Error for unknown names and
  /// unreadable images; appends to `warnings`.
  MaterialTable(const SceneDescription& description, TextureGraph& textures, SpectrumStore& spectra,
                std::vector<description::Warning>& warnings, const MaterialTable* loaded = nullptr);

  /// Resolves mixes: returns the visible material at a point. `towards` points from the surface to the ray's origin.
  /// The choice is a hash of both, so that the same ray always sees the same material.
  std::uint32_t resolve(std::uint32_t material, const TexturePoint& at, const Direction& towards) const {
    while (materials_[material].mix) material = choose(*materials_[material].mix, at, towards);
    return material;
  }
  /// Calls `visit(resolved, share)` for the materials that are visible at a point, with the shares of rays that see
  /// them.
  template <class Visit>
  void for_parts(std::uint32_t material, const TexturePoint& at, float share, const Visit& visit) const {
    const std::optional<Mix>& mix = materials_[material].mix;
    if (!mix) return visit(material, share);
    const float amount = std::clamp(mix->amount(at), 0.0f, 1.0f);
    if (amount < 1) for_parts(mix->materials[0], at, share * (1 - amount), visit);
    if (amount > 0) for_parts(mix->materials[1], at, share * amount, visit);
  }
  /// The closure of a resolved material at a point. Not for interface materials.
  PointBsdf evaluate(std::uint32_t resolved, const TexturePoint& at, const Wavelengths& w) const {
    const Material& m = materials_[resolved];
    if (w.mode == ColorMode::rgb && m.constant_rgb) return PointBsdf(&*m.constant_rgb);
    return m.closure(at, w);
  }
  /// Shading frame of a resolved material's closure, relief included. The surface must have its tangents.
  Frame shading_frame(std::uint32_t resolved, const SurfaceGeometry& surface, const TexturePoint& at) const;

  /// The normal of a resolved material's normal map, in the frame of dp/du, dp/dv and the smooth normal; nullopt if it
  /// has none.
  std::optional<Normal> mapped_normal(std::uint32_t resolved, const TexturePoint& at) const;

  const MaterialTraits& traits(std::uint32_t material) const { return materials_[material].traits; }
  /// True if some material may have delta lobes.
  bool may_be_specular() const {
    return std::any_of(materials_.begin(), materials_.end(), [](const auto& m) { return m.traits.may_be_specular; });
  }
  bool has_fibres() const {
    return std::any_of(materials_.begin(), materials_.end(), [](const auto& m) { return m.traits.is_hair; });
  }
  std::size_t size() const { return materials_.size(); }

 private:
  struct Mix {
    std::array<std::uint32_t, 2> materials{};
    FloatAt amount;
    TextureGraph::Cost cost{};  ///< of visiting all parts
  };
  struct Material {
    ClosureAt closure;  ///< none for mixes, interfaces and materials that no shape uses
    std::optional<Mix> mix;
    std::optional<std::uint32_t> relief;  ///< into reliefs_
    std::vector<SpectrumInput> filtered;  ///< parameters that may be averaged over footprints
    std::optional<Bsdf> constant_rgb;     ///< the closure, if it depends on neither place nor wavelength in RGB mode
    MaterialTraits traits;
  };

  /// Records which materials have textures with coarser levels, once the images are loaded.
  void note_levels();
  Material make(const description::Material& source, MaterialCompiler& compiler, TextureGraph& textures,
                std::vector<description::Warning>& warnings);
  /// Traits of a mix of materials compiled before it. Removes interfaces from the mix, with a warning, and parts that
  /// are never chosen. There is only one medium inside, because light that enters through one part can leave through
  /// another.
  MaterialTraits settle(Mix& mix, const SourceLocation& location, std::vector<description::Warning>& warnings) const;
  /// Cost of visiting all parts, including nested mixes. Throws Error if it exceeds the limit for textures.
  TextureGraph::Cost cost_of(const Mix& mix, const SourceLocation& location) const;
  static std::uint32_t choose(const Mix& mix, const TexturePoint& at, const Direction& towards);

  const TextureGraph* textures_;
  std::vector<Material> materials_;
  std::vector<Relief> reliefs_;
  MaterialStore store_;
};

}  // namespace lanthorn
