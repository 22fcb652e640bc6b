// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <string_view>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/scene.h"
#include "lanthorn/text.h"
#include "value_types.h"

namespace lanthorn::program {

namespace {

std::optional<LookAt> parse_look_at(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const auto number = parse_number(text.substr(at, end - at));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
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
    const auto text = [](const DVec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); };
    return fmt::format("{},{},{}", text(look.eye), text(look.target), text(look.up));
  };
  return {"NUMBERS",
          "nine numbers ex,ey,ez,tx,ty,tz,ux,uy,uz: the camera's place, the point that it looks at, and the direction "
          "upwards",
          parse_look_at, print};
}

bool is_finite(const DVec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// FNV-1a (Fowler, Noll & Vo), seeded with the hash of the scene's file.
std::uint64_t hash_of(std::uint64_t scene, std::string_view text) {
  std::uint64_t hash = scene ^ 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

void check_names(const Scene& scene, const LightFactors& factors) {
  if (factors.empty()) return;
  std::vector<std::string> known;
  for (const NamedLight& light : lights_of(scene)) known.push_back(light.id);
  for (const auto& [name, factor] : factors)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(known.empty() ? fmt::format("--light {}: the scene has no lights", printable(name))
                                : fmt::format("--light {}: the scene has {}{}", printable(name), known.front(),
                                              known.size() > 1 ? " to " + known.back() : ""));
}

}  // namespace

void check(const LookAt& look) {
  constexpr double farthest = 1e12, least_sine = 1e-4;
  const DVec3 view = look.target - look.eye;
  const double length = glm::length(view), up = glm::length(look.up);
  const bool is_known = is_finite(look.eye) && is_finite(look.target) && is_finite(look.up) &&
                        glm::length(look.eye) < farthest && length < farthest && up < farthest;
  if (!is_known || !(length > 0) || !(up > 0) || !(glm::length(glm::cross(view / length, look.up / up)) > least_sine))
    throw Error(
        "--look-at: the camera's place, the point that it looks at and the up direction must not lie on one line");
}

LookAt look_of(const ViewDescription& view, const ViewOptions& options, float distance, const DVec3& origin) {
  const Transform to_world = translate(origin) * camera_placement(view, options);
  const DVec3 eye(to_world.matrix[3]), forward(to_world.vector({0, 0, 1}));
  return {eye, eye + static_cast<double>(distance) * glm::normalize(forward),
          glm::normalize(DVec3(to_world.vector({0, 1, 0})))};
}

void place_camera(ViewDescription& view, const LookAt& look, const DVec3& origin) {
  description::Camera& camera = view.camera;
  const Transform& before = camera.camera_to_world.start;
  Vec3 factors{glm::length(before.vector({1, 0, 0})), glm::length(before.vector({0, 1, 0})),
               glm::length(before.vector({0, 0, 1}))};
  if (before.swaps_handedness()) factors.x = -factors.x;
  camera.camera_to_world = AnimatedTransform(look_at(look.eye - origin, look.target - origin, look.up).inverted() *
                                             lanthorn::scale(factors));
  camera.subject.reset();
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
  check_names(*scene, factors);
  std::string text;
  for (const auto& [name, factor] : factors)
    if (factor != 1) text += fmt::format("{}={},", name, factor);
  if (text.empty()) return scene;
  SceneDescription description = description_of(*scene);
  const auto scale = [&](auto& lights, const auto& name_of) {
    for (description::Index i = 0; i < lights.size(); ++i)
      if (const auto found = factors.find(name_of(i)); found != factors.end() && found->second != 1)
        scale_light(lights[i], found->second);
  };
  scale(description.area_lights, name_of_area_light);
  scale(description.lights, name_of_light);
  description.hash = hash_of(description.hash, text);
  return build_scene(std::move(description), scene);
}

ViewDescription view_of(const Scene& scene, const SceneChanges& changes, const ViewOptions& options) {
  ViewDescription view = description_of(scene).view;
  if (changes.look) place_camera(view, *changes.look, description_of(scene).origin);
  change_lens(view, changes.lens, scene, options);
  return view;
}

void move_camera(SceneChanges& changes, const LookAt& look) {
  changes.look = look;
  changes.lens.orbit.reset();
}

SceneChanges moved(SceneChanges changes, const std::optional<LookAt>& look, LightFactors lights) {
  changes.look.reset();
  if (look) move_camera(changes, *look);
  changes.lights = std::move(lights);
  return changes;
}

OptionTable scene_change_options(SceneChanges& changes) {
  OptionTable table{
      {.names = "--look-at",
       .value = into(changes.look, look_at_type()),
       .brief = "Place the camera at ex,ey,ez, looking at tx,ty,tz, with up vector ux,uy,uz",
       .details = "Lens and resolution stay those of the scene file, unless other options change them."},
      {.names = "--light",
       .value = each_into(changes.lights, light_factor_type()),
       .brief = "Scale a light, such as light1=0.5 (repeatable)",
       .details =
           "light1, light2 ... are the scene's lights and area1 ... its emitting surfaces, in the order of the file."}};
  return joined(std::move(table), lens_options(changes.lens));
}

}  // namespace lanthorn::program
