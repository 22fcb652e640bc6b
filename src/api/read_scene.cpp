// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/read_scene.h"

#include "lanthorn/error.h"
#include "lanthorn/scene.h"
#include "math/hash.h"
#include "render/method_of_file.h"

namespace lanthorn {

SceneDescription read_scene(const std::filesystem::path& path, const ReadOptions& options) {
  const EnvironmentChoice& environment = options.environment;
  if (environment.source.empty() && !(environment == EnvironmentChoice()))
    throw Error("--environment-rotate, -scale, -up: expected --environment FILE, which they are about");
  SceneDescription scene = read_scene_file(path, options, method_of_file);
  if (options.window_glass) {
    if (replace_window_glass(scene) == 0)
      scene.warnings.push_back(
          {{path.string()}, "--window-glass: no thin dielectric and no flat slab of clear glass is in the scene"});
    scene.hash = hash_words({scene.hash, 1});  // another scene
  }
  move_origin(scene);
  replace_environment(scene, environment);
  return scene;
}

SceneDescription read_pbrt_string(std::string_view text, const std::filesystem::path& folder, const std::string& name) {
  SceneDescription scene = read_pbrt_text(text, folder, name, method_of_file);
  move_origin(scene);
  return scene;
}

}  // namespace lanthorn
