// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/geometry.h"

#include <cmath>
#include <cstddef>

#include "math/hash.h"

namespace lanthorn {

namespace {

using Kind = GeometryRecord::Kind;

Point origin_of(const RTCRay& ray) { return {ray.org_x, ray.org_y, ray.org_z}; }
Vec3 direction_of(const RTCRay& ray) { return {ray.dir_x, ray.dir_y, ray.dir_z}; }

// Tests alpha as the probability that a surface exists. The random number depends only on the ray and the primitive:
// the same ray always sees the same surfaces, and different surfaces along it are independent.
bool passes_alpha(const ShapeStore& shape, const RTCRay& ray, const PrimitiveHit& hit, std::uint32_t root) {
  if (!shape.alpha.node && shape.alpha.value >= 1) return true;
  const SurfaceGeometry surface = evaluate_surface(shape.record, hit);
  // A ray that enters a tube and leaves it meets two surfaces.
  if (shape.record.kind == Kind::curves && dot(surface.normal, direction_of(ray)) > 0) ++root;
  const float alpha = shape.textures->evaluate(shape.alpha, {surface.position, surface.normal, surface.uv});
  if (alpha >= 1) return true;
  if (!(alpha > 0)) return false;
  const std::uint64_t seed = hash_words({shape.number, hit.primitive, root});
  return unit_float(hash_vec(direction_of(ray), hash_vec(origin_of(ray), seed))) < alpha;
}

void alpha_filter(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& shape = *static_cast<const ShapeStore*>(args->geometryUserPtr);
  const auto& ray = *reinterpret_cast<const RTCRay*>(args->ray);
  const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
  const DVec3 o(origin_of(ray)), d(direction_of(ray));
  const DVec3 near = o + static_cast<double>(ray.tfar) * d;
  if (!passes_alpha(shape, ray, {hit.primID, hit.u, hit.v, near, d}, 0)) args->valid[0] = 0;
}

struct UserHit {
  float t = 0, u = 0, v = 0;
};

// Nearest hit of a ray with one quadric or patch inside (tnear, tfar).
std::optional<UserHit> nearest_hit(const ShapeStore& shape, const RTCRay& ray, std::uint32_t primitive) {
  const Point o = origin_of(ray);
  const Vec3 d = direction_of(ray);
  if (shape.record.kind == Kind::quadric) {
    const QuadricRoots roots = intersect(shape.quadric, o, d, ray.tnear, ray.tfar);
    for (int i = 0; i < roots.count; ++i) {
      const double t = roots.t[static_cast<unsigned>(i)];
      if (passes_alpha(shape, ray, {primitive, 0, 0, DVec3(o) + t * DVec3(d)}, static_cast<std::uint32_t>(i)))
        return UserHit{static_cast<float>(t), 0, 0};
    }
    return {};
  }
  const PatchHits hits = intersect(shape.patch(primitive), o, d, ray.tnear, ray.tfar);
  for (int i = 0; i < hits.count; ++i) {
    const PatchHits::Hit& hit = hits.hits[static_cast<unsigned>(i)];
    const auto u = static_cast<float>(hit.u), v = static_cast<float>(hit.v);
    if (passes_alpha(shape, ray, {primitive, u, v}, static_cast<std::uint32_t>(i)))
      return UserHit{static_cast<float>(hit.t), u, v};
  }
  return {};
}

void shape_bounds(const RTCBoundsFunctionArguments* args) {
  const Bounds b = static_cast<const ShapeStore*>(args->geometryUserPtr)->bounds_of(args->primID);
  *args->bounds_o = {b.min.x, b.min.y, b.min.z, 0, b.max.x, b.max.y, b.max.z, 0};
}

void shape_intersect(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& shape = *static_cast<const ShapeStore*>(args->geometryUserPtr);
  auto& query = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const std::optional<UserHit> hit = nearest_hit(shape, query.ray, args->primID);
  if (!hit) return;
  query.ray.tfar = hit->t;
  query.hit.u = hit->u;
  query.hit.v = hit->v;
  query.hit.primID = args->primID;
  query.hit.geomID = args->geomID;
  query.hit.instID[0] = args->context->instID[0];
}

void shape_occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& shape = *static_cast<const ShapeStore*>(args->geometryUserPtr);
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  if (nearest_hit(shape, ray, args->primID)) ray.tfar = -infinity;
}

// Maximum absolute row sum: bound of the result for coordinates of magnitude at most 1. Infinite if an entry is NaN.
double row_norm(const DMat3& m) {
  double largest = 0;
  for (int r = 0; r < 3; ++r) {
    const double sum = std::fabs(m[0][r]) + std::fabs(m[1][r]) + std::fabs(m[2][r]);
    largest = std::isnan(sum) ? HUGE_VAL : std::max(largest, sum);
    if (largest == HUGE_VAL) break;
  }
  return largest;
}

// Largest distance of ray origins from the origin, per axis, for which Embree can map rays into a fixed instance.
// Embree inverts the map in single precision; 0 if that fails.
float embree_reach(const Affine& map) {
  constexpr double longest = 1e12, worst_condition = 1e6;
  const double size = row_norm(map.linear), inverse_size = row_norm(map.inverse);
  if (!(size <= longest && size * inverse_size <= worst_condition)) return 0;
  const DVec3 t = glm::abs(map.translation);
  return static_cast<float>(static_cast<double>(embree::largest_coordinate) / (1.01 * inverse_size) -
                            std::max({t.x, t.y, t.z}));
}
// Ten times the distance at which rays begin to miss: nothing is lost by not tracing rays from beyond.
constexpr float least_embree_reach = 1e13f;

// Normalises; in double precision if the squared length exceeds the range of single precision.
Normal unit(const DVec3& v) {
  const Normal n(v);
  const float length2 = length_squared(n);
  return length2 > 1e-30f && length2 < 1e30f ? normalize(n) : Normal(glm::normalize(v));
}

Vec3 abs_transform(const DMat3& m, const Vec3& v) {
  const glm::mat3 a(m);
  return abs(a[0]) * v.x + abs(a[1]) * v.y + abs(a[2]) * v.z;
}

}  // namespace

// A placed group whose rays are mapped here, not by Embree: a user geometry whose callback maps each ray by the
// placement at the ray's own time. Used for moving groups, so that hits agree with AnimatedTransform rather than with
// an interpolation between key frames, and for fixed groups for which single precision is insufficient.
struct Geometry::MappedInstance {
  const Geometry* owner = nullptr;
  std::size_t placement = 0;
  Bounds bounds;
};

Geometry::Geometry(float shutter_open, float shutter_close)
    : shutter_open_(shutter_open),
      shutter_close_(shutter_close),
      shutter_scale_(shutter_close > shutter_open ? 1 / (shutter_close - shutter_open) : 0.0f) {
  device_ = rtcNewDevice(nullptr);
  if (device_ == nullptr) throw Error("Embree cannot be started on this machine");
  rtcSetDeviceMemoryMonitorFunction(device_, monitor_memory, this);
  scene_ = make_scene();
}

Geometry::~Geometry() {
  for (const RTCScene scene : group_scenes_) rtcReleaseScene(scene);
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

bool Geometry::monitor_memory(void* self, ssize_t bytes, bool) {
  static_cast<Geometry*>(self)->bvh_bytes_ += bytes;
  return true;
}

RTCScene Geometry::make_scene() {
  const RTCScene scene = rtcNewScene(device_);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  return scene;
}

void Geometry::commit_scene(RTCScene scene) {
  rtcCommitScene(scene);
  if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
    throw Error(error == RTC_ERROR_OUT_OF_MEMORY
                    ? "not enough memory to build the acceleration structure"
                    : "Embree failed to build the acceleration structure, error " + std::to_string(error));
}

void share_triangles(RTCGeometry geometry, const ShapeStore& shape) {
  if (shape.vertices.empty())
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, shape.positions.data(), 0,
                               sizeof(Point), shape.positions.size() - 1);
  else
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, shape.vertices.data(),
                               offsetof(Vertex, position), sizeof(Vertex), shape.vertices.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, shape.triangles.data(), 0,
                             sizeof(shape.triangles[0]), shape.triangles.size());
}

namespace {

void share_curves(RTCGeometry geometry, const description::Curves& curves) {
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, curves.points.data(), 0,
                             sizeof(curves.points[0]), curves.points.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, curves.segments.data(), 0,
                             sizeof(curves.segments[0]), curves.segments.size());
  if (curves.kind == description::CurveKind::ribbon)
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3, curves.normals.data(), 0,
                               sizeof(Normal), curves.points.size());
  if (curves.kind == description::CurveKind::flat) {
    constexpr float most_quads = 16;
    rtcSetGeometryTessellationRate(geometry, most_quads);
  }
}

RTCGeometryType type_of(const ShapeStore& shape) {
  if (shape.record.kind == Kind::triangles) return RTC_GEOMETRY_TYPE_TRIANGLE;
  if (shape.record.kind != Kind::curves) return RTC_GEOMETRY_TYPE_USER;
  switch (shape.curves.kind) {
    case description::CurveKind::flat:
      return RTC_GEOMETRY_TYPE_FLAT_BEZIER_CURVE;
    case description::CurveKind::cylinder:
      return RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE;
    case description::CurveKind::ribbon:
      break;
  }
  return RTC_GEOMETRY_TYPE_NORMAL_ORIENTED_BEZIER_CURVE;
}

}  // namespace

RTCGeometry Geometry::make_geometry(const ShapeStore& shape) {
  const RTCGeometryType type = type_of(shape);
  const RTCGeometry geometry = rtcNewGeometry(device_, type);
  rtcSetGeometryUserData(geometry, const_cast<ShapeStore*>(&shape));
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  if (type != RTC_GEOMETRY_TYPE_USER) {
    if (type == RTC_GEOMETRY_TYPE_TRIANGLE)
      share_triangles(geometry, shape);
    else
      share_curves(geometry, shape.curves);
    if (shape.alpha.node || shape.alpha.value < 1) {
      rtcSetGeometryIntersectFilterFunction(geometry, alpha_filter);
      rtcSetGeometryOccludedFilterFunction(geometry, alpha_filter);
    }
  } else {
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(shape.primitives()));
    rtcSetGeometryBoundsFunction(geometry, shape_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, shape_intersect);
    rtcSetGeometryOccludedFunction(geometry, shape_occluded);
  }
  rtcCommitGeometry(geometry);
  return geometry;
}

void Geometry::add(std::unique_ptr<ShapeStore> shape) { shapes_.push_back(std::move(shape)); }

std::uint32_t Geometry::add_group(std::vector<std::unique_ptr<ShapeStore>> shapes) {
  Bounds bounds;
  for (const auto& shape : shapes) bounds.extend(shape->bounds());
  group_bounds_.push_back(bounds);
  groups_.push_back(std::move(shapes));
  return static_cast<std::uint32_t>(groups_.size() - 1);
}

void Geometry::place(std::uint32_t group, const AnimatedTransform& outer, const AnimatedTransform& inner,
                     std::uint32_t first_light) {
  Placement p;
  p.outer = Motion(outer);
  p.inner = Motion(inner);
  p.moving = p.outer.is_moving() || p.inner.is_moving();
  p.fixed = Affine(outer.start) * Affine(inner.start);
  p.first_light = first_light;
  moves_ = moves_ || p.moving;
  placements_.push_back(p);
  placed_groups_.push_back(group);
}

void Geometry::commit() {
  std::uint32_t number = 0;
  const auto attach = [&](RTCScene scene, ShapeStore& shape, std::size_t id) {
    shape.number = number++;
    records_.push_back(shape.record);
    const RTCGeometry geometry = make_geometry(shape);
    rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(id));
    rtcReleaseGeometry(geometry);
  };
  for (std::size_t i = 0; i < shapes_.size(); ++i) attach(scene_, *shapes_[i], i);
  std::vector<std::uint32_t> first_records;
  for (const auto& group : groups_) {
    first_records.push_back(static_cast<std::uint32_t>(records_.size()));
    group_scenes_.push_back(make_scene());
    for (std::size_t i = 0; i < group.size(); ++i) attach(group_scenes_.back(), *group[i], i);
    commit_scene(group_scenes_.back());
  }
  for (std::size_t i = 0; i < placements_.size(); ++i) {
    placements_[i].first_record = first_records[placed_groups_[i]];
    placements_[i].scene = group_scenes_[placed_groups_[i]];
  }
  attach_placements();
  commit_scene(scene_);
  RTCBounds b;
  rtcGetSceneBounds(scene_, &b);
  bounds_ = {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
}

void Geometry::attach_placements() {
  for (std::size_t i = 0; i < placements_.size(); ++i) {
    const float reach = placements_[i].moving ? 0 : embree_reach(placements_[i].fixed);
    const bool is_embrees = reach >= least_embree_reach;
    if (is_embrees) farthest_origin_ = std::min(farthest_origin_, reach);
    const RTCGeometry geometry = is_embrees ? make_fixed_instance(placements_[i]) : make_mapped_instance(i);
    rtcAttachGeometryByID(scene_, geometry, static_cast<unsigned>(shapes_.size() + i));
    rtcReleaseGeometry(geometry);
  }
}

RTCGeometry Geometry::make_fixed_instance(const Placement& placement) {
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, placement.scene);
  std::array<float, 12> columns{};
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 3; ++r)
      columns[static_cast<unsigned>(3 * c + r)] =
          static_cast<float>(c < 3 ? placement.fixed.linear[c][r] : placement.fixed.translation[r]);
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
  rtcCommitGeometry(geometry);
  return geometry;
}

Bounds Geometry::swept_bounds(std::size_t number, const Bounds& local) const {
  const Placement& placement = placements_[number];
  const int steps = placement.moving ? 64 : 0;
  Bounds swept;
  double farthest = 0;
  std::array<DVec3, 8> previous{};
  for (int step = 0; step <= steps; ++step) {
    const float s = static_cast<float>(step) / 64;
    const Affine map = placement.at(lerp(s, shutter_open_, shutter_close_));
    for (unsigned corner = 0; corner < 8; ++corner) {
      const DVec3 p = map.point({corner & 1 ? local.max.x : local.min.x, corner & 2 ? local.max.y : local.min.y,
                                 corner & 4 ? local.max.z : local.min.z});
      swept.extend(Point(p));
      if (step > 0) farthest = std::max(farthest, glm::length(p - previous[corner]));
      previous[corner] = p;
    }
  }
  // Between two steps no point moves farther than half a step's path, which is barely longer than its chord.
  const auto margin = static_cast<float>(0.6 * farthest) + 0x1p-20f * max_component(abs(swept.min) + abs(swept.max));
  return {swept.min - Vec3(margin), swept.max + Vec3(margin)};
}

RTCGeometry Geometry::make_mapped_instance(std::size_t placement) {
  const Bounds& local = group_bounds_[placed_groups_[placement]];
  mapped_.push_back(std::make_unique<MappedInstance>(MappedInstance{this, placement, swept_bounds(placement, local)}));
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserData(geometry, mapped_.back().get());
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryBoundsFunction(geometry, mapped_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, mapped_intersect);
  rtcSetGeometryOccludedFunction(geometry, mapped_occluded);
  rtcCommitGeometry(geometry);
  return geometry;
}

void Geometry::mapped_bounds(const RTCBoundsFunctionArguments* args) {
  const Bounds& b = static_cast<const MappedInstance*>(args->geometryUserPtr)->bounds;
  *args->bounds_o = {b.min.x, b.min.y, b.min.z, 0, b.max.x, b.max.y, b.max.z, 0};
}

RTCRay Geometry::to_local(const RTCRay& ray, const Placement& placement) const {
  const Affine map = placement.at(callback_time(ray.time));
  RTCRay local = embree::make_ray(Point(map.inverse_point(DVec3(origin_of(ray)))),
                                  Vec3(map.inverse_vector(DVec3(direction_of(ray)))), ray.tfar, ray.time);
  local.tnear = ray.tnear;
  return local;
}

void Geometry::mapped_intersect(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& instance = *static_cast<const MappedInstance*>(args->geometryUserPtr);
  const Placement& placement = instance.owner->placements_[instance.placement];
  auto& query = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  RTCRayHit local;
  local.ray = instance.owner->to_local(query.ray, placement);
  local.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  local.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  if (!embree::is_valid(local.ray)) return;
  embree::intersect(placement.scene, local);
  if (local.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
  query.ray.tfar = local.ray.tfar;
  query.hit = local.hit;
  query.hit.instID[0] = args->geomID;
}

void Geometry::mapped_occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& instance = *static_cast<const MappedInstance*>(args->geometryUserPtr);
  const Placement& placement = instance.owner->placements_[instance.placement];
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  RTCRay local = instance.owner->to_local(ray, placement);
  if (!embree::is_valid(local)) return;
  embree::occluded(placement.scene, local);
  if (local.tfar < 0) ray.tfar = -infinity;
}

SurfaceGeometry Geometry::evaluate_other(const GeometryHit& hit, const Ray& ray) const {
  const DVec3 o(ray.origin), d(ray.direction);
  const auto t = static_cast<double>(hit.t);
  if (hit.placement == nullptr) return evaluate_surface(*hit.record, {hit.primitive, hit.u, hit.v, o + t * d, d});
  const Affine map = hit.placement->at(callback_time(embree_time(ray.time)));
  const DVec3 along = map.inverse_vector(d);
  SurfaceGeometry s =
      evaluate_surface(*hit.record, {hit.primitive, hit.u, hit.v, map.inverse_point(o) + t * along, along});
  const Point world(map.point(DVec3(s.position)));
  // In addition to the hit's own error: Embree maps the next ray into the instance in single precision, with a rounded
  // inverse.
  constexpr float mapping = 4 * 0x1p-24f;
  const Vec3 mapped = abs_transform(map.inverse, abs(world) + abs(Vec3(map.translation)));
  s.error = abs_transform(map.linear, s.error + mapping * mapped) + 0x1p-23f * abs(world);
  s.position = world;
  s.normal = unit(map.normal(DVec3(s.normal)));
  s.shading_normal = unit(map.normal(DVec3(s.shading_normal)));
  if (dot(s.normal, s.shading_normal) < 0) s.shading_normal = -s.shading_normal;
  if (hit.record->wants_tangents)
    for (Vec3* v : {&s.tangent, &s.dpdu, &s.dpdv}) *v = Vec3(map.vector(DVec3(*v)));
  return s;
}

bool can_be_placed(const AnimatedTransform& outer, const AnimatedTransform& inner) {
  constexpr double longest = 5e17;  // well within embree::largest_coordinate
  const auto inverts = [](const Transform& a, const Transform& b) {
    return !a.is_singular() && !b.is_singular() && row_norm((Affine(a) * Affine(b)).inverse) < longest;
  };
  return inverts(outer.start, inner.start) && inverts(outer.end, inner.end);
}

const SourceLocation& Geometry::location(const GeometryHit& hit) const {
  const auto index = static_cast<std::size_t>(hit.record - records_.data());
  if (hit.placement == nullptr) return shapes_[index]->location;
  const std::uint32_t group = placed_groups_[static_cast<std::size_t>(hit.placement - placements_.data())];
  return groups_[group][index - hit.placement->first_record]->location;
}

std::uint64_t Geometry::bytes() const {
  std::uint64_t sum = records_.size() * sizeof(GeometryRecord);
  for (const auto& shape : shapes_) sum += shape->bytes();
  for (const auto& group : groups_)
    for (const auto& shape : group) sum += shape->bytes();
  return sum;
}

}  // namespace lanthorn
