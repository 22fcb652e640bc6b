// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Weights of multiple importance sampling from the densities at all vertices of a path: for heuristics that the
// recursive sums of mis.h cannot express, because they look at the whole path. That is why there are two; without such
// a heuristic both give the same weights, these at a cost in proportion to the path's length.
#pragma once

#include <optional>
#include <span>

#include "path/mis.h"

namespace lanthorn {

/// A vertex of a whole path as weights see it. Delta scatterings have density 1 per solid angle both ways: theirs
/// cancel.
struct PathVertex {
  float by_eye = 0;     ///< density per area with which the eye walk arrives
  float by_light = 0;   ///< and the light walk
  bool delta = false;   ///< no technique begins or ends here
  bool merges = false;  ///< photons are merged here
};

/// The technique that sampled a path x_1 ... x_k, z (from the eye's side; z is the light's point).
struct PathTechnique {
  bool merged = false;
  /// Vertices that the eye walk sampled: 0 if the lens was connected to x_1, k for next-event estimation, k + 1 if the
  /// walk hit the light. With `merged`, the number of the vertex where the photon was merged.
  std::size_t eye_vertices = 0;
};

/// Weight of one technique among all that could have sampled the path: the balance heuristic (Veach 1997, eq. 9.8) over
/// n p, and with `t.correlated()` over n p c, where c, from 1/N to 1, is what is left of the gain of merging at x_i
/// with N light paths.
///
/// By chances (Grittmann, Georgiev & Slusallek 2021, "Correlation-Aware Multiple Importance Sampling for Bidirectional
/// Rendering Algorithms"), where the eye walk makes x_1 ... x_i with probability P and the light walk the rest with
/// probability Q:
///   c = P / (P + Q - P Q); c = 1 at x_1.
/// Probabilities are products of densities times the area seen under one degree from the lens, at most 1 each.
///
/// By footprints (Jendersie 2019, "Variance Reduction via Footprint Estimation in the Presence of Path Reuse", Ray
/// Tracing Gems, chapter 31): light paths are averaged over where the light walk's footprint is the larger one. With
/// the areas A and B over which the eye walk and the light walk spread up to x_i and q = A² / B²,
///   c = (1 + q) / (1 + N q).
/// Each scattering that is no delta adds the radius of the area that its density stands for.
///
/// `direct`: density per area with which next-event estimation chooses z. `first_distance`: of the lens and x_1.
/// For infinite lights z's densities are per solid angle.
float path_weight(std::span<const PathVertex> path, float direct, const PathTechnique& technique, const Techniques& t,
                  float first_distance);

/// A vertex that a walk has made.
struct TrailVertex {
  float arrives = 0;   ///< density per area of the walk itself
  float back = 0;      ///< of the other kind of walk, coming from the next vertex; known from the next but one on
  float geometry = 0;  ///< density per area over density per solid angle at the next vertex, of the way back
  float direct = 0;    ///< of a light's point: density per area of next-event estimation from the first vertex
  bool delta = false;  ///< the walk scattered by a delta lobe
  bool merges = false;
};

/// Densities at the last vertex of a subpath that joins another.
struct Junction {
  float arrives = 0;             ///< per area, of the other walk at this vertex
  std::optional<float> reverse;  ///< per solid angle, of the other walk to the vertex before; none: known to the trail
};

/// The weight of two subpaths joined by a connection: `eye` is x_1 ..., `light` begins with z.
float weight_of_joined(std::span<const TrailVertex> eye, const Junction& at_eye, std::span<const TrailVertex> light,
                       const Junction& at_light, const Techniques& t, float first_distance);
/// The eye walk, whose last vertex is x_k, has hit the light at z with density `z.back`; `arrives`: of the light walk
/// from there at x_k.
float weight_of_hit(std::span<const TrailVertex> eye, float arrives, const TrailVertex& z, const Techniques& t,
                    float first_distance);
/// The last vertex of `light` is a photon at the last one of `eye`. `forward`, `reverse`: densities per solid angle
/// from there, of the eye walk to where the photon came from, and of the light walk to where the eye walk came from.
float weight_of_merged(std::span<const TrailVertex> eye, std::span<const TrailVertex> light, float forward,
                       float reverse, const Techniques& t, float first_distance);

}  // namespace lanthorn
