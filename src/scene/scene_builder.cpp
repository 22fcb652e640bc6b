// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Builds a scene from its description.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "base/parallel.h"
#include "lanthorn/error.h"
#include "lanthorn/number_text.h"
#include "math/hash.h"
#include "scene/area_lights.h"
#include "scene/media.h"
#include "scene/medium_around.h"
#include "scene/scene_data.h"
#include "scene/scene_memory.h"
#include "scene/subsurface.h"
#include "scene/volume_lights.h"
#include "shape/curves.h"
#include "shape/displacement.h"

namespace lanthorn {

namespace {

const Transform identity;
const AnimatedTransform still_identity;

// True for shapes that cannot be stored in their surrounding space: shapes in motion, and curves under non-uniform
// scaling, because curves have circular cross-sections.
bool must_be_placed(const description::Shape& shape) {
  const AnimatedTransform& t = shape.object_to_world;
  return t.is_moving() || (std::holds_alternative<description::Curves>(shape.geometry) && !even_scale(t.start));
}

std::vector<std::unique_ptr<ShapeStore>> group_of(std::unique_ptr<ShapeStore> shape) {
  std::vector<std::unique_ptr<ShapeStore>> group;
  group.push_back(std::move(shape));
  return group;
}

class SceneBuilder {
 public:
  SceneBuilder(SceneData& data, const SceneData* like) : data_(data), like_(like) {}
  void build();

 private:
  void check_displacements() const;
  void load_textures_of_shapes();
  void add_shapes();
  void add_objects();
  void add_part(description::Shape& shape, const std::vector<description::Index>& instances);
  void add_lights();
  Light make_light(const description::Light& light);
  void count();
  bool is_visible(const description::Shape& shape) const;
  std::unique_ptr<ShapeStore> store(description::Shape& shape, const Transform& to_space);
  bool may_be_hidden(const GeometryRecord& record, const SourceLocation& location);
  void displace(description::Shape& shape);
  void settle_emission(description::Shape& shape);
  std::uint32_t add_emitter(EmittingShape emitter);
  std::uint32_t add_placed_emitter(const description::Shape& source, const Transform& to_world);
  void place(PlacedInstance placed);
  bool leave_out(const AnimatedTransform& outer, const AnimatedTransform& inner, const SourceLocation& location);
  void warn_of_left_out();
  void warn_of_motion(const AnimatedTransform& motion, const SourceLocation& location);
  void warn_of_distance(const Bounds& box, const SourceLocation& location);
  void note_coarse_steps(const Bounds& box, const SourceLocation& location);
  void warn_of_coarse_steps();
  float shutter_middle() const { return lanthorn::shutter_middle(data_.description); }

  SceneData& data_;
  const SceneData* like_;
  std::size_t left_out_ = 0;  // shapes and instances that cannot be placed
  SourceLocation first_left_out_;
  struct CoarseSteps {
    std::size_t count = 0;  // of shapes
    SourceLocation first;
    float size = 0, reach = 0, step = 0;  // of the first, metres
  };
  CoarseSteps coarse_;
};

void SceneBuilder::build() {
  const auto started = std::chrono::steady_clock::now();
  check_displacements();
  load_textures_of_shapes();
  data_.media = std::make_shared<const std::vector<Medium>>(make_media(data_.description, *data_.spectra));
  find_media_under_surfaces(data_);
  data_.has_emissive =
      std::any_of(data_.media->begin(), data_.media->end(), [](const Medium& m) { return is_emissive(m); });
  add_shapes();
  add_objects();
  warn_of_left_out();
  warn_of_coarse_steps();
  data_.geometry.commit();
  data_.sphere = bounding_sphere(data_.geometry.bounds());
  add_lights();
  data_.textures.require_readable();
  count();
  data_.statistics.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
}

// False for interfaces with the same medium on both sides.
bool SceneBuilder::is_visible(const description::Shape& shape) const {
  return !data_.materials.traits(shape.material).is_interface || shape.inside_medium != shape.outside_medium;
}

// In the shape's own space; empty for shapes without a mesh.
Bounds bounds_of_mesh(const description::Shape& shape) {
  Bounds box;
  const auto extend = [&](const std::vector<Point>& positions) {
    for (const Point& p : positions) box.extend(p);
  };
  if (const auto* triangles = std::get_if<description::TriangleMesh>(&shape.geometry)) extend(triangles->positions);
  if (const auto* patches = std::get_if<description::BilinearMesh>(&shape.geometry)) extend(patches->positions);
  return box;
}

std::unique_ptr<ShapeStore> SceneBuilder::store(description::Shape& shape, const Transform& to_space) {
  if (shape.material >= data_.materials.size()) throw Error(shape.location, "the shape's material does not exist");
  const MaterialTraits& traits = data_.materials.traits(shape.material);
  if (shape.displacement) displace(shape);
  note_coarse_steps(bounds_of_mesh(shape), shape.location);
  // The closure of hair includes the passage through it, so light must not meet the far side of a tube.
  auto* curves = std::get_if<description::Curves>(&shape.geometry);
  if (traits.is_hair && curves != nullptr && curves->kind == description::CurveKind::cylinder)
    curves->kind = description::CurveKind::flat;
  std::unique_ptr<ShapeStore> stored = make_shape_store(shape, to_space);
  stored->record.wants_tangents = traits.is_anisotropic || traits.has_relief || is_flat(stored->record);
  stored->record.wants_footprint = traits.has_levels;
  stored->record.is_interface = traits.is_interface;
  const std::optional<description::Index>& interior = traits.interior;
  stored->record.media = {medium_id(interior ? interior : shape.inside_medium), medium_id(shape.outside_medium)};
  data_.has_measured_spectra = data_.has_measured_spectra || traits.has_tables || traits.is_dispersive;
  data_.has_dispersion = data_.has_dispersion || traits.is_dispersive;
  data_.has_interfaces = data_.has_interfaces || traits.is_interface;
  stored->record.is_hidden = !shape.visible_to_camera && may_be_hidden(stored->record, shape.location);
  data_.has_hidden_shapes = data_.has_hidden_shapes || stored->record.is_hidden;
  stored->textures = &data_.textures;
  stored->alpha = data_.textures.without_opaque_image(data_.textures.compile(shape.alpha));
  stored->pane = shape.pane;
  stored->record.emits = shape.area_light.has_value();
  stored->record.wants_uv = traits.varies || traits.has_relief || stored->is_cut_out() || stored->record.emits;
  return stored;
}

// Rays that pass through a hidden shape stay in their medium.
bool SceneBuilder::may_be_hidden(const GeometryRecord& record, const SourceLocation& location) {
  if (!record.is_interface && !record.media.is_transition()) return true;
  warn_once(data_.description, location, "a shape that bounds media cannot be hidden from the camera: it is visible");
  return false;
}

void SceneBuilder::displace(description::Shape& shape) {
  const FloatInput height = data_.textures.compile(shape.displacement->height);
  auto* quads = std::get_if<description::BilinearMesh>(&shape.geometry);
  auto* triangles = std::get_if<description::TriangleMesh>(&shape.geometry);
  if (quads == nullptr && triangles == nullptr) return;
  shape.geometry = displaced(
      quads != nullptr ? triangulated(std::move(*quads)) : std::move(*triangles), shape.displacement->edge_length,
      shape.object_to_world.start, [&](const TexturePoint& at) { return data_.textures.evaluate(height, at); },
      shape.location);
  shape.displacement.reset();
}

void SceneBuilder::settle_emission(description::Shape& shape) {
  if (!shape.area_light) return;
  if (data_.materials.traits(shape.material).is_interface) {
    warn_once(data_.description, shape.location, "the emission of a shape with interface material is ignored");
    shape.area_light.reset();
  } else if (const auto* curves = std::get_if<description::Curves>(&shape.geometry)) {
    warn_once(data_.description, shape.location, "curves that emit become triangles, flat ones tubes of their width");
    check_curves(*curves, shape.location);
    shape.geometry = triangulated(*curves);
  }
}

std::uint32_t SceneBuilder::add_emitter(EmittingShape emitter) {
  const description::AreaLight& light = data_.description.area_lights.at(*emitter.source->area_light);
  const SpectrumInput radiance =
      data_.textures.compile(light.radiance, description::SpectrumRole::illuminant, light.location);
  std::vector<Light> added = make_area_lights(emitter, light, radiance, *data_.light_store);
  const SourceLocation& location = emitter.source->location;
  for (const Light& l : added) check_power(l, location);
  const auto first = static_cast<std::uint32_t>(data_.lights.size());
  emitter.first_light = first;
  data_.light_locations[first] = location;
  data_.light_media.insert(data_.light_media.end(), added.size(), emitter.shape->record.media);
  data_.emitters.push_back(emitter);
  data_.lights.insert(data_.lights.end(), std::make_move_iterator(added.begin()), std::make_move_iterator(added.end()));
  return first;
}

// Adds the lights of an emitting shape that is not stored in world space.
std::uint32_t SceneBuilder::add_placed_emitter(const description::Shape& source, const Transform& to_world) {
  description::Shape copy = source;
  std::unique_ptr<ShapeStore> posed = store(copy, to_world);
  const std::uint32_t first = add_emitter({posed.get(), &source, to_world, true});
  data_.posed_emitters.push_back(std::move(posed));
  return first;
}

bool SceneBuilder::leave_out(const AnimatedTransform& outer, const AnimatedTransform& inner,
                             const SourceLocation& location) {
  if (can_be_placed(outer, inner)) return false;
  if (left_out_++ == 0) first_left_out_ = location;
  return true;
}

void SceneBuilder::warn_of_left_out() {
  if (left_out_ == 0) return;
  warn_once(data_.description, first_left_out_,
            (left_out_ == 1 ? std::string("a shape or instance is")
                            : std::to_string(left_out_) + " shapes or instances, the first of them here, are") +
                " left out: the scale is 0 along some axis, or the transformation is singular in single precision");
}

void SceneBuilder::warn_of_motion(const AnimatedTransform& motion, const SourceLocation& location) {
  if (motion.is_moving())
    warn_once(data_.description, location, "a moving shape emits from its place in the middle of the shutter interval");
}

// Embree tests rays in single precision: curves and instances vanish at ten times this distance, everything at 10^18.
void SceneBuilder::warn_of_distance(const Bounds& box, const SourceLocation& location) {
  constexpr float farthest = 1e12f;
  const Vec3 reach = glm::max(abs(box.min), abs(box.max));
  if (!(reach.x <= farthest && reach.y <= farthest && reach.z <= farthest))
    warn_once(data_.description, location, "the shape reaches farther than 1e12 from the origin: rays may miss it");
}

// Notes shapes in which the steps of single precision show.
void SceneBuilder::note_coarse_steps(const Bounds& box, const SourceLocation& location) {
  if (box.empty()) return;
  const float size = max_component(box.extent()), reach = max_component(glm::max(abs(box.min), abs(box.max)));
  const float step = std::nextafter(reach, infinity) - reach;
  constexpr float fewest_steps = 256;
  if (!(size > 0 && size < fewest_steps * step)) return;
  if (coarse_.count == 0) coarse_ = {0, location, size, reach, step};
  ++coarse_.count;
}

void SceneBuilder::warn_of_coarse_steps() {
  if (coarse_.count == 0) return;
  warn_once(data_.description, coarse_.first,
            fmt::format("this shape{} has a size of {} m, but coordinates around {} m, which are rounded to "
                        "{:.1g} m: its surface and its shadows are rough. Model the scene nearer to the origin",
                        coarse_.count > 1 ? fmt::format(", the first of {} such,", coarse_.count) : "",
                        short_number(coarse_.size), short_number(coarse_.reach), coarse_.step));
}

void SceneBuilder::place(PlacedInstance placed) {
  data_.geometry.place(placed.placed);
  const Bounds& box = data_.geometry.group_bounds(placed.placed.group);
  const Bounds swept = data_.geometry.swept_bounds(placed.placed, box);
  warn_of_distance(swept, placed.location);
  note_coarse_steps(swept, placed.location);
  data_.placed.push_back(std::move(placed));
}

// Checked before any is made, because small files may ask for many triangles.
void SceneBuilder::check_displacements() const {
  constexpr double most_triangles = 1 << 26;
  const SceneDescription& scene = data_.description;
  std::vector<double> copies(scene.objects.size(), 1);  // shapes that emit are made anew for each instance
  for (const description::Instance& instance : scene.instances) ++copies.at(instance.object);
  double sum = 0;
  const auto add = [&](const description::Shape& shape, double times) {
    if (shape.displacement) sum += times * least_displaced_triangles(shape);
    if (sum > most_triangles)
      throw Error(shape.location, "the scene's displacements make more than 67 million triangles together");
  };
  for (const description::Shape& shape : scene.shapes) add(shape, 1);
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    for (const description::Shape& shape : scene.objects[i].shapes) add(shape, shape.area_light ? copies[i] : 1);
}

// Lights and alpha filters evaluate these textures while the scene is built.
void SceneBuilder::load_textures_of_shapes() {
  const auto note = [&](const description::Shape& shape) {
    data_.textures.compile(shape.alpha);
    if (shape.displacement) data_.textures.compile(shape.displacement->height);
    if (!shape.area_light) return;
    const description::AreaLight& light = data_.description.area_lights.at(*shape.area_light);
    data_.textures.compile(light.radiance, description::SpectrumRole::illuminant, light.location);
  };
  for (const description::Shape& shape : data_.description.shapes) note(shape);
  for (const description::Object& object : data_.description.objects)
    for (const description::Shape& shape : object.shapes) note(shape);
  data_.textures.load_images();
}

void SceneBuilder::add_shapes() {
  for (description::Shape& shape : data_.description.shapes) {
    settle_emission(shape);
    if (!is_visible(shape) || leave_out(shape.object_to_world, still_identity, shape.location)) continue;
    if (!must_be_placed(shape)) {
      const Transform& to_world = shape.object_to_world.start;
      std::unique_ptr<ShapeStore> stored = store(shape, to_world);
      if (shape.area_light) stored->record.first_light = add_emitter({stored.get(), &shape, to_world});
      warn_of_distance(stored->bounds(), shape.location);
      note_coarse_steps(stored->bounds(), shape.location);
      data_.geometry.add(std::move(stored));
      continue;
    }
    std::uint32_t first_light = 0;
    if (shape.area_light) {
      warn_of_motion(shape.object_to_world, shape.location);
      first_light = add_placed_emitter(shape, shape.object_to_world.at(shutter_middle()));
    }
    const std::uint32_t group = data_.geometry.add_group(group_of(store(shape, identity)));
    place({{group, shape.object_to_world, still_identity, first_light},
           {},
           shape.area_light.has_value(),
           shape.location});
  }
}

// Each object becomes one group of its fixed, non-emitting shapes, and one group for each other shape.
void SceneBuilder::add_objects() {
  std::vector<std::vector<description::Index>> instances(data_.description.objects.size());
  for (std::size_t i = 0; i < data_.description.instances.size(); ++i) {
    const description::Instance& instance = data_.description.instances[i];
    if (!leave_out(instance.object_to_world, still_identity, instance.location))
      instances.at(instance.object).push_back(static_cast<description::Index>(i));
  }
  for (std::size_t i = 0; i < data_.description.objects.size(); ++i) {
    std::vector<std::unique_ptr<ShapeStore>> still;
    for (description::Shape& shape : data_.description.objects[i].shapes) {
      settle_emission(shape);
      if (!is_visible(shape) || leave_out(shape.object_to_world, still_identity, shape.location)) continue;
      if (must_be_placed(shape) || shape.area_light)
        add_part(shape, instances[i]);
      else
        still.push_back(store(shape, shape.object_to_world.start));
    }
    if (still.empty()) continue;
    const std::uint32_t group = data_.geometry.add_group(std::move(still));
    for (const description::Index i_instance : instances[i]) {
      const description::Instance& instance = data_.description.instances[i_instance];
      place({{group, instance.object_to_world, still_identity}, i_instance, false, instance.location});
    }
  }
}

// Adds a shape of an object that needs its own placement, or its own lights in each instance.
void SceneBuilder::add_part(description::Shape& shape, const std::vector<description::Index>& instances) {
  std::vector<PlacedInstance> placed;
  for (const description::Index i : instances) {
    const description::Instance& instance = data_.description.instances[i];
    const AnimatedTransform& to_world = instance.object_to_world;
    if (leave_out(to_world, shape.object_to_world, instance.location)) continue;
    std::uint32_t first_light = 0;
    if (shape.area_light) {
      warn_of_motion(to_world, shape.location);
      warn_of_motion(shape.object_to_world, shape.location);
      const float time = shutter_middle();
      first_light = add_placed_emitter(shape, to_world.at(time) * shape.object_to_world.at(time));
    }
    placed.push_back(
        {{0, to_world, shape.object_to_world, first_light}, i, shape.area_light.has_value(), instance.location});
  }
  const std::uint32_t group = data_.geometry.add_group(group_of(store(shape, identity)));
  for (PlacedInstance& instance : placed) {
    instance.placed.group = group;
    place(std::move(instance));
  }
}

Light SceneBuilder::make_light(const description::Light& light) {
  if (like_ != nullptr)
    if (std::optional<Light> shared = make_from(*like_, light, data_.sphere)) {
      // The image belongs to that scene, or to one from which that scene has it.
      data_.kept = like_->kept;
      if (!like_->light_store->spherical_images.empty()) data_.kept.push_back(like_->light_store);
      return *shared;
    }
  return lanthorn::make_light(light, data_.description.access, data_.sphere, *data_.spectra,
                              data_.description.color_space, *data_.light_store, data_.description.warnings);
}

void SceneBuilder::add_lights() {
  for (const description::Light& light : data_.description.lights) {
    data_.lights.push_back(make_light(light));
    check_power(data_.lights.back(), light.location);
    data_.light_locations[static_cast<std::uint32_t>(data_.lights.size() - 1)] = light.location;
  }
  make_volume_lights(data_, shutter_middle());
  index_lights(data_);
}

void SceneBuilder::count() {
  const auto add = [&](const ShapeStore& shape) {
    if (!shape.patches.empty())
      data_.statistics.patches += shape.patches.size();
    else if (shape.record.kind == GeometryRecord::Kind::triangles)
      data_.statistics.triangles += shape.triangles.size();
    else if (shape.record.kind == GeometryRecord::Kind::curves)
      data_.statistics.curves += shape.curves.segments.size() / shape.curves.pieces;
    else
      ++data_.statistics.quadrics;
  };
  for (const auto& shape : data_.geometry.shapes()) add(*shape);
  for (const auto& group : data_.geometry.groups())
    for (const auto& shape : group) add(*shape);
  data_.statistics.instances = data_.description.instances.size();
  data_.statistics.materials = data_.materials.size();
  data_.statistics.textures = data_.description.float_textures.size() + data_.description.spectrum_textures.size();
  data_.statistics.lights = data_.lights.size();
  data_.statistics.geometry_bytes = data_.geometry.bytes();
  data_.statistics.bvh_bytes = data_.geometry.bvh_bytes();
  data_.statistics.texture_bytes = data_.textures.bytes();
  data_.statistics.texture_disk_bytes = data_.textures.disk_bytes();
}

}  // namespace

SceneData::SceneData(SceneDescription&& source, const SceneData* loaded, Geometry own_geometry)
    : description(std::move(source)),
      textures(description, *spectra, loaded != nullptr ? &loaded->textures : nullptr),
      materials(description, textures, *spectra, description.warnings,
                loaded != nullptr ? &loaded->materials : nullptr),
      geometry(std::move(own_geometry)) {}

std::shared_ptr<const SceneData> build(SceneDescription&& description, const SceneData* like) {
  require_scene_memory(description);  // before images are read
  const description::Camera& camera = description.view.camera;
  Geometry geometry(camera.shutter_open, camera.shutter_close);
  const auto data = std::make_shared<SceneData>(std::move(description), like, std::move(geometry));
  SceneBuilder(*data, like).build();
  std::vector<description::Index> lights(data->description.lights.size());
  std::iota(lights.begin(), lights.end(), description::Index{0});
  settle_light_media(data, lights);
  return data;
}

const SourceLocation& SceneData::light_location(std::uint32_t light) const {
  return std::prev(light_locations.upper_bound(light))->second;
}

float shutter_middle(const SceneDescription& description) {
  const description::Camera& camera = description.view.camera;
  return lerp(0.5f, camera.shutter_open, std::max(camera.shutter_open, camera.shutter_close));
}

void warn_once(SceneDescription& description, const SourceLocation& location, const std::string& message) {
  const bool known = std::any_of(description.warnings.begin(), description.warnings.end(),
                                 [&](const description::Warning& w) { return w.message == message; });
  if (!known) description.warnings.push_back({location, message});
}

// Products of light with densities and areas must stay below the largest float, 3e38.
void check_power(const Light& light, const SourceLocation& location) {
  constexpr float most = 1e32f;  // the sun's is 4e26
  if (!(power(light) <= most))
    throw Error(location, "the light's power exceeds 1e32 W: it is too bright, or it or the scene is too large");
}

void check_radiance(float radiance, const SourceLocation& location) {
  constexpr float most = 1e25f;  // the sun's is 2e7
  if (!(radiance <= most))
    throw Error(location,
                "the emission is too bright: its radiance, or that of a white surface near the light, exceeds 1e25 "
                "W/(m² sr)");
}

BoundingSphere bounding_sphere(const Bounds& box) {
  if (box.empty()) return {};
  return {box.centre(), std::sqrt(distance_squared(box.centre(), box.max))};
}

namespace {

// The least distance at which `count` rays from a light without extent meet something. The scene's radius is no measure
// for it: a lamp may hang above a table in a landscape. Distances below 2^-16 of the radius are raised to that, so that
// a lamp that touches its holder does not push the rest, 2^32 times darker, below the film's resolution.
float distance_lit(const SceneData& data, const Light& light, HashRng rng, std::size_t count) {
  float nearest = data.sphere.radius;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 u_position = rng.next2(), u_direction = rng.next2();
    const std::optional<EmissionSample> s = sample_emission(light, u_position, u_direction, Wavelengths::rgb(0.5f));
    if (!s) continue;
    if (const auto hit = data.geometry.intersect({s->origin, s->direction, nearest})) nearest = hit->t;
  }
  return std::max(nearest, 0x1p-16f * data.sphere.radius);
}

}  // namespace

float find_largest_radiance(const SceneData& data) {
  constexpr std::size_t chunk = 4096, most_rays = std::size_t{1} << 18;
  const std::size_t rays =
      std::clamp<std::size_t>(most_rays / std::max<std::size_t>(1, data.lights.size()), 1, 64);  // of a light
  struct Brightest {
    float radiance = 0;
    std::uint32_t light = 0;
  };
  std::vector<Brightest> of_chunks((data.lights.size() + chunk - 1) / chunk);
  parallel_chunks(data.lights.size(), chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Light& light = data.lights[i];
      const float distance = is_point(light) ? distance_lit(data, light, HashRng(i), rays) : 0;
      const float radiance = largest_radiance(light, distance);
      if (radiance > of_chunks[c].radiance) of_chunks[c] = {radiance, static_cast<std::uint32_t>(i)};
    }
  });
  Brightest brightest;
  for (const Brightest& b : of_chunks)
    if (b.radiance > brightest.radiance) brightest = b;
  if (brightest.radiance > 0) check_radiance(brightest.radiance, data.light_location(brightest.light));
  return brightest.radiance;
}

std::optional<Light> make_from(const SceneData& scene, const description::Light& light, const BoundingSphere& bounds) {
  const std::size_t first = scene.first_described_light();
  for (std::size_t i = 0; i < scene.description.lights.size(); ++i)
    if (auto made = make_from({scene.description.lights[i], scene.lights[first + i]}, light, bounds)) return made;
  return {};
}

void index_lights(SceneData& data) {
  data.infinite_lights.clear();
  for (std::size_t i = 0; i < data.lights.size(); ++i)
    if (is_infinite(data.lights[i])) data.infinite_lights.push_back(static_cast<std::uint32_t>(i));
  data.largest_radiance = find_largest_radiance(data);
  data.light_bvh = LightBvh(data.lights);
  if (std::any_of(data.media->begin(), data.media->end(), [](const Medium& m) { return scatters(m); }))
    data.ray_lights = RayLights(data.lights);
}

}  // namespace lanthorn
