// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "staging/environments.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include "base/memory.h"
#include "base/parallel.h"
#include "ibl/cube_map.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/ibl.h"
#include "lanthorn/scene.h"
#include "lanthorn/text.h"
#include "math/hash.h"
#include "math/vec.h"

namespace lanthorn {

namespace {

using namespace description;

// Rotations from a light's space to the layouts of `Environment` (lanthorn/ibl.h), whose y is up: equirectangular
// pictures and cubes turn by half a turn, and all are mirrored, because pbrt's worlds are left-handed.
const Mat4 equirectangular_to_y_up(-1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
const Mat4 octahedral_to_y_up(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
const Mat4 y_up_to_z_up(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);

std::vector<Rgb> colours_of(const Image& image) {
  const auto r = image.find_channel("R"), g = image.find_channel("G"), b = image.find_channel("B"),
             y = image.find_channel("Y");
  const std::size_t red = y ? *y : *r, green = y ? *y : *g, blue = y ? *y : *b;
  std::vector<Rgb> colours;
  colours.reserve(image.pixels.size() / image.channel_count());
  for (std::size_t i = 0; i < image.pixels.size(); i += image.channel_count())
    colours.push_back({image.pixels[i + red], image.pixels[i + green], image.pixels[i + blue]});
  return colours;
}

// Averages four points of each texel.
SphericalTexels unrolled(const Image& strip) {
  const CubeMap cube = cube_of(strip);
  SphericalTexels texels{4 * cube.size(), 2 * cube.size(), {}};
  texels.rows.resize(static_cast<std::size_t>(texels.width) * static_cast<std::size_t>(texels.height));
  const auto radiance = [&](float x, float y) {
    const float azimuth = 2 * pi * x / static_cast<float>(texels.width) - pi;
    const float polar = pi * y / static_cast<float>(texels.height);
    return cube.lookup({std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)});
  };
  parallel_for(0, texels.height, [&](int row) {
    for (int column = 0; column < texels.width; ++column) {
      Spectrum sum;
      for (const float dx : {0.25f, 0.75f})
        for (const float dy : {0.25f, 0.75f})
          sum += radiance(static_cast<float>(column) + dx, static_cast<float>(row) + dy) * 0.25f;
      texels.rows[static_cast<std::size_t>(row) * static_cast<std::size_t>(texels.width) +
                  static_cast<std::size_t>(column)] = {sum[0], sum[1], sum[2]};
    }
  });
  return texels;
}

// The picture of an environment; octahedral layouts stay square.
std::shared_ptr<const SphericalTexels> picture_of(const Image& image) {
  if (*layout_of(image) == EnvironmentLayout::cube) return std::make_shared<const SphericalTexels>(unrolled(image));
  return std::make_shared<const SphericalTexels>(SphericalTexels{image.width, image.height, colours_of(image)});
}

// The camera's up vector is the best indication of a pbrt file's up axis.
UpAxis axis_upwards(const Camera& camera) {
  const Vec3 up = camera.camera_to_world.start.vector({0, 1, 0});
  return std::fabs(up.z) > std::fabs(up.y) ? UpAxis::z : UpAxis::y;
}

std::string extension_of(const SceneDescription& scene) {
  const std::filesystem::path path = scene.filename;
  return lower_extension(lower_extension(path) == ".gz" ? path.stem() : path);
}

// glTF and OBJ worlds are right-handed, and may not have a camera yet. For other formats, the camera's transform tells,
// since camera space is left-handed.
bool is_left_handed(const SceneDescription& scene) {
  const std::string extension = extension_of(scene);
  const bool is_model = extension == ".gltf" || extension == ".glb" || extension == ".obj";
  return !is_model && !scene.view.camera.camera_to_world.start.swaps_handedness();
}

// In a left-handed world, pictures are mirrored, so that the camera sees them unmirrored.
Transform placement(const SceneDescription& scene, const EnvironmentChoice& choice, UpAxis up, bool is_octahedral) {
  const Transform base(is_octahedral ? octahedral_to_y_up : equirectangular_to_y_up);
  const bool left_handed = is_left_handed(scene);
  const Transform handed = scale({1, 1, left_handed && !is_octahedral ? -1 : 1});
  const Transform turned = rotate(left_handed ? -choice.rotation : choice.rotation, {0, 1, 0});
  const Transform upright = up == UpAxis::z ? Transform(y_up_to_z_up) : Transform();
  return upright * turned * handed * base;
}

bool is_environment(const Light& light) { return std::holds_alternative<InfiniteLight>(light.node); }

// Replaces the first environment in the list of lights, so that the names of the other lights do not change.
void replace_lights(std::vector<Light>& lights, Light light) {
  const auto first = std::find_if(lights.begin(), lights.end(), is_environment);
  if (first == lights.end()) {
    lights.push_back(std::move(light));
    return;
  }
  *first = std::move(light);
  lights.erase(std::remove_if(first + 1, lights.end(), is_environment), lights.end());
}

// The source is a separate file, even if the scene uses a file of the same name.
std::string name_of_file(const EnvironmentChoice& choice) { return "--environment " + choice.source; }

// The picture of the scene's current environment; null if `choice` has a different source.
std::shared_ptr<const SphericalTexels> known_picture(const SceneDescription& scene, const EnvironmentChoice& choice) {
  if (scene.environment.source != choice.source) return nullptr;
  const auto light = std::find_if(scene.lights.begin(), scene.lights.end(), is_environment);
  return light == scene.lights.end() ? nullptr : std::get<InfiniteLight>(light->node).texels;
}

UpAxis axis_upwards(SceneDescription& scene, const EnvironmentChoice& choice) {
  if (choice.up) return *choice.up;
  if (extension_of(scene) != ".pbrt") return UpAxis::y;
  const UpAxis up = axis_upwards(scene.view.camera);
  std::string message = fmt::format(
      "--environment: +{0} is up, because the camera's up vector is nearer to it than to {1}; "
      "use --environment-up {1} to change it",
      up == UpAxis::z ? 'z' : 'y', up == UpAxis::z ? 'y' : 'z');
  if (std::none_of(scene.warnings.begin(), scene.warnings.end(),
                   [&](const Warning& w) { return w.message == message; }))
    scene.warnings.push_back({{printable(scene.filename)}, std::move(message)});
  return up;
}

// Restores the lights from before any environment replaced the scene's own.
void restore_environment(SceneDescription& scene) {
  if (scene.environment.source.empty()) return;
  scene.files.erase(name_of_file(scene.environment));
  scene.lights = std::move(scene.own_lights);
  scene.own_lights.clear();
  scene.environment = {};
}

void check(const EnvironmentChoice& choice) {
  if (!(choice.scale >= 0 && std::isfinite(choice.scale) && std::isfinite(choice.rotation)))
    throw Error("--environment-rotate, --environment-scale: expected finite numbers, and a scale of 0 or more");
}

}  // namespace

EnvironmentPicture read_environment_picture(const EnvironmentChoice& choice, std::uint64_t max_pixels) {
  if (const std::optional<Image> own = own_environment(choice.source)) return {picture_of(*own), {}};
  File file;
  file.path = choice.source;
  const std::string bytes = read_file(file.path);
  file.hash = hash_bytes(std::as_bytes(std::span(bytes)));
  return {picture_of(read_environment({choice.source}, max_pixels)), std::move(file)};
}

void replace_environment(SceneDescription& scene, const EnvironmentChoice& choice, const EnvironmentPicture& picture) {
  check(choice);
  if (scene.environment.source.empty()) scene.own_lights = scene.lights;
  if (scene.environment.source != choice.source) scene.files.erase(name_of_file(scene.environment));
  if (picture.file) scene.files[name_of_file(choice)] = *picture.file;
  Light light;
  const bool is_octahedral = picture.texels->width == picture.texels->height;
  light.light_to_world = placement(scene, choice, axis_upwards(scene, choice), is_octahedral);
  light.location.file = scene.filename;
  InfiniteLight& environment = light.node.emplace<InfiniteLight>();
  environment.texels = picture.texels;
  environment.radiance.scale = choice.scale;
  replace_lights(scene.lights.edit(), std::move(light));
  scene.environment = choice;
}

void replace_environment(SceneDescription& scene, const EnvironmentChoice& choice) {
  check(choice);
  if (choice.source.empty()) return restore_environment(scene);
  EnvironmentPicture picture{known_picture(scene, choice), {}};
  if (!picture.texels) picture = read_environment_picture(choice, scene.access.max_pixels);
  replace_environment(scene, choice, picture);
}

}  // namespace lanthorn
