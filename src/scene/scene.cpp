// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <map>
#include <string>

#include "scene/area_lights.h"
#include "scene/geometry.h"
#include "scene/lights.h"
#include "scene/media.h"
#include "scene/obstacles.h"
#include "shape/curves.h"
#include "shape/displacement.h"

namespace lanthorn {

struct Scene::Impl {
  SceneDescription description;
  SpectrumStore spectra;
  TextureGraph textures;
  MaterialTable materials;
  Geometry geometry;
  std::vector<Medium> media;
  LightStore light_store;
  std::vector<std::unique_ptr<ShapeStore>> posed_emitters;  // in world space, for patterns of placed shapes
  std::vector<Light> lights;
  std::vector<MediumInterface> light_media;                        // media around each light, by index
  std::map<std::uint32_t, const SourceLocation*> light_locations;  // by the index of the first light described there
  std::vector<std::uint32_t> infinite_lights;
  LightBvh light_bvh;
  BoundingSphere sphere;
  float largest_radiance = 0;
  bool has_measured_spectra = false, has_dispersion = false, has_emissive = false;
  SceneStatistics statistics;
  std::size_t left_out = 0;  // shapes and instances that cannot be placed
  SourceLocation first_left_out;

  explicit Impl(SceneDescription&& source);

 private:
  void load_textures_of_shapes();
  void add_shapes();
  void add_objects();
  void add_part(description::Shape& shape, const std::vector<const description::Instance*>& instances);
  void add_lights();
  void count();
  bool is_visible(const description::Shape& shape) const;
  std::unique_ptr<ShapeStore> store(description::Shape& shape, const Transform& to_space);
  void displace(description::Shape& shape);
  void settle_emission(description::Shape& shape);
  std::uint32_t add_emitter(const ShapeStore& shape, const description::Shape& source, const Transform& to_world);
  std::uint32_t add_placed_emitter(const description::Shape& source, const Transform& to_world);
  void place(std::uint32_t group, const AnimatedTransform& outer, const AnimatedTransform& inner,
             const SourceLocation& location, std::uint32_t first_light = 0);
  bool leave_out(const AnimatedTransform& outer, const AnimatedTransform& inner, const SourceLocation& location);
  void warn_of_left_out();
  void warn_of_motion(const AnimatedTransform& motion, const SourceLocation& location);
  void warn_of_distance(const Bounds& box, const SourceLocation& location);
  void warn_once(const SourceLocation& location, const std::string& message);
  // Middle of the shutter interval in the scene's description.
  float shutter_middle() const {
    return lerp(0.5f, description.view.camera.shutter_open,
                std::max(description.view.camera.shutter_open, description.view.camera.shutter_close));
  }
};

namespace {

const Transform identity;
const AnimatedTransform still_identity;

// True for shapes that cannot be stored in their surrounding space: shapes in motion, and curves under non-uniform
// scaling, because curves have circular cross-sections.
bool must_be_placed(const description::Shape& shape) {
  const AnimatedTransform& t = shape.object_to_world;
  return t.is_moving() || (std::holds_alternative<description::Curves>(shape.geometry) && !even_scale(t.start));
}

bool is_flat(const GeometryRecord& record) {
  return record.kind == GeometryRecord::Kind::curves && record.curves->kind == description::CurveKind::flat;
}

// Lights are chosen in proportion to their power, so each power must be finite.
void check_power(const Light& light, const SourceLocation& location) {
  if (!std::isfinite(power(light)))
    throw Error(location, "the light's power is not finite: it is too bright, or it or the scene is too large");
}

// At degenerate points, the position or normal may exceed single precision; such hits are ignored.
bool is_finite(const SurfaceGeometry& s) {
  const Vec3 sum = s.position + s.normal + s.shading_normal;
  return std::isfinite(sum.x + sum.y + sum.z) && std::isfinite(s.uv.x + s.uv.y);
}

std::vector<std::unique_ptr<ShapeStore>> group_of(std::unique_ptr<ShapeStore> shape) {
  std::vector<std::unique_ptr<ShapeStore>> group;
  group.push_back(std::move(shape));
  return group;
}

}  // namespace

Scene::Impl::Impl(SceneDescription&& source)
    : description(std::move(source)),
      textures(description, spectra),
      materials(description, textures, spectra, description.warnings),
      geometry(description.view.camera.shutter_open, description.view.camera.shutter_close) {
  const auto started = std::chrono::steady_clock::now();
  load_textures_of_shapes();
  media = make_media(description, spectra);
  has_emissive = std::any_of(media.begin(), media.end(), [](const Medium& m) { return is_emissive(m); });
  add_shapes();
  add_objects();
  warn_of_left_out();
  geometry.commit();
  const Bounds& box = geometry.bounds();
  if (!box.empty()) {
    sphere.centre = box.centre();
    sphere.radius = std::sqrt(distance_squared(sphere.centre, box.max));
  }
  add_lights();
  count();
  statistics.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
}

void Scene::Impl::warn_once(const SourceLocation& location, const std::string& message) {
  const bool known = std::any_of(description.warnings.begin(), description.warnings.end(),
                                 [&](const description::Warning& w) { return w.message == message; });
  if (!known) description.warnings.push_back({location, message});
}

// False for interfaces with the same medium on both sides.
bool Scene::Impl::is_visible(const description::Shape& shape) const {
  return !materials.traits(shape.material).is_interface || shape.inside_medium != shape.outside_medium;
}

std::unique_ptr<ShapeStore> Scene::Impl::store(description::Shape& shape, const Transform& to_space) {
  if (shape.material >= materials.size()) throw Error(shape.location, "the shape's material does not exist");
  const MaterialTable::Traits& traits = materials.traits(shape.material);
  if (shape.displacement) displace(shape);
  // The closure of hair includes the passage through it, so light must not meet the far side of a tube.
  auto* curves = std::get_if<description::Curves>(&shape.geometry);
  if (traits.is_hair && curves != nullptr && curves->kind == description::CurveKind::cylinder)
    curves->kind = description::CurveKind::flat;
  std::unique_ptr<ShapeStore> stored = make_shape_store(shape, to_space);
  stored->record.wants_tangents = traits.is_anisotropic || traits.has_relief;
  stored->record.is_interface = traits.is_interface;
  const std::optional<description::Index>& interior = traits.interior;
  stored->record.media = {medium_id(interior ? interior : shape.inside_medium), medium_id(shape.outside_medium)};
  has_measured_spectra = has_measured_spectra || traits.has_tables || traits.is_dispersive;
  has_dispersion = has_dispersion || traits.is_dispersive;
  stored->textures = &textures;
  stored->alpha = textures.compile(shape.alpha);
  stored->record.emits = shape.area_light.has_value();
  return stored;
}

void Scene::Impl::displace(description::Shape& shape) {
  const FloatInput height = textures.compile(shape.displacement->height);
  auto* quads = std::get_if<description::BilinearMesh>(&shape.geometry);
  auto* triangles = std::get_if<description::TriangleMesh>(&shape.geometry);
  if (quads == nullptr && triangles == nullptr) return;
  shape.geometry = displaced(
      quads != nullptr ? triangulated(std::move(*quads)) : std::move(*triangles), shape.displacement->edge_length,
      shape.object_to_world.start, [&](const TexturePoint& at) { return textures.evaluate(height, at); },
      shape.location);
  shape.displacement.reset();
}

void Scene::Impl::settle_emission(description::Shape& shape) {
  if (!shape.area_light) return;
  if (materials.traits(shape.material).is_interface) {
    warn_once(shape.location, "the emission of a shape with interface material is ignored");
    shape.area_light.reset();
  } else if (const auto* curves = std::get_if<description::Curves>(&shape.geometry)) {
    warn_once(shape.location, "curves that emit become triangles, flat ones tubes of their width");
    check_curves(*curves, shape.location);
    shape.geometry = triangulated(*curves);
    shape.shares_power = true;
  }
}

std::uint32_t Scene::Impl::add_emitter(const ShapeStore& shape, const description::Shape& source,
                                       const Transform& to_world) {
  const description::AreaLight& light = description.area_lights.at(*source.area_light);
  const SpectrumInput radiance =
      textures.compile(light.radiance, description::SpectrumRole::illuminant, light.location);
  std::vector<Light> added = make_area_lights(shape, source, light, radiance, to_world, light_store);
  for (const Light& l : added) check_power(l, source.location);
  const auto first = static_cast<std::uint32_t>(lights.size());
  light_locations[first] = &source.location;
  light_media.insert(light_media.end(), added.size(), shape.record.media);
  lights.insert(lights.end(), std::make_move_iterator(added.begin()), std::make_move_iterator(added.end()));
  return first;
}

// Adds the lights of an emitting shape that is not stored in world space.
std::uint32_t Scene::Impl::add_placed_emitter(const description::Shape& source, const Transform& to_world) {
  description::Shape copy = source;
  std::unique_ptr<ShapeStore> posed = store(copy, to_world);
  const std::uint32_t first = add_emitter(*posed, source, to_world);
  posed_emitters.push_back(std::move(posed));
  return first;
}

bool Scene::Impl::leave_out(const AnimatedTransform& outer, const AnimatedTransform& inner,
                            const SourceLocation& location) {
  if (can_be_placed(outer, inner)) return false;
  if (left_out++ == 0) first_left_out = location;
  return true;
}

void Scene::Impl::warn_of_left_out() {
  if (left_out == 0) return;
  warn_once(first_left_out,
            (left_out == 1 ? std::string("a shape or instance is")
                           : std::to_string(left_out) + " shapes or instances, the first of them here, are") +
                " left out: the scale is 0 along some axis, or the transformation is singular in single precision");
}

void Scene::Impl::warn_of_motion(const AnimatedTransform& motion, const SourceLocation& location) {
  if (motion.is_moving())
    warn_once(location, "a moving shape that emits is lit from where it is in the middle of the shutter interval");
}

// Embree tests rays in single precision: curves and instances vanish at ten times this distance, everything at 10^18.
void Scene::Impl::warn_of_distance(const Bounds& box, const SourceLocation& location) {
  constexpr float farthest = 1e12f;
  const Vec3 reach = glm::max(abs(box.min), abs(box.max));
  if (!(reach.x <= farthest && reach.y <= farthest && reach.z <= farthest))
    warn_once(location, "the shape reaches farther than 1e12 from the origin: rays may miss it");
}

void Scene::Impl::place(std::uint32_t group, const AnimatedTransform& outer, const AnimatedTransform& inner,
                        const SourceLocation& location, std::uint32_t first_light) {
  geometry.place(group, outer, inner, first_light);
  warn_of_distance(geometry.swept_bounds(geometry.placement_count() - 1, geometry.group_bounds(group)), location);
}

// Lights and alpha filters evaluate these textures while the scene is built.
void Scene::Impl::load_textures_of_shapes() {
  const auto note = [&](const description::Shape& shape) {
    textures.compile(shape.alpha);
    if (shape.displacement) textures.compile(shape.displacement->height);
    if (!shape.area_light) return;
    const description::AreaLight& light = description.area_lights.at(*shape.area_light);
    textures.compile(light.radiance, description::SpectrumRole::illuminant, light.location);
  };
  for (const description::Shape& shape : description.shapes) note(shape);
  for (const description::Object& object : description.objects)
    for (const description::Shape& shape : object.shapes) note(shape);
  textures.load_images();
}

void Scene::Impl::add_shapes() {
  for (description::Shape& shape : description.shapes) {
    settle_emission(shape);
    if (!is_visible(shape) || leave_out(shape.object_to_world, still_identity, shape.location)) continue;
    if (!must_be_placed(shape)) {
      const Transform& to_world = shape.object_to_world.start;
      std::unique_ptr<ShapeStore> stored = store(shape, to_world);
      if (shape.area_light) stored->record.first_light = add_emitter(*stored, shape, to_world);
      warn_of_distance(stored->bounds(), shape.location);
      geometry.add(std::move(stored));
      continue;
    }
    std::uint32_t first_light = 0;
    if (shape.area_light) {
      warn_of_motion(shape.object_to_world, shape.location);
      first_light = add_placed_emitter(shape, shape.object_to_world.at(shutter_middle()));
    }
    place(geometry.add_group(group_of(store(shape, identity))), shape.object_to_world, still_identity, shape.location,
          first_light);
  }
}

// Each object becomes one group of its fixed, non-emitting shapes, and one group for each other shape.
void Scene::Impl::add_objects() {
  std::vector<std::vector<const description::Instance*>> instances(description.objects.size());
  for (const description::Instance& instance : description.instances)
    if (!leave_out(instance.object_to_world, still_identity, instance.location))
      instances.at(instance.object).push_back(&instance);
  for (std::size_t i = 0; i < description.objects.size(); ++i) {
    std::vector<std::unique_ptr<ShapeStore>> still;
    for (description::Shape& shape : description.objects[i].shapes) {
      settle_emission(shape);
      if (!is_visible(shape) || leave_out(shape.object_to_world, still_identity, shape.location)) continue;
      if (must_be_placed(shape) || shape.area_light)
        add_part(shape, instances[i]);
      else
        still.push_back(store(shape, shape.object_to_world.start));
    }
    if (still.empty()) continue;
    const std::uint32_t group = geometry.add_group(std::move(still));
    for (const description::Instance* instance : instances[i])
      place(group, instance->object_to_world, still_identity, instance->location);
  }
}

// Adds a shape of an object that needs its own placement, or its own lights in each instance.
void Scene::Impl::add_part(description::Shape& shape, const std::vector<const description::Instance*>& instances) {
  std::vector<const description::Instance*> placed;
  std::copy_if(instances.begin(), instances.end(), std::back_inserter(placed), [&](const auto* instance) {
    return !leave_out(instance->object_to_world, shape.object_to_world, instance->location);
  });
  std::vector<std::uint32_t> first_lights(placed.size());
  for (std::size_t i = 0; shape.area_light && i < placed.size(); ++i) {
    const AnimatedTransform& to_world = placed[i]->object_to_world;
    warn_of_motion(to_world, shape.location);
    warn_of_motion(shape.object_to_world, shape.location);
    const float time = shutter_middle();
    first_lights[i] = add_placed_emitter(shape, to_world.at(time) * shape.object_to_world.at(time));
  }
  const std::uint32_t group = geometry.add_group(group_of(store(shape, identity)));
  for (std::size_t i = 0; i < placed.size(); ++i)
    place(group, placed[i]->object_to_world, shape.object_to_world, placed[i]->location, first_lights[i]);
}

void Scene::Impl::add_lights() {
  for (const description::Light& light : description.lights) {
    lights.push_back(make_light(light, description.access, sphere, spectra, description.color_space, light_store,
                                description.warnings));
    check_power(lights.back(), light.location);
    light_locations[static_cast<std::uint32_t>(lights.size() - 1)] = &light.location;
    // Light from infinitely far away has travelled through vacuum.
    const MediumId medium = is_infinite(lights.back()) ? MediumId::vacuum : medium_id(light.medium);
    light_media.push_back({medium, medium});
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (is_infinite(lights[i])) infinite_lights.push_back(static_cast<std::uint32_t>(i));
    largest_radiance = std::max(largest_radiance, lanthorn::largest_radiance(lights[i], sphere));
  }
  light_bvh = LightBvh(lights);
}

void Scene::Impl::count() {
  const auto add = [&](const ShapeStore& shape) {
    if (!shape.patches.empty())
      statistics.patches += shape.patches.size();
    else if (shape.record.kind == GeometryRecord::Kind::triangles)
      statistics.triangles += shape.triangles.size();
    else if (shape.record.kind == GeometryRecord::Kind::curves)
      statistics.curves += shape.curves.segments.size() / shape.curves.pieces;
    else
      ++statistics.quadrics;
  };
  for (const auto& shape : geometry.shapes()) add(*shape);
  for (const auto& group : geometry.groups())
    for (const auto& shape : group) add(*shape);
  statistics.instances = description.instances.size();
  statistics.materials = materials.size();
  statistics.textures = description.float_textures.size() + description.spectrum_textures.size();
  statistics.lights = lights.size();
  statistics.geometry_bytes = geometry.bytes();
  statistics.bvh_bytes = geometry.bvh_bytes();
  statistics.texture_bytes = textures.bytes();
}

Scene::Scene(SceneDescription description) : impl_(std::make_unique<Impl>(std::move(description))) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

std::optional<SurfacePoint> Scene::intersect(const Ray& ray, const Wavelengths& w) const {
  std::optional<SurfacePoint> result;
  const std::optional<GeometryHit> hit = impl_->geometry.intersect(ray);
  if (!hit) return result;
  const SurfaceGeometry surface = impl_->geometry.evaluate(*hit, ray);
  if (!is_finite(surface)) return result;
  const GeometryRecord& record = *hit->record;
  SurfacePoint& p = result.emplace();
  p.position = surface.position;
  p.position_error = surface.error;
  p.normal = surface.normal;
  p.uv = surface.uv;
  p.media = record.media;
  p.is_interface = record.is_interface;
  if (!record.is_interface) {
    const TexturePoint at{surface.position, surface.normal, surface.uv};
    const std::uint32_t material = impl_->materials.resolve(record.material, at, -ray.direction);
    p.shading =
        record.wants_tangents ? impl_->materials.shading_frame(material, surface, at) : Frame(surface.shading_normal);
    p.bsdf = impl_->materials.evaluate(material, at, w);
    p.is_hair = is_flat(record) && is_fibre(p.bsdf);
  }
  if (record.emits) p.light = hit->light();
  p.time = ray.time;
  return result;
}

bool Scene::visible(const Ray& ray) const { return !impl_->geometry.occluded(ray); }

const std::vector<Light>& Scene::lights() const { return impl_->lights; }
const LightBvh& Scene::light_bvh() const { return impl_->light_bvh; }
const std::vector<std::uint32_t>& Scene::infinite_lights() const { return impl_->infinite_lights; }
std::vector<Obstacle> Scene::obstacles() const { return find_obstacles(impl_->geometry, impl_->materials); }
const Bounds& Scene::bounds() const { return impl_->geometry.bounds(); }
BoundingSphere Scene::bounding_sphere() const { return impl_->sphere; }
float Scene::largest_radiance() const { return impl_->largest_radiance; }
bool Scene::has_measured_spectra() const { return impl_->has_measured_spectra; }
bool Scene::has_dispersion() const { return impl_->has_dispersion; }
bool Scene::has_motion() const { return impl_->geometry.moves(); }
bool Scene::has_media() const { return !impl_->media.empty(); }
bool Scene::has_scattering_media() const {
  return has_media() &&
         std::any_of(impl_->media.begin(), impl_->media.end(), [](const Medium& m) { return scatters(m); });
}
bool Scene::has_emissive_media() const { return impl_->has_emissive; }
const Medium& Scene::medium(MediumId id) const { return impl_->media[static_cast<std::size_t>(id) - 1]; }
MediumInterface Scene::light_media(std::uint32_t light) const { return impl_->light_media[light]; }
std::optional<SourceLocation> Scene::locate(const Ray& ray) const {
  const std::optional<GeometryHit> hit = impl_->geometry.intersect(ray);
  return hit ? std::optional(impl_->geometry.location(*hit)) : std::nullopt;
}
const SourceLocation& Scene::light_location(std::uint32_t light) const {
  return *std::prev(impl_->light_locations.upper_bound(light))->second;
}
const SceneStatistics& Scene::statistics() const { return impl_->statistics; }
const std::vector<description::Warning>& Scene::warnings() const { return impl_->description.warnings; }
const SceneDescription& Scene::description() const { return impl_->description; }

}  // namespace lanthorn
