// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/description_data.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/plain_data.h"
#include "lanthorn/text.h"
#include "plain/type.h"

namespace lanthorn {

using namespace plain;
using description::Index;

namespace {

// Depth-first traversal along references.
class ReferenceOrder {
 public:
  ReferenceOrder(Reader& reader, const Dict& table) : reader_(reader) {
    for (const Dict::Entry& entry : table.entries()) places_.emplace(entry.first, Place{&entry, Mark::unseen});
    for (const Dict::Entry& entry : table.entries()) visit(entry.first);
  }
  std::vector<const Dict::Entry*> take() { return std::move(order_); }

 private:
  enum class Mark : std::uint8_t { unseen, open, done };
  struct Place {
    const Dict::Entry* entry;
    Mark mark;
  };

  // Unknown names are left to the reader, which reports them.
  void visit(const std::string& name) {
    const auto found = places_.find(name);
    if (found == places_.end() || found->second.mark == Mark::done) return;
    if (found->second.mark == Mark::open) reader_.fail(in_quotes(name) + " refers to itself");
    found->second.mark = Mark::open;
    visit_references(found->second.entry->second);
    found->second.mark = Mark::done;
    order_.push_back(found->second.entry);
  }

  void visit_name(const Value& name) {
    if (name.as<std::string>() != nullptr) visit(*name.as<std::string>());
  }

  void visit_references(const Value& value) {
    if (const auto* list = value.as<List>())
      for (const Value& item : *list) visit_references(item);
    if (const auto* dict = value.as<Dict>())
      for (const auto& [key, item] : dict->entries()) {
        if (key == "texture") visit_name(item);
        if (key == "materials" && item.as<List>() != nullptr)
          for (const Value& name : *item.as<List>()) visit_name(name);
        visit_references(item);
      }
  }

  Reader& reader_;
  std::map<std::string, Place> places_;
  std::vector<const Dict::Entry*> order_;
};

// The entries of a dict of textures or materials in an order in which each one follows those that it refers to by
// {"texture": name} or, in a mix, {"materials": [names]}. Fails for entries that refer to themselves.
std::vector<const Dict::Entry*> in_reference_order(Reader& reader, const Dict& table) {
  return ReferenceOrder(reader, table).take();
}

bool is_table(const Member& member) { return member.type->kind == Kind::list; }

// An entry of a table, with its path in messages and, unless the table is a list, its name in references.
struct TableEntry {
  std::string step, name;
  const Value* value = nullptr;
};

std::string own_name(const Value& entry) {
  const auto* dict = entry.as<Dict>();
  const Value* name = dict != nullptr ? dict->find("name") : nullptr;
  return name != nullptr && name->as<std::string>() != nullptr ? *name->as<std::string>() : "";
}

std::vector<TableEntry> entries_of(Reader& reader, const std::string& table, const Value& data) {
  std::vector<TableEntry> entries;
  if (const auto* list = data.as<List>()) {
    for (const Value& value : *list)
      entries.push_back({"[" + std::to_string(entries.size()) + "]", own_name(value), &value});
  } else if (const auto* dict = data.as<Dict>()) {
    const bool is_ordered = table.ends_with("_textures") || table == "materials";
    if (is_ordered)
      for (const Dict::Entry* entry : in_reference_order(reader, *dict))
        entries.push_back({"." + entry->first, entry->first, &entry->second});
    else
      for (const auto& [name, value] : dict->entries()) entries.push_back({"." + name, name, &value});
  } else {
    reader.fail("a list", data);
  }
  return entries;
}

template <class T>
std::shared_ptr<const NameTable> names_of(const std::vector<T>& items) {
  NameTable names;
  for (std::size_t i = 0; i < items.size(); ++i)
    if (!items[i].name.empty()) names.emplace(items[i].name, static_cast<Index>(i));
  return std::make_shared<const NameTable>(std::move(names));
}

using Tables = std::map<std::string, std::vector<TableEntry>>;

Tables tables_of(Reader& reader, const Dict& data) {
  Tables tables;
  for (const Member& member : type_of<SceneDescription>().members)
    if (const Value* table = is_table(member) ? data.find(member.name) : nullptr)
      reader.at(member.name, [&] { tables.emplace(member.name, entries_of(reader, member.name, *table)); });
  for (const auto& [table, entries] : tables) reader.names[table] = names_of(entries);
  return tables;
}

// The entry's own name is the one that others refer to it by.
void set_name(const Type& type, void* entry, const std::string& name) {
  for (const Member& member : type.members)
    if (member.name != nullptr && member.name == std::string_view("name"))
      *static_cast<std::string*>(member.of(entry)) = name;
}

void read_table(Reader& reader, const std::vector<TableEntry>& entries, const Type& list, void* out) {
  const Type& type = *list.items[0];
  list.resize(out, entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i)
    reader.at(entries[i].step, [&] {
      read(reader, *entries[i].value, type, list.item(out, i));
      set_name(type, list.item(out, i), entries[i].name);
    });
}

Reader reader_for(const SceneDescription& scene) {
  Reader reader;
  reader.names["materials"] = names_of(scene.materials.entries());
  reader.names["media"] = names_of(scene.media.entries());
  reader.names["objects"] = names_of(scene.objects.entries());
  const auto number = [&](const char* table, std::size_t count, auto&& name_of) {
    NameTable names;
    for (Index i = 0; i < count; ++i) names.emplace(name_of(i), i);
    reader.names[table] = std::make_shared<const NameTable>(std::move(names));
  };
  number("lights", scene.lights.size(), name_of_light);
  number("area_lights", scene.area_lights.size(), name_of_area_light);
  return reader;
}

// The identity of states includes the files that the scene names.
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

bool is_whole_number(const std::string& text) {
  return !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == std::string::npos;
}

// The entry of a table that an edit refers to: by name if one matches, or else by index.
Index edited_entry(Reader& reader, const std::string& key, const char* table) {
  Index index = 0;
  const bool is_index = is_whole_number(key) && !reader.names_in(table).contains(key);
  read_reference(reader, is_index ? Value(static_cast<std::int64_t>(std::stol(key))) : Value(key), table, index);
  return index;
}

// The edited entries of a table. Each edit starts from the existing entry: missing keys keep their values.
template <class T>
std::map<Index, T> read_edits(Reader& reader, const Dict& edits, const char* table, const std::vector<T>& old) {
  std::map<Index, T> entries;
  const Value* data = edits.find(table);
  if (data == nullptr) return entries;
  reader.at(table, [&] {
    for (const auto& edit : dict_of(reader, *data).entries()) {  // no structured binding: Clang 14 cannot capture it
      const std::string& key = edit.first;
      reader.at("[" + (is_whole_number(key) ? key : "'" + key + "'") + "]", [&] {
        const Index index = edited_entry(reader, key, table);
        if (index >= old.size())
          reader.fail("expected an index below " + std::to_string(old.size()) + ", got " + std::to_string(index));
        T entry = old[index];
        read(reader, edit.second, entry);
        entries.emplace(index, std::move(entry));
      });
    }
  });
  return entries;
}

template <class T>
void replace(description::Table<T>& table, const std::map<Index, T>& by) {
  for (const auto& [index, entry] : by) table[index] = entry;
}

void mix_environment(Reader& reader, const EnvironmentChoice& choice) {
  reader.mix(choice.source);
  reader.mix(&choice.rotation, sizeof(choice.rotation));
  reader.mix(&choice.scale, sizeof(choice.scale));
}

// Gives those members that `data` has their default values.
void reset_members(const Dict& data, const Type& type, void* out, void* defaults) {
  for (const Member& member : type.members)
    if (member.name == nullptr)
      reset_members(data, *member.type, member.of(out), member.of(defaults));
    else if (data.contains(member.name))
      member.type->assign(member.of(out), member.of(defaults));
}

// Reads those members of the description that `data` has, all but the environment. `tables`: those in `data`.
void read_present(Reader& reader, const Dict& data, const Tables& tables, SceneDescription& scene) {
  SceneDescription defaults;
  reset_members(data, type_of<SceneDescription>(), &scene, &defaults);
  Keys known{"environment"};
  for (const Member& member : type_of<SceneDescription>().members)
    if (is_table(member))
      known.emplace_back(member.name);
    else
      read_member(reader, data, member, &scene, known);
  refuse_other_keys(reader, data, known);
  for (const Member& member : type_of<SceneDescription>().members)
    if (is_table(member) && tables.contains(member.name))
      reader.at(member.name, [&] { read_table(reader, tables.at(member.name), *member.type, member.of(&scene)); });
  if (scene.materials.empty()) scene.materials.emplace_back();
}

SceneDescription read_all(Reader& reader, const Value& value) {
  const Dict& data = dict_of(reader, value);
  SceneDescription scene;
  const Tables tables = tables_of(reader, data);
  read_present(reader, data, tables, scene);
  if (reader.is_hashing) mix_files(reader, scene);
  scene.hash = reader.hash;
  if (const Value* environment = data.find("environment"))
    replace_environment(scene, environment_of_data(*environment));
  return scene;
}

// Entries of these tables are not referred to.
bool is_leaf(const std::string& table) { return table == "shapes" || table == "instances" || table == "lights"; }

}  // namespace

SceneDescription description_of_data(const Value& data) {
  Reader reader;
  return read_all(reader, data);
}

PartialDescription::PartialDescription(const Value& data) {
  Reader reader;
  reader.is_hashing = false;
  description_ = read_all(reader, data);
  names_ = std::move(reader.names);
}

bool PartialDescription::read_again(const Value& value) {
  Reader reader;
  reader.is_hashing = false;
  reader.names = names_;
  const Dict& data = dict_of(reader, value);
  const Tables tables = tables_of(reader, data);
  for (const auto& [table, entries] : tables) {
    const auto before = names_.find(table);
    if (!is_leaf(table) && (before == names_.end() || *before->second != reader.names_in(table))) return false;
  }
  const bool has_environment = !description_.environment.source.empty();
  if (data.contains("environment") || (has_environment && data.contains("lights"))) return false;
  SceneDescription scene = description_;
  read_present(reader, data, tables, scene);
  const auto is_mirrored = [](const SceneDescription& s) {
    return s.view.camera.camera_to_world.start.swaps_handedness();
  };
  if (has_environment && is_mirrored(scene) != is_mirrored(description_)) return false;
  description_ = std::move(scene);
  names_ = std::move(reader.names);
  return true;
}

Value data_of_description(const SceneDescription& description, const ViewDescription& view) {
  Dict data;
  write_members(data, type_of<ViewDescription>(), &view);
  for (const Member& member : type_of<SceneDescription>().members)
    if (member.name != nullptr) write_member(data, member, &description);
  return data;
}

EnvironmentChoice environment_of_data(const Value& data) {
  if (data.as<std::string>() != nullptr) return {.source = *data.as<std::string>()};
  Reader reader;
  EnvironmentChoice choice;
  reader.at("environment", [&] { read(reader, data, choice); });
  return choice;
}

DescriptionEdits edits_of_data(const Value& value, const SceneDescription& scene, const ViewDescription& view) {
  Reader reader = reader_for(scene);
  const Dict& data = dict_of(reader, value);
  DescriptionEdits result{.view = view};
  Keys known{"materials", "lights", "area_lights", "instances", "environment"};
  read_members(reader, data, type_of<ViewDescription>(), &result.view, known);
  refuse_other_keys(reader, data, known);

  // Excludes the members of the view, because they are part of the view's own identity.
  reader.hash = scene.hash;
  const auto materials = read_edits(reader, data, "materials", scene.materials.entries());
  const auto lights = read_edits(reader, data, "lights", scene.lights.entries());
  const auto area_lights = read_edits(reader, data, "area_lights", scene.area_lights.entries());
  std::vector<AnimatedTransform> places;
  for (const description::Instance& instance : scene.instances) places.push_back(instance.object_to_world);
  const auto instances = read_edits(reader, data, "instances", places);
  std::optional<EnvironmentChoice> choice;
  if (const Value* environment = data.find("environment")) {
    choice = environment_of_data(*environment);
    mix_environment(reader, *choice);
  }
  if (materials.empty() && lights.empty() && area_lights.empty() && instances.empty() && !choice) return result;
  SceneDescription& edited = result.scene.emplace(scene);
  edited.hash = reader.hash;
  replace(edited.materials, materials);
  replace(edited.area_lights, area_lights);
  if (choice) replace_environment(edited, *choice);
  if (!lights.empty() && lights.rbegin()->first >= edited.lights.size())
    throw Error("the scene has no light with index " + std::to_string(lights.rbegin()->first));
  replace(edited.lights, lights);
  for (const auto& [index, place] : instances) edited.instances[index].object_to_world = place;
  return result;
}

}  // namespace lanthorn
