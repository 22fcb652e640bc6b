// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes as Python's plain data, and edits of scenes.
#include <utility>

#include "bindings.h"
#include "description_fields.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"

namespace lanthorn::python {

namespace {

using Table = std::map<std::string, Index>;

Table names_in(const py::dict& data, const char* table) {
  Table names;
  if (!data.contains(table) || !py::isinstance<py::list>(data[table])) return names;
  Index index = 0;
  for (const py::handle& item : data[table].cast<py::list>()) {
    if (py::isinstance<py::dict>(item) && item.contains("name") && py::isinstance<py::str>(item["name"]))
      names.emplace(item["name"].cast<std::string>(), index);
    ++index;
  }
  return names;
}

template <class T>
Table names_of(const std::vector<T>& items) {
  Table names;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (!items[i].name.empty()) names.emplace(items[i].name, static_cast<Index>(i));
  return names;
}

constexpr auto view_members =
    std::tuple(field("camera", &ViewDescription::camera), field("film", &ViewDescription::film),
               field("filter", &ViewDescription::filter));
constexpr auto scene_members =
    std::tuple(field("hints", &SceneDescription::hints), field("float_textures", &SceneDescription::float_textures),
               field("spectrum_textures", &SceneDescription::spectrum_textures),
               field("materials", &SceneDescription::materials), field("media", &SceneDescription::media),
               field("area_lights", &SceneDescription::area_lights), field("shapes", &SceneDescription::shapes),
               field("objects", &SceneDescription::objects), field("instances", &SceneDescription::instances),
               field("lights", &SceneDescription::lights), field("color_space", &SceneDescription::color_space));

template <class T, class Members>
void read_listed(Reader& reader, const py::dict& data, T& out, const Members& members, Keys& known) {
  std::apply([&](const auto&... member) { (read_member(reader, data, out, member, known), ...); }, members);
}

// States belong to the files that the scene names, too.
void mix_files(Reader& reader, const SceneDescription& scene) {
  const auto mix = [&](const std::string& name) {
    if (!name.empty() && !scene.access.is_missing(name)) reader.mix(scene.access.read(name));
  };
  const auto mix_image = [&](const auto& textures) {
    for (const auto& texture : textures)
      if (const auto* image = std::get_if<description::ImageTexture>(&texture.node)) mix(image->filename);
  };
  mix_image(scene.float_textures);
  mix_image(scene.spectrum_textures);
  for (const description::Light& light : scene.lights)
    if (const auto* infinite = std::get_if<description::InfiniteLight>(&light.node)) mix(infinite->image.value_or(""));
}

// The entry of a table that an edit means: by index, or by the name that its material has.
Index edited_entry(Reader& reader, py::handle key, const char* table) {
  Index index = 0;
  read_reference(reader, key, table, index);
  return index;
}

std::string place_of(py::handle key) { return "[" + py::repr(key).cast<std::string>() + "]"; }

// Each edit starts from what is there: keys that are missing stay as they are.
template <class T>
void read_edits(Reader& reader, const py::dict& edits, const char* table, const std::vector<T>& old,
                std::map<Index, T>& out) {
  if (!edits.contains(table)) return;
  const py::object data = edits[table];
  reader.at(table, [&] {
    require_dict(reader, data);
    for (const auto& edit : data.cast<py::dict>()) {  // no structured binding: Clang 14 cannot capture it
      reader.at(place_of(edit.first), [&] {
        const Index index = edited_entry(reader, edit.first, table);
        if (index >= old.size())
          reader.fail("expected an index below " + std::to_string(old.size()) + ", got " + std::to_string(index));
        T entry = old[index];
        read(reader, edit.second, entry);
        out.emplace(index, std::move(entry));
      });
    }
  });
}

}  // namespace

SceneDescription description_of_dict(const py::dict& data) {
  Reader reader;
  for (const char* table : {"materials", "media", "objects"}) reader.names[table] = names_in(data, table);
  SceneDescription scene;
  Keys known{"environment"};
  read_listed(reader, data, scene.view, view_members, known);
  read_listed(reader, data, scene, scene_members, known);
  refuse_other_keys(reader, data, known);
  if (scene.materials.empty()) scene.materials.emplace_back();
  mix_files(reader, scene);
  scene.hash = reader.hash;
  if (data.contains("environment")) replace_environment(scene, environment_of(data["environment"]));
  return scene;
}

py::dict dict_of_description(const SceneDescription& description, const ViewDescription& view) {
  py::dict data;
  const auto write_listed = [&](const auto& value, const auto& members) {
    std::apply([&](const auto&... member) { (write_member(data, value, member), ...); }, members);
  };
  write_listed(view, view_members);
  write_listed(description, scene_members);
  return data;
}

EnvironmentChoice environment_of(py::handle data) {
  if (py::isinstance<py::str>(data)) return {.source = data.cast<std::string>()};
  Reader reader;
  EnvironmentChoice choice;
  require_dict(reader, data);
  const auto dict = py::reinterpret_borrow<py::dict>(data);
  constexpr auto members =
      std::tuple(field("source", &EnvironmentChoice::source), field("rotation", &EnvironmentChoice::rotation),
                 field("scale", &EnvironmentChoice::scale));
  Keys known{"up"};
  reader.at("environment", [&] {
    read_listed(reader, dict, choice, members, known);
    if (dict.contains("up")) {
      std::string up;
      read(reader, dict["up"], up);
      if (up != "y" && up != "z") reader.fail("one of 'y', 'z'", dict["up"]);
      choice.up = up == "y" ? UpAxis::y : UpAxis::z;
    }
    refuse_other_keys(reader, dict, known);
  });
  return choice;
}

SeenScene edited(const SeenScene& scene, const py::dict& edits) {
  const SceneDescription& old = description_of(*scene.scene);
  Reader reader;
  reader.names["materials"] = names_of(old.materials);
  reader.names["media"] = names_of(old.media);
  reader.names["objects"] = names_of(old.objects);
  for (std::size_t i = 0; i < old.lights.size(); ++i)
    reader.names["lights"].emplace(name_of_light(static_cast<Index>(i)), static_cast<Index>(i));
  for (std::size_t i = 0; i < old.area_lights.size(); ++i)
    reader.names["area_lights"].emplace(name_of_area_light(static_cast<Index>(i)), static_cast<Index>(i));

  SeenScene result = scene;
  Keys known{"materials", "lights", "area_lights", "instances", "environment"};
  read_listed(reader, edits, result.view, view_members, known);
  refuse_other_keys(reader, edits, known);

  SceneEdits changes;
  // What the view has read is part of the view's own identity.
  reader.hash = old.hash;
  read_edits(reader, edits, "materials", old.materials, changes.materials);
  read_edits(reader, edits, "lights", old.lights, changes.lights);
  read_edits(reader, edits, "area_lights", old.area_lights, changes.area_lights);
  std::vector<AnimatedTransform> places;
  for (const description::Instance& instance : old.instances) places.push_back(instance.object_to_world);
  read_edits(reader, edits, "instances", places, changes.instances);
  if (edits.contains("environment")) {
    changes.environment = environment_of(edits["environment"]);
    reader.mix(py::repr(edits["environment"]).cast<std::string>());
  }
  changes.hash = reader.hash;
  const bool is_scene_edited = !changes.materials.empty() || !changes.lights.empty() || !changes.area_lights.empty() ||
                               !changes.instances.empty() || changes.environment;
  if (is_scene_edited) {
    const py::gil_scoped_release release;
    result.scene = edit_scene(*scene.scene, changes);
  }
  return result;
}

}  // namespace lanthorn::python
