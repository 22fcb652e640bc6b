// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "material/compiler.h"

namespace lanthorn {

using description::SpectrumRole;

FloatAt MaterialCompiler::number(const description::FloatParameter& p) {
  FloatAt at{&textures_, textures_.compile(p)};
  is_constant = is_constant && at.is_constant();
  return at;
}

SpectrumAt MaterialCompiler::spectrum(const description::SpectrumParameter& p, SpectrumRole role) {
  SpectrumAt at{&textures_, textures_.compile(p, role, location_)};
  is_constant = is_constant && at.is_constant();
  traits.has_tables = traits.has_tables || at.input.curve.table != nullptr;
  return at;
}

FilteredSpectrumAt MaterialCompiler::filtered_albedo(const description::SpectrumParameter& p) {
  const FilteredSpectrumAt at{albedo(p)};
  textures_.want_levels(at.input);
  filtered.push_back(at.input);
  return at;
}

SpectrumCurve MaterialCompiler::curve(const description::SpectrumValue& value) {
  return spectra_.curve(value, SpectrumRole::unbounded, description_.color_space, location_);
}

SpectrumCurve MaterialCompiler::index(const description::SpectrumValue& eta) {
  const SpectrumCurve index = curve(eta);
  traits.is_dispersive = traits.is_dispersive || index.varies();
  is_constant = is_constant && !index.varies();
  return index;
}

const MeasuredBrdf& MaterialCompiler::measured(description::Index brdf) {
  std::shared_ptr<const MaterialStore::LoadedBrdf>& loaded = store_.measured[brdf];
  if (!loaded)
    loaded = std::make_shared<const MaterialStore::LoadedBrdf>(
        MaterialStore::LoadedBrdf{description_.measured_brdfs.at(brdf)});
  traits.has_tables = traits.has_tables || !loaded->data->wavelengths.empty();
  traits.is_anisotropic = traits.is_anisotropic || !loaded->data->is_isotropic();
  return loaded->brdf;
}

const CoatPassage& MaterialCompiler::coat_passage(float eta, float alpha, float thickness) {
  std::shared_ptr<const CoatPassage>& known = store_.coat_passages[{eta, alpha, thickness}];
  if (!known) known = std::make_shared<const CoatPassage>(Dielectric{eta, alpha, alpha}, thickness);
  return *known;
}

}  // namespace lanthorn
