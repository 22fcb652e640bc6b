// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/read_scene.h"

#include <optional>

#include "io/replace_environment.h"
#include "lanthorn/error.h"
#include "lanthorn/scene.h"
#include "math/hash.h"
#include "render/method_of_file.h"

namespace lanthorn {

struct SceneFile::Parts {
  SceneSource source;
  std::filesystem::path path;
  ReadOptions options;
  std::optional<EnvironmentPicture> environment{};
};

SceneFile::SceneFile(const std::filesystem::path& path, const ReadOptions& options)
    : parts_(new Parts{{path, options, method_of_file}, path, options}) {
  const EnvironmentChoice& environment = options.environment;
  if (environment.source.empty() && !(environment == EnvironmentChoice()))
    throw Error("--environment-rotate, -scale, -up: expected --environment FILE, which they are about");
}
SceneFile::~SceneFile() = default;

SceneDescription SceneFile::at(const std::optional<double>& seconds) {
  auto& [source, path, options, environment] = *parts_;
  SceneDescription scene = source.read(seconds);
  if (options.window_glass) {
    if (replace_window_glass(scene) == 0)
      scene.warnings.push_back(
          {{path.string()}, "--window-glass: no thin dielectric and no flat slab of clear glass is in the scene"});
    scene.hash = hash_words({scene.hash, 1});  // another scene
  }
  move_origin(scene);
  if (options.environment.source.empty()) return scene;
  if (!environment) environment = read_environment_picture(options.environment, options.max_pixels);
  replace_environment(scene, options.environment, *environment);
  return scene;
}

SceneDescription read_scene(const std::filesystem::path& path, const ReadOptions& options) {
  return SceneFile(path, options).at(options.at);
}

SceneDescription read_pbrt_string(std::string_view text, const std::filesystem::path& folder, const std::string& name) {
  SceneDescription scene = read_pbrt_text(text, folder, name, method_of_file);
  move_origin(scene);
  return scene;
}

}  // namespace lanthorn
