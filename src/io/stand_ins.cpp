// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/stand_ins.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "io/grounds.h"
#include "io/lit_sides.h"
#include "io/own_environments.h"
#include "io/surfaces.h"
#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

namespace {

using namespace description;

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

}  // namespace

namespace {

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
