// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/plain_data.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "math/hash.h"
#include "plain/type.h"

namespace lanthorn::plain {

namespace {

void read_flag(Reader& reader, const Value& data, bool& out) {
  const bool* flag = data.as<bool>();
  if (flag == nullptr) reader.fail("True or False", data);
  out = *flag;
  reader.mix(&out, sizeof(out));
}

template <class T>
T number_in_range(const Reader& reader, const Value& data) {
  if constexpr (std::is_integral_v<T>) {
    const auto* whole = data.as<std::int64_t>();
    const auto* large = data.as<std::uint64_t>();
    if (whole == nullptr && large == nullptr) reader.fail("a whole number", data);
    if (whole != nullptr ? !std::in_range<T>(*whole) : !std::in_range<T>(*large))
      reader.fail("a whole number in range", data);
    return whole != nullptr ? static_cast<T>(*whole) : static_cast<T>(*large);
  } else {
    const std::optional<double> number = number_of(data);
    if (!number || std::isnan(*number)) reader.fail("a number", data);
    return static_cast<T>(*number);
  }
}

void read_number(Reader& reader, const Value& data, Scalar scalar, void* out) {
  with_type(scalar, [&](const auto* type) {
    const auto number = number_in_range<std::decay_t<decltype(*type)>>(reader, data);
    std::memcpy(out, &number, sizeof(number));
    reader.mix(&number, sizeof(number));
  });
}

void read_text(Reader& reader, const Value& data, std::string& out) {
  const auto* text = data.as<std::string>();
  if (text == nullptr) reader.fail("text", data);
  out = *text;
  reader.mix(out);
}

// The index of the name that `data` is; nullopt if it is none of them.
std::optional<std::size_t> find_name(const Value& data, std::span<const std::string_view> names) {
  const auto* text = data.as<std::string>();
  const auto found = text != nullptr ? std::find(names.begin(), names.end(), *text) : names.end();
  return found != names.end() ? std::optional(static_cast<std::size_t>(found - names.begin())) : std::nullopt;
}

[[noreturn]] void fail_name(const Reader& reader, const Value& data, std::span<const std::string_view> names) {
  std::string known;
  for (const std::string_view name : names) known.append(known.empty() ? "'" : ", '").append(name).append("'");
  reader.fail("one of " + known, data);
}

void read_choice(Reader& reader, const Value& data, const Type& type, std::uint8_t& out) {
  const std::optional<std::size_t> index = find_name(data, type.names);
  if (!index) fail_name(reader, data, type.names);
  out = static_cast<std::uint8_t>(*index);
  reader.mix(type.names[*index]);
}

void read_row(Reader& reader, const Value& data, const Type& type, void* out) {
  const std::string expected = std::to_string(type.count) + " numbers";
  if (shape_of(reader, data, is_integer(type.scalar), expected) != Shape{type.count}) reader.fail(expected, data);
  copy_numbers(reader, data, type.scalar, out, expected);
  require_finite(reader, type.scalar, out, type.count, 1);
  reader.mix(out, type.count * bytes_of(type.scalar));
}

void read_rows(Reader& reader, const Value& data, const Type& type, void* out) {
  const std::string expected = std::string(is_integer(type.scalar) ? "whole numbers" : "numbers") + " of shape (n" +
                               (type.count > 1 ? ", " + std::to_string(type.count) + ")" : ")");
  const Shape shape = shape_of(reader, data, is_integer(type.scalar), expected);
  const bool is_empty = !shape.empty() && shape[0] == 0;
  const bool fits = is_empty || (type.count == 1 ? shape.size() == 1 : shape.size() == 2 && shape[1] == type.count);
  if (!fits) reader.fail(expected, data);
  if (type.resize != nullptr)
    type.resize(out, shape[0]);
  else if (shape[0] != type.size(out))
    reader.fail(std::to_string(type.size(out)) + " values", data);
  void* const numbers = type.item(out, 0);
  const std::size_t count = shape[0] * type.count;
  if (!is_empty) copy_numbers(reader, data, type.scalar, numbers, expected);
  require_finite(reader, type.scalar, numbers, count, type.count);
  reader.mix(numbers, count * bytes_of(type.scalar));
}

void read_optional(Reader& reader, const Value& data, const Type& type, void* out) {
  type.resize(out, data.is_none() ? 0 : 1);
  if (!data.is_none()) read(reader, data, *type.items[0], type.item(out, 0));
}

void read_list(Reader& reader, const Value& data, const Type& type, void* out) {
  const auto* list = data.as<List>();
  if (list == nullptr) reader.fail("a list", data);
  type.resize(out, list->size());
  for (std::size_t i = 0; i < list->size(); ++i)
    reader.at("[" + std::to_string(i) + "]", [&] { read(reader, (*list)[i], *type.items[0], type.item(out, i)); });
}

// Reads the alternative that "type" names; without "type", the alternative that `out` holds.
void read_alternative(Reader& reader, const Dict& data, const Type& type, void* out, Keys& known) {
  known.emplace_back("type");
  if (const Value* name = data.find("type")) {
    std::vector<std::string_view> names;
    for (const Type* alternative : type.items) names.emplace_back(alternative->name);
    const std::optional<std::size_t> index = find_name(*name, names);
    if (!index) reader.at(".type", [&] { fail_name(reader, *name, names); });
    if (*index != type.size(out)) type.resize(out, *index);
    reader.mix(names[*index]);
  }
  read_members(reader, data, *type.items[type.size(out)], type.item(out, 0), known);
}

// The keys of a structure or of a variant, which are all or some keys of `data`.
void read_keys(Reader& reader, const Dict& data, const Type& type, void* out, Keys& known) {
  if (type.kind == Kind::variant)
    read_alternative(reader, data, type, out, known);
  else
    read_members(reader, data, type, out, known);
}

void read_dict(Reader& reader, const Value& data, const Type& type, void* out) {
  const Dict& dict = dict_of(reader, data);
  Keys known;
  read_keys(reader, dict, type, out, known);
  refuse_other_keys(reader, dict, known);
}

// An index, none, or a fixed number of indices.
void read_references(Reader& reader, const Value& data, const Member& member, void* out) {
  const Type& type = *member.type;
  if (type.kind == Kind::optional) {
    type.resize(out, data.is_none() ? 0 : 1);
    if (!data.is_none()) read_reference(reader, data, member.table, *static_cast<std::uint32_t*>(type.item(out, 0)));
  } else if (type.kind == Kind::row) {
    const auto* list = data.as<List>();
    if (list == nullptr || list->size() != type.count)
      reader.fail(std::to_string(type.count) + " indices or names", data);
    for (std::size_t i = 0; i < type.count; ++i)
      read_reference(reader, (*list)[i], member.table, static_cast<std::uint32_t*>(out)[i]);
  } else {
    read_reference(reader, data, member.table, *static_cast<std::uint32_t*>(out));
  }
}

}  // namespace

const NameTable& Reader::names_in(const std::string& table) const {
  static const NameTable none;
  const auto found = names.find(table);
  return found != names.end() ? *found->second : none;
}

void Reader::mix(const void* bytes, std::size_t count) {
  if (is_hashing) hash = hash_words({hash, hash_bytes({static_cast<const std::byte*>(bytes), count})});
}

void Reader::fail(const std::string& expected, const Value& got) const {
  fail("expected " + expected + ", got " + shown(got));
}
void Reader::fail(const std::string& message) const {
  const std::size_t start = path_.starts_with('.') ? 1 : 0;
  throw Error(path_.empty() ? message : path_.substr(start) + ": " + message);
}

const Dict& dict_of(Reader& reader, const Value& data) {
  if (data.as<Dict>() == nullptr) reader.fail("a dict", data);
  return *data.as<Dict>();
}

void refuse_other_keys(Reader& reader, const Dict& data, const Keys& known) {
  for (const auto& [name, value] : data.entries()) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      reader.fail("unknown key " + in_quotes(name) + did_you_mean(name, known));
  }
}

void read(Reader& reader, const Value& data, const Type& type, void* out) {
  switch (type.kind) {
    case Kind::flag:
      return read_flag(reader, data, *static_cast<bool*>(out));
    case Kind::number:
      return read_number(reader, data, type.scalar, out);
    case Kind::text:
      return read_text(reader, data, *static_cast<std::string*>(out));
    case Kind::choice:
      return read_choice(reader, data, type, *static_cast<std::uint8_t*>(out));
    case Kind::row:
      return read_row(reader, data, type, out);
    case Kind::rows:
      return read_rows(reader, data, type, out);
    case Kind::optional:
      return read_optional(reader, data, type, out);
    case Kind::list:
      return read_list(reader, data, type, out);
    case Kind::variant:
    case Kind::structure:
      return read_dict(reader, data, type, out);
    case Kind::special:
      return type.read(reader, data, out);
  }
}

void read_members(Reader& reader, const Dict& data, const Type& type, void* out, Keys& known) {
  for (const Member& member : type.members) read_member(reader, data, member, out, known);
}

void read_member(Reader& reader, const Dict& data, const Member& member, void* owner, Keys& known) {
  void* const out = member.of(owner);
  if (member.name == nullptr) return read_keys(reader, data, *member.type, out, known);
  known.emplace_back(member.name);
  const Value* value = data.find(member.name);
  if (value == nullptr) return;
  reader.at("." + std::string(member.name), [&] {
    if (member.table != nullptr)
      read_references(reader, *value, member, out);
    else
      read(reader, *value, *member.type, out);
  });
}

void read_reference(Reader& reader, const Value& data, const char* table, std::uint32_t& out) {
  if (data.as<std::string>() == nullptr) {
    if (!number_of(data)) reader.fail("an entry of \"" + std::string(table) + "\", by its index or name", data);
    return read_number(reader, data, Scalar::uint32, &out);
  }
  const std::string& name = *data.as<std::string>();
  const NameTable& known = reader.names_in(table);
  if (const auto found = known.find(name); found != known.end()) {
    out = found->second;
    return reader.mix(&out, sizeof(out));
  }
  Keys all;
  for (const auto& [other, index] : known) all.push_back(other);
  reader.fail("there is no entry named " + in_quotes(name) + " in \"" + table + "\"" + did_you_mean(name, all));
}

}  // namespace lanthorn::plain
