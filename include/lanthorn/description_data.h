// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes, edits and options as plain data: the format shared by `lanthorn.load_dict` of the Python module and the
// `lanthorn link` protocol. The keys are the names of the structs' members (docs/python.md).
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "lanthorn/plain_data.h"
#include "lanthorn/plain_value.h"
#include "lanthorn/render_options.h"
#include "lanthorn/scene.h"

namespace lanthorn {

/// Converts a dict to a description. Each table ("materials", "lights", ...) is a list, or a dict of named entries; in
/// a dict, textures and mixes of materials may refer to later entries. References are indices or names. Throws Error
/// with the location of the problem, such as "materials.glass.eta: expected a number, got 'high'".
SceneDescription description_of_data(const plain::Value& data);
/// A description that is read from plain data, and again in parts when the data change. Its `hash` is 0.
class PartialDescription {
 public:
  /// Reads all of `data`, as `description_of_data` does.
  explicit PartialDescription(const plain::Value& data);

  /// Reads those members again that `data` has, and no others. Returns false, and changes nothing, if others depend on
  /// the change, so that all must be read: if entries that may be referred to came, went or changed their order, or if
  /// the environment is concerned. Throws Error as `description_of_data` does, and then changes nothing.
  bool read_again(const plain::Value& data);

  const SceneDescription& description() const { return description_; }

 private:
  SceneDescription description_;
  std::map<std::string, std::shared_ptr<const plain::NameTable>> names_;  ///< by table
};

/// The description and view as a dict of lists; the inverse of `description_of_data`.
plain::Value data_of_description(const SceneDescription& description, const ViewDescription& view);

/// A view and a description with the edits that a dict describes.
struct DescriptionEdits {
  ViewDescription view;
  std::optional<SceneDescription> scene{};  ///< none: only the view changes
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
