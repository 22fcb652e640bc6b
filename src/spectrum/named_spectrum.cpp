// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "spectrum/cie.h"
#include "spectrum/curve.h"

namespace lanthorn {
namespace {

using NamedSpectra = std::map<std::string, DenseSpectrum, std::less<>>;

void add_conductor(NamedSpectra& named, const std::string& name, const std::vector<float>& nm,
                   const std::vector<float>& eta, const std::vector<float>& k) {
  named["metal-" + name + "-eta"] = resample(nm.data(), eta.data(), nm.size(), true);
  named["metal-" + name + "-k"] = resample(nm.data(), k.data(), nm.size(), true);
}

/// Metals sampled at equal steps of photon energy.
void add_metals(NamedSpectra& named) {
  constexpr std::size_t samples = 56;
  struct Constants {
    double eta, k;
  };
  struct Metal {
    const char* name;
    std::array<Constants, samples> values;
  };
  static constexpr Metal metals[] = {
#include "spectrum/data/metals.inc"
  };
  constexpr double nm_electronvolt = 1239.8418;
  for (const Metal& metal : metals) {
    std::vector<float> nm, eta, k;
    for (std::size_t i = 0; i < samples; ++i) {
      nm.push_back(static_cast<float>(nm_electronvolt / (4.15 - 0.05 * static_cast<double>(i))));
      eta.push_back(static_cast<float>(metal.values[i].eta));
      k.push_back(static_cast<float>(metal.values[i].k));
    }
    add_conductor(named, metal.name, nm, eta, k);
  }
}

/// Materials, each sampled at its own wavelengths.
void add_optical_constants(NamedSpectra& named) {
  struct Constants {
    double nm, eta, k;
  };
  struct Material {
    const char* name;
    std::vector<Constants> values;
  };
  const Material materials[] = {
#include "spectrum/data/optical_constants.inc"
  };
  for (const Material& material : materials) {
    std::vector<float> nm, eta, k;
    for (const Constants& c : material.values) {
      nm.push_back(static_cast<float>(c.nm));
      eta.push_back(static_cast<float>(c.eta));
      k.push_back(static_cast<float>(c.k));
    }
    add_conductor(named, material.name, nm, eta, k);
  }
}

/// Sellmeier's formula n^2 = 1 + sum b l^2 / (l^2 - c), l in micrometres, with the coefficients of SCHOTT's catalogue
/// (2017; refractiveindex.info, CC0). All are the current lead-free "N-" glasses, even if the name in a scene file has
/// no "N": pbrt uses the same indices under those names.
void add_glasses(NamedSpectra& named) {
  struct Glass {
    const char* name;
    std::array<double, 3> b, c;
  };
  static constexpr Glass glasses[] = {
      {"glass-BK7", {1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}},
      {"glass-BAF10", {1.5851495, 0.143559385, 1.08521269}, {0.00926681282, 0.0424489805, 105.613573}},
      {"glass-FK51A", {0.971247817, 0.216901417, 0.904651666}, {0.00472301995, 0.0153575612, 168.68133}},
      {"glass-LASF9", {2.00029547, 0.298926886, 1.80691843}, {0.0121426017, 0.0538736236, 156.530829}},
      {"glass-F5", {1.52481889, 0.187085527, 1.42729015}, {0.011254756, 0.0588995392, 129.141675}},    // N-SF5
      {"glass-F10", {1.62153902, 0.256287842, 1.64447552}, {0.0122241457, 0.0595736775, 147.468793}},  // N-SF10
      {"glass-F11", {1.73759695, 0.313747346, 1.89878101}, {0.013188707, 0.0623068142, 155.23629}},    // N-SF11
  };
  for (const Glass& glass : glasses) {
    DenseSpectrum& eta = named[glass.name];
    for (std::size_t i = 0; i < spectrum_samples; ++i) {
      const double micrometres = 1e-3 * (double{lambda_min} + static_cast<double>(i));
      const double l2 = micrometres * micrometres;
      double n2 = 1;
      for (std::size_t term = 0; term < 3; ++term) n2 += glass.b[term] * l2 / (l2 - glass.c[term]);
      eta.values[i] = static_cast<float>(std::sqrt(n2));
    }
  }
}

/// CIE standard illuminant A (ISO 11664-2): Planck's law at 2848 K with the value of c2 from its definition.
DenseSpectrum illuminant_a() {
  DenseSpectrum a;
  const auto excitation = [](double nm) { return std::expm1(1.435e7 / (2848 * nm)); };
  for (std::size_t i = 0; i < spectrum_samples; ++i) {
    const double nm = double{lambda_min} + static_cast<double>(i);
    a.values[i] = static_cast<float>(std::pow(560 / nm, 5) * excitation(560) / excitation(nm));
  }
  return normalized_luminance(a);
}

void add_illuminants(NamedSpectra& named) {
  named["stdillum-A"] = illuminant_a();
  named["stdillum-D50"] = daylight(0.34567, 0.35850);
  named["stdillum-D65"] = illuminant_d65;

  constexpr std::size_t samples = 81;
  static constexpr std::array<double, samples> fluorescent[12] = {
#include "spectrum/data/cie_fluorescent.inc"
  };
  std::vector<float> nm(samples), values(samples);
  for (std::size_t f = 0; f < std::size(fluorescent); ++f) {
    for (std::size_t i = 0; i < samples; ++i) {
      nm[i] = 380 + 5 * static_cast<float>(i);
      values[i] = static_cast<float>(fluorescent[f][i]);
    }
    named["stdillum-F" + std::to_string(f + 1)] =
        normalized_luminance(resample(nm.data(), values.data(), samples, false));
  }
}

NamedSpectra make_named_spectra() {
  NamedSpectra named;
  add_metals(named);
  add_optical_constants(named);
  add_glasses(named);
  add_illuminants(named);
  return named;
}

}  // namespace

const DenseSpectrum* named_spectrum(const char* name) {
  static const NamedSpectra named = make_named_spectra();
  const auto found = named.find(std::string_view(name));
  return found == named.end() ? nullptr : &found->second;
}

}  // namespace lanthorn
