// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "medium/medium.h"

namespace lanthorn {

Spectrum transmittance(const Medium& medium, const Segment& segment, const Wavelengths& w, HashRng&) {
  return std::get<HomogeneousMedium>(medium).transmittance(segment.length, w);
}

Flight fly(const Medium& medium, const Segment& segment, const Spectrum& beta, const Wavelengths& w, HashRng& rng) {
  return std::get<HomogeneousMedium>(medium).fly(segment.length, beta, w, rng);
}

const HenyeyGreenstein& phase_of(const Medium& medium) {
  return std::visit([](const auto& m) -> const HenyeyGreenstein& { return m.phase; }, medium);
}

}  // namespace lanthorn
