// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Stores the shapes of a description in the ray tracer.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "scene/scene_data.h"
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

class ShapeBuilder {
 public:
  ShapeBuilder(SceneData& data, const std::shared_ptr<MaterialPart>& materials)
      : data_(data),
        scene_(data.description),
        materials_(*materials),
        shapes_(data.description.shapes.take()),
        objects_(data.description.objects.take()),
        geometry_(scene_.view.camera.shutter_open, scene_.view.camera.shutter_close) {
    part_.materials = materials;
  }
  void build();

 private:
  void check_displacements() const;
  void load_textures() const;
  void add_shapes();
  void add_objects();
  void add_part(description::Shape& shape, const std::vector<description::Index>& instances);
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
  void warn(const SourceLocation& location, const std::string& message) {
    warn_once(part_.warnings, location, message);
  }
  void warn_of_left_out();
  void warn_of_motion(const AnimatedTransform& motion, const SourceLocation& location);
  void warn_of_distance(const Bounds& box, const SourceLocation& location);
  void note_coarse_steps(const Bounds& box, const SourceLocation& location);
  void warn_of_coarse_steps();

  SceneData& data_;
  const SceneDescription& scene_;
  MaterialPart& materials_;
  std::vector<description::Shape>& shapes_;    // of the description
  std::vector<description::Object>& objects_;  // of the description
  ShapePart part_;
  Geometry geometry_;
  std::vector<PlacedInstance> placed_;
  std::size_t left_out_ = 0;  // shapes and instances that cannot be placed
  SourceLocation first_left_out_;
  struct CoarseSteps {
    std::size_t count = 0;  // of shapes
    SourceLocation first;
    float size = 0, reach = 0, step = 0;  // of the first, metres
  };
  CoarseSteps coarse_;
};

void ShapeBuilder::build() {
  check_displacements();
  load_textures();
  add_shapes();
  add_objects();
  warn_of_left_out();
  warn_of_coarse_steps();
  geometry_.commit();
  count();
  data_.shapes = std::make_shared<const ShapePart>(std::move(part_));
  data_.placed = std::make_shared<const std::vector<PlacedInstance>>(std::move(placed_));
  data_.geometry = std::make_shared<const Geometry>(std::move(geometry_));
}

// False for interfaces with the same medium on both sides.
bool ShapeBuilder::is_visible(const description::Shape& shape) const {
  return !materials_.table.traits(shape.material).is_interface || shape.inside_medium != shape.outside_medium;
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

std::unique_ptr<ShapeStore> ShapeBuilder::store(description::Shape& shape, const Transform& to_space) {
  if (shape.material >= materials_.table.size()) throw Error(shape.location, "the shape's material does not exist");
  const MaterialTraits& traits = materials_.table.traits(shape.material);
  if (shape.displacement) displace(shape);
  note_coarse_steps(bounds_of_mesh(shape), shape.location);
  // The closure of hair includes the passage through it, so light must not meet the far side of a tube.
  auto* curves = std::get_if<description::Curves>(&shape.geometry);
  if (traits.is_hair && curves != nullptr && curves->kind == description::CurveKind::cylinder)
    curves->kind = description::CurveKind::flat;
  std::unique_ptr<ShapeStore> stored = make_shape_store(shape, to_space);
  note_traits(stored->record, traits);
  stored->record.is_interface = traits.is_interface;
  const std::optional<description::Index>& interior = traits.interior;
  stored->record.media = {medium_id(interior ? interior : shape.inside_medium), medium_id(shape.outside_medium)};
  part_.has_interfaces = part_.has_interfaces || traits.is_interface;
  stored->record.is_hidden = !shape.visible_to_camera && may_be_hidden(stored->record, shape.location);
  part_.has_hidden_shapes = part_.has_hidden_shapes || stored->record.is_hidden;
  stored->textures = &materials_.textures;
  stored->alpha = materials_.textures.without_opaque_image(materials_.textures.compile(shape.alpha));
  stored->pane = shape.pane;
  stored->record.emits = shape.area_light.has_value();
  stored->record.wants_uv = stored->record.wants_uv || stored->is_cut_out() || stored->record.emits;
  return stored;
}

// Rays that pass through a hidden shape stay in their medium.
bool ShapeBuilder::may_be_hidden(const GeometryRecord& record, const SourceLocation& location) {
  if (!record.is_interface && !record.media.is_transition()) return true;
  warn(location, "a shape that bounds media cannot be hidden from the camera: it is visible");
  return false;
}

void ShapeBuilder::displace(description::Shape& shape) {
  const FloatInput height = materials_.textures.compile(shape.displacement->height);
  auto* quads = std::get_if<description::BilinearMesh>(&shape.geometry);
  auto* triangles = std::get_if<description::TriangleMesh>(&shape.geometry);
  if (quads == nullptr && triangles == nullptr) return;
  shape.geometry = displaced(
      quads != nullptr ? triangulated(std::move(*quads)) : std::move(*triangles), shape.displacement->edge_length,
      shape.object_to_world.start, [&](const TexturePoint& at) { return materials_.textures.evaluate(height, at); },
      shape.location);
  shape.displacement.reset();
}

void ShapeBuilder::settle_emission(description::Shape& shape) {
  if (!shape.area_light) return;
  if (materials_.table.traits(shape.material).is_interface) {
    warn(shape.location, "the emission of a shape with interface material is ignored");
    shape.area_light.reset();
  } else if (const auto* curves = std::get_if<description::Curves>(&shape.geometry)) {
    warn(shape.location, "curves that emit become triangles, flat ones tubes of their width");
    check_curves(*curves, shape.location);
    shape.geometry = triangulated(*curves);
  }
}

// Returns the index of the first of its lights.
std::uint32_t ShapeBuilder::add_emitter(EmittingShape emitter) {
  emitter.first_light = part_.light_count;
  part_.light_count += static_cast<std::uint32_t>(light_count(*emitter.shape));
  part_.emitters.push_back(emitter);
  return emitter.first_light;
}

// Adds the lights of an emitting shape that is not stored in world space.
std::uint32_t ShapeBuilder::add_placed_emitter(const description::Shape& source, const Transform& to_world) {
  description::Shape copy = source;
  std::unique_ptr<ShapeStore> posed = store(copy, to_world);
  const std::uint32_t first = add_emitter({posed.get(), &source, to_world, true});
  part_.posed_emitters.push_back(std::move(posed));
  return first;
}

bool ShapeBuilder::leave_out(const AnimatedTransform& outer, const AnimatedTransform& inner,
                             const SourceLocation& location) {
  if (can_be_placed(outer, inner)) return false;
  if (left_out_++ == 0) first_left_out_ = location;
  return true;
}

void ShapeBuilder::warn_of_left_out() {
  if (left_out_ == 0) return;
  warn(first_left_out_,
       (left_out_ == 1 ? std::string("a shape or instance is")
                       : std::to_string(left_out_) + " shapes or instances, the first of them here, are") +
           " left out: the scale is 0 along some axis, or the transformation is singular in single precision");
}

void ShapeBuilder::warn_of_motion(const AnimatedTransform& motion, const SourceLocation& location) {
  if (motion.is_moving()) warn(location, "a moving shape emits from its place in the middle of the shutter interval");
}

// Embree tests rays in single precision: curves and instances vanish at ten times this distance, everything at 10^18.
void ShapeBuilder::warn_of_distance(const Bounds& box, const SourceLocation& location) {
  constexpr float farthest = 1e12f;
  const Vec3 reach = glm::max(abs(box.min), abs(box.max));
  if (!(reach.x <= farthest && reach.y <= farthest && reach.z <= farthest))
    warn(location, "the shape reaches farther than 1e12 from the origin: rays may miss it");
}

// Notes shapes in which the steps of single precision show.
void ShapeBuilder::note_coarse_steps(const Bounds& box, const SourceLocation& location) {
  if (box.empty()) return;
  const float size = max_component(box.extent()), reach = max_component(glm::max(abs(box.min), abs(box.max)));
  const float step = std::nextafter(reach, infinity) - reach;
  constexpr float fewest_steps = 256;
  if (!(size > 0 && size < fewest_steps * step)) return;
  if (coarse_.count == 0) coarse_ = {0, location, size, reach, step};
  ++coarse_.count;
}

void ShapeBuilder::warn_of_coarse_steps() {
  if (coarse_.count == 0) return;
  warn(coarse_.first,
       fmt::format("this shape{} has a size of {} m, but coordinates around {} m, which are rounded to "
                   "{:.1g} m: its surface and its shadows are rough. Model the scene nearer to the origin",
                   coarse_.count > 1 ? fmt::format(", the first of {} such,", coarse_.count) : "",
                   short_number(coarse_.size), short_number(coarse_.reach), coarse_.step));
}

void ShapeBuilder::place(PlacedInstance placed) {
  geometry_.place(placed.placed);
  const Bounds& box = geometry_.group_bounds(placed.placed.group);
  const Bounds swept = geometry_.swept_bounds(placed.placed, box);
  warn_of_distance(swept, placed.location);
  note_coarse_steps(swept, placed.location);
  placed_.push_back(std::move(placed));
}

// Checked before any is made, because small files may ask for many triangles.
void ShapeBuilder::check_displacements() const {
  constexpr double most_triangles = 1 << 26;
  const SceneDescription& scene = scene_;
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
void ShapeBuilder::load_textures() const {
  const auto note = [&](const description::Shape& shape) {
    materials_.textures.compile(shape.alpha);
    if (shape.displacement) materials_.textures.compile(shape.displacement->height);
    if (!shape.area_light) return;
    const description::AreaLight& light = scene_.area_lights.at(*shape.area_light);
    materials_.textures.compile(light.radiance, description::SpectrumRole::illuminant, light.location);
  };
  for (const description::Shape& shape : shapes_) note(shape);
  for (const description::Object& object : objects_)
    for (const description::Shape& shape : object.shapes) note(shape);
  materials_.textures.load_images();
}

void ShapeBuilder::add_shapes() {
  for (description::Shape& shape : shapes_) {
    settle_emission(shape);
    if (!is_visible(shape) || leave_out(shape.object_to_world, still_identity, shape.location)) continue;
    if (!must_be_placed(shape)) {
      const Transform& to_world = shape.object_to_world.start;
      std::unique_ptr<ShapeStore> stored = store(shape, to_world);
      if (shape.area_light) stored->record.first_light = add_emitter({stored.get(), &shape, to_world});
      warn_of_distance(stored->bounds(), shape.location);
      note_coarse_steps(stored->bounds(), shape.location);
      geometry_.add(std::move(stored));
      continue;
    }
    std::uint32_t first_light = 0;
    if (shape.area_light) {
      warn_of_motion(shape.object_to_world, shape.location);
      first_light = add_placed_emitter(shape, shape.object_to_world.at(shutter_middle(scene_)));
    }
    const std::uint32_t group = geometry_.add_group(group_of(store(shape, identity)));
    place({{group, shape.object_to_world, still_identity, first_light},
           {},
           shape.area_light.has_value(),
           shape.location});
  }
}

// Each object becomes one group of its fixed, non-emitting shapes, and one group for each other shape.
void ShapeBuilder::add_objects() {
  std::vector<std::vector<description::Index>> instances(objects_.size());
  for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
    const description::Instance& instance = scene_.instances[i];
    if (!leave_out(instance.object_to_world, still_identity, instance.location))
      instances.at(instance.object).push_back(static_cast<description::Index>(i));
  }
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    std::vector<std::unique_ptr<ShapeStore>> still;
    for (description::Shape& shape : objects_[i].shapes) {
      settle_emission(shape);
      if (!is_visible(shape) || leave_out(shape.object_to_world, still_identity, shape.location)) continue;
      if (must_be_placed(shape) || shape.area_light)
        add_part(shape, instances[i]);
      else
        still.push_back(store(shape, shape.object_to_world.start));
    }
    if (still.empty()) continue;
    const std::uint32_t group = geometry_.add_group(std::move(still));
    for (const description::Index i_instance : instances[i]) {
      const description::Instance& instance = scene_.instances[i_instance];
      place({{group, instance.object_to_world, still_identity}, i_instance, false, instance.location});
    }
  }
}

// Adds a shape of an object that needs its own placement, or its own lights in each instance.
void ShapeBuilder::add_part(description::Shape& shape, const std::vector<description::Index>& instances) {
  std::vector<PlacedInstance> placed;
  for (const description::Index i : instances) {
    const description::Instance& instance = scene_.instances[i];
    const AnimatedTransform& to_world = instance.object_to_world;
    if (leave_out(to_world, shape.object_to_world, instance.location)) continue;
    std::uint32_t first_light = 0;
    if (shape.area_light) {
      warn_of_motion(to_world, shape.location);
      warn_of_motion(shape.object_to_world, shape.location);
      const float time = shutter_middle(scene_);
      first_light = add_placed_emitter(shape, to_world.at(time) * shape.object_to_world.at(time));
    }
    placed.push_back(
        {{0, to_world, shape.object_to_world, first_light}, i, shape.area_light.has_value(), instance.location});
  }
  const std::uint32_t group = geometry_.add_group(group_of(store(shape, identity)));
  for (PlacedInstance& instance : placed) {
    instance.placed.group = group;
    place(std::move(instance));
  }
}

void ShapeBuilder::count() {
  SceneStatistics& statistics = part_.statistics;
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
  for (const auto& shape : geometry_.shapes()) add(*shape);
  for (const auto& group : geometry_.groups())
    for (const auto& shape : group) add(*shape);
  statistics.geometry_bytes = geometry_.bytes();
}

}  // namespace

void note_traits(GeometryRecord& record, const MaterialTraits& traits) {
  record.wants_tangents = traits.is_anisotropic || traits.has_relief || is_flat(record);
  record.wants_footprint = traits.has_levels;
  record.wants_uv = record.wants_uv || traits.varies || traits.has_relief;
}

void build_shapes(SceneData& scene, const std::shared_ptr<MaterialPart>& materials) {
  ShapeBuilder(scene, materials).build();
}

}  // namespace lanthorn
