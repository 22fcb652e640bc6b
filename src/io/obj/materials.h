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

#include "lanthorn/scene_description.h"

namespace lanthorn::obj {

/// Adds a warning, unless there is one with this key.
using Warn = std::function<void(const std::string& key, const SourceLocation& place, const std::string& message)>;

/// The properties that a material gives to its faces.
struct Surface {
  description::Index material = 0;
  std::optional<description::Index> area_light;
  description::FloatParameter alpha{1, {}};
  std::map<std::string, description::File> files;  ///< its images, by their names in the MTL file
};
using Materials = std::unordered_map<std::string, Surface>;

/// Reads an MTL file into the scene and adds new materials to `materials`. Images become files of the scene only where
/// faces use their material: unused ones may be missing. Relative file names are resolved in `folder`. `access`: for
/// the images, if they are on disk. Throws Error with line and column.
void read_materials(std::string_view text, const std::filesystem::path& folder, const std::string& name,
                    const FileAccess* access, SceneDescription& scene, Materials& materials, const Warn& warn);

/// Multiplies the diffuse reflectance of all materials, and the reflectance of metals, by the vertex colours, which are
/// 1 on meshes without any.
void add_vertex_colors(SceneDescription& scene);

}  // namespace lanthorn::obj
