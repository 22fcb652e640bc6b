// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <string_view>

#include "spectrum/cie.h"
#include "spectrum/curve.h"

namespace lanthorn {
namespace {

std::map<std::string_view, DenseSpectrum> make_named_spectra() {
  std::map<std::string_view, DenseSpectrum> named;
  named["stdillum-D65"] = illuminant_d65;
  return named;
}

}  // namespace

const DenseSpectrum* named_spectrum(const char* name) {
  static const std::map<std::string_view, DenseSpectrum> named = make_named_spectra();
  const auto found = named.find(name);
  return found == named.end() ? nullptr : &found->second;
}

}  // namespace lanthorn
