// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "staging/stand_ins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lanthorn/scene_description.h"
#include "math/vec.h"
#include "spectrum/spectrum.h"
#include "staging/environments.h"
#include "staging/lit_sides.h"
#include "staging/surfaces.h"

namespace lanthorn {

namespace {

using namespace description;

float size_of(const Bounds& box) { return box.empty() ? 0 : std::sqrt(length_squared(box.extent())); }

// The axis along which a box is thin, if the box is wide along both other axes.
std::optional<int> thin_axis(const Bounds& box) {
  constexpr float thin = 0.05f, wide = 0.1f;
  const Vec3 extent = box.extent();
  std::array<int, 3> axes{0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return extent[a] < extent[b]; });
  const float largest = extent[axes[2]];
  if (extent[axes[0]] <= thin * largest && extent[axes[1]] >= wide * largest) return axes[0];
  return {};
}

// Sorted by size, largest first.
std::vector<Part> sorted_parts(const SceneDescription& scene) {
  std::vector<Part> parts = parts_of(scene);
  std::erase_if(parts, [](const Part& part) { return !std::isfinite(size_of(part.box)); });
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return size_of(a.box) > size_of(b.box); });
  return parts;
}

// Direction from the ground to the objects on it. Zero if the box is thin along no axis, or the scene is not thin along
// that axis: then the box is a wall of a room.
Vec3 side_of_ground(const Bounds& box, const Bounds& things, const Bounds& scene) {
  constexpr float far_larger = 4;
  Vec3 side(0);
  const auto axis = thin_axis(box);
  const float size = size_of(box), largest = std::max(size_of(things), axis ? scene.extent()[*axis] : 0.0f);
  if (axis && size_of(things) > 0 && size >= far_larger * largest)
    side[*axis] = things.centre()[*axis] < box.centre()[*axis] ? -1.0f : 1.0f;
  return side;
}

struct FoundGrounds {
  std::size_t count = 0;  ///< the largest `count` parts are grounds
  Vec3 side{0};           ///< direction towards the objects
};

FoundGrounds find_grounds(const std::vector<Part>& parts) {
  std::vector<Bounds> others(parts.size() + 1);  // bounding boxes of the parts from each index on
  for (std::size_t i = parts.size(); i-- > 0;) {
    others[i] = others[i + 1];
    others[i].extend(parts[i].box);
  }
  FoundGrounds found;
  for (std::size_t i = 0; i < parts.size() && thin_axis(parts[i].box); ++i)
    if (side_of_ground(parts[i].box, others[i + 1], others[0]) != Vec3(0)) found.count = i + 1;
  if (found.count == 0) return found;
  const Bounds& things = others[found.count];
  found.side = side_of_ground(parts[0].box, things, others[0]);
  const bool are_alike =
      std::all_of(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(found.count),
                  [&](const Part& part) { return side_of_ground(part.box, things, others[0]) == found.side; });
  return are_alike ? found : FoundGrounds();
}

// Removes the elements at these positions and returns them in ascending order.
template <class T>
std::vector<std::pair<std::size_t, T>> take(std::vector<T>& from, std::vector<std::size_t> places) {
  std::sort(places.begin(), places.end());
  std::vector<std::pair<std::size_t, T>> taken;
  std::vector<T> left;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (taken.size() < places.size() && places[taken.size()] == i)
      taken.emplace_back(i, std::move(from[i]));
    else
      left.push_back(std::move(from[i]));
  }
  from = std::move(left);
  return taken;
}

template <class T>
void insert(std::vector<T>& into, std::vector<std::pair<std::size_t, T>> taken) {
  std::vector<T> all;
  auto next = into.begin();
  for (auto& [place, element] : taken) {
    while (all.size() < place) all.push_back(std::move(*next++));
    all.push_back(std::move(element));
  }
  all.insert(all.end(), std::make_move_iterator(next), std::make_move_iterator(into.end()));
  into = std::move(all);
}

/// Removes grounds (ground planes and backdrops) from a scene, so that a view can frame the objects on them. A ground
/// is a mesh that is flat along a world axis along which the whole scene is also flat, and whose bounding box is at
/// least four times as large as the box of all other meshes: in a view of everything, these would be small. All grounds
/// of a scene are on the same side of the other meshes.
class Grounds {
 public:
  explicit Grounds(SceneDescription& scene) {
    const std::vector<Part> parts = sorted_parts(scene);
    const FoundGrounds found = find_grounds(parts);
    if (found.count == 0) return;
    side_ = found.side;
    std::vector<std::size_t> shapes, instances;
    for (std::size_t i = 0; i < found.count; ++i) (parts[i].is_instance ? instances : shapes).push_back(parts[i].place);
    shapes_ = take(scene.shapes.edit(), std::move(shapes));
    instances_ = take(scene.instances.edit(), std::move(instances));
  }

  /// The unit normal of the grounds, towards the objects. Empty if the scene has no ground.
  const std::optional<Vec3>& side() const { return side_; }
  /// Restores all grounds. The scene's shapes and instances must be those that the constructor left.
  void put_back(SceneDescription& scene) {
    if (!side_) return;
    insert(scene.shapes.edit(), std::exchange(shapes_, {}));
    insert(scene.instances.edit(), std::exchange(instances_, {}));
  }

 private:
  // Positions in the scene's vectors, ascending.
  std::vector<std::pair<std::size_t, description::Shape>> shapes_;
  std::vector<std::pair<std::size_t, description::Instance>> instances_;
  std::optional<Vec3> side_;
};

// World space is right-handed, camera space left-handed: x runs to the right of the picture in both.
Transform to_world(const ViewFrame& frame, const Point& eye) {
  return Transform(
      Mat4(glm::vec4(frame.right, 0), glm::vec4(frame.up, 0), glm::vec4(-frame.towards_eye, 0), glm::vec4(eye, 1)));
}

void add_camera(SceneDescription& scene, const StandInView& view) {
  Camera& camera = scene.view.camera;
  camera.location.file = scene.filename;
  camera.node = PerspectiveCamera{.fov = view.field_of_view};
  if (view.inside) {
    camera.camera_to_world = AnimatedTransform(to_world(view.frame, view.inside->eye));
    return;
  }
  const Transform placed = to_world(view.frame, Point(0));
  camera.camera_to_world = AnimatedTransform(placed);
  camera.subject = bounds_of(scene, placed.inverted());
  if (camera.subject->empty() || !std::isfinite(length_squared(camera.subject->extent())))
    camera.subject = Bounds{Point(-1), Point(1)};
}

// Adds an invisible ball that emits light, so that white surfaces at the typical distance have radiance of about 1.
void add_lamp(SceneDescription& scene, const ViewInside& room) {
  AreaLight& light = scene.area_lights.emplace_back();
  const float radiance = sqr(room.lamp_distance / room.lamp_radius);
  light.radiance.value = RgbSpectrum{{radiance, radiance, radiance}};
  light.location.file = scene.filename;
  Shape& ball = scene.shapes.emplace_back();
  ball.geometry = Sphere{.radius = room.lamp_radius};
  ball.object_to_world = AnimatedTransform(translate(room.lamp));
  ball.material = static_cast<Index>(scene.materials.size());
  scene.materials.emplace_back().location.file = scene.filename;
  ball.area_light = static_cast<Index>(scene.area_lights.size() - 1);
  ball.alpha = {0, {}};
  ball.location.file = scene.filename;
}

// The studio, with its radiances times `scale`.
void add_studio(SceneDescription& scene, const Direction& up, float scale = 1) {
  constexpr int width = 256, height = width / 2;
  const auto texels = static_cast<std::size_t>(width) * height;
  InfiniteLight studio;
  SphericalTexels picture{width, height, {}};
  picture.rows.reserve(texels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float phi = 2 * pi * (static_cast<float>(x) + 0.5f) / width;
      const float theta = pi * (static_cast<float>(y) + 0.5f) / height;
      const float radiance =
          studio_radiance({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
      picture.rows.push_back({radiance, radiance, radiance});
    }
  studio.texels = std::make_shared<const SphericalTexels>(std::move(picture));
  studio.radiance.scale = scale;
  const Vec3 seen = scene.view.camera.camera_to_world.start.vector({0, 0, -1});
  const Vec3 level = seen - dot(seen, up) * up;
  const Direction towards = length_squared(level) > 0 ? normalize(level) : Direction(0, 0, 1);
  Light& light = scene.lights.emplace_back();
  light.node = std::move(studio);
  light.light_to_world =
      Transform(Mat4(glm::vec4(towards, 0), glm::vec4(cross(up, towards), 0), glm::vec4(up, 0), glm::vec4(0, 0, 0, 1)));
  light.location.file = scene.filename;
}

// The warning about defaults. The user's environment is not one of them.
std::string message_of(const StandIns& lacking, const std::optional<StandInView>& view, bool has_ground) {
  const bool is_inside = view && view->inside, hides_lights = view && view->hides_lights;
  const bool has_studio = !lacking.gets_environment && !is_inside;
  const std::string studio = "a studio of three soft lamps";
  if (!view) return lacking.light && has_studio ? "the file has no light: " + studio + " stands in" : "";
  std::string text = lacking.has_blind_camera ? "the file has no camera that sees anything" : "the file has no camera";
  if (hides_lights) text += ", and its lights are inside closed meshes, whose outside they do not illuminate";
  const bool has_lamp = lacking.light && is_inside, is_in_studio = (lacking.light || hides_lights) && has_studio;
  if (lacking.light && (has_lamp || is_in_studio)) text += " and no light";
  const char* shown = is_inside    ? ": a view "
                      : has_ground ? ": a view of all but the ground "
                                   : ": a view of all of it ";
  text += shown;
  text += view->name;
  if (has_lamp) text += ", lit by a lamp in the room,";
  if (is_in_studio) text += ", in " + studio + ",";
  return text + " stands in";
}

// True if light from around the scene cannot reach the camera's surroundings. A camera that frames the model is
// outside.
bool is_in_closed_room(const SceneDescription& scene, const ModelSamples& model) {
  constexpr float least_closed = 0.95f;
  if (scene.view.camera.subject) return false;
  const Point eye = scene.view.camera.camera_to_world.start.point(Point(0));
  return Panorama(model, eye, Panorama::Sight::through_glass).closed() >= least_closed;
}

// Light around metal and glass that reflect the darkness around the file's own lights.
void add_image_light(SceneDescription& scene, const StandIns& lacking, const Direction& up) {
  constexpr float share = 1.0f / 3;
  const ModelSamples model(scene, lacking.one_sided);
  if (model.samples.empty()) return;
  const float irradiance = typical_irradiance(scene, model);
  if (!(irradiance > 0) || is_in_closed_room(scene, model)) return;
  add_studio(scene, up, share * irradiance / pi);
  scene.warnings.push_back(
      {{scene.filename},
       "the file's lights are points and directions, of which metal and glass reflect next to nothing: a dim studio is "
       "added, as viewers do; --environment studio --environment-scale 0 leaves it dark"});
}

}  // namespace

bool is_lit_by(const SceneDescription& scene, std::span<const Index> lamps) {
  constexpr double least = 0.05;
  const Surfaces surfaces(scene);
  double flux = 0, dark_area = surfaces.area();
  for (const Index i : lamps) {
    const AreaLight& light = scene.area_lights[i];
    if (!shines(light)) continue;
    dark_area -= surfaces.emitting_areas()[i];
    flux += static_cast<double>(radiance_of(light)) * surfaces.emitting_areas()[i];
  }
  return dark_area > 0 && flux > least * dark_area;
}

void add_stand_ins(SceneDescription& scene, const StandIns& lacking) {
  scene.view.film.measures_exposure = !lacking.light || lacking.gets_environment;
  if (!lacking.camera && !lacking.light && !lacking.reflects_darkness) return;
  std::optional<StandInView> view;
  bool has_ground = false;
  if (lacking.camera) {
    Grounds grounds(scene);
    has_ground = grounds.side().has_value();
    view = stand_in_view(scene, lacking.one_sided, lacking.parts, !lacking.light, grounds.side());
    add_camera(scene, *view);
    grounds.put_back(scene);
  }
  if (lacking.light && view && view->inside) {
    add_lamp(scene, *view->inside);
    scene.view.film.measures_exposure = true;  // walls may be close to the lamp
  } else if (lacking.light || (view && view->hides_lights)) {
    add_studio(scene, view ? view->up : Direction(0, 1, 0));
  } else if (lacking.reflects_darkness && !lacking.gets_environment) {
    add_image_light(scene, lacking, view ? view->up : Direction(0, 1, 0));
  }
  const std::string message = message_of(lacking, view, has_ground);
  if (!message.empty()) scene.warnings.push_back({{scene.filename}, message});
}

SceneDescription with_stand_ins(ModelFile file) {
  add_stand_ins(file.scene, file.lacking);
  return std::move(file.scene);
}

}  // namespace lanthorn
