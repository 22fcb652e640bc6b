// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "plain/type.h"

namespace lanthorn {

namespace {

using description::FilterKind;
using nlohmann::json;

using FileHashes = std::map<std::string, std::set<std::string>>;

// The words for the values of an enumeration, in their order.
template <class T>
std::span<const std::string_view> words_of(T) {
  return plain::type_of<T>().names;
}

// The members of each object, for reading and writing alike. `member` takes a name and a variable, and:
// `flag`: is written only if it is true; `added`: keeps its default if it is missing, as in files of before it was
// added; `others`: all other members. An optional variable may be missing, too.

void list_members(description::Filter& f, auto& member) {
  member("kind", f.kind);
  member("radius", f.radius);
  if (f.kind == FilterKind::gaussian) member("sigma", f.sigma);
  if (f.kind == FilterKind::mitchell) {
    member("b", f.b);
    member("c", f.c);
  }
  if (f.kind == FilterKind::sinc) member("tau", f.tau);
}

void list_members(RenderIdentity& i, auto& member) {
  member("version", i.version);
  member("scene_hash", i.scene_hash);
  member("files", i.files);
  member("integrator", i.integrator);
  member("parameters", i.parameters);
  member("seed", i.seed);
  member("color", i.color);
  member("max_depth", i.max_depth);
  member("photons", i.photons);
  member("resolution", i.resolution);
  member("crop", i.crop);
  member("margin", i.margin);
  member("filter", i.filter);
  member("plateau_wavelength_sets", i.wavelength_sets);
  member.flag("heroes_of_paths", i.heroes_of_paths);
  member.flag("filter_lobes_apart", i.filter_lobes_apart);
  for_each_render_option([&](const auto& option) {
    if (option.is_recorded) member(option.name, i.options.*option.value);
  });
  member("view", i.view);
  member("coarse", i.coarse);
  member.others(i.others);
}

void list_members(EyeWork& w, auto& member) {
  member("rays", w.rays);
  member("next_events", w.next_events);
  member("connections", w.connections);
  member("lookups", w.lookups);
  member("merges", w.merges);
}

void list_members(LightWork& w, auto& member) {
  member("rays", w.rays);
  member("vertices", w.vertices);
}

void list_members(UniformEffort& u, auto& member) {
  member("light_paths_per_pixel", u.light_paths_per_pixel);
  member("connections", u.place.connections);
  member("merges", u.place.merges);
  member("merges_in_media", u.place.merges_in_media);
  member("connects_to_lens", u.place.sees);
  member.added("goes_on", u.place.goes_on);
  member("variance", u.variance);
  member("work", u.work);
}

void list_members(EffortReport& r, auto& member) {
  member("summary", r.summary);
  member("caustic_light", r.caustic_light);
  member("caustic_part", r.caustic_part);
  member("light_by_light_paths", r.light_by_light_paths);
  member("light_paths_per_pixel", r.light_paths_per_pixel);
  member("merged_part", r.merged_part);
  member("connected_part", r.connected_part);
  member.added("short_part", r.short_part);
  member("variance", r.variance);
  member("work", r.work);
  member("eye_path", r.work_of_eye_path);
  member("light_path", r.work_of_light_path);
  member("everywhere", r.uniform);
}

void list_members(RenderRecord& r, auto& member) {
  member("identity", r.identity);
  member("scene", r.scene);
  member.added("measures_exposure", r.measures_exposure);
  member.flag("display_emission", r.display_emission);
  member.flag("bias_not_measured", r.bias_not_measured);
  member("findings", r.findings);
  member.others(r.others);
}

std::string dumped(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

template <class T>
concept Enumeration = std::is_enum_v<T>;

/// A struct whose members are listed above.
template <class T>
concept Listed = requires(T& value, int& members) {
  list_members(value, members);
};

class RecordWriter {
 public:
  void operator()(const char* name, auto& value) { object_[name] = written(value); }
  template <class T>
  void operator()(const char* name, std::optional<T>& value) {
    if (value) object_[name] = written(*value);
  }
  void added(const char* name, auto& value) { object_[name] = written(value); }
  void flag(const char* name, bool value) {
    if (value) object_[name] = true;
  }
  void others(const OtherMembers& texts) {
    for (const auto& [name, text] : texts) object_[name] = json::parse(text);
  }

  static json written(Listed auto& value) {
    RecordWriter members;
    list_members(value, members);
    return std::move(members.object_);
  }

 private:
  static json written(const auto& value) { return value; }
  static json written(const Enumeration auto& value) { return words_of(value)[static_cast<std::size_t>(value)]; }
  static json written(const Vec2& v) { return {v.x, v.y}; }
  static json written(const FileHashes& files) {
    json object = json::object();
    for (const auto& [name, hashes] : files) object[name] = hashes.size() == 1 ? json(*hashes.begin()) : json(hashes);
    return object;
  }
  static json written(std::vector<UniformEffort>& choices) {
    json list = json::array();
    for (UniformEffort& choice : choices) list.push_back(written(choice));
    return list;
  }

  json object_ = json::object();
};

class RecordReader {
 public:
  /// `path`: of the object, in messages.
  RecordReader(const json& object, std::string path, const std::string& file)
      : object_(object), path_(std::move(path)), file_(file) {
    require(object.is_object(), "an object", path_);
  }

  void require(bool is_so, const std::string& expected, const std::string& path) const {
    if (!is_so) throw Error({file_}, fmt::format("damaged: expected {} at {}", expected, path));
  }

  void operator()(const char* name, auto& value) {
    static const json missing = json::value_t::discarded;
    const json* const found = find(name);
    read(found ? *found : missing, path_of(name), value);
  }
  template <class T>
  void operator()(const char* name, std::optional<T>& value) {
    if (const json* const found = find(name)) read(*found, path_of(name), value.emplace());
  }
  void added(const char* name, auto& value) {
    if (const json* const found = find(name)) read(*found, path_of(name), value);
  }
  void flag(const char* name, bool& value) { added(name, value); }
  void others(OtherMembers& texts) const {
    for (const auto& [name, value] : object_.items())
      if (!known_.contains(name)) texts[name] = dumped(value);
  }

 private:
  std::string path_of(const std::string& name) const { return path_ + '.' + excerpt(name); }
  const json* find(const std::string& name) {
    known_.insert(name);
    const auto found = object_.find(name);
    return found == object_.end() ? nullptr : &*found;
  }

  void read(const json& from, const std::string& path, Listed auto& to) const {
    RecordReader members(from, path, file_);
    list_members(to, members);
  }
  void read(const json& from, const std::string& path, bool& to) const {
    require(from.is_boolean(), "true or false", path);
    to = from.get<bool>();
  }
  void read(const json& from, const std::string& path, std::string& to) const {
    require(from.is_string(), "text", path);
    to = from.get<std::string>();
  }
  template <std::integral T>
  void read(const json& from, const std::string& path, T& to) const {
    constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<T>::max());
    const bool is_count = from.is_number_unsigned() || (from.is_number_integer() && from.get<std::int64_t>() >= 0);
    require(is_count && from.get<std::uint64_t>() <= most, fmt::format("a count up to {}", most), path);
    to = from.get<T>();
  }
  template <std::floating_point T>
  void read(const json& from, const std::string& path, T& to) const {
    constexpr double most = std::numeric_limits<T>::max();
    const bool is_none = from.is_null();  // written for infinities, and equal to itself when read
    require(is_none || (from.is_number() && from >= -most && from <= most), "a number", path);
    to = is_none ? std::numeric_limits<T>::infinity() : from.get<T>();
  }
  template <Enumeration T>
  void read(const json& from, const std::string& path, T& to) const {
    const auto words = words_of(to);
    const auto* text = from.get_ptr<const std::string*>();
    const auto found = text != nullptr ? std::find(words.begin(), words.end(), *text) : words.end();
    require(found != words.end(), fmt::format("one of {}", fmt::join(words, ", ")), path);
    to = static_cast<T>(found - words.begin());
  }
  template <class T, std::size_t n>
  void read(const json& from, const std::string& path, std::array<T, n>& to) const {
    require(from.is_array() && from.size() == n, fmt::format("{} numbers", n), path);
    for (std::size_t i = 0; i < n; ++i) read(from[i], fmt::format("{}[{}]", path, i), to[i]);
  }
  void read(const json& from, const std::string& path, Vec2& to) const {
    std::array<float, 2> numbers{};
    read(from, path, numbers);
    to = {numbers[0], numbers[1]};
  }
  void read(const json& from, const std::string& path, std::vector<UniformEffort>& to) const {
    require(from.is_array(), "a list", path);
    to.resize(from.size());
    for (std::size_t i = 0; i < to.size(); ++i) read(from[i], fmt::format("{}[{}]", path, i), to[i]);
  }
  template <class T>
  void read(const json& from, const std::string& path, std::map<std::string, T>& to) const {
    require(from.is_object(), "an object", path);
    for (const auto& [name, value] : from.items()) read(value, path + '.' + excerpt(name), to[name]);
  }
  void read(const json& from, const std::string& path, std::set<std::string>& hashes) const {
    for (const json& hash : from.is_array() ? from : json::array({from})) {
      std::string text;
      read(hash, path, text);
      hashes.insert(text);
    }
  }

  const json& object_;
  std::string path_;
  const std::string& file_;
  std::set<std::string> known_;
};

constexpr const char* record_path = "settings";

// Numbers that are possible one by one, but not together.
void check_together(const RenderIdentity& i, const RecordReader& reader) {
  const std::string identity = fmt::format("{}.identity.", record_path);
  const auto& [width, height] = i.resolution;
  const auto& [x0, y0, x1, y1] = i.crop;
  reader.require(x0 < x1 && y0 < y1 && x1 <= width && y1 <= height, "a part of the resolution", identity + "crop");
  const auto& [left, top, right, bottom] = i.margin.value_or(std::array<int, 4>{});
  reader.require(left <= x0 && top <= y0 && right <= width - x1 && bottom <= height - y1,
                 "pixels that are in the resolution", identity + "margin");
  constexpr std::uint32_t most_sets = 16;
  reader.require(!i.wavelength_sets || (*i.wavelength_sets > 0 && *i.wavelength_sets <= most_sets),
                 fmt::format("a count from 1 to {}", most_sets), identity + "plateau_wavelength_sets");
}

}  // namespace

json json_of(RenderIdentity identity) { return RecordWriter::written(identity); }
json json_of(RenderRecord record) { return RecordWriter::written(record); }

std::string settings_text(const RenderRecord& record) { return dumped(json_of(record)); }

RenderRecord read_record(const json& settings, const std::string& file) {
  RenderRecord record;
  RecordReader reader(settings, record_path, file);
  list_members(record, reader);
  check_together(record.identity, reader);
  return record;
}

RenderRecord read_record(const std::string& text, const std::string& file) {
  return read_record(json::parse(text, nullptr, /*allow_exceptions=*/false), file);
}

std::array<int, 2> rendered_size(const RenderIdentity& identity) {
  const auto& [x0, y0, x1, y1] = identity.crop;
  const auto& [left, top, right, bottom] = identity.margin.value_or(std::array<int, 4>{});
  return {left + x1 - x0 + right, top + y1 - y0 + bottom};
}

RenderRecord common_record(const RenderRecord& a, const RenderRecord& b) {
  json common = json_of(a);
  const json other = json_of(b);
  for (auto member = common.begin(); member != common.end();) {
    const auto found = other.find(member.key());
    member = found != other.end() && *found == *member ? std::next(member) : common.erase(member);
  }
  RenderRecord record;
  const std::string nowhere;
  RecordReader reader(common, record_path, nowhere);
  list_members(record, reader);
  return record;
}

}  // namespace lanthorn
