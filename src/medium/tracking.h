// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Null-collision tracking through heterogeneous media (Woodcock et al. 1965): null particles fill the medium up to a
// known majorant, and a collision with them changes nothing. A source of coefficients has
//   BlockGrid majorants;                               // upper bounds of its density
//   float extinction_bound(const Wavelengths&) const;  // per metre, of any channel at density 1
//   Local at(const Point&, const Wavelengths&) const;  // coefficients at a point in its space
// and of emission
//   Spectrum emitted(const Point&, const Wavelengths&) const;  // radiance per metre there
#pragma once

#include <algorithm>
#include <cmath>

#include "math/hash.h"
#include "medium/block_grid.h"
#include "medium/flight.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Coefficients at a point of a medium.
struct LocalCoefficients {
  Spectrum absorbed, scattered;  ///< per metre
};

namespace tracking_detail {

/// Null-collision coefficient that fills the medium up to the majorant. Never negative: a majorant that is too small by
/// rounding causes an error of that rounding only.
inline Spectrum imaginary(const LocalCoefficients& c, float majorant) {
  return map(Spectrum(majorant) - c.absorbed - c.scattered, [](float x) { return std::max(0.0f, x); });
}

/// A collision of ratio tracking, with Russian roulette once the transmittance is low.
inline void attenuate(Spectrum& transmittance, const LocalCoefficients& c, float majorant, HashRng& rng) {
  constexpr float little = 0.1f, survival = 0.25f;
  transmittance *= imaginary(c, majorant) / majorant;
  if (max_component(transmittance) >= little) return;
  if (rng.next() >= survival) transmittance = Spectrum();
  transmittance /= survival;
}

/// Calls `collide(t, local, majorant)` at tentative collisions along the segment (in the medium's space) until it
/// returns false.
template <class Source, class Collide>
void for_each_collision(const Source& source, const Segment& segment, const Wavelengths& w, HashRng& rng,
                        Collide&& collide) {
  const float bound = source.extinction_bound(w);
  source.majorants.for_each_piece(segment, [&](float t0, float t1, float density) {
    const float majorant = bound * density;
    if (!(majorant > 0)) return true;
    for (float t = t0;;) {
      t -= std::log1p(-rng.next()) / majorant;
      if (t >= t1) return true;
      if (!collide(t, source.at(segment.origin + t * segment.direction, w), majorant)) return false;
    }
  });
}

}  // namespace tracking_detail

/// Null-collision tracking of a flight. Scatters with probability proportional to the scattering coefficient against
/// the null-collision coefficient, both averaged over channels weighted by the walk's throughput; continues otherwise.
/// Absorption is a weight (Kutz et al. 2017, "Spectral and Decomposition Tracking", §4, with the history-aware averages
/// of §4.2). Distances are in units of the segment's direction.
template <class Source>
Flight track_flight(const Source& source, const Segment& segment, const Spectrum& beta, const Wavelengths& w,
                    HashRng& rng) {
  Flight flight;
  flight.pdf.reset();
  tracking_detail::for_each_collision(
      source, segment, w, rng, [&](float t, const LocalCoefficients& c, float majorant) {
        const Spectrum null = tracking_detail::imaginary(c, majorant);
        const Spectrum throughput = beta * flight.weight;
        const float scatters = sum_of(throughput * c.scattered), goes_on = sum_of(throughput * null);
        if (!(scatters + goes_on > 0)) {
          flight.weight = Spectrum();
          return false;
        }
        const float probability = scatters / (scatters + goes_on);
        if (rng.next() < probability) {
          flight.weight *= c.scattered / (majorant * probability);
          flight.distance = t;
          return false;
        }
        flight.weight *= null / (majorant * (1 - probability));
        return true;
      });
  return flight;
}

/// Emission of the segment as seen from its origin, and its transmittance. Takes one sample of the emission in each
/// block that the segment crosses, with the transmittance to it by ratio tracking. Tracking alone would rarely meet a
/// thin flame.
template <class Source>
VolumeEmission track_emission(const Source& source, const Segment& segment, const Wavelengths& w, HashRng& rng) {
  VolumeEmission result;
  const float bound = source.extinction_bound(w);
  const auto point = [&](float t) { return segment.origin + t * segment.direction; };
  source.majorants.for_each_piece(segment, [&](float t0, float t1, float density) {
    const float majorant = bound * density;
    if (!(majorant > 0)) return true;
    const float sampled = lerp(rng.next(), t0, t1);
    float t = t0 - std::log1p(-rng.next()) / majorant;
    const auto collide_until = [&](float end) {
      for (; t < end && !result.transmittance.is_black(); t -= std::log1p(-rng.next()) / majorant)
        tracking_detail::attenuate(result.transmittance, source.at(point(t), w), majorant, rng);
    };
    collide_until(sampled);
    result.emitted += result.transmittance * source.emitted(point(sampled), w) * (t1 - t0);
    collide_until(t1);
    return !result.transmittance.is_black();
  });
  return result;
}

/// Ratio tracking (Novák et al. 2014). Calls `step(t, estimate)` at each collision: `estimate` is the transmittance
/// from there to the next collision, unbiased at every point of the segment.
template <class Source, class Step>
void track_transmittance(const Source& source, const Segment& segment, const Wavelengths& w, HashRng& rng,
                         Step&& step) {
  Spectrum result(1);
  tracking_detail::for_each_collision(source, segment, w, rng,
                                      [&](float t, const LocalCoefficients& c, float majorant) {
                                        tracking_detail::attenuate(result, c, majorant, rng);
                                        step(t, result);
                                        return !result.is_black();
                                      });
}

}  // namespace lanthorn
