// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Saved renders.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "bindings.h"
#include "lanthorn/state.h"

namespace lanthorn::python {

namespace {

using SharedState = std::shared_ptr<RenderState>;

/// A state as a Python object. RenderState itself is incomplete here.
struct SavedState {
  SharedState state;
};

py::list ranges_of(const StateSummary& summary) {
  py::list ranges;
  for (const PassRange& range : summary.passes) ranges.append(py::make_tuple(range.begin, range.end));
  return ranges;
}

SavedState merged(const std::vector<std::filesystem::path>& paths) {
  if (paths.empty()) throw Error("merge: expected at least one state");
  const py::gil_scoped_release release;
  SavedState sum{open_state(paths.front())};
  for (std::size_t i = 1; i < paths.size(); ++i) merge_into(*sum.state, *open_state(paths[i]));
  return sum;
}

}  // namespace

void bind_state(py::module_& module) {
  py::class_<SavedState>(module, "State", "The sums of a saved render: a checkpoint, a shard or a finished render.")
      .def(
          "picture", [](const SavedState& s, bool noise) { return picture_of_state(*s.state, noise); }, py::kw_only(),
          py::arg("noise") = false, py::call_guard<py::gil_scoped_release>(),
          "The Picture so far, with all its layers. noise: adds the layers that `denoise` needs.")
      .def(
          "save", [](const SavedState& s, const std::filesystem::path& path) { save_state(*s.state, path); },
          py::arg("path"), py::call_guard<py::gil_scoped_release>(), "Writes the state, whole or not at all.")
      .def_property_readonly(
          "pass_count", [](const SavedState& s) { return summarize(*s.state).pass_count; }, "int: completed passes.")
      .def_property_readonly(
          "passes", [](const SavedState& s) { return ranges_of(summarize(*s.state)); },
          "list of (int, int): ranges of completed passes, end exclusive.")
      .def_property_readonly(
          "integrator", [](const SavedState& s) { return summarize(*s.state).integrator; }, "str: the method.")
      .def_property_readonly(
          "settings", [](const SavedState& s) { return settings_text(summarize(*s.state).record); },
          "str: a JSON object; its member 'identity' must be equal to resume or to merge.")
      .def("__repr__", [](const SavedState& s) {
        const StateSummary summary = summarize(*s.state);
        return "<lanthorn.State " + summary.integrator + ", " + std::to_string(summary.pass_count) + " passes>";
      });
  module.def(
      "open_state", [](const std::filesystem::path& path) { return SavedState{open_state(path)}; }, py::arg("path"),
      py::call_guard<py::gil_scoped_release>(),
      "Reads a saved state. Raises Error if the file is truncated, damaged or of another version.");
  module.def("merge", &merged, py::arg("paths"),
             "The State of all passes of saved shards of one render, exactly, in any order.\n"
             "Raises Error if passes overlap or the renders differ, naming the first difference.");
}

}  // namespace lanthorn::python
