// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/plain_data.h"

#include <algorithm>
#include <cstddef>

#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "math/hash.h"

namespace lanthorn::plain {

namespace {

// Fails unless all rows have the shape of the first one.
Shape shape_of_rows(Reader& reader, const List& list, bool is_integral, const std::string& expected) {
  Shape shape{list.size()};
  if (list.empty()) return shape;
  const Shape row = shape_of(reader, list.front(), is_integral, expected);
  for (const Value& item : list)
    if (shape_of(reader, item, is_integral, expected) != row) reader.fail(expected, list);
  shape.insert(shape.end(), row.begin(), row.end());
  return shape;
}

}  // namespace

std::optional<double> number_of(const Value& value) {
  if (const auto* number = value.as<double>()) return *number;
  if (const auto* whole = value.as<std::int64_t>()) return static_cast<double>(*whole);
  if (const auto* large = value.as<std::uint64_t>()) return static_cast<double>(*large);
  return std::nullopt;
}

Shape shape_of(Reader& reader, const Value& data, bool is_integral, const std::string& expected) {
  if (const auto* list = data.as<List>()) return shape_of_rows(reader, *list, is_integral, expected);
  if (const auto* array = data.as<Array>()) {
    if (is_integral && !is_integer(array->type) && array->count() > 0) reader.fail(expected, data);
    return array->shape;
  }
  if (!number_of(data) || (is_integral && data.as<double>() != nullptr)) reader.fail(expected, data);
  return {};
}

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

void read_reference(Reader& reader, const Value& data, const char* table, Index& out) {
  if (data.as<std::string>() == nullptr) {
    if (!number_of(data)) reader.fail("an entry of \"" + std::string(table) + "\", by its index or name", data);
    return read(reader, data, out);
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
