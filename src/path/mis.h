// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The algebra of multiple importance sampling weights (Veach 1997, chapter 9): plain numbers in, a weight out. All of
// it but the power heuristic is here; other files supply the densities.
//
// - Two techniques, a light sample and the walk's hit: `power_heuristic` (math/sampling.h).
// - Several sets of samples that are summed, whichever set a sample is from: `over_balanced`.
// - A sample drawn from one of two densities: `mixture_pdf`.
// - The techniques of bidirectional methods: `sum_of_hit` and the functions after it, from sums that `SubpathDensities`
//   carries from vertex to vertex. A test compares them with products of densities (tests/unit/path/mis_test.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace lanthorn {

/// `value` over the density of several sets of samples together, Σ n p: the weight of the balance heuristic times
/// value / (n p), which is the same whatever set a sample is from (Veach 1997, eq. 9.8). 0 where no set has samples.
inline float over_balanced(float value, float density_of_all) {
  return density_of_all > 0 ? value / density_of_all : 0.0f;
}

/// Density of samples that are drawn with `other` with probability `share`, else with `pdf`: one sample, balance
/// heuristic (Veach 1997, section 9.2.4).
inline float mixture_pdf(float pdf, float other, float share) { return (1 - share) * pdf + share * other; }

// # The weights of bidirectional methods
// (Georgiev 2012, "Implementing Vertex Connection and Merging", technical report: "TR")
//
// A path x_0 x_1 ... x_k leads from a point x_0 on a light to x_k, the vertex that the lens sees. Let p_i be the
// density per area with which a light walk goes from x_(i-1) to x_i, and q_i the density with which an eye walk goes
// from x_(i+1) to x_i. There are two ways to make the path out of two walks. A *connection* joins x_(s-1), where the
// light walk ends, to x_s, where the eye walk ends. A *merge* takes a photon near x_m for one at x_m, where both walks
// end; it accepts photons in a disc of area π r², and all N light paths of the pass take part. The densities, each
// times its number of samples:
//
//   C_s = p_0 ... p_(s-1) q_s ... q_k,     M_m = η p_0 ... p_m q_m ... q_k,     η = N π r²          (TR eq. 20)
//
// The balance heuristic weighs a technique by its density over the sum of all. For a connection, divide by C_s:
//
//   w_s = 1 / (w_light + 1 + w_eye)                                                                       (TR eq. 37)
//
// w_light sums the ratios of the techniques whose eye walk makes x_(s-1), too, and w_eye of those whose light walk
// makes x_s. The terms of w_light have factors in common:
//
//   w_light = q_(s-1) (η + 1/p_(s-1) + q_(s-2)/p_(s-1) (η + 1/p_(s-2) + q_(s-3)/p_(s-2) (...)))
//
// The light walk cannot know q_(s-2) when it arrives at x_(s-1): that density depends on where the eye walk comes from.
// It is g_(s-2) r_(s-1), with g_i = cos_i / distance² for the geometry, which is known, and with the density r_i per
// solid angle with which the other walk goes on from x_i to the vertex before. So each vertex keeps what is known:
//
//   d_VCM(i) = 1/p_i,     d_VC(i) = g_(i-1)/p_i (η + d_VCM(i-1) + r_(i-1) d_VC(i-1))              (TR eqs. 34, 35)
//   w_light = q_(s-1) (η + d_VCM(s-1) + r_(s-1) d_VC(s-1))                                              (TR eq. 40)
//
// w_eye is the same with both walks exchanged (TR eq. 41). For a merge, divide by M_m instead; then w_light is
// (d_VCM(m) + r_m d_VC(m)) / η (TR eq. 38).
//
// The walks begin differently (TR eqs. 31-33). Next-event estimation chooses x_0 with a density of its own, p_direct:
// d_VCM(1) = p_direct / (p_0 p_1), d_VC(1) = g_0 / (p_0 p_1). All N light paths are connected to the lens, and nothing
// begins beyond it: for the eye walk, d_VCM = N / q_k and d_VC = 0.
// At a delta lobe no technique begins. Both walks have the same delta function in their densities, which cancels: η
// and d_VCM drop out (TR eqs. 53-55).
//
// The code keeps d_VC as ends + c vc + media + η vm, so that one light path serves merges of every radius and any
// number c of connections. In g_(i-1)/p_i the distance cancels, and cos_(i-1) / (pdf cos_i) remains: `scatter` has the
// cosine and the density of the vertex that the walk leaves, `arrive` the cosine of the next one.
//
// In media the same recursions hold with the densities of flights (`FlightDensity`), and with one more sum, for merging
// there by points and beams (`VolumeMerging`; Křivánek et al. 2014, "Unifying Points, Beams, and Paths in Volumetric
// Light Transport Simulation"). Merging in media is weighted by the *coherence* of the eye path up to there
// (path/coherence.h): where eye paths have spread widely, the n photons that one of them meets carry less information
// than n independent samples, which the balance heuristic does not know.
//
// Densities need not be exactly those of the walks (Russian roulette is left out, and flights use the mean extinction
// of the wavelengths): weights only have to sum to 1 over the techniques that make a path, which they do as long as all
// techniques use the same functions for them.

/// Density of a flight to a vertex: a function of the segment and of the vertex, the same for walks in both directions.
struct FlightDensity {
  float pass = 1;       ///< probability of coming as far as the vertex
  float collision = 1;  ///< in a medium: density per metre of scattering at the vertex, once there; on surfaces 1

  float arrival() const { return pass * collision; }
  /// `optical_depth` of the segment. Small results are bounded from below, so that products of reciprocals stay finite.
  static float passing(float optical_depth) {
    return optical_depth > 0 ? std::exp(-std::min(optical_depth, 18.0f)) : 1.0f;
  }
  static float colliding(float per_metre) { return std::max(per_metre, 1e-6f); }
};

/// Merging in media: for each estimator, its number of light paths times the size of its kernel; 0 if it is not used.
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
  /// merging. It may differ between pixels, as radii do, but all techniques of a pixel use the same η.
  float merging = 0;
  /// Vertices are connected to lights and to the lens. Photons straight from a light are merged only without
  /// connections: next-event estimation finds their light as well, and without the dark edges of merging.
  bool connects = true;
  float connections = 1;   ///< light paths to whose vertices each eye vertex is connected; may differ between pixels
  VolumeMerging volume{};  ///< photons straight from a light are merged, too
  float volume_part = 1;   ///< 0 for pixels without merging in media
  float lens_part = 1;     ///< 0 for pixels without connections of light paths to the lens
  /// Eye paths use all techniques at every vertex. If false, eye paths are short: they connect and merge only at their
  /// first vertex with a non-delta lobe, and merge in media on the way there; from there they follow only delta lobes,
  /// to lights. Merging then finds all other light, except on fibres.
  bool goes_on = true;
};

/// The data of a subpath up to a vertex that MIS weights need: d_VCM = `end` + c `vcm` and d_VC = `ends` + c `vc` +
/// `media` + η `vm`, where each vertex is connected to c light paths. The `end` of a light path is next-event
/// estimation and the eye path's hit; the `end` of an eye path is the lens.
struct VertexDensities {
  float end = 0;    ///< at the first vertex: next-event estimation, or the lens
  float ends = 0;   ///< the same at a later vertex, and the hit of the light
  float vcm = 0;    ///< the connection of this vertex and the one before
  float vc = 0;     ///< all connections before
  float media = 0;  ///< all ways to merge in media; of a light path, if the eye path is coherent up to this vertex
  float vm = 0;     ///< all ways to merge on surfaces, over η
};

/// How a subpath scatters at a vertex into the direction of the next one.
struct Scattering {
  float cos = 1;            ///< of the direction; 1 in media
  float pdf = 0;            ///< of the direction, per solid angle
  float reverse = 0;        ///< with which the other walk goes on to the vertex before, per solid angle
  bool merges = false;      ///< photons are merged at the vertex, on a surface
  float merging_media = 0;  ///< the part of merging at the vertex in a medium that is known before the next flight
  float coherence = 1;      ///< of a light path's vertex: the weight of merging in media before it
};

/// The same during a walk.
struct SubpathDensities : VertexDensities {
  static constexpr float least_cos = 1e-8f;

  float vm_apart = 0;  ///< all ways to merge on surfaces at vertices before the last one, over η

  /// Start of an eye path (TR eqs. 31-33), before the geometry of its first vertex. `pdf`: of its first ray, per solid
  /// angle.
  static SubpathDensities from_lens(float light_paths, float pdf) {
    SubpathDensities result;
    result.end = light_paths / pdf;
    return result;
  }
  /// The same of a light path. `traced`: density of its start, per area times per solid angle; `direct`: density of
  /// next-event estimation there from the first vertex, per area; `cos`: of the first ray on the light, 0 if eye walks
  /// do not hit it.
  static SubpathDensities from_light(float traced, float direct, float cos) {
    SubpathDensities result;
    result.end = direct / traced;
    result.ends = cos / traced;
    return result;
  }
  /// Makes the start of a light path `ratio` times as dense, once the path has reached its first vertex.
  void start_denser(float ratio) {
    end /= ratio;
    ends /= ratio;
  }

  /// The step over a vertex: towards the next one, before its geometry (TR eqs. 34-36, numerators).
  void scatter(const Scattering& s, bool connects = true) {
    if (!(s.pdf > 0)) {  // along the surface, by rounding
      *this = {};
      return;
    }
    ends = s.cos / s.pdf * (ends * s.reverse + (connects ? end : 0.0f));
    vc = s.cos / s.pdf * (vc * s.reverse + (connects ? vcm : 0.0f));
    media = s.cos / s.pdf * (s.coherence * media * s.reverse + s.merging_media);
    vm_apart = s.cos / s.pdf * vm * s.reverse;
    vm = vm_apart + (s.merges ? s.cos / s.pdf : 0.0f);
    end = 0;
    vcm = 1 / s.pdf;
  }
  /// The same through a delta lobe (TR eqs. 53-55).
  void scatter_delta(float cos) {
    ends *= cos;
    vc *= cos;
    media *= cos;
    vm *= cos;
    vm_apart = vm;
    end = vcm = 0;
  }
  /// The flight to the next vertex, before `arrive`. `collision`: `FlightDensity::collision` at the vertex before.
  /// `over_pass`: the part of merging there that is divided by the probability of passing this flight.
  void fly(const FlightDensity& flight, float collision, float over_pass) {
    const float ratio = collision / flight.collision;
    end /= flight.arrival();
    vcm /= flight.arrival();
    ends *= ratio;
    vc *= ratio;
    media = (media + over_pass / flight.pass) * ratio;
    vm *= ratio;
    vm_apart *= ratio;
  }
  /// Turns densities per solid angle into those per area at the vertex that is `distance2`^(1/2) away and seen under
  /// `cos` (TR eqs. 31-36, denominators). `from_infinity`: the way to the first vertex of light from infinitely far,
  /// whose density is per area already.
  void arrive(float distance2, float cos, bool from_infinity = false) {
    cos = cos > least_cos ? cos : least_cos;
    const float spread = (from_infinity ? 1.0f : distance2) / cos;
    end *= spread;
    vcm *= spread;
    ends /= cos;
    vc /= cos;
    media /= cos;
    vm /= cos;
    vm_apart /= cos;
  }
};

/// Densities of techniques, by kind, each times its number of samples.
struct TechniqueDensities {
  float walk = 0;         ///< next-event estimation, and the eye path's hit
  float lens = 0;         ///< light vertices connected to the lens
  float connections = 0;  ///< of vertices of both paths
  float merging = 0;      ///< on surfaces
  float media = 0;        ///< merging in media

  float all() const { return walk + lens + connections + merging + media; }
};
/// One of them.
using Technique = float TechniqueDensities::*;
inline constexpr std::array all_techniques{&TechniqueDensities::walk, &TechniqueDensities::lens,
                                           &TechniqueDensities::connections, &TechniqueDensities::merging,
                                           &TechniqueDensities::media};

/// The densities of all techniques that can make a path, relative to a common unit.
struct TechniqueSum {
  float own = 1;                ///< of the technique that made it
  TechniqueDensities within{};  ///< of short eye paths (`Techniques::goes_on`)
  TechniqueDensities beyond{};  ///< of longer ones; some of those that a longer eye path made are in `within`
  bool is_beyond = false;       ///< the technique that made it is one of these

  /// The part that contains the technique that made the path. `longer`: the technique used a longer eye path.
  TechniqueDensities& made_by(bool longer) {
    is_beyond = longer;
    return longer ? beyond : within;
  }
  float all() const { return within.all() + beyond.all(); }
  /// Weight of the balance heuristic.
  float weight(const Techniques& t) const { return own / (t.goes_on ? all() : within.all()); }
};

/// The last vertex of a subpath that a technique joins to the other one.
struct SubpathEnd {
  const VertexDensities& densities;
  float reverse = 0;        ///< with which the other walk goes on from here to the vertex before, per solid angle
  bool scattered = false;   ///< the subpath has scattered before by a lobe that is not delta
  float coherence = 1;      ///< at a light path: of the eye path up to and including this vertex
  Technique end = nullptr;  ///< end of the subpath: `lens` of an eye path, `walk` of a light path

  /// Adds `factor` times r d_VC: all techniques that begin at earlier vertices, except the connection to this one.
  void add_earlier(float factor, const Techniques& t, TechniqueDensities& sum) const {
    const float back = factor * reverse;
    sum.*end += back * part_of_end(t) * densities.ends;
    sum.connections += back * t.connections * densities.vc;
    sum.media += back * t.volume_part * coherence * densities.media;
    sum.merging += back * t.merging * densities.vm;
  }
  /// Adds `factor` times d_VCM: the connection to this vertex.
  void add_here(float factor, const Techniques& t, TechniqueDensities& sum) const {
    sum.*end += factor * part_of_end(t) * densities.end;
    sum.connections += factor * t.connections * densities.vcm;
  }
  float part_of_end(const Techniques& t) const { return end == &TechniqueDensities::lens ? t.lens_part : 1.0f; }
};
inline SubpathEnd end_of_eye_path(const VertexDensities& densities, float reverse, bool scattered) {
  return {densities, reverse, scattered, 1, &TechniqueDensities::lens};
}
inline SubpathEnd end_of_light_path(const VertexDensities& densities, float reverse, bool scattered, float coherence) {
  return {densities, reverse, scattered, coherence, &TechniqueDensities::walk};
}

/// One end of a connection.
struct ConnectedEnd : SubpathEnd {
  float arrival = 0;  ///< with which the other walk comes here, per area; with its flight, so in media per volume
  float merging = 0;  ///< η of this vertex, on a surface
  float volume_merging = 0;  ///< the same in a medium, times the coherence of the eye path before it

  /// Whether there are other techniques whose other walk makes this vertex, too.
  bool has_other_techniques(const Techniques& t) const {
    TechniqueDensities sum;
    ConnectedEnd{*this, 1, merging, volume_merging}.add_other_techniques(1, t, sum, sum, sum);
    return sum.all() != 0;
  }
  /// Adds `factor` times w_light, or w_eye: all techniques whose other walk makes this vertex, too (TR eqs. 40, 41):
  /// to `merged` the merges at this vertex, to `connected` its connection to the vertex before, to `earlier` the rest.
  void add_other_techniques(float factor, const Techniques& t, TechniqueDensities& merged,
                            TechniqueDensities& connected, TechniqueDensities& earlier) const {
    const float there = factor * arrival;
    merged.merging += there * merging;
    merged.media += there * t.volume_part * volume_merging;
    add_here(there, t, connected);
    add_earlier(there, t, earlier);
  }
};

/// True if light paths can also make the path of an eye walk that hits a light at this vertex.
inline bool has_light_paths(const SubpathDensities& at_light, const Techniques& t) {
  return t.lens_part * at_light.ends + t.connections * at_light.vc + t.merging * at_light.vm_apart +
             t.volume_part * at_light.media !=
         0;
}
/// An eye walk hits a light (TR eq. 43): its last vertex is the point there. `direct`: density with which next-event
/// estimation would have chosen the point, per area (infinite lights: per solid angle). `emission`: density with which
/// a light path starts there in that direction, per area times per solid angle; ignored without `has_light_paths`.
/// `scatterings`: number of the walk's non-delta scatterings.
inline TechniqueSum sum_of_hit(const SubpathDensities& at_light, float direct, float emission, int scatterings,
                               const Techniques& t) {
  TechniqueSum sum{.within = {.lens = emission * t.lens_part * at_light.ends,
                              .connections = emission * t.connections * at_light.vc,
                              .merging = emission * t.merging * at_light.vm_apart,
                              .media = emission * t.volume_part * at_light.media}};
  sum.made_by(scatterings > 1).walk = 1 + direct * at_light.vcm;
  return sum;
}

/// Next-event estimation (TR eqs. 44, 45) that has chosen the point on the light with density `pdf_direct`. The walk
/// would find the light with density `pdf_walk`, 0 if it cannot. `at_eye.arrival`: density of a light path that starts
/// at the point, divided by that of next-event estimation; `at_eye.merging`: that of photons straight from a light.
inline TechniqueSum sum_of_next_event(const ConnectedEnd& at_eye, float pdf_direct, float pdf_walk,
                                      const Techniques& t) {
  TechniqueSum sum;
  TechniqueDensities& own = sum.made_by(at_eye.scattered);
  own.walk = 1 + pdf_walk / pdf_direct;
  at_eye.add_other_techniques(1, t, own, sum.within, sum.within);
  return sum;
}

/// A light vertex connected to the lens (TR eq. 46). `at_light.arrival`: density of one pixel's eye paths.
inline TechniqueSum sum_of_lens(const ConnectedEnd& at_light, const Techniques& t) {
  TechniqueSum sum{.own = t.lens_part, .within = {.lens = t.lens_part}};
  at_light.add_other_techniques(1 / t.light_paths, t, sum.within, sum.within,
                                at_light.scattered ? sum.beyond : sum.within);
  return sum;
}

/// Two vertices connected (TR eq. 37): one of `connections` connections, which share the technique's weight equally.
inline TechniqueSum sum_of_connection(const ConnectedEnd& at_eye, const ConnectedEnd& at_light, const Techniques& t) {
  TechniqueSum sum;
  TechniqueDensities& own = sum.made_by(at_eye.scattered);
  own.connections = t.connections;
  at_light.add_other_techniques(1, t, sum.beyond, sum.beyond, sum.beyond);
  at_eye.add_other_techniques(1, t, own, sum.within, sum.within);
  return sum;
}

/// Adds the techniques that begin at or before the ends of two subpaths that meet.
inline void add_ends(const SubpathEnd& at_eye, const SubpathEnd& at_light, const Techniques& t, TechniqueSum& sum) {
  TechniqueDensities& here = at_eye.scattered ? sum.beyond : sum.within;
  if (t.connects) {
    at_eye.add_here(1, t, sum.within);
    at_light.add_here(1, t, here);
  }
  at_eye.add_earlier(1, t, sum.within);
  at_light.add_earlier(1, t, at_light.scattered ? sum.beyond : here);
}

/// A photon merged into an eye vertex on a surface (TR eqs. 38, 39).
inline TechniqueSum sum_of_merge(const SubpathEnd& at_eye, const SubpathEnd& at_light, const Techniques& t) {
  TechniqueSum sum{.own = t.merging};
  sum.made_by(at_eye.scattered).merging = t.merging;
  add_ends(at_eye, at_light, t, sum);
  return sum;
}
/// The same in a medium. `own`: η of the estimator, `all`: the sum over all estimators there; both times the coherence
/// of the eye path before the vertex.
inline TechniqueSum sum_of_volume_merge(const SubpathEnd& at_eye, const SubpathEnd& at_light, float own, float all,
                                        const Techniques& t) {
  TechniqueSum sum{.own = t.volume_part * own};
  sum.made_by(at_eye.scattered).media = t.volume_part * all;
  add_ends(at_eye, at_light, t, sum);
  return sum;
}

}  // namespace lanthorn
