// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "linked_scene.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/text.h"

namespace lanthorn::program {

namespace {

using plain::Dict;
using plain::Value;

const std::vector<std::string> table_names{"float_textures", "spectrum_textures", "materials", "media", "area_lights",
                                           "shapes",         "objects",           "instances", "lights"};
const std::vector<std::string> single_names{"camera", "film", "filter", "hints", "environment", "color_space"};

bool is_table(const std::string& name) {
  return std::find(table_names.begin(), table_names.end(), name) != table_names.end();
}
bool is_of_view(const std::string& name) { return name == "camera" || name == "film" || name == "filter"; }

const Dict& dict_at(const std::string& place, const Value& value) {
  const auto* dict = value.as<Dict>();
  if (dict == nullptr) throw Error(place + ": expected an object of parts by name, got " + shown(value));
  return *dict;
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

LinkedScene::Table& LinkedScene::changed_table(Parts& parts, const std::string& name) {
  std::shared_ptr<const Table>& shared = parts.tables[name];
  const auto own = shared ? std::make_shared<Table>(*shared) : std::make_shared<Table>();
  shared = own;
  return *own;
}

void LinkedScene::take_away(Parts& parts, const Dict& remove, Names& changed) {
  for (const auto& [table, names] : remove.entries()) {
    if (!is_table(table)) refuse_part("remove", table);
    const auto* list = names.as<plain::List>();
    if (list == nullptr) throw Error("remove." + table + ": expected a list of names, got " + shown(names));
    Table& entries = changed_table(parts, table);
    for (const Value& name : *list) {
      const std::string text = text_at("remove." + table, name);
      if (entries.erase(text) == 0) throw Error("remove." + table + ": there is no part " + in_quotes(text));
    }
    changed.insert(table);
  }
}

void LinkedScene::put(Parts& parts, const Dict& set, Names& changed) {
  for (const auto& [name, value] : set.entries()) {
    if (is_table(name)) {
      Table& entries = changed_table(parts, name);
      for (const auto& [entry, part] : dict_at("set." + name, value).entries()) entries.insert_or_assign(entry, part);
    } else {
      if (std::find(single_names.begin(), single_names.end(), name) == single_names.end()) refuse_part("set", name);
      parts.singles.insert_or_assign(name, value);
    }
    changed.insert(name);
  }
}

// `names`: of the tables and single parts that the data contain; null: all.
Dict LinkedScene::data_of(const Parts& parts, const Names* names) {
  Dict data;
  for (const auto& [name, part] : parts.singles)
    if (names == nullptr || names->contains(name)) data.set(name, part);
  for (const auto& [name, table] : parts.tables) {
    if (names != nullptr && !names->contains(name)) continue;
    Dict entries;
    for (const auto& [entry, part] : *table) entries.set(entry, part);
    data.set(name, std::move(entries));
  }
  return data;
}

RenderEdit LinkedScene::update(const Value* set, const Value* remove) {
  Parts parts = parts_;
  Names changed;
  if (remove != nullptr) take_away(parts, dict_at("remove", *remove), changed);
  if (set != nullptr) put(parts, dict_at("set", *set), changed);
  const bool is_partial = description_ && description_->read_again(data_of(parts, &changed));
  if (!is_partial) description_ = PartialDescription(data_of(parts));
  parts_ = std::move(parts);
  // Image files may have changed since the last scene read them.
  if (!is_partial || changed.contains("float_textures") || changed.contains("spectrum_textures"))
    scene_ = std::make_shared<SharedScene>();
  RenderEdit edit{.view = view()};
  if (!is_partial || !std::all_of(changed.begin(), changed.end(), &is_of_view))
    edit.scene = [description = description_->description(), scene = scene_] {
      return *scene = build_scene(description, *scene);
    };
  return edit;
}

SharedScene LinkedScene::build() {
  if (!description_) throw Error("there is no scene yet: send an update first");
  return *scene_ = build_scene(description_->description(), *scene_);
}

}  // namespace lanthorn::program
