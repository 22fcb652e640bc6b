// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <set>
#include <string_view>
#include <variant>

#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "quantities.h"

namespace lanthorn::program {

namespace {

std::optional<LookAt> parse_look_at(std::string_view text) {
  std::vector<float> numbers;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const auto number = parse_number(text.substr(at, end - at));
    if (!number) return std::nullopt;
    numbers.push_back(static_cast<float>(*number));
    at = end + 1;
  }
  if (numbers.size() != 9) return std::nullopt;
  const LookAt look{
      {numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}, {numbers[6], numbers[7], numbers[8]}};
  check(look);
  return look;
}

ValueType<LookAt> look_at_type() {
  const auto print = [](const LookAt& look) {
    const auto text = [](const Vec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); };
    return fmt::format("{},{},{}", text(look.eye), text(look.target), text(look.up));
  };
  return {"NUMBERS",
          "nine numbers ex,ey,ez,tx,ty,tz,ux,uy,uz: the camera's place, the point that it looks at, and the direction "
          "upwards",
          parse_look_at, print};
}

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Area lights are numbered as in the description, where those without a shape may be.
std::set<description::Index> used_area_lights(const SceneDescription& scene) {
  std::set<description::Index> used;
  const auto add = [&](const description::Shape& shape) {
    if (shape.area_light) used.insert(*shape.area_light);
  };
  for (const description::Shape& shape : scene.shapes) add(shape);
  for (const description::Object& object : scene.objects)
    for (const description::Shape& shape : object.shapes) add(shape);
  return used;
}

std::string place_of(const SourceLocation& location) {
  return location.line > 0 ? fmt::format(", line {}", location.line) : std::string();
}

std::string label_of(const description::Light& light) {
  return std::visit([](const auto& l) { return l.kind.label; }, light.node);
}

// FNV-1a (Fowler, Noll & Vo), continued from the hash of the scene's file.
std::uint64_t hash_of(std::uint64_t scene, std::string_view text) {
  std::uint64_t hash = scene ^ 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

void check_names(const SceneDescription& scene, const LightFactors& factors) {
  std::vector<std::string> known;
  for (const NamedLight& light : lights_of(scene)) known.push_back(light.name);
  for (const auto& [name, factor] : factors)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(known.empty() ? fmt::format("--light {}: the scene has no lights", printable(name))
                                : fmt::format("--light {}: the scene has {}{}", printable(name), known.front(),
                                              known.size() > 1 ? " to " + known.back() : ""));
}

}  // namespace

void check(const LookAt& look) {
  constexpr float farthest = 1e12f, least_sine = 1e-4f;
  const Vec3 view = look.target - look.eye;
  const float length = glm::length(view), up = glm::length(look.up);
  const bool is_known = is_finite(look.eye) && is_finite(look.target) && is_finite(look.up) &&
                        glm::length(look.eye) < farthest && length < farthest && up < farthest;
  if (!is_known || !(length > 0) || !(up > 0) || !(glm::length(glm::cross(view / length, look.up / up)) > least_sine))
    throw Error(
        "--look-at: the camera's place, the point that it looks at and the direction upwards must not lie on "
        "one line");
}

LookAt look_of(const ViewDescription& view, const ViewOptions& options, float distance) {
  const Transform to_world = camera_placement(view, options);
  const Point eye = to_world.point(Point(0));
  return {eye, eye + distance * glm::normalize(to_world.vector({0, 0, 1})), glm::normalize(to_world.vector({0, 1, 0}))};
}

void place_camera(ViewDescription& view, const LookAt& look) {
  description::Camera& camera = view.camera;
  const Transform& before = camera.camera_to_world.start;
  Vec3 factors{glm::length(before.vector({1, 0, 0})), glm::length(before.vector({0, 1, 0})),
               glm::length(before.vector({0, 0, 1}))};
  if (before.swaps_handedness()) factors.x = -factors.x;
  camera.camera_to_world =
      AnimatedTransform(look_at(look.eye, look.target, look.up).inverted() * lanthorn::scale(factors));
  camera.subject.reset();
}

std::vector<NamedLight> lights_of(const SceneDescription& scene) {
  std::vector<NamedLight> lights;
  for (const description::Index index : used_area_lights(scene))
    lights.push_back({name_of_area_light(index), "Emitting surface" + place_of(scene.area_lights[index].location)});
  for (description::Index index = 0; index < scene.lights.size(); ++index)
    lights.push_back({name_of_light(index), label_of(scene.lights[index]) + place_of(scene.lights[index].location)});
  return lights;
}

ValueType<std::pair<std::string, float>> light_factor_type() {
  using Factor = std::pair<std::string, float>;
  const auto parse = [](std::string_view text) -> std::optional<Factor> {
    constexpr double largest = 1e12;
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string_view::npos) return std::nullopt;
    const auto factor = parse_number(text.substr(equals + 1));
    if (!factor || *factor < 0 || *factor > largest) return std::nullopt;
    return Factor(text.substr(0, equals), static_cast<float>(*factor));
  };
  return {"NAME=FACTOR", "NAME=FACTOR with a factor of 0 or more, e.g. light1=0.5", parse,
          [](const Factor& factor) { return fmt::format("{}={}", factor.first, factor.second); }};
}

SharedScene scale_lights(const SharedScene& scene, const LightFactors& factors) {
  const SceneDescription& description = description_of(*scene);
  check_names(description, factors);
  SceneEdits edits;
  std::string text;
  for (const auto& [name, factor] : factors)
    if (factor != 1) text += fmt::format("{}={},", name, factor);
  if (text.empty()) return scene;
  const auto factor_of = [&](const std::string& name) {
    const auto found = factors.find(name);
    return found == factors.end() ? 1.0f : found->second;
  };
  for (description::Index i = 0; i < description.area_lights.size(); ++i)
    if (const float factor = factor_of(name_of_area_light(i)); factor != 1) {
      description::AreaLight light = description.area_lights[i];
      scale_light(light, factor);
      edits.area_lights[i] = light;
    }
  for (description::Index i = 0; i < description.lights.size(); ++i)
    if (const float factor = factor_of(name_of_light(i)); factor != 1) {
      description::Light light = description.lights[i];
      scale_light(light, factor);
      edits.lights[i] = light;
    }
  edits.hash = hash_of(description.hash, text);
  return edit_scene(*scene, edits);
}

ViewDescription view_of(const Scene& scene, const SceneChanges& changes, const ViewOptions& options) {
  ViewDescription view = description_of(scene).view;
  LensChanges lens = changes.lens;
  if (changes.look) {
    place_camera(view, *changes.look);
    lens.orbit.reset();
  }
  change_lens(view, lens, scene, options);
  return view;
}

SceneChanges moved(SceneChanges changes, const std::optional<LookAt>& look, LightFactors lights) {
  changes.look = look;
  changes.lights = std::move(lights);
  if (look) changes.lens.orbit.reset();
  return changes;
}

OptionTable scene_change_options(SceneChanges& changes) {
  OptionTable table{
      {.names = "--look-at",
       .value = into(changes.look, look_at_type()),
       .brief = "Camera at ex,ey,ez, looking at tx,ty,tz, with ux,uy,uz upwards",
       .details = "Lens and picture are those of the scene file, unless options change them."},
      {.names = "--light",
       .value = each_into(changes.lights, light_factor_type()),
       .brief = "Multiply a light, such as light1=0.5; may be given several times",
       .details = "light1, light2 ... are the scene's lights, area1 ... its emitting surfaces, in the file's "
                  "order."}};
  return joined(std::move(table), lens_options(changes.lens));
}

}  // namespace lanthorn::program
