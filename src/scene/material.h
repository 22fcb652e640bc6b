// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Materials with their textures, evaluated to closures.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "lanthorn/scene_description.h"
#include "math/frame.h"
#include "math/vec.h"
#include "scene/relief.h"
#include "scene/surface_point.h"
#include "shape/geometry_record.h"
#include "spectrum/wavelengths.h"
#include "surface/bsdf.h"
#include "texture/spectrum_store.h"
#include "texture/textures.h"

namespace lanthorn {

/// The description's materials with compiled parameters. Immutable once built.
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
    const float amount = std::clamp(textures_->evaluate(mix->amount, at), 0.0f, 1.0f);
    if (amount < 1) for_parts(mix->materials[0], at, share * (1 - amount), visit);
    if (amount > 0) for_parts(mix->materials[1], at, share * amount, visit);
  }
  /// The closure of a resolved material at a point. Not for interface materials.
  PointBsdf evaluate(std::uint32_t resolved, const TexturePoint& at, const Wavelengths& w) const {
    const Material& m = materials_[resolved];
    if (w.mode == ColorMode::rgb && m.constant_rgb) return PointBsdf(&*m.constant_rgb);
    return evaluate(m, at, w);
  }
  /// Shading frame of a resolved material's closure, relief included. The surface must have its tangents.
  Frame shading_frame(std::uint32_t resolved, const SurfaceGeometry& surface, const TexturePoint& at) const;

  /// The normal of a resolved material's normal map, in the frame of dp/du, dp/dv and the smooth normal; nullopt if it
  /// has none.
  std::optional<Normal> mapped_normal(std::uint32_t resolved, const TexturePoint& at) const;

  struct Traits {
    bool is_interface = false;                   ///< no surface
    bool is_anisotropic = false;                 ///< the shading frame's tangent matters
    bool is_dispersive = false;                  ///< an index of refraction varies with wavelength
    bool has_tables = false;                     ///< some spectrum is tabulated, other than a metal's (see metal_rgb.h)
    bool varies = false;                         ///< depends on the place
    bool has_relief = false;                     ///< a normal map or a displacement modifies shading normals
    bool may_be_specular = false;                ///< has delta lobes at least in some places
    bool is_hair = false;                        ///< scatters as a hair, whose width faces every ray
    std::optional<description::Index> interior;  ///< medium inside; of a mix: the interior of the part that has one
  };
  const Traits& traits(std::uint32_t material) const { return materials_[material].traits; }
  /// True if some material may have delta lobes.
  bool may_be_specular() const {
    return std::any_of(materials_.begin(), materials_.end(), [](const auto& m) { return m.traits.may_be_specular; });
  }
  std::size_t size() const { return materials_.size(); }

 private:
  struct RoughnessInput {
    FloatInput u, v;
    bool remap = true;
  };
  struct MetalInput {
    std::optional<SpectrumInput> reflectance;
    SpectrumInput eta, k;
    RoughnessInput roughness;
  };
  struct CoatInput {
    RoughnessInput roughness;
    FloatInput thickness;
    SpectrumCurve eta;
    SpectrumInput albedo;
    FloatInput g;
    int max_depth = 10;
    int samples = 1;
    const CoatPassage* passage = nullptr;  ///< of a clear coat that is the same everywhere; null: walks
  };
  struct FilmInput {
    FloatInput thickness;
    float eta = 1;
  };
  struct DiffuseMaterial {
    SpectrumInput reflectance;
  };
  struct TransmissionMaterial {
    SpectrumInput reflectance, transmittance;
    float scale = 1;
  };
  struct ConductorMaterial {
    MetalInput metal;
  };
  struct DielectricMaterial {
    SpectrumCurve eta;
    RoughnessInput roughness;
    SpectrumInput tint;
    std::optional<FilmInput> film;
  };
  struct ThinMaterial {
    SpectrumCurve eta;
    RoughnessInput roughness;
    SpectrumInput tint;
    std::optional<FilmInput> film;
  };
  struct CoatedDiffuseMaterial {
    SpectrumInput reflectance;
    CoatInput coat;
  };
  struct CoatedConductorMaterial {
    MetalInput metal;
    CoatInput coat;
  };
  struct HairMaterial {
    std::optional<SpectrumInput> sigma_a, color;
    FloatInput eumelanin, pheomelanin;
    SpectrumCurve eumelanin_absorption, pheomelanin_absorption;
    FloatInput eta, beta_m, beta_n, alpha;
  };
  struct PlasticMaterial {
    SpectrumInput reflectance;
    RoughnessInput roughness;
    SpectrumCurve eta;
    FloatInput specular;
    SpectrumInput specular_color;
    std::optional<SpectrumInput> sheen_color;
    FloatInput sheen_roughness;
    std::optional<FilmInput> film;
  };
  struct CoatedPlasticMaterial {
    PlasticMaterial base;
    CoatInput coat;
  };
  struct MeasuredMaterial {
    const MeasuredBrdf* brdf = nullptr;
  };
  struct Mix {
    std::array<std::uint32_t, 2> materials{};
    FloatInput amount;
    TextureGraph::Cost cost{};  ///< of visiting all parts
  };
  struct Material {
    std::variant<DiffuseMaterial, TransmissionMaterial, ConductorMaterial, DielectricMaterial, ThinMaterial,
                 CoatedDiffuseMaterial, CoatedConductorMaterial, HairMaterial, PlasticMaterial, CoatedPlasticMaterial,
                 MeasuredMaterial>
        node;
    std::optional<Mix> mix;
    std::optional<std::uint32_t> relief;  ///< into reliefs_
    std::optional<Bsdf> constant_rgb;     ///< the closure, if it depends on neither place nor wavelength in RGB mode
    Traits traits;
  };
  struct Compiler;

  /// Traits of a mix of materials compiled before it. Removes interfaces from the mix, with a warning, and parts that
  /// are never chosen. There is only one medium inside, because light that enters through one part can leave through
  /// another.
  Traits settle(Mix& mix, const SourceLocation& location, std::vector<description::Warning>& warnings) const;
  /// Throws Error if it is more than textures may cost: mixes are visited recursively, too.
  TextureGraph::Cost cost_of(const Mix& mix, const SourceLocation& location) const;
  std::uint32_t choose(const Mix& mix, const TexturePoint& at, const Direction& towards) const;
  Bsdf evaluate(const Material& material, const TexturePoint& at, const Wavelengths& w) const;
  Bsdf evaluate_node(const DiffuseMaterial& m, const TexturePoint& at, const Wavelengths& w) const;
  Bsdf evaluate_node(const TransmissionMaterial& m, const TexturePoint& at, const Wavelengths& w) const;
  Bsdf evaluate_node(const ConductorMaterial& m, const TexturePoint& at, const Wavelengths& w) const;
  Bsdf evaluate_node(const DielectricMaterial& m, const TexturePoint& at, const Wavelengths& w) const;
  Bsdf evaluate_node(const ThinMaterial& m, const TexturePoint& at, const Wavelengths& w) const;
  Bsdf evaluate_node(const CoatedDiffuseMaterial& m, const TexturePoint& at, const Wavelengths& w) const;
  Bsdf evaluate_node(const CoatedConductorMaterial& m, const TexturePoint& at, const Wavelengths& w) const;
  Bsdf evaluate_node(const HairMaterial& m, const TexturePoint& at, const Wavelengths& w) const;
  Spectrum absorption(const HairMaterial& m, float beta_n, const TexturePoint& at, const Wavelengths& w) const;
  Bsdf evaluate_node(const PlasticMaterial& m, const TexturePoint& at, const Wavelengths& w) const;
  Plastic plastic(const PlasticMaterial& m, const TexturePoint& at, const Wavelengths& w) const;
  Bsdf evaluate_node(const CoatedPlasticMaterial& m, const TexturePoint& at, const Wavelengths& w) const;
  Bsdf evaluate_node(const MeasuredMaterial& m, const TexturePoint& at, const Wavelengths& w) const;
  Conductor metal(const MetalInput& m, const TexturePoint& at, const Wavelengths& w) const;
  template <class Base>
  Coated<Base> coated(const CoatInput& coat, const Base& base, const TexturePoint& at, const Wavelengths& w) const;
  Vec2 alpha(const RoughnessInput& roughness, const TexturePoint& at) const;
  ThinFilm film(const std::optional<FilmInput>& film, const TexturePoint& at, const Wavelengths& w) const;

  const TextureGraph* textures_;
  std::vector<Material> materials_;
  std::vector<Relief> reliefs_;
  struct LoadedBrdf {
    std::shared_ptr<const MeasuredData> data;  // outlives `brdf`
    MeasuredBrdf brdf{*data};
  };
  std::map<description::Index, std::shared_ptr<const LoadedBrdf>> measured_;  // those in use
  /// By index, width and thickness of the coat.
  using CoatPassages = std::map<std::array<float, 3>, std::shared_ptr<const CoatPassage>>;
  CoatPassages coat_passages_;
};

}  // namespace lanthorn
