// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The algebra of multiple importance sampling weights (Veach 1997, chapter 9): plain numbers in, a weight out.
//
// - Two techniques, a light sample and the walk's hit: `power_heuristic` (math/power_heuristic.h).
// - Sets of samples added up without regard to which made what: `over_balanced`.
// - A sample drawn from one of two densities: `mixture_pdf`.
// - The techniques of bidirectional methods: recursive, after Georgiev 2012, "Implementing Vertex Connection and
//   Merging", technical report ("TR" below), with the balance heuristic.
//
// There is a second algebra for the last of these, path_weights.h: recursions carry sums from vertex to vertex, and no
// such sum can express a heuristic that looks at all vertices of a path at once (`Correlation`). Recursions cost a few
// operations for each technique and no memory, so they are the rule. `Techniques` chooses between the two, and
// path/connections, which has the densities that both are told, is the only place where the choice is made. A test
// holds both against products of densities (tests/unit/path/mis_test.cpp).
//
// In media the same recursions hold with the densities of flights (`FlightDensity`), and with one more sum, for merging
// there by points and beams (`VolumeMerging`; Křivánek et al. 2014, "Unifying Points, Beams, and Paths in Volumetric
// Light Transport Simulation"). A vertex takes a constant number of operations. Merging in media counts by the
// *coherence* of the eye path up to there (path/coherence.h): where eye paths have spread widely, the n photons that
// one of them meets say less than n samples of the path, which the balance heuristic does not know.
//
// Densities need not be those of the walks to the last factor (roulette is left out, and flights are those of a mean
// wavelength): weights only have to sum to 1 over the techniques that make a path, which they do as long as all
// techniques take the same functions for them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lanthorn {

/// `value` over the density of several sets of samples together, Σ n p: the weight of the balance heuristic times
/// value / (n p), which is the same whatever set a sample is from (Veach 1997, eq. 9.8). 0 where no set has samples.
inline float over_balanced(float value, float density_of_all) {
  return density_of_all > 0 ? value / density_of_all : 0.0f;
}

/// Density of samples that are drawn with `other` with probability `share`, else with `pdf`: one sample, balance
/// heuristic (Veach 1997, section 9.2.4).
inline float mixture_pdf(float pdf, float other, float share) { return (1 - share) * pdf + share * other; }

/// What weights know of merges sharing light paths, which lessens what is gained by the number of these.
enum class Correlation : std::uint8_t {
  ignored,    ///< the balance heuristic
  chances,    ///< how probable both walks are to come as near (Grittmann, Georgiev & Slusallek 2021)
  footprints  ///< over what areas both walks would have spread (Jendersie 2019)
};

/// Density of a flight to a vertex: a function of the segment and of the vertex, the same for walks in both directions.
struct FlightDensity {
  float pass = 1;       ///< probability of coming as far as the vertex
  float collision = 1;  ///< in a medium: density per metre of scattering at the vertex, once there; on surfaces 1

  float arrival() const { return pass * collision; }
  /// `optical_depth` of the segment. What is small is bounded, so that products of reciprocals stay finite.
  static float passing(float optical_depth) {
    return optical_depth > 0 ? std::exp(-std::min(optical_depth, 18.0f)) : 1.0f;
  }
  static float colliding(float per_metre) { return std::max(per_metre, 1e-6f); }
};

/// Merging in media: for each estimator its number of light paths times the size of its kernel. 0 for those that are
/// not used.
struct VolumeMerging {
  float point = 0;        ///< photons around points of eye paths: N 4/3 π r³ (m³)
  float beam = 0;         ///< photons around eye paths' rays: N π r² (m²)
  float photon_beam = 0;  ///< photons' flights around points of eye paths: N π r² (m²)
  float beams = 0;        ///< photons' flights that pass eye paths' rays: N 2 r (m)

  bool is_used() const { return point + beam + photon_beam + beams > 0; }

  // How much denser each estimator draws a path than if both walks scattered at the vertex where they meet. A walk
  // whose whole ray takes part need not have scattered there. Densities per metre and probabilities of passing are
  // those of the flights to the vertex, `sin` is of the angle between them.

  float by_beam(float collision, float pass_eye) const { return beam / (collision * pass_eye); }
  float by_photon_beam(float collision, float pass_light) const { return photon_beam / (collision * pass_light); }
  float by_beams(float collision, float pass_light, float pass_eye, float sin) const {
    return beams * sin / (collision * pass_light * collision * pass_eye);
  }
  float all(float collision, float pass_light, float pass_eye, float sin) const {
    return point + by_beam(collision, pass_eye) + by_photon_beam(collision, pass_light) +
           by_beams(collision, pass_light, pass_eye, sin);
  }
  /// The same for walks of the other kind.
  VolumeMerging reversed() const { return {point, photon_beam, beam, beams}; }

  /// `all` as a + b / (probability of passing the next flight).
  struct Sum {
    float a = 0, b = 0;
  };
  /// At a vertex of an eye walk that arrived there with `flight`; of a light walk if this is `reversed`.
  Sum before_next(const FlightDensity& flight, float sin) const {
    return {point + by_beam(flight.collision, flight.pass),
            photon_beam / flight.collision + by_beams(flight.collision, flight.pass, 1, sin)};
  }
};

/// The techniques that bidirectional methods combine, as weights see them.
struct Techniques {
  float light_paths = 1;  ///< of a pass; every one of them is connected to the lens
  /// η_VCM = light paths π r² (TR eq. 20): how much denser paths are drawn by merging than by connecting; 0 without
  /// merging. It may differ between pixels, as their radii do: the same pixel, the same η for all techniques.
  float merging = 0;
  /// Vertices are connected, to lights and the lens too. Photons straight from a light are merged without that only:
  /// next-event estimation finds their light as well, and without the dark edges of merging.
  bool connects = true;
  VolumeMerging volume{};  ///< photons straight from a light are merged, too
  Correlation correlation = Correlation::ignored;

  /// Weights are those of path_weights.h, and subpaths keep trails for them.
  bool correlated() const { return correlation != Correlation::ignored; }
};

/// What weights need to know of a subpath up to a vertex: sums of ratios of densities over the techniques that would
/// make it otherwise. TR's dVC is vc + media + η vm, its dVM that over η: kept apart, one subpath serves merges of
/// every radius.
struct VertexDensities {
  float vcm = 0;    ///< the connection of this vertex and the one before, or next-event estimation
  float vc = 0;     ///< all other ways to connect
  float media = 0;  ///< all ways to merge in media; of a light path, if the eye path is coherent up to this vertex
  float vm = 0;     ///< all ways to merge on surfaces, over η

  /// All ways to merge. `coherence`: of the eye path up to and including this vertex, for a light path; else 1.
  float merging(float coherence, const Techniques& t) const { return coherence * media + t.merging * vm; }
  /// Of all techniques at vertices before, for a connection to this vertex. `reverse`: density per solid angle from the
  /// connection's other end to the vertex before; `coherence`: as above.
  float before(float reverse, float coherence, const Techniques& t) const {
    return vcm + (vc + merging(coherence, t)) * reverse;
  }
};

/// The same during a walk.
struct SubpathDensities : VertexDensities {
  static constexpr float least_cos = 1e-8f;

  float vm_apart = 0;  ///< all ways to merge on surfaces at vertices before the last one, over η

  /// The step over a vertex where the subpath has scattered into a direction: towards the next vertex, before its
  /// geometry. `cos` and the densities per solid angle are at the vertex scattered at; `reverse`: from the next vertex
  /// to the one before; `merges`: photons are merged there, on a surface (TR eqs. 34-36, numerators of the next
  /// vertex). In media, `volume`: the part of merging there that is known before the next flight; `coherence`: of a
  /// light path's vertex, by which merging at those before counts.
  void scatter(float cos, float pdf, float reverse, bool merges, bool connects = true, float volume = 0,
               float coherence = 1) {
    if (!(pdf > 0)) {  // along the surface, by rounding
      *this = {};
      return;
    }
    vc = cos / pdf * (vc * reverse + (connects ? vcm : 0.0f));
    media = cos / pdf * (coherence * media * reverse + volume);
    vm_apart = cos / pdf * vm * reverse;
    vm = vm_apart + (merges ? cos / pdf : 0.0f);
    vcm = 1 / pdf;
  }
  /// The same through a delta lobe, whose densities cancel: no technique can begin there.
  void scatter_delta(float cos) {
    vc *= cos;
    media *= cos;
    vm *= cos;
    vm_apart = vm;
    vcm = 0;
  }
  /// Turns densities per solid angle into those per area at the vertex that is `distance2`^(1/2) away and seen under
  /// `cos`. `from_infinity`: the way to the first vertex of light from infinitely far, whose density is per area
  /// already.
  void arrive(float distance2, float cos, bool from_infinity = false) {
    cos = cos > least_cos ? cos : least_cos;
    vcm *= (from_infinity ? 1.0f : distance2) / cos;
    vc /= cos;
    media /= cos;
    vm /= cos;
    vm_apart /= cos;
  }
  /// The flight to the next vertex, before `arrive`; `collision` at the vertex before, and `over_pass`: the part of
  /// merging there that is over the probability of passing this flight.
  void fly(const FlightDensity& flight, float collision, float over_pass) {
    const float ratio = collision / flight.collision;
    vcm /= flight.arrival();
    vc *= ratio;
    media = (media + over_pass / flight.pass) * ratio;
    vm *= ratio;
    vm_apart *= ratio;
  }
};

// Weights of techniques. `at_...`: densities of the subpath at the vertex named. Densities are per area where it says
// so (with the flight's density, in media per volume), else per solid angle. `merging...`: of that vertex, in a medium
// times the coherence of the eye path before it. `coherence`: of the eye path up to and including the last vertex of
// the light path.

/// An eye walk hits a light (TR eq. 43). `direct`: with which next-event estimation would have chosen the point, per
/// area (infinite lights: per solid angle); `emission`: with which a light path starts there in that direction, the
/// product of per area and per solid angle.
inline float weight_hit(const SubpathDensities& at_light, float direct, float emission, const Techniques& t) {
  return 1 / (1 + direct * at_light.vcm + emission * (at_light.vc + at_light.media + t.merging * at_light.vm_apart));
}

/// Next-event estimation at an eye vertex (TR eqs. 44, 45). `pdf_direct`: its own; `pdf_walk`: with which the walk
/// would find the light, 0 if it cannot; `emission_ratio`: emission density times |cos| at the eye vertex over that of
/// next-event estimation times |cos| at the light; `reverse`: from the light to the vertex before; `merging`: of the
/// eye vertex with photons straight from the light.
inline float weight_next_event(const VertexDensities& at_eye, float pdf_direct, float pdf_walk, float emission_ratio,
                               float reverse, float merging, const Techniques& t) {
  return 1 / (1 + pdf_walk / pdf_direct + emission_ratio * (merging + at_eye.before(reverse, 1, t)));
}

/// A light vertex connected to the lens (TR eq. 46). `pixel_density`: per area, with which one pixel's eye paths arrive
/// there; `reverse`: from the lens to the vertex before.
inline float weight_lens(const VertexDensities& at_light, float pixel_density, float reverse, float merging,
                         float coherence, const Techniques& t) {
  return 1 / (1 + pixel_density / t.light_paths * (merging + at_light.before(reverse, coherence, t)));
}

/// Two vertices connected (TR eqs. 40, 41). `to_light`: density per area at the light vertex with which the eye walk
/// goes there, `to_eye` the other way round; `reverse_...`: each from the other vertex to the one before.
inline float weight_connection(const VertexDensities& at_eye, const VertexDensities& at_light, float to_light,
                               float to_eye, float reverse_eye, float reverse_light, float merging_eye,
                               float merging_light, float coherence, const Techniques& t) {
  return 1 / (1 + to_light * (merging_light + at_light.before(reverse_light, coherence, t)) +
              to_eye * (merging_eye + at_eye.before(reverse_eye, 1, t)));
}

/// A photon merged into an eye vertex (TR eqs. 38, 39). `own`: the estimator's merging, `all`: that of all estimators
/// there, which on surfaces is one; `forward`: density with which the eye walk would go where the photon came from;
/// `reverse`: from there to the vertex before.
inline float weight_merge(const VertexDensities& at_eye, const VertexDensities& at_light, float own, float all,
                          float coherence, float forward, float reverse, const Techniques& t) {
  const float here = t.connects ? at_light.vcm + at_eye.vcm : 0.0f;
  const float elsewhere =
      (at_light.vc + at_light.merging(coherence, t)) * forward + (at_eye.vc + at_eye.merging(1, t)) * reverse;
  return own / (all + here + elsewhere);
}

}  // namespace lanthorn
