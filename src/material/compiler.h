// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "lanthorn/scene_description.h"
#include "material/material.h"
#include "surface/clear_coated.h"
#include "surface/measured.h"
#include "texture/spectrum_store.h"
#include "texture/textures.h"

namespace lanthorn {

/// A float parameter at a point.
struct FloatAt {
  const TextureGraph* textures = nullptr;
  FloatInput input;

  bool is_constant() const { return !input.node; }
  float operator()(const TexturePoint& at) const { return textures->evaluate(input, at); }
};
/// A spectrum parameter at a point.
struct SpectrumAt {
  const TextureGraph* textures = nullptr;
  SpectrumInput input;

  bool is_constant() const { return !input.node; }
  Spectrum operator()(const TexturePoint& at, const Wavelengths& w) const { return textures->evaluate(input, at, w); }
};

/// A spectrum parameter at a point, averaged over its footprint (`TextureGraph::evaluate_filtered`). Only for
/// parameters in which the closure is linear and on which its sampling does not depend: the width of the footprint then
/// changes neither the expected picture nor MIS weights.
struct FilteredSpectrumAt : SpectrumAt {
  Spectrum operator()(const TexturePoint& at, const Wavelengths& w) const {
    return textures->evaluate_filtered(input, at, w);
  }
};

/// Data that closures point to. Shared by the materials of a scene and by edited scenes.
struct MaterialStore {
  struct LoadedBrdf {
    std::shared_ptr<const MeasuredData> data;  ///< outlives `brdf`
    MeasuredBrdf brdf{*data};
  };
  std::map<description::Index, std::shared_ptr<const LoadedBrdf>> measured;
  std::map<std::array<float, 3>, std::shared_ptr<const CoatPassage>> coat_passages;  ///< by index, width, thickness
};

/// Compiles the parameters of one material and records its traits on the way.
class MaterialCompiler {
 public:
  /// All arguments must outlive the compiler. `textures` and the contents of `spectra` and `store` must also outlive
  /// the closures that it compiles.
  MaterialCompiler(const SceneDescription& description, TextureGraph& textures, SpectrumStore& spectra,
                   MaterialStore& store, const SourceLocation& location)
      : description_(description), textures_(textures), spectra_(spectra), store_(store), location_(location) {}

  FloatAt number(const description::FloatParameter& p);
  SpectrumAt spectrum(const description::SpectrumParameter& p, description::SpectrumRole role);
  SpectrumAt albedo(const description::SpectrumParameter& p) { return spectrum(p, description::SpectrumRole::albedo); }
  FilteredSpectrumAt filtered_albedo(const description::SpectrumParameter& p);
  /// A spectrum that is the same everywhere and has no effect on the traits.
  SpectrumCurve curve(const description::SpectrumValue& value);
  /// An index of refraction whose variation disperses light.
  SpectrumCurve index(const description::SpectrumValue& eta);
  const MeasuredBrdf& measured(description::Index brdf);
  /// The table of light that passes a coat of this index, GGX width and thickness, made on first use.
  const CoatPassage& coat_passage(float eta, float alpha, float thickness);

  const SourceLocation& location() const { return location_; }

  std::vector<SpectrumInput> filtered;  ///< parameters that may be averaged
  MaterialTraits traits;                ///< those that follow from the parameters compiled so far
  bool is_constant = true;              ///< the closure depends on neither place nor, in RGB mode, wavelength

 private:
  const SceneDescription& description_;
  TextureGraph& textures_;
  SpectrumStore& spectra_;
  MaterialStore& store_;
  const SourceLocation& location_;
};

}  // namespace lanthorn
