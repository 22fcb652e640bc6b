// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes, edits and options as plain data: what `lanthorn.load_dict` of the Python module and the protocol of
// `lanthorn link` have in common. The keys are the members of the structs (docs/python.md).
#pragma once

#include <optional>

#include "lanthorn/plain_value.h"
#include "lanthorn/render_options.h"
#include "lanthorn/scene.h"

namespace lanthorn {

/// A dict to a description. A table ("materials", "lights" ...) is a list, or a dict of entries by name; in such a
/// dict, textures and mixes of materials may refer to entries that come later. References are indices or names. Throws
/// Error with the place of what is wrong, such as "materials.glass.eta: expected a number, got 'high'".
SceneDescription description_of_data(const plain::Value& data);
/// The description as a dict of lists, seen like this.
plain::Value data_of_description(const SceneDescription& description, const ViewDescription& view);

/// What a dict of edits asks for.
struct DescriptionEdits {
  ViewDescription view;
  std::optional<SceneEdits> scene{};  ///< none: only the view changes
};
/// Keys: `camera`, `film` and `filter`, and `materials`, `lights`, `area_lights` and `instances`, which are dicts of
/// entries by name or index, and `environment`. Members that an entry does not have stay as they are in `scene`.
DescriptionEdits edits_of_data(const plain::Value& data, const SceneDescription& scene, const ViewDescription& view);

/// A source, or a dict of the members of EnvironmentChoice.
EnvironmentChoice environment_of_data(const plain::Value& data);

/// The members of RenderOptions; all else are parameters of the method, with "-" or "_" between words.
RenderOptions options_of_data(const plain::Value& data);

}  // namespace lanthorn
