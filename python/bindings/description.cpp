// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes as Python's plain data, and edits of scenes.
#include <utility>

#include "bindings.h"
#include "lanthorn/description_data.h"
#include "plain_data.h"

namespace lanthorn::python {

SceneDescription description_of_dict(const py::dict& data) { return description_of_data(value_of(data)); }

py::dict dict_of_description(const SceneDescription& description, const ViewDescription& view) {
  return object_of(data_of_description(description, view));
}

EnvironmentChoice environment_of(py::handle data) { return environment_of_data(value_of(data)); }

RenderOptions options_of(const py::dict& keywords) { return options_of_data(value_of(keywords)); }

SeenScene edited(const SeenScene& scene, const py::dict& edits) {
  DescriptionEdits changes = edits_of_data(value_of(edits), description_of(*scene.scene), scene.view);
  SeenScene result{scene.scene, std::move(changes.view)};
  if (changes.scene) {
    const py::gil_scoped_release release;
    result.scene = build_scene(*std::move(changes.scene), scene.scene);
  }
  return result;
}

py::list texts_of(const std::vector<description::Warning>& warnings) {
  py::list texts;
  for (const description::Warning& warning : warnings) texts.append(Error(warning.location, warning.message).what());
  return texts;
}

}  // namespace lanthorn::python
