// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "linked_scene.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "lanthorn/description_data.h"
#include "lanthorn/error.h"
#include "lanthorn/text.h"

namespace lanthorn::program {

namespace {

using plain::Dict;
using plain::Value;

const std::vector<std::string> table_names{"float_textures", "spectrum_textures", "materials", "media", "area_lights",
                                           "shapes",         "objects",           "instances", "lights"};
const std::vector<std::string> single_names{"camera", "film", "filter", "hints", "environment", "color_space"};
// Tables whose entries `edit_scene` can replace.
constexpr std::array<std::string_view, 4> editable{"materials", "area_lights", "lights", "instances"};

bool is_table(const std::string& name) {
  return std::find(table_names.begin(), table_names.end(), name) != table_names.end();
}
bool is_of_view(const std::string& name) { return name == "camera" || name == "film" || name == "filter"; }

const Dict& dict_at(const std::string& place, const Value& value) {
  const auto* dict = value.as<Dict>();
  if (dict == nullptr) throw Error(place + ": expected an object of parts by name, got " + shown(value));
  return *dict;
}

std::vector<std::string> names_of(const std::vector<description::Material>& materials) {
  std::vector<std::string> names;
  names.reserve(materials.size());
  for (const description::Material& material : materials) names.push_back(material.name);
  return names;
}

[[noreturn]] void refuse_part(const std::string& place, const std::string& name) {
  std::vector<std::string> known = table_names;
  known.insert(known.end(), single_names.begin(), single_names.end());
  throw Error(place + ": unknown part " + in_quotes(name) + did_you_mean(name, known));
}

std::string text_at(const std::string& place, const Value& value) {
  if (value.as<std::string>() == nullptr) throw Error(place + ": expected names, got " + shown(value));
  return *value.as<std::string>();
}

}  // namespace

void LinkedScene::take_away(Parts& parts, const Dict& remove, Changes& changes) {
  for (const auto& [table, names] : remove.entries()) {
    if (!is_table(table)) refuse_part("remove", table);
    const auto* list = names.as<plain::List>();
    if (list == nullptr) throw Error("remove." + table + ": expected a list of names, got " + shown(names));
    for (const Value& name : *list) {
      const std::string text = text_at("remove." + table, name);
      if (parts.tables[table].erase(text) == 0)
        throw Error("remove." + table + ": there is no part " + in_quotes(text));
      changes.is_other_scene = true;
    }
  }
}

void LinkedScene::put(Parts& parts, const Dict& set, Changes& changes) {
  for (const auto& [name, value] : set.entries()) {
    if (!is_table(name)) {
      if (std::find(single_names.begin(), single_names.end(), name) == single_names.end()) refuse_part("set", name);
      parts.singles.insert_or_assign(name, value);
      changes.singles.insert(name);
      continue;
    }
    for (const auto& [entry, part] : dict_at("set." + name, value).entries()) {
      if (parts.tables[name].insert_or_assign(entry, part).second) changes.is_other_scene = true;
      changes.entries[name].insert(entry);
    }
  }
}

LinkedScene::Changes LinkedScene::merge(Parts& parts, const Value* set, const Value* remove) {
  Changes changes;
  if (remove != nullptr) take_away(parts, dict_at("remove", *remove), changes);
  if (set != nullptr) put(parts, dict_at("set", *set), changes);
  return changes;
}

Dict LinkedScene::data_of(const Parts& parts) {
  Dict data;
  for (const auto& [name, part] : parts.singles) data.set(name, part);
  for (const auto& [name, table] : parts.tables) {
    Dict entries;
    for (const auto& [entry, part] : table) entries.set(entry, part);
    data.set(name, std::move(entries));
  }
  return data;
}

// All parts are sorted by name, except that materials follow those that they mix. A replaced entry therefore keeps its
// index.
void LinkedScene::note_edits(const SceneDescription& description, const Changes& changes) {
  const auto note = [&](const char* table, auto&& copy) {
    const auto found = changes.entries.find(table);
    if (found == changes.entries.end()) return;
    const Table& all = parts_.tables.at(table);
    for (const std::string& name : found->second)
      copy(static_cast<description::Index>(std::distance(all.begin(), all.find(name))));
  };
  if (const auto found = changes.entries.find("materials"); found != changes.entries.end())
    for (std::size_t i = 0; i < description.materials.size(); ++i)
      if (found->second.contains(description.materials[i].name))
        edits_.materials.insert_or_assign(static_cast<description::Index>(i), description.materials[i]);
  note("area_lights", [&](auto i) { edits_.area_lights.insert_or_assign(i, description.area_lights[i]); });
  note("lights", [&](auto i) { edits_.lights.insert_or_assign(i, description.lights[i]); });
  note("instances", [&](auto i) { edits_.instances.insert_or_assign(i, description.instances[i].object_to_world); });
}

bool LinkedScene::can_edit(const SceneDescription& description, const Changes& changes) const {
  const bool has_environment = parts_.singles.contains("environment");  // it adds lights
  return !changes.is_other_scene && !has_environment && names_of(description.materials) == built_->material_names &&
         std::all_of(changes.entries.begin(), changes.entries.end(),
                     [](const auto& table) {
                       return std::find(editable.begin(), editable.end(), table.first) != editable.end();
                     }) &&
         std::all_of(changes.singles.begin(), changes.singles.end(), &is_of_view);
}

SharedScene LinkedScene::scene_of(Built& built) {
  if (built.scene) return built.scene;
  if (!built.problem.empty()) throw Error(built.problem);
  if (!built.description) throw Error("there is no scene yet: send an update first");
  try {
    built.scene = build_scene(*std::exchange(built.description, std::nullopt));
  } catch (const Error& e) {
    built.problem = e.what();
    throw;
  }
  return built.scene;
}

RenderEdit LinkedScene::change_of(SceneDescription description, const Changes& changes) {
  RenderEdit edit;
  edit.view = description.view;
  if (!can_edit(description, changes)) {
    std::vector<std::string> names = names_of(description.materials);
    built_ = std::make_shared<Built>(Built{std::move(description), {}, {}, std::move(names)});
    edits_ = {};
    edit.scene = [built = built_] { return scene_of(*built); };
  } else if (!changes.entries.empty()) {
    note_edits(description, changes);
    edits_.hash = description.hash;
    edit.scene = [built = built_, edits = edits_, whole = std::make_shared<SceneDescription>(std::move(description))] {
      try {
        return edit_scene(*scene_of(*built), edits);
      } catch (const Error&) {  // the edit requires the scene to be rebuilt
        return build_scene(*whole, built->scene);
      }
    };
  }
  return edit;
}

RenderEdit LinkedScene::update(const Value* set, const Value* remove) {
  Parts parts = parts_;
  const Changes changes = merge(parts, set, remove);
  SceneDescription description = description_of_data(data_of(parts));
  parts_ = std::move(parts);
  view_ = description.view;
  return change_of(std::move(description), changes);
}

SharedScene LinkedScene::build() {
  const bool has_edits =
      !edits_.materials.empty() || !edits_.area_lights.empty() || !edits_.lights.empty() || !edits_.instances.empty();
  try {
    SharedScene scene = scene_of(*built_);
    return has_edits ? edit_scene(*scene, edits_) : scene;
  } catch (const Error&) {
    if (!has_edits) throw;
    return build_scene(description_of_data(data_of(parts_)));
  }
}

}  // namespace lanthorn::program
