// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Estimators of the light that media scatter, by points and beams (Jarosz, Nowrouzezahrai, Sadeghi & Jensen 2011), for
// any kind of photon record. A visitor has
//   bool wants(slot);                     // false: leave the photon out
//   void meet(slot, const VolumeMeeting&);
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "index/ball_bvh.h"
#include "index/beam_bvh.h"
#include "math/hash.h"
#include "medium/medium.h"
#include "path/path_context.h"
#include "path/vertex.h"

namespace lanthorn {

/// Where a photon and an eye path meet in a medium.
struct VolumeMeeting {
  Spectrum factor;  ///< factor of the radiance, without flux, phase function and kernel
  float dist2 = 0;  ///< m², between photon or beam and the eye's point or ray
  float t = 0;      ///< m, on the eye's ray, if the whole ray takes part
  float s = 0;      ///< m, on the photon's beam
  float sin = 1;    ///< of the angle between ray and beam
};

/// Random numbers that belong to an eye path and a ray of it.
inline std::uint64_t key_of_ray(const PathContext& path, int depth, const Point& origin, const Direction& direction) {
  HashRng own = path.sampler.generator(visitor_dimensions(depth));
  const auto bits =
      std::uint64_t{std::bit_cast<std::uint32_t>(own.next())} << 32 | std::bit_cast<std::uint32_t>(own.next());
  return hash_vec(direction, hash_vec(origin, bits));
}

/// An eye path's ray, all the way to the next surface.
struct EyeRay {
  const Medium& medium;
  RaySegment ray;
  std::uint64_t key;
  TransmittanceCurve transmitted;
  /// Normals of the surfaces at both ends, in the ray's hemisphere; 0 if there is none.
  Normal begin_normal, end_normal;

  EyeRay(const PathContext& path, const FlownSegment& flight)
      : medium(path.scene.medium(flight.state.medium)),
        ray{flight.segment.origin, flight.segment.direction, 0, flight.reach},
        key(key_of_ray(path, flight.state.depth, ray.origin, ray.direction)),
        transmitted(curve(path, *this)),
        begin_normal(along(flight.begin_normal)),
        end_normal(along(flight.end_normal)) {}

  /// The part of the line that may be within `aside` (m) of a point between the planes of the end surfaces.
  RaySegment between_planes(float aside) const {
    return {ray.origin, ray.direction, ray.begin - beyond(begin_normal, aside), ray.end + beyond(end_normal, aside)};
  }
  /// The part of the ray around which all points at most `aside` (m) away lie between the planes. May be empty.
  RaySegment clear_of_planes(float aside) const {
    return {ray.origin, ray.direction, ray.begin + extent(begin_normal, aside), ray.end - extent(end_normal, aside)};
  }
  bool is_between_planes(const Point& p) const {
    const Vec3 from_begin = p - ray.origin;
    return dot(from_begin, begin_normal) >= 0 &&
           (end_normal == Normal(0) || dot(from_begin - ray.end * ray.direction, end_normal) <= 0);
  }
  /// Maps t of a point of `between_planes` to the ray: points beyond an end are mirrored at it.
  float on_ray(float t) const { return t > ray.end ? 2 * ray.end - t : std::fabs(t); }

 private:
  static TransmittanceCurve curve(const PathContext& path, const EyeRay& eye) {
    HashRng rng(eye.key);
    return {eye.medium, {eye.ray.origin, eye.ray.direction, eye.ray.end}, path.w, rng};
  }
  Normal along(const Normal& n) const { return dot(n, ray.direction) < 0 ? -n : n; }
  /// How far (m) along the ray, before and beyond an end, the plane through that end reaches within `aside` (m) of the
  /// ray.
  float extent(const Normal& n, float aside) const {
    if (n == Normal(0)) return 0;
    const float cosine = dot(n, ray.direction);
    return cosine > 0 ? aside * safe_sqrt(1 - sqr(cosine)) / cosine : infinity;
  }
  /// The same, limited so that mirroring at the end never leaves the ray.
  float beyond(const Normal& n, float aside) const {
    constexpr float most = 16;
    return std::min({extent(n, aside), most * aside, ray.end});
  }
};

/// Transmittance from the start of a beam to its point s.
inline Spectrum along_beam(const PathContext& path, const Medium& medium, const Beam& beam, float s, std::uint64_t key,
                           std::uint32_t slot) {
  HashRng rng(hash_words({key, slot}));
  return transmittance(medium, {beam.origin, beam.direction, s}, path.w, rng);
}

/// Photons in a disc across the ray, each at the place where the ray passes it (Jarosz et al. 2008, eq. 14), at most
/// `aside` (m) from it. The cylinder ends at the planes of the surfaces at the ray's ends. If it were cut off
/// perpendicular to the ray, it would partly lie behind a surface that the ray meets at an angle. That side has
/// no photons, or the photons of another room. A uniform density between the planes is thus estimated without bias.
template <class Visitor>
void meet_points_along(const EyeRay& eye, const BallBvh& photons, float aside, Visitor&& visitor) {
  const RaySegment clear = eye.clear_of_planes(aside);
  photons.for_each_along(eye.between_planes(aside), [&](std::uint32_t slot, float on_line, float dist2) {
    if (!visitor.wants(slot)) return;
    const bool is_clear = on_line >= clear.begin && on_line <= clear.end;
    if (!is_clear && !eye.is_between_planes(photons.position(slot))) return;
    const float t = eye.on_ray(on_line);
    visitor.meet(slot, {.factor = eye.transmitted.to(t), .dist2 = dist2, .t = t});
  });
}

/// Beams that pass the ray (Jarosz et al. 2011, eq. 12). `left(slot, s)`: share of a beam's flux that is left at its
/// point s.
template <class Left, class Visitor>
void meet_beams_along(const PathContext& path, const EyeRay& eye, const BeamBvh& beams, Left&& left,
                      Visitor&& visitor) {
  beams.for_each_crossing(eye.ray, [&](std::uint32_t slot, const BeamCrossing& c) {
    if (!visitor.wants(slot)) return;
    const Spectrum scattered = scattering_at(eye.medium, eye.ray.origin + c.t * eye.ray.direction, path.w);
    if (scattered.is_black()) return;
    visitor.meet(slot, {.factor = left(slot, c.s) * scattered * eye.transmitted.to(c.t) / c.sin,
                        .dist2 = c.dist2,
                        .t = c.t,
                        .s = c.s,
                        .sin = c.sin});
  });
}

/// Photons in a ball around a point where the eye path scatters (Jensen & Christensen 1998). `scattering`: per metre.
template <class Visitor>
void meet_points_at(const BallBvh& photons, const Point& p, const Spectrum& scattering, Visitor&& visitor) {
  // Photons and the eye's flight each contain the scattering coefficient; it counts only once.
  const Spectrum once = map(scattering, [](float sigma) { return sigma > 0 ? 1 / sigma : 0.0f; });
  photons.for_each_containing(p, [&](std::uint32_t slot, float dist2) {
    if (visitor.wants(slot)) visitor.meet(slot, {.factor = once, .dist2 = dist2});
  });
}

/// Beams around a point where the eye path scatters.
template <class Left, class Visitor>
void meet_beams_at(const BeamBvh& beams, const Point& p, Left&& left, Visitor&& visitor) {
  beams.for_each_around(p, [&](std::uint32_t slot, float s, float dist2) {
    if (visitor.wants(slot)) visitor.meet(slot, {.factor = left(slot, s), .dist2 = dist2, .s = s});
  });
}

}  // namespace lanthorn
