// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/read_scene.h"

#include <optional>

#include "lanthorn/error.h"
#include "lanthorn/scene.h"
#include "math/hash.h"
#include "render/method_of_file.h"
#include "staging/environments.h"

namespace lanthorn {

struct SceneFile::Parts {
  SceneSource source;
  std::filesystem::path path;
  ReadOptions options;
  std::optional<EnvironmentPicture> environment{};
};

namespace {

SceneDescription read_at(SceneSource& source, const std::filesystem::path& path, const ReadOptions& options,
                         std::optional<EnvironmentPicture>& environment, const std::optional<double>& seconds,
                         const MeshObserver& observer) {
  SceneDescription scene = source.read(seconds, observer);
  if (options.window_glass) {
    const std::size_t warnings = scene.warnings.size();
    if (replace_window_glass(scene) == 0 && scene.warnings.size() == warnings)
      scene.warnings.push_back(
          {{path.string()}, "--window-glass: no thin dielectric and no flat slab of clear glass is in the scene"});
    scene.hash = hash_words({scene.hash, 1});  // a different scene
  }
  move_origin(scene);
  if (options.environment.source.empty()) return scene;
  if (!environment) environment = read_environment_picture(options.environment, options.max_pixels);
  replace_environment(scene, options.environment, *environment);
  return scene;
}

void check_environment(const EnvironmentChoice& environment) {
  if (environment.source.empty() && !(environment == EnvironmentChoice()))
    throw Error("--environment-rotate, -scale, -up: expected --environment FILE, to which they apply");
}

}  // namespace

SceneFile::SceneFile(const std::filesystem::path& path, const ReadOptions& options)
    : parts_(new Parts{{path, options, method_of_file}, path, options}) {
  check_environment(options.environment);
}
SceneFile::~SceneFile() = default;

SceneDescription SceneFile::at(const std::optional<double>& seconds) {
  return read_at(parts_->source, parts_->path, parts_->options, parts_->environment, seconds, {});
}

SceneDescription read_scene(const std::filesystem::path& path, const ReadOptions& options) {
  return read_scene(path, options, {});
}

SceneDescription read_scene(const std::filesystem::path& path, const ReadOptions& options,
                            const MeshObserver& observer) {
  SceneSource source(path, options, method_of_file);
  check_environment(options.environment);
  std::optional<EnvironmentPicture> environment;
  return read_at(source, path, options, environment, options.at, observer);
}

SceneDescription read_pbrt_string(std::string_view text, const std::filesystem::path& folder, const std::string& name) {
  SceneDescription scene = read_pbrt_text(text, folder, name, method_of_file);
  move_origin(scene);
  return scene;
}

}  // namespace lanthorn
