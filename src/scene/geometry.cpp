// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/geometry.h"

#include <atomic>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <string>
#include <utility>

#include "math/hash.h"
#include "scene/windows.h"

namespace lanthorn {

namespace {

using Kind = GeometryRecord::Kind;

Point origin_of(const RTCRay& ray) { return {ray.org_x, ray.org_y, ray.org_z}; }
Vec3 direction_of(const RTCRay& ray) { return {ray.dir_x, ray.dir_y, ray.dir_z}; }

// Tests alpha as the probability that a surface exists. The random number depends only on the ray and the primitive:
// the same ray always sees the same surfaces, and different surfaces along it are independent.
bool passes_alpha(const ShapeStore& shape, const RTCRay& ray, const PrimitiveHit& hit, std::uint32_t root) {
  if (!shape.is_cut_out()) return true;
  const SurfaceGeometry surface = evaluate_surface(shape.record, hit);
  // A ray that enters a tube and leaves it meets two surfaces.
  if (shape.record.kind == Kind::curves && dot(surface.normal, direction_of(ray)) > 0) ++root;
  float alpha = shape.textures->evaluate(shape.alpha, {surface.position, surface.normal, surface.uv, surface.color});
  if (shape.pane) alpha *= reflectance_of_pane(shape, origin_of(ray), direction_of(ray), surface);
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

// Finds the nearest hit of a ray with one quadric inside (tnear, tfar).
inline bool meets_quadric(const ShapeStore& shape, const RTCRay& ray, UserHit& nearest) {
  const Point o = origin_of(ray);
  const Vec3 d = direction_of(ray);
  const QuadricRoots roots = intersect(shape.quadric, o, d, ray.tnear, ray.tfar);
  for (int i = 0; i < roots.count; ++i) {
    const double t = roots.t[static_cast<unsigned>(i)];
    if (shape.is_cut_out() &&
        !passes_alpha(shape, ray, {0, 0, 0, DVec3(o) + t * DVec3(d)}, static_cast<std::uint32_t>(i)))
      continue;
    nearest = {static_cast<float>(t), 0, 0};
    return true;
  }
  return false;
}

// The same with a patch.
bool meets_patch(const ShapeStore& shape, const RTCRay& ray, std::uint32_t primitive, UserHit& nearest) {
  const Point o = origin_of(ray);
  const Vec3 d = direction_of(ray);
  const PatchHits hits = intersect(shape.patch(primitive), o, d, ray.tnear, ray.tfar);
  for (int i = 0; i < hits.count; ++i) {
    const PatchHits::Hit& hit = hits.hits[static_cast<unsigned>(i)];
    const auto u = static_cast<float>(hit.u), v = static_cast<float>(hit.v);
    if (!passes_alpha(shape, ray, {primitive, u, v}, static_cast<std::uint32_t>(i))) continue;
    nearest = {static_cast<float>(hit.t), u, v};
    return true;
  }
  return false;
}

inline bool meets(const ShapeStore& shape, const RTCRay& ray, std::uint32_t primitive, UserHit& nearest) {
  return shape.record.kind == Kind::quadric ? meets_quadric(shape, ray, nearest)
                                            : meets_patch(shape, ray, primitive, nearest);
}

void shape_bounds(const RTCBoundsFunctionArguments* args) {
  const Bounds b = static_cast<const ShapeStore*>(args->geometryUserPtr)->bounds_of(args->primID);
  *args->bounds_o = {b.min.x, b.min.y, b.min.z, 0, b.max.x, b.max.y, b.max.z, 0};
}

void shape_intersect(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& shape = *static_cast<const ShapeStore*>(args->geometryUserPtr);
  auto& query = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  UserHit nearest;
  if (!meets(shape, query.ray, args->primID, nearest)) return;
  query.ray.tfar = nearest.t;
  query.hit.u = nearest.u;
  query.hit.v = nearest.v;
  query.hit.primID = args->primID;
  query.hit.geomID = args->geomID;
  query.hit.instID[0] = args->context->instID[0];
}

void shape_occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& shape = *static_cast<const ShapeStore*>(args->geometryUserPtr);
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  UserHit nearest;
  if (meets(shape, ray, args->primID, nearest)) ray.tfar = -infinity;
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

// ThreadSanitizer cannot see in which order the threads of Embree, which is not compiled for it, do their work.
#ifdef __SANITIZE_THREAD__
constexpr const char* embree_settings = "threads=1";
#else
constexpr const char* embree_settings = nullptr;
#endif

struct Geometry::Shapes {
  RTCDevice device = nullptr;
  std::atomic<std::int64_t> bvh_bytes{0};
  std::vector<std::unique_ptr<ShapeStore>> in_world;
  std::vector<std::vector<std::unique_ptr<ShapeStore>>> groups;
  std::vector<Bounds> group_bounds;
  std::vector<RTCScene> group_scenes;
  std::vector<std::uint32_t> first_records;  // of the groups
  std::once_flag has_world_scene;
  RTCScene world_scene = nullptr;  // of `in_world` alone, once placements have been replaced

  Shapes() {
    device = rtcNewDevice(embree_settings);
    if (device == nullptr) throw Error("Embree cannot be started on this machine");
    rtcSetDeviceMemoryMonitorFunction(device, monitor_memory, this);
  }
  ~Shapes() {
    for (const RTCScene scene : group_scenes) rtcReleaseScene(scene);
    if (world_scene != nullptr) rtcReleaseScene(world_scene);
    rtcReleaseDevice(device);
  }
  Shapes(const Shapes&) = delete;
  Shapes& operator=(const Shapes&) = delete;

  RTCScene make_scene() const {
    const RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    return scene;
  }
  void commit(RTCScene scene) const;
  void attach(RTCScene scene, RTCGeometry geometry, std::size_t id) const {
    rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(id));
    rtcReleaseGeometry(geometry);
  }
  void attach_world(RTCScene scene) const {
    for (std::size_t i = 0; i < in_world.size(); ++i) attach(scene, make_geometry(*in_world[i]), i);
  }
  // An instance of the shapes in world space, in their own space.
  RTCGeometry make_world_instance();
  RTCGeometry make_geometry(const ShapeStore& shape) const;

  static bool monitor_memory(void* self, ssize_t bytes, bool) {
    static_cast<Shapes*>(self)->bvh_bytes += bytes;
    return true;
  }
};

struct Geometry::TopLevel {
  // A placed group whose rays are mapped here, not by Embree: a user geometry whose callback maps each ray by the
  // placement at the ray's own time. Used for moving groups, so that hits agree with AnimatedTransform rather than with
  // an interpolation between key frames, and for fixed groups for which single precision is insufficient.
  struct MappedInstance {
    const Placement* placement = nullptr;
    float shutter_open = 0, shutter_close = 0;
    Bounds bounds;

    RTCGeometry in_embree(RTCDevice device) const;
    RTCRay to_local(const RTCRay& ray) const;
    static void bounds_of(const RTCBoundsFunctionArguments* args);
    static void intersect(const RTCIntersectFunctionNArguments* args);
    static void occluded(const RTCOccludedFunctionNArguments* args);
  };

  RTCScene scene = nullptr;
  std::vector<PlacedGroup> placed;
  std::vector<Placement> placements;  // of `placed`, by index
  std::vector<std::unique_ptr<MappedInstance>> mapped;
  float farthest_origin = embree::largest_coordinate;
  bool has_world_instance = false;  // the shapes in world space are geometry 0, an instance

  TopLevel() = default;
  ~TopLevel() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
  TopLevel(const TopLevel&) = delete;
  TopLevel& operator=(const TopLevel&) = delete;
};

Geometry::Geometry(float shutter_open, float shutter_close)
    : shutter_open_(shutter_open),
      shutter_close_(shutter_close),
      shutter_scale_(shutter_close > shutter_open ? 1 / (shutter_close - shutter_open) : 0.0f),
      shapes_(std::make_shared<Shapes>()),
      top_level_(std::make_shared<TopLevel>()) {}

void Geometry::Shapes::commit(RTCScene scene) const {
  rtcCommitScene(scene);
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
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

RTCGeometry Geometry::Shapes::make_geometry(const ShapeStore& shape) const {
  const RTCGeometryType type = type_of(shape);
  const RTCGeometry geometry = rtcNewGeometry(device, type);
  rtcSetGeometryUserData(geometry, const_cast<ShapeStore*>(&shape));
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  if (type != RTC_GEOMETRY_TYPE_USER) {
    if (type == RTC_GEOMETRY_TYPE_TRIANGLE)
      share_triangles(geometry, shape);
    else
      share_curves(geometry, shape.curves);
    if (shape.is_cut_out()) {
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

void Geometry::add(std::unique_ptr<ShapeStore> shape) { shapes_->in_world.push_back(std::move(shape)); }

std::uint32_t Geometry::add_group(std::vector<std::unique_ptr<ShapeStore>> shapes) {
  Bounds bounds;
  for (const auto& shape : shapes) bounds.extend(shape->bounds());
  shapes_->group_bounds.push_back(bounds);
  shapes_->groups.push_back(std::move(shapes));
  return static_cast<std::uint32_t>(shapes_->groups.size() - 1);
}

namespace {

RTCGeometry make_instance(RTCDevice device, RTCScene scene, const Affine& map) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, scene);
  std::array<float, 12> columns{};
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 3; ++r)
      columns[static_cast<unsigned>(3 * c + r)] = static_cast<float>(c < 3 ? map.linear[c][r] : map.translation[r]);
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
  rtcCommitGeometry(geometry);
  return geometry;
}

Placement make_placement(const PlacedGroup& placed) {
  Placement p;
  if (placed.outer.is_moving() || placed.inner.is_moving())
    p.movement = std::make_unique<Placement::Movement>(Placement::Movement{Motion(placed.outer), Motion(placed.inner)});
  p.fixed = Affine(placed.outer.start) * Affine(placed.inner.start);
  p.first_light = placed.first_light;
  return p;
}

}  // namespace

// Embree maps rays by the identity without rounding, so that hits stay the same bits.
RTCGeometry Geometry::Shapes::make_world_instance() {
  std::call_once(has_world_scene, [&] {
    const RTCScene scene = make_scene();
    attach_world(scene);
    commit(scene);
    world_scene = scene;
  });
  return make_instance(device, world_scene, Affine(Transform()));
}

void Geometry::place(const PlacedGroup& placed) { top_level_->placed.push_back(placed); }

void Geometry::commit() {
  Shapes& shapes = *shapes_;
  std::uint32_t number = 0;
  const auto record = [&](ShapeStore& shape) {
    shape.number = number++;
    records_.push_back(shape.record);
  };
  for (const auto& shape : shapes.in_world) record(*shape);
  join_windows(shapes.in_world);
  for (const auto& group : shapes.groups) {
    join_windows(group);
    shapes.first_records.push_back(static_cast<std::uint32_t>(records_.size()));
    shapes.group_scenes.push_back(shapes.make_scene());
    const RTCScene scene = shapes.group_scenes.back();
    for (std::size_t i = 0; i < group.size(); ++i) {
      record(*group[i]);
      shapes.attach(scene, shapes.make_geometry(*group[i]), i);
    }
    shapes.commit(scene);
  }
  commit_top_level();
}

void Geometry::place_again(const std::vector<PlacedGroup>& placed) {
  top_level_ = std::make_shared<TopLevel>();
  top_level_->placed = placed;
  top_level_->has_world_instance = !shapes_->in_world.empty();
  commit_top_level();
}

void Geometry::commit_top_level() {
  Shapes& shapes = *shapes_;
  TopLevel& top = *top_level_;
  top.scene = shapes.make_scene();
  if (top.has_world_instance)
    shapes.attach(top.scene, shapes.make_world_instance(), 0);
  else
    shapes.attach_world(top.scene);
  moves_ = false;
  top.placements.reserve(top.placed.size());  // addresses are stable
  for (const PlacedGroup& placed : top.placed) {
    Placement& placement = top.placements.emplace_back(make_placement(placed));
    placement.first_record = shapes.first_records[placed.group];
    placement.scene = shapes.group_scenes[placed.group];
    const bool is_moving = placement.movement != nullptr;
    moves_ = moves_ || is_moving;
    const float reach = is_moving ? 0 : embree_reach(placement.fixed);
    const bool is_embrees = reach >= least_embree_reach;
    if (is_embrees) {
      top.farthest_origin = std::min(top.farthest_origin, reach);
    } else {
      const Bounds box = swept_bounds(placed, shapes.group_bounds[placed.group]);
      top.mapped.push_back(std::make_unique<TopLevel::MappedInstance>(
          TopLevel::MappedInstance{&placement, shutter_open_, shutter_close_, box}));
    }
    const std::size_t id = shapes.in_world.size() + top.placements.size() - 1;
    shapes.attach(top.scene,
                  is_embrees ? make_instance(shapes.device, placement.scene, placement.fixed)
                             : top.mapped.back()->in_embree(shapes.device),
                  id);
  }
  shapes.commit(top.scene);
  RTCBounds b;
  rtcGetSceneBounds(top.scene, &b);
  bounds_ = {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}};
  scene_ = top.scene;
  placements_ = top.placements.data();
  placement_count_ = static_cast<unsigned>(top.placements.size());
  first_placement_ = static_cast<unsigned>(shapes.in_world.size());
  farthest_origin_ = top.farthest_origin;
}

Bounds Geometry::swept_bounds(const PlacedGroup& placed, const Bounds& local) const {
  const Placement placement = make_placement(placed);
  const int steps = placement.movement != nullptr ? 64 : 0;
  Bounds swept;
  double farthest = 0;
  std::array<DVec3, 8> previous{};
  for (int step = 0; step <= steps; ++step) {
    const float s = static_cast<float>(step) / 64;
    std::optional<Affine> moved;
    const Affine& map = placement.at(lerp(s, shutter_open_, shutter_close_), moved);
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

RTCGeometry Geometry::TopLevel::MappedInstance::in_embree(RTCDevice device) const {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserData(geometry, const_cast<MappedInstance*>(this));
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryOccludedFunction(geometry, occluded);
  rtcCommitGeometry(geometry);
  return geometry;
}

void Geometry::TopLevel::MappedInstance::bounds_of(const RTCBoundsFunctionArguments* args) {
  const Bounds& b = static_cast<const MappedInstance*>(args->geometryUserPtr)->bounds;
  *args->bounds_o = {b.min.x, b.min.y, b.min.z, 0, b.max.x, b.max.y, b.max.z, 0};
}

RTCRay Geometry::TopLevel::MappedInstance::to_local(const RTCRay& ray) const {
  std::optional<Affine> moved;
  const Affine& map = placement->at(lerp(ray.time, shutter_open, shutter_close), moved);
  RTCRay local = embree::make_ray(Point(map.inverse_point(DVec3(origin_of(ray)))),
                                  Vec3(map.inverse_vector(DVec3(direction_of(ray)))), ray.tfar, ray.time);
  local.tnear = ray.tnear;
  return local;
}

void Geometry::TopLevel::MappedInstance::intersect(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& instance = *static_cast<const MappedInstance*>(args->geometryUserPtr);
  auto& query = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  RTCRayHit local;
  local.ray = instance.to_local(query.ray);
  local.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  local.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  if (!embree::is_valid(local.ray)) return;
  embree::intersect(instance.placement->scene, local);
  if (local.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
  query.ray.tfar = local.ray.tfar;
  query.hit = local.hit;
  query.hit.instID[0] = args->geomID;
}

void Geometry::TopLevel::MappedInstance::occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& instance = *static_cast<const MappedInstance*>(args->geometryUserPtr);
  auto& ray = *reinterpret_cast<RTCRay*>(args->ray);
  RTCRay local = instance.to_local(ray);
  if (!embree::is_valid(local)) return;
  embree::occluded(instance.placement->scene, local);
  if (local.tfar < 0) ray.tfar = -infinity;
}

SurfaceGeometry Geometry::evaluate_other(const GeometryHit& hit, const Ray& ray) const {
  const DVec3 o(ray.origin), d(ray.direction);
  const auto t = static_cast<double>(hit.t);
  if (hit.placement == nullptr) return evaluate_surface(*hit.record, {hit.primitive, hit.u, hit.v, o + t * d, d});
  std::optional<Affine> moved;
  const Affine& map = hit.placement->at(shutter_time(ray.time), moved);
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
  if (hit.record->wants_derivatives())
    for (Vec3* v : {&s.tangent, &s.dpdu, &s.dpdv}) *v = Vec3(map.vector(DVec3(*v)));
  return s;
}

float Geometry::rise_of_mesh(const GeometryHit& hit, const SurfaceGeometry& surface, const Ray& ray) const {
  std::optional<Affine> moved;
  const Affine* map = hit.placement == nullptr ? nullptr : &hit.placement->at(shutter_time(ray.time), moved);
  const Vec3 wi = map == nullptr ? -ray.direction : Vec3(map->inverse_vector(DVec3(-ray.direction)));
  const auto [normal, height] = rise_over_triangle(*hit.record, hit.primitive, hit.u, hit.v, wi);
  const double scale = map == nullptr ? 1.0 : 1 / glm::length(map->normal(DVec3(normal)));
  return std::copysign(height * static_cast<float>(scale), -dot(ray.direction, surface.normal));
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
  if (hit.placement == nullptr) return shapes_->in_world[index]->location;
  const std::uint32_t group = placed_group(static_cast<std::size_t>(hit.placement - placements_)).group;
  return shapes_->groups[group][index - hit.placement->first_record]->location;
}

std::uint64_t Geometry::bytes() const {
  std::uint64_t sum = records_.size() * sizeof(GeometryRecord);
  for (const auto& shape : shapes_->in_world) sum += shape->bytes();
  for (const auto& group : shapes_->groups)
    for (const auto& shape : group) sum += shape->bytes();
  return sum;
}

std::uint64_t Geometry::bvh_bytes() const { return static_cast<std::uint64_t>(shapes_->bvh_bytes.load()); }
const std::vector<std::unique_ptr<ShapeStore>>& Geometry::shapes() const { return shapes_->in_world; }
const std::vector<std::vector<std::unique_ptr<ShapeStore>>>& Geometry::groups() const { return shapes_->groups; }
const Bounds& Geometry::group_bounds(std::uint32_t group) const { return shapes_->group_bounds[group]; }
const PlacedGroup& Geometry::placed_group(std::size_t placement) const { return top_level_->placed[placement]; }

std::string version_of_embree() {
  const RTCDevice device = rtcNewDevice(nullptr);
  if (device == nullptr) throw Error("Embree cannot be started on this machine");
  const auto number = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION);
  rtcReleaseDevice(device);
  return std::to_string(number / 10000) + '.' + std::to_string(number / 100 % 100) + '.' + std::to_string(number % 100);
}

}  // namespace lanthorn
