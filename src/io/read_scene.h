// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Implements `read_scene` and `read_pbrt_string` (lanthorn/scene.h).
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "io/known_method.h"
#include "lanthorn/scene.h"

namespace lanthorn {

namespace gltf {
class File;
}  // namespace gltf

/// Like `SceneFile`, but ignores `ReadOptions::window_glass` and the environment.
class SceneSource {
 public:
  SceneSource(const std::filesystem::path& path, const ReadOptions& options, FindMethod methods);
  ~SceneSource();
  SceneSource(const SceneSource&) = delete;
  SceneSource& operator=(const SceneSource&) = delete;

  SceneDescription read(const std::optional<double>& seconds, const MeshObserver& observer = {});

 private:
  SceneDescription read_model(const std::optional<double>& seconds);

  std::string name_;
  std::filesystem::path folder_;
  ReadOptions options_;
  FindMethod methods_;
  FileAccess access_;
  std::string bytes_;
  std::unique_ptr<gltf::File> gltf_;                // for glTF files, once parsed
  std::map<std::string, description::File> files_;  // the scene's other files, as they were when first read
};
/// `read_pbrt_string`.
SceneDescription read_pbrt_text(std::string_view text, const std::filesystem::path& folder, const std::string& name,
                                const FindMethod& methods);

}  // namespace lanthorn
