// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Densities along the eye subpaths and light subpaths of bidirectional methods.
#pragma once

#include <cmath>
#include <optional>
#include <variant>

#include "camera/camera.h"
#include "path/coherence.h"
#include "path/emission_densities.h"
#include "path/mis.h"
#include "path/path_context.h"
#include "path/vertex.h"
#include "scene/scene.h"

namespace lanthorn {

/// True where photons are stored and merged: at surfaces with a non-delta lobe, except fibres. The photons on a fibre
/// do not lie in a disc, so that no area can be given.
inline bool merges_at(const SurfacePoint& at) { return has_non_delta(at.bsdf) && !is_fibre(at.bsdf); }

/// Where a subpath begins: at the lens, or on a light.
struct PathStart {
  const Camera* camera = nullptr;  ///< null for light paths
  std::uint32_t light = 0;         ///< index of the light
  EmissionSample emission{};
  float density_factor = 0;  ///< of light paths (`EmissionDensities::factor`)

  bool is_eye() const { return camera != nullptr; }
};

/// How a subpath leaves its last vertex: determines its densities at any point of the next flight where it could
/// scatter.
struct Departure {
  SubpathDensities densities;  ///< after `SubpathDensities::scatter`; before the first vertex 0
  float collision = 1;         ///< at the last vertex (`FlightDensity`)
  float over_pass = 0;         ///< of merging there
  float optical_depth = 0;     ///< flown since then
  Point from{0};               ///< the last vertex
  Direction direction{0, 0, 1};
  bool is_first = true;  ///< the subpath has no vertex yet, and leaves the lens or the light
};

/// Densities of a subpath that scatters in a medium, on its way.
struct VolumeArrival {
  VertexDensities densities;
  FlightDensity flight;
};

/// Densities of a subpath that leaves like `departure`, if it scattered at `p` after a further optical depth of
/// `optical_depth`. `collision`: density of collisions at p, per metre. `start` is needed for the first vertex only.
VolumeArrival arrive_in_medium(const Scene& scene, const PathStart& start, const Departure& departure,
                               const Techniques& techniques, const Point& p, float time, float optical_depth,
                               float collision);

/// Records the densities of a subpath during its walk. Call a `begin` function first, then `arrive` at each vertex in
/// order, and `fly` for each flight between them.
class Subpath {
 public:
  explicit Subpath(const Techniques& techniques) : techniques_(techniques) {}

  /// Begins an eye path.
  void begin_at_lens(const Camera& camera) { start_.camera = &camera; }
  /// Begins a light path on light `index`.
  void begin_at_light(std::uint32_t index, const EmissionSample& emission, const EmissionDensities& densities) {
    emission_densities_ = &densities;
    const EmitterHit origin{emission.origin, emission.normal, Vec2(0)};
    start_ = {nullptr, index, emission, densities.factor(index, origin, emission.direction)};
  }

  void arrive(const PathContext& path, const SurfaceVertex& v);
  void arrive(const PathContext& path, const MediumVertex& v);
  /// The walk leaves the last vertex, and the scene: densities then refer to light that comes along the ray. `flies` is
  /// false for light that a medium on the way emits: the flight then has no density in MIS weights.
  void escape(const WalkState& state, const Direction& direction, bool flies = true);

  /// The beginning of a flight: how the subpath left its last vertex.
  const Departure& depart(const FlownSegment& flight);
  /// A whole flight.
  void fly(const FlownSegment& flight);

  const PathStart& start() const { return start_; }
  const Departure& departure() const { return departure_; }
  /// Densities at the last vertex.
  const SubpathDensities& densities() const { return departure_.densities; }
  /// The same at the first vertex of a light path, if the light is direct.
  SubpathDensities densities_of_direct_light() const;
  /// Density of the flight to the last vertex.
  const FlightDensity& flight() const { return flight_; }
  /// For an eye path: share of merging in media that counts at the last vertex, or on the flight after `depart`.
  float coherence() const { return coherence_; }
  /// Coherence beyond the last vertex, if the path continues from it by a non-delta lobe.
  float coherence_beyond() const { return coherence_ * previous_.coherence; }

 private:
  struct Position {
    Point position;
    Normal normal{0};  // 0 in a medium
    float time = 0;
    float cos = 1;        // |cos| of the walk's incident direction
    float collision = 1;  // 1 on surfaces
    bool merges = false;
  };
  void arrive_at(const Scene& scene, const WalkState& state, const Position& at, const Direction& wi);
  void depart(const WalkState& state, const Direction& direction);
  /// Density per solid angle with which the other kind of walk, coming from `direction`, would continue to the vertex
  /// before the last one.
  float reverse_density(const WalkState& state, const Direction& direction) const;

  // The previous vertex.
  struct Previous {
    std::optional<SurfacePoint> surface;  // empty in a medium
    Vec3 wi_local{0};
    Direction wi{0, 0, 1};
    bool merges = false;
    float coherence = 1;  // 1 without merging in media
  };

  Techniques techniques_;
  const EmissionDensities* emission_densities_ = nullptr;
  PathStart start_;
  Departure departure_;
  bool has_departed_ = false;
  FlightDensity flight_;
  Previous previous_;
  float coherence_ = 1;
};

}  // namespace lanthorn
