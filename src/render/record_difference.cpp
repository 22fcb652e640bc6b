// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lanthorn/text.h"
#include "render/record.h"

namespace lanthorn {

namespace {

using nlohmann::json;

/// The first difference of two JSON values in the order of their keys. A value is null if its side has no such member.
struct Difference {
  std::vector<std::string> path;
  const json *a = nullptr, *b = nullptr;
};

std::optional<Difference> find_difference(const json& a, const json& b, const std::vector<std::string>& first = {}) {
  if (a == b) return std::nullopt;
  if (!a.is_object() || !b.is_object()) return Difference{{}, &a, &b};
  std::set<std::string> members;
  for (const json* object : {&a, &b})
    for (const auto& member : object->items()) members.insert(member.key());
  std::vector<std::string> keys = first;
  for (const std::string& key : first) members.erase(key);
  keys.insert(keys.end(), members.begin(), members.end());
  for (const std::string& key : keys) {
    if (!a.contains(key) && !b.contains(key)) continue;
    const auto in_a = a.find(key), in_b = b.find(key);
    if (in_a == a.end()) return Difference{{key}, nullptr, &*in_b};
    if (in_b == b.end()) return Difference{{key}, &*in_a, nullptr};
    auto inner = find_difference(*in_a, *in_b);
    if (!inner) continue;
    inner->path.insert(inner->path.begin(), key);
    return inner;
  }
  return std::nullopt;
}

// In order of cause and effect: another resolution also changes the window and the number of photons.
const std::vector<std::string> causes{"version", "scene_hash", "files", "integrator", "resolution", "crop", "margin"};

// The option as the user typed it, or would type it.
std::string field_name(const std::vector<std::string>& path) {
  const std::string& field = path.front();
  if (field == "version") return "the program's version";
  if (field == "scene_hash") return "the content of the scene file";
  if (field == "files" && path.size() == 2) return "the content of " + printable(path[1]);
  if (field == "parameters" && path.size() == 2) return "--set " + excerpt(path[1]);
  if (field == "margin") return "the margin that --denoise adds to --crop";
  if (field == "filter") return excerpt(fmt::format("the scene's {}", fmt::join(path, ".")));
  if (field == "coarse") return "the pixels of a coarse picture, for whose passes there was no time";
  bool is_option = false;
  for_each_render_option([&](const auto& option) { is_option = is_option || field == option.name; });
  if (is_option && path.size() == 1) return flag_name(field);
  return excerpt(fmt::format("{}", fmt::join(path, ".")));
}

std::string value_text(const std::vector<std::string>& path, const json* value) {
  if (!value) return "not set";
  const bool is_text = value->is_string() && path.front() != "scene_hash" && path.front() != "files";
  const std::string text =
      excerpt(is_text ? value->get<std::string>() : value->dump(-1, ' ', false, json::error_handler_t::replace));
  if (!value->is_array() || (path.front() != "resolution" && path.front() != "crop")) return text;
  std::string numbers = text.substr(1, text.size() - 2);  // as the options take them
  if (path.front() == "resolution") std::replace(numbers.begin(), numbers.end(), ',', 'x');
  return numbers;
}

}  // namespace

std::optional<std::string> identity_difference(const RenderIdentity& a, const RenderIdentity& b) {
  const json one = json_of(a), other = json_of(b);
  const auto difference = find_difference(one, other, causes);
  if (!difference) return std::nullopt;
  return fmt::format("{} ({} and {})", field_name(difference->path), value_text(difference->path, difference->a),
                     value_text(difference->path, difference->b));
}

}  // namespace lanthorn
