// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The shapes of a scene in Embree, and the surface at a ray's hit.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lanthorn/scene_description.h"
#include "math/affine.h"
#include "math/ray.h"
#include "math/vec.h"
#include "scene/embree.h"
#include "shape/geometry_record.h"
#include "shape/patch.h"
#include "shape/quadric.h"
#include "shape/triangle.h"
#include "texture/textures.h"

namespace lanthorn {

/// A flat face of a pane of window glass, in a shape's space.
struct PaneFace {
  DVec3 normal{0.0};  ///< unit, of either side
  double offset = 0;  ///< the plane's distance from the origin along `normal`, metres
  double margin = 0;  ///< bound of the distance from the plane of rounded points on the face, metres
  Bounds box;         ///< around the face, with the margin
  description::Pane glass;
};

/// Data of one shape, which Embree and the records refer to.
struct ShapeStore {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 4>> patches;
  std::vector<Vertex> vertices;    ///< of a mesh with normals or uvs
  std::vector<Point> positions;    ///< of a mesh without them; one more than needed, because Embree may read it
  std::vector<FlatTriangle> flat;  ///< of the same: its triangles
  std::vector<Vec3> tangents;
  std::vector<glm::vec4> colors;
  Quadric quadric;
  description::Curves curves;  ///< one normal of ribbons more than needed, because Embree may read it
  FloatInput alpha;
  std::optional<description::Pane> pane;
  /// Of a flat pane: all faces of the window that it belongs to (windows.h); null for other shapes.
  std::shared_ptr<const std::vector<PaneFace>> window;
  const TextureGraph* textures = nullptr;
  std::uint32_t number = 0;  ///< distinguishes geometries in hashes
  SourceLocation location;
  GeometryRecord record;

  /// True if some rays pass through the shape.
  bool is_cut_out() const { return alpha.node || alpha.value < 1 || pane; }
  std::size_t primitives() const;
  std::size_t bytes() const;
  Patch patch(std::uint32_t primitive) const;
  /// A box around the whole shape, in the shape's space.
  Bounds bounds() const;
  /// A box around the primitive, in the shape's space.
  Bounds bounds_of(std::uint32_t primitive) const;
};

/// Shares the shape's triangles with Embree without copying.
void share_triangles(RTCGeometry geometry, const ShapeStore& shape);

/// Stores shape `source` in the space that `to_space` maps to; for curves the map must scale uniformly. Moves the mesh
/// out of `source`. Throws Error for an invalid mesh (indices out of range, wrong counts).
std::unique_ptr<ShapeStore> make_shape_store(description::Shape& source, const Transform& to_space);

/// A hit of a ray of direction `along` (not 0) on a primitive of a shape. Triangles: barycentric coordinates u, v.
/// Patches: bilinear coordinates u, v. Quadrics: the point `near`. Curves: `near` and the parameter u of the segment.
struct PrimitiveHit {
  std::uint32_t primitive = 0;
  float u = 0, v = 0;
  DVec3 near{0.0};
  DVec3 along{0.0, 0.0, 1.0};
};
/// The surface at the hit, all in the shape's own space.
SurfaceGeometry evaluate_surface(const GeometryRecord& record, const PrimitiveHit& hit);

/// Placement of a group of shapes: fixed, or moving by a product of motions.
struct Placement {
  /// Point in the world: outer(inner(p)).
  struct Movement {
    Motion outer, inner;
  };
  std::unique_ptr<const Movement> movement;  ///< null if nothing moves: most do not, and there may be millions
  Affine fixed;                              ///< the product if nothing moves
  std::uint32_t first_record = 0;
  std::uint32_t first_light = 0;  ///< if the group's only shape emits
  RTCScene scene = nullptr;

  /// As `Motion::at`.
  const Affine& at(float time, std::optional<Affine>& moved) const {
    if (movement == nullptr) return fixed;
    std::optional<Affine> a, b;
    return moved.emplace(movement->outer.at(time, a) * movement->inner.at(time, b));
  }
};

/// An intersection reported by Embree.
struct GeometryHit {
  const GeometryRecord* record = nullptr;
  const Placement* placement = nullptr;  ///< null: in world space
  std::uint32_t primitive = 0;
  float u = 0, v = 0, t = 0;

  /// The light of the primitive, if its shape emits.
  std::uint32_t light() const {
    const std::uint32_t first = placement != nullptr ? placement->first_light : record->first_light;
    return first + (record->lit_in_pairs ? primitive / 2 : primitive);
  }
};

/// Where a group of shapes stands.
struct PlacedGroup {
  std::uint32_t group = 0;
  AnimatedTransform outer, inner;  ///< point in the world: outer(inner(p))
  std::uint32_t first_light = 0;   ///< of this placement, if the group's only shape emits
};

/// All geometry of a scene. Immutable once `commit`ted. A copy shares shapes and acceleration structures; it can be
/// given other flags of materials (`update_records`) and other placements (`place_again`).
class Geometry {
 public:
  Geometry(float shutter_open, float shutter_close);

  /// Adds a shape in world space.
  void add(std::unique_ptr<ShapeStore> shape);
  /// Creates a group that can be placed; returns its index.
  std::uint32_t add_group(std::vector<std::unique_ptr<ShapeStore>> shapes);
  /// Places a group. An emitting shape must be the only shape of its group.
  void place(const PlacedGroup& placed);
  void commit();

  /// Calls `update(record)` for the record of each shape. To be called before the first ray.
  template <class Update>
  void update_records(Update&& update) {
    for (GeometryRecord& record : records_) update(record);
  }
  /// Of each shape.
  const std::vector<GeometryRecord>& records() const { return records_; }
  /// Replaces all placements. Takes time for each placement; the first such call on a geometry or a copy of it also
  /// builds an acceleration structure of the shapes in world space by themselves.
  void place_again(const std::vector<PlacedGroup>& placed);

  /// Nearest hit. Rays with coordinates that are not finite, or too large for Embree, hit nothing.
  std::optional<GeometryHit> intersect(const Ray& ray) const {
    RTCRayHit query;
    query.ray = embree::make_ray(ray.origin, ray.direction, ray.t_max, embree_time(ray.time));
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    if (!can_follow(query.ray)) return {};
    embree::intersect(scene_, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    GeometryHit hit{nullptr, nullptr, query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar};
    const unsigned placement = query.hit.instID[0] - first_placement_;
    if (placement >= placement_count_) {  // also for RTC_INVALID_GEOMETRY_ID
      hit.record = &records_[query.hit.geomID];
    } else {
      hit.placement = &placements_[placement];
      hit.record = &records_[hit.placement->first_record + query.hit.geomID];
    }
    return hit;
  }
  /// True if something blocks the ray; also for rays that Embree cannot trace, because no light arrives along them.
  bool occluded(const Ray& ray) const {
    RTCRay query = embree::make_ray(ray.origin, ray.direction, ray.t_max, embree_time(ray.time));
    if (!can_follow(query)) return true;
    embree::occluded(scene_, query);
    return query.tfar < 0;
  }
  /// The surface at a hit, in world space.
  SurfaceGeometry evaluate(const GeometryHit& hit, const Ray& ray) const {
    if (hit.placement == nullptr && hit.record->kind == GeometryRecord::Kind::triangles)
      return evaluate_triangle(*hit.record, hit.primitive, hit.u, hit.v);
    return evaluate_other(hit, ray);
  }

  /// Height, metres along `surface.normal`, of the smooth surface that the mesh's normals describe, where it bulges out
  /// on the side that the ray comes from; 0 where it does not. `surface`: as `evaluate` gave it.
  float rise(const GeometryHit& hit, const SurfaceGeometry& surface, const Ray& ray) const {
    if (hit.record->kind != GeometryRecord::Kind::triangles || !hit.record->has_normals) return 0;
    return rise_of_mesh(hit, surface, ray);
  }

  /// Location in the scene file of the shape that was hit.
  const SourceLocation& location(const GeometryHit& hit) const;

  const Bounds& bounds() const { return bounds_; }
  bool moves() const { return moves_; }
  std::uint64_t bytes() const;
  std::uint64_t bvh_bytes() const;
  const std::vector<std::unique_ptr<ShapeStore>>& shapes() const;
  const std::vector<std::vector<std::unique_ptr<ShapeStore>>>& groups() const;
  const Bounds& group_bounds(std::uint32_t group) const;
  std::size_t placement_count() const { return placement_count_; }
  const PlacedGroup& placed_group(std::size_t placement) const;
  /// A box around everything that the box `local` of a placed group covers while the shutter is open.
  Bounds swept_bounds(const PlacedGroup& placed, const Bounds& local) const;

 private:
  struct Shapes;    // shapes and groups in Embree
  struct TopLevel;  // the placements, and the Embree scene of everything

  bool can_follow(const RTCRay& ray) const {
    return embree::is_valid(ray) &&
           std::max({std::fabs(ray.org_x), std::fabs(ray.org_y), std::fabs(ray.org_z)}) <= farthest_origin_;
  }
  // Embree's time: 0 to 1 over the shutter interval.
  float embree_time(float time) const { return std::clamp((time - shutter_open_) * shutter_scale_, 0.0f, 1.0f); }
  float shutter_time(float time) const { return lerp(embree_time(time), shutter_open_, shutter_close_); }
  SurfaceGeometry evaluate_other(const GeometryHit& hit, const Ray& ray) const;
  float rise_of_mesh(const GeometryHit& hit, const SurfaceGeometry& surface, const Ray& ray) const;
  void commit_top_level();

  float shutter_open_, shutter_close_, shutter_scale_;
  std::shared_ptr<Shapes> shapes_;
  std::shared_ptr<TopLevel> top_level_;
  std::vector<GeometryRecord> records_;
  Bounds bounds_;
  bool moves_ = false;
  // Data of the top level, for rays.
  RTCScene scene_ = nullptr;
  const Placement* placements_ = nullptr;
  unsigned first_placement_ = 0, placement_count_ = 0;  // Embree geometries from first_placement_ on are placements
  float farthest_origin_ = embree::largest_coordinate;  // per axis: Embree maps rays into its instances
};

/// True if rays can be mapped by the inverse of outer * inner at both ends of a motion. False if the product is
/// singular, or so small that unit vectors become too long for single precision.
bool can_be_placed(const AnimatedTransform& outer, const AnimatedTransform& inner);

}  // namespace lanthorn
