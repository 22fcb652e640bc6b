// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// MIS weights computed from the densities at all vertices of a path, for heuristics that need the whole path. The
// recursive sums of mis.h cannot express them: that is why there are two. Without such a heuristic both give the same
// weights; these cost time in proportion to the path's length.
#pragma once

#include <optional>
#include <span>

#include "path/mis.h"

namespace lanthorn {

/// A vertex of a complete path, with what MIS weights need. Delta scatterings have density 1 per solid angle in both
/// directions, so that they cancel.
struct PathVertex {
  float by_eye = 0;     ///< density per area with which the eye walk arrives
  float by_light = 0;   ///< density per area with which the light walk arrives
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

/// MIS weight of one technique among all that can sample the path: the balance heuristic (Veach 1997, eq. 9.8) over n
/// p. With `t.correlated()` it is taken over n p c. Merging at x_i uses all N light paths of the pass, but these
/// samples are correlated between pixels; c in [1/N, 1] is the factor by which the correlation reduces their number.
///
/// Correlation by probabilities (Grittmann, Georgiev & Slusallek 2021, "Correlation-Aware Multiple Importance Sampling
/// for Bidirectional Rendering Algorithms"). The eye walk samples x_1 ... x_i with probability P, the light walk the
/// rest with probability Q:
///   c = P / (P + Q - P Q); c = 1 at x_1.
/// Each probability is a product of densities times the area that one degree from the lens subtends, at most 1 each.
///
/// Correlation by footprints (Jendersie 2019, "Variance Reduction via Footprint Estimation in the Presence of Path
/// Reuse", Ray Tracing Gems, chapter 31). Merging averages over light paths where the light walk's footprint is the
/// larger one. With the areas A and B over which the eye walk and the light walk spread up to x_i, and q = A² / B²,
///   c = (1 + q) / (1 + N q).
/// Each non-delta scattering adds the radius of the disc whose area is the reciprocal of its density.
///
/// `direct` is the density per area with which next-event estimation chooses z, `first_distance` the distance from the
/// lens to x_1. For infinite lights the densities at z are per solid angle.
float path_weight(std::span<const PathVertex> path, float direct, const PathTechnique& technique, const Techniques& t,
                  float first_distance);

/// A vertex of a walk with the densities of both kinds of walk.
struct TrailVertex {
  float arrives = 0;   ///< density per area of the walk itself
  float back = 0;      ///< of the other kind of walk, from the next vertex; set when the next vertex but one is known
  float geometry = 0;  ///< density per area here / density per solid angle at the next vertex, for the way back
  float direct = 0;    ///< at a point on a light: density per area of next-event estimation from the first vertex
  bool delta = false;  ///< the walk scattered by a delta lobe
  bool merges = false;
};

/// Densities at the last vertex of a subpath that is connected to another subpath.
struct Junction {
  float arrives = 0;             ///< per area, of the other walk at this vertex
  std::optional<float> reverse;  ///< per solid angle, of the other walk to the previous vertex; empty: the trail has it
};

/// Weight of a connection of two subpaths: `eye` is x_1 ..., `light` begins with z.
float weight_of_joined(std::span<const TrailVertex> eye, const Junction& at_eye, std::span<const TrailVertex> light,
                       const Junction& at_light, const Techniques& t, float first_distance);
/// Weight of an eye walk that has hit the light. Its last vertex is x_k, and it reached z with density `z.back`.
/// `arrives` is the density with which the light walk reaches x_k from z.
float weight_of_hit(std::span<const TrailVertex> eye, float arrives, const TrailVertex& z, const Techniques& t,
                    float first_distance);
/// Weight of a merge: the last vertex of `light` is a photon near the last vertex of `eye`. Densities per solid angle
/// at that vertex: `forward` of the eye walk, to the photon's previous vertex; `reverse` of the light walk, to the eye
/// walk's previous vertex.
float weight_of_merged(std::span<const TrailVertex> eye, std::span<const TrailVertex> light, float forward,
                       float reverse, const Techniques& t, float first_distance);

}  // namespace lanthorn
