// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "io/counted_warnings.h"
#include "lanthorn/scene_description.h"

namespace lanthorn::obj {

/// Where warnings go.
struct Warnings {
  /// Adds a warning, unless there is one with this key.
  std::function<void(const std::string& key, const SourceLocation& place, const std::string& message)> add;
  /// Adds a name to the warning with this key (`CountedWarnings::add_name`).
  std::function<void(const std::string& key, const SourceLocation& place, const std::string& name,
                     const MessageOfNames& message_of)>
      add_name;
};

/// The properties that a material gives to its faces.
struct Surface {
  description::Index material = 0;
  std::optional<description::Index> area_light;
  description::FloatParameter alpha{1, {}};
  std::map<std::string, description::File> files;  ///< its images, by their names in the MTL file
};
using Materials = std::unordered_map<std::string, Surface>;

/// Reads an MTL file into the scene and adds new materials to `materials`. Images become files of the scene only where
/// faces use their material. An image that is missing is replaced by the neutral value of its role. Relative file names
/// are resolved in `folder`. `access`: for the images, if they are on disk. Throws Error with line and column.
void read_materials(std::string_view text, const std::filesystem::path& folder, const std::string& name,
                    const FileAccess* access, SceneDescription& scene, Materials& materials, const Warnings& warnings);

/// Multiplies the diffuse reflectance of all materials, and the reflectance of metals, by the vertex colours, which are
/// 1 on meshes without any.
void add_vertex_colors(SceneDescription& scene);

/// Finds a picture in the model's folder whose name marks it as the model's colours, such as MODEL_diffuse.png beside
/// MODEL.obj: many collections ship such pictures without an MTL file that names them.
std::optional<std::string> texture_beside(const std::filesystem::path& model);

}  // namespace lanthorn::obj
