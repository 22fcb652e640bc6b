// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes, edits and options as plain data: the format shared by `lanthorn.load_dict` of the Python module and the
// `lanthorn link` protocol. The keys are the names of the structs' members (docs/python.md).
#pragma once

#include <optional>

#include "lanthorn/plain_value.h"
#include "lanthorn/render_options.h"
#include "lanthorn/scene.h"

namespace lanthorn {

/// Converts a dict to a description. Each table ("materials", "lights", ...) is a list, or a dict of named entries; in
/// a dict, textures and mixes of materials may refer to later entries. References are indices or names. Throws Error
/// with the location of the problem, such as "materials.glass.eta: expected a number, got 'high'".
SceneDescription description_of_data(const plain::Value& data);
/// The description and view as a dict of lists; the inverse of `description_of_data`.
plain::Value data_of_description(const SceneDescription& description, const ViewDescription& view);

/// The edits that a dict describes.
struct DescriptionEdits {
  ViewDescription view;
  std::optional<SceneEdits> scene{};  ///< none: only the view changes
};
/// Keys: `camera`, `film`, `filter`, `environment`, and `materials`, `lights`, `area_lights`, `instances`, which are
/// dicts of entries by name or index. Members that an entry omits keep their values from `scene`.
DescriptionEdits edits_of_data(const plain::Value& data, const SceneDescription& scene, const ViewDescription& view);

/// `data` is the environment's source, or a dict of the members of EnvironmentChoice.
EnvironmentChoice environment_of_data(const plain::Value& data);

/// Converts a dict of the members of RenderOptions; all other keys are parameters of the method, with "-" or "_"
/// between words.
RenderOptions options_of_data(const plain::Value& data);

}  // namespace lanthorn
