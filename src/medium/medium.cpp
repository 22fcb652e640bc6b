// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "medium/medium.h"

namespace lanthorn {

namespace {

// Affine maps preserve the parameter along a line: distances remain those in the world.
template <class M>
Segment in_medium(const M& medium, const Segment& s) {
  return {medium.to_medium.point(s.origin), medium.to_medium.vector(s.direction), s.length};
}

Spectrum transmittance_of(const HomogeneousMedium& m, const Segment& s, const Wavelengths& w, HashRng&) {
  return m.transmittance(s.length, w);
}
template <class M>
Spectrum transmittance_of(const M& m, const Segment& s, const Wavelengths& w, HashRng& rng) {
  return track_transmittance(m, in_medium(m, s), w, rng);
}

Flight fly_through(const HomogeneousMedium& m, const Segment& s, const Spectrum& beta, const Wavelengths& w,
                   HashRng& rng) {
  return m.fly(s.length, beta, w, rng);
}
template <class M>
Flight fly_through(const M& m, const Segment& s, const Spectrum& beta, const Wavelengths& w, HashRng& rng) {
  return track_flight(m, in_medium(m, s), beta, w, rng);
}

}  // namespace

bool scatters(const Medium& medium) {
  return std::visit(
      [](const auto& m) {
        if constexpr (requires { m.sigma_s.is_black(); }) return !m.sigma_s.is_black();
        return true;
      },
      medium);
}

bool is_emissive(const Medium& medium) {
  struct IsEmissive {
    bool operator()(const HomogeneousMedium& m) const { return !m.emission.is_black(); }
    bool operator()(const DensityMedium& m) const { return m.emission.has_value(); }
    bool operator()(const RgbGridMedium& m) const { return m.emission.has_value(); }
  };
  return std::visit(IsEmissive{}, medium);
}

Spectrum transmittance(const Medium& medium, const Segment& segment, const Wavelengths& w, HashRng& rng) {
  return std::visit([&](const auto& m) { return transmittance_of(m, segment, w, rng); }, medium);
}

Flight fly(const Medium& medium, const Segment& segment, const Spectrum& beta, const Wavelengths& w, HashRng& rng) {
  return std::visit([&](const auto& m) { return fly_through(m, segment, beta, w, rng); }, medium);
}

const HenyeyGreenstein& phase_of(const Medium& medium) {
  return std::visit([](const auto& m) -> const HenyeyGreenstein& { return m.phase; }, medium);
}

}  // namespace lanthorn
