// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes: loading from files and Python data, conversion to plain data, and editing.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>
#include <string>
#include <utility>

#include "bindings.h"
#include "lanthorn/description_data.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "plain_data.h"

namespace lanthorn::python {

SceneDescription description_of_dict(const py::dict& data) { return description_of_data(value_of(data)); }

RenderOptions options_of(const py::dict& keywords) { return options_of_data(value_of(keywords)); }

py::list texts_of(const std::vector<description::Warning>& warnings) {
  py::list texts;
  for (const description::Warning& warning : warnings) texts.append(Error(warning.location, warning.message).what());
  return texts;
}

namespace {

SeenScene built(SceneDescription description) {
  ViewDescription view = description.view;
  SharedScene scene = build_scene(std::move(description));
  return {std::move(scene), std::move(view)};
}

SeenScene load_file(const std::filesystem::path& path, const py::object& environment, const std::string& camera,
                    const std::string& variant, const std::optional<double>& at, bool sandbox, bool skip_missing,
                    bool window_glass) {
  ReadOptions options{.sandbox = sandbox,
                      .skip_missing = skip_missing,
                      .window_glass = window_glass,
                      .at = at,
                      .camera = camera,
                      .variant = variant};
  if (!environment.is_none()) options.environment = environment_of_data(value_of(environment));
  const py::gil_scoped_release release;
  return built(read_scene(path, options));
}

SeenScene load_string(const std::string& text, const std::filesystem::path& folder, const std::string& name) {
  return built(read_pbrt_string(text, folder, name));
}

SeenScene load_dict(const py::dict& data) {
  SceneDescription description = description_of_dict(data);
  const py::gil_scoped_release release;
  return built(std::move(description));
}

// The scene with the replacements in the keywords `camera`, `film`, `filter`, `materials`, `lights`, `area_lights`,
// `instances` and `environment`.
SeenScene edited(const SeenScene& scene, const py::kwargs& edits) {
  DescriptionEdits changes = edits_of_data(value_of(edits), description_of(*scene.scene), scene.view);
  SeenScene result{scene.scene, std::move(changes.view)};
  if (changes.scene) result.scene = without_gil([&] { return build_scene(*std::move(changes.scene), scene.scene); });
  return result;
}

py::dict summary_of(const SeenScene& seen) {
  const SceneSummary summary = summarize(*seen.scene);
  py::dict data;
  data["triangles"] = summary.triangles;
  data["patches"] = summary.patches;
  data["quadrics"] = summary.quadrics;
  data["curves"] = summary.curves;
  data["instances"] = summary.instances;
  data["textures"] = summary.textures;
  data["lights"] = summary.lights;
  data["materials"] = summary.materials;
  data["bounds"] = py::make_tuple(write(summary.bounds.min), write(summary.bounds.max));
  data["bytes"] = summary.geometry_bytes + summary.bvh_bytes + summary.texture_bytes;
  data["build_seconds"] = summary.build_seconds;
  return data;
}

py::list lights_as_list(const SeenScene& seen) {
  py::list lights;
  for (const NamedLight& light : lights_of(*seen.scene)) lights.append(py::make_tuple(light.id, light.words));
  return lights;
}

py::list names_of_materials(const SeenScene& seen) {
  py::list names;
  for (const description::Material& material : description_of(*seen.scene).materials) names.append(material.name);
  return names;
}

LookAt look_of(const py::object& eye, const py::object& target, const py::object& up) {
  Reader reader;
  LookAt look;
  reader.at("eye", [&] { read(reader, eye, look.eye); });
  reader.at("target", [&] { read(reader, target, look.target); });
  reader.at("up", [&] { read(reader, up, look.up); });
  constexpr double least_sine = 1e-6;
  const DVec3 view = look.target - look.eye;
  if (!(glm::length(glm::cross(view, look.up)) > least_sine * glm::length(view) * glm::length(look.up)))
    throw Error("look_at: `eye`, `target` and `up` must not lie on one line");
  return look;
}

// As `--look-at`: keeps the mirroring and scale of the camera's transform.
SeenScene look(const SeenScene& seen, const py::object& eye, const py::object& target, const py::object& up) {
  const LookAt look = look_of(eye, target, up);
  const DVec3 origin = description_of(*seen.scene).origin;
  SeenScene result = seen;
  description::Camera& camera = result.view.camera;
  const Transform& before = camera.camera_to_world.start;
  Vec3 factors{glm::length(before.vector({1, 0, 0})), glm::length(before.vector({0, 1, 0})),
               glm::length(before.vector({0, 0, 1}))};
  if (before.swaps_handedness()) factors.x = -factors.x;
  const Transform to_world = lanthorn::look_at(look.eye - origin, look.target - origin, look.up).inverted();
  camera.camera_to_world = AnimatedTransform(to_world * lanthorn::scale(factors));
  camera.subject.reset();
  return result;
}

void add_row(std::string& html, const std::string& name, const std::string& value) {
  html += "<tr><th style='text-align:left'>" + name + "</th><td>" + value + "</td></tr>";
}
std::string counted(const std::map<std::string, int>& numbers) {
  std::string text;
  for (const auto& [kind, count] : numbers) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
  return text.empty() ? "none" : text;
}
// Shows only names of kinds and counts, so that no text of a file gets into the page.
std::string html_of(const SeenScene& seen) {
  const SceneSummary summary = summarize(*seen.scene);
  const auto size = film_size(seen.view);
  std::string html = "<table>";
  add_row(html, "picture", std::to_string(size[0]) + " × " + std::to_string(size[1]) + " pixels");
  add_row(html, "triangles", std::to_string(summary.triangles));
  add_row(html, "other shapes", std::to_string(summary.patches + summary.quadrics + summary.curves));
  add_row(html, "instances", std::to_string(summary.instances));
  add_row(html, "lights", counted(summary.lights));
  add_row(html, "materials", counted(summary.materials));
  add_row(html, "warnings", std::to_string(warnings_of(*seen.scene, seen.view).size()));
  return html + "</table>";
}
std::string text_of(const SeenScene& seen) {
  const SceneSummary summary = summarize(*seen.scene);
  const auto size = film_size(seen.view);
  const auto others = summary.patches + summary.quadrics + summary.curves;
  return "<lanthorn.Scene " + std::to_string(size[0]) + " x " + std::to_string(size[1]) + ", " +
         std::to_string(summary.triangles) + " triangles, " + std::to_string(others) +
         " other shapes, lights: " + counted(summary.lights) + ", materials: " + counted(summary.materials) + ">";
}

template <class Make>
py::object matrix(const py::object& vector, const char* name, Make&& make) {
  Reader reader;
  DVec3 v{0.0};
  reader.at(name, [&] { read(reader, vector, v); });
  return write(make(v));
}

void bind_transforms(py::module_& module) {
  module.def(
      "translate",
      [](const py::object& offset) { return matrix(offset, "offset", [](const DVec3& v) { return translate(v); }); },
      py::arg("offset"), "The 4 x 4 matrix that moves points by `offset` (x, y, z), metres.");
  module.def(
      "scale",
      [](const py::object& factors) { return matrix(factors, "factors", [](const DVec3& v) { return scale(v); }); },
      py::arg("factors"), "The 4 x 4 matrix that scales by `factors` (x, y, z).");
  module.def(
      "rotate",
      [](double degrees, const py::object& axis) {
        return matrix(axis, "axis", [&](const DVec3& v) { return rotate(degrees, v); });
      },
      py::arg("degrees"), py::arg("axis"),
      "The 4 x 4 matrix of a right-handed rotation by `degrees` about `axis` (x, y, z), of any length.");
  module.def(
      "look_at",
      [](const py::object& eye, const py::object& target, const py::object& up) {
        const LookAt look = look_of(eye, target, up);
        // Camera space is left-handed, as in pbrt; mirror it for a right-handed world.
        return write(lanthorn::look_at(look.eye, look.target, look.up).inverted() * lanthorn::scale({-1, 1, 1}));
      },
      py::arg("eye"), py::arg("target"), py::arg("up") = py::make_tuple(0, 1, 0),
      "The 4 x 4 matrix camera_to_world of a camera at `eye` that looks at `target`, with `up` upwards in the\n"
      "picture. Each is (x, y, z) in metres, in right-handed coordinates: seen along -z, +x is to the right.");
}

}  // namespace

void bind_scene(py::module_& module) {
  py::class_<SeenScene>(module, "Scene",
                        "A scene that can be rendered, with its camera. Immutable: `edit` and `look_at` return\n"
                        "another scene, which shares geometry and images with this one.")
      .def("edit", &edited,
           "The scene with replacements; takes a fraction of a millisecond unless geometry must be rebuilt.\n\n"
           "camera, film, filter: dicts as in `description`; omitted keys keep their values.\n"
           "materials: {index or name: dict}; lights: {index or 'light1': dict}; area_lights: {index or 'area1': "
           "dict};\n"
           "instances: {index: 4 x 4 matrix}; environment: a name, a file, or {'source', 'rotation', 'scale', 'up'}.\n"
           "Raises Error, naming the place in the data, for invalid edits.")
      .def("look_at", &look, py::arg("eye"), py::arg("target"), py::arg("up") = py::make_tuple(0, 1, 0),
           "The scene with its camera at `eye`, looking at `target`: (x, y, z) in metres, in the file's coordinates.")
      .def_property_readonly(
          "description",
          [](const SeenScene& s) { return object_of(data_of_description(description_of(*s.scene), s.view)); },
          "dict: the scene as plain data, as `load_dict` takes it. The meshes of a built scene are\n"
          "empty: only the ray tracer has them.")
      .def_property_readonly("summary", &summary_of,
                             "dict: numbers of triangles, lights and materials by kind; bounds in metres; bytes.")
      .def_property_readonly("lights", &lights_as_list,
                             "list of (str, str): each light's name in `edit`, and its description.")
      .def_property_readonly("materials", &names_of_materials,
                             "list of str: names of the materials by index; empty for anonymous ones.")
      .def_property_readonly(
          "warnings", [](const SeenScene& s) { return texts_of(warnings_of(*s.scene, s.view)); },
          "list of str: unsupported features of the scene, and what replaces them.")
      .def_property_readonly(
          "resolution",
          [](const SeenScene& s) {
            const auto size = film_size(s.view);
            return py::make_tuple(size[0], size[1]);
          },
          "(int, int): width and height in pixels, unless options override them.")
      .def("_repr_html_", &html_of, "Representation in notebooks.")
      .def("__repr__", &text_of);
  module.def(
      "load_file", &load_file, py::arg("path"), py::kw_only(), py::arg("environment") = py::none(),
      py::arg("camera") = "", py::arg("variant") = "", py::arg("at") = py::none(), py::arg("sandbox") = false,
      py::arg("skip_missing") = false, py::arg("window_glass") = false,
      "Reads a scene from a .pbrt, .gltf, .glb or .obj file, each also gzipped, and builds it.\n\n"
      "environment: a name (see `environments`), an image file, or a dict {'source', 'rotation' (degrees), 'scale',\n"
      "'up' ('y' or 'z')}, which replaces the scene's own. camera, variant (of the materials): of a glTF file, name "
      "or\n"
      "number from 1. at: seconds into a glTF animation. sandbox: reads only files below the scene's folder. "
      "skip_missing: continues without\n"
      "missing files. window_glass: light passes straight through clear panes.\n"
      "Raises Error with file, line and column.");
  module.def("load_string", &load_string, py::arg("text"), py::kw_only(), py::arg("folder") = ".",
             py::arg("name") = "text", py::call_guard<py::gil_scoped_release>(),
             "Reads a scene from the text of a pbrt-v4 file. Relative file names are resolved in `folder`; messages "
             "call it `name`.");
  module.def("load_dict", &load_dict, py::arg("description"),
             "Builds a scene from plain data: a dict with the members of SceneDescription (docs/python.md).\n\n"
             "Arrays may be numpy's. Raises Error that names the location: \"shapes[0].radius: expected a number, got "
             "'wide'\".");
  module.def("environments", &environment_names, "list of str: built-in environments, which need no file.");
  bind_transforms(module);
}

}  // namespace lanthorn::python
