// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "plain_json.h"

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "lanthorn/error.h"
#include "lanthorn/text.h"

namespace lanthorn::program {

namespace {

using plain::Scalar;

constexpr int deepest = 64;  // levels of nested lists and objects
constexpr const char* array_key = "$array";
constexpr std::array<std::pair<const char*, Scalar>, 10> scalar_names{{{"int8", Scalar::int8},
                                                                       {"int16", Scalar::int16},
                                                                       {"int32", Scalar::int32},
                                                                       {"int64", Scalar::int64},
                                                                       {"uint8", Scalar::uint8},
                                                                       {"uint16", Scalar::uint16},
                                                                       {"uint32", Scalar::uint32},
                                                                       {"uint64", Scalar::uint64},
                                                                       {"float32", Scalar::float32},
                                                                       {"float64", Scalar::float64}}};

class JsonReader {
 public:
  explicit JsonReader(std::shared_ptr<const std::vector<std::byte>> data) : data_(std::move(data)) {}

  plain::Dict dict(const nlohmann::json& object, int depth) const {
    plain::Dict dict;
    for (const auto& [key, item] : object.items()) dict.set(key, value(item, depth + 1));
    return dict;
  }

 private:
  plain::Value value(const nlohmann::json& data, int depth) const {
    if (depth > deepest) throw Error("expected at most " + std::to_string(deepest) + " levels of lists and objects");
    switch (data.type()) {
      case nlohmann::json::value_t::boolean:
        return data.get<bool>();
      case nlohmann::json::value_t::number_integer:
        return data.get<std::int64_t>();
      case nlohmann::json::value_t::number_unsigned:
        return whole(data.get<std::uint64_t>());
      case nlohmann::json::value_t::number_float:
        return data.get<double>();
      case nlohmann::json::value_t::string:
        return data.get<std::string>();
      case nlohmann::json::value_t::array:
        return list(data, depth);
      case nlohmann::json::value_t::object:
        break;
      default:
        return {};
    }
    if (data.contains(array_key)) return array(data);
    return dict(data, depth);
  }

  static plain::Value whole(std::uint64_t number) {
    if (std::in_range<std::int64_t>(number)) return static_cast<std::int64_t>(number);
    return number;
  }

  plain::Value list(const nlohmann::json& data, int depth) const {
    plain::List list;
    list.reserve(data.size());
    for (const nlohmann::json& item : data) list.push_back(value(item, depth + 1));
    return list;
  }

  plain::Value array(const nlohmann::json& data) const {
    const std::optional<Scalar> type = scalar_of(data[array_key]);
    if (!type) throw Error("expected the type of an array, such as float32, got " + excerpt(data[array_key].dump()));
    const std::optional<std::uint64_t> offset = whole_of(data.value("offset", nlohmann::json(0)));
    const nlohmann::json shape = data.value("shape", nlohmann::json());
    if (!offset || !shape.is_array()) throw Error("an array has a type, a \"shape\" and an \"offset\" in bytes");
    plain::Array array{*type, {}, data_, nullptr};
    // Compares by division, because the product of forged extents may overflow.
    const std::uint64_t room = *offset <= data_->size() ? (data_->size() - *offset) / bytes_of(*type) : 0;
    std::uint64_t count = 1;
    for (const nlohmann::json& extent : shape) {
      const std::optional<std::uint64_t> size = whole_of(extent);
      if (!size || (*size > 0 && count > room / *size)) throw Error("an array extends beyond the end of its message");
      count *= *size;
      array.shape.push_back(static_cast<std::size_t>(*size));
    }
    if (*offset > data_->size() || count > room) throw Error("an array extends beyond the end of its message");
    array.data = data_->data() + *offset;
    return array;
  }

  static std::optional<Scalar> scalar_of(const nlohmann::json& name) {
    for (const auto& [known, scalar] : scalar_names)
      if (name == known) return scalar;
    return std::nullopt;
  }
  static std::optional<std::uint64_t> whole_of(const nlohmann::json& number) {
    if (!number.is_number_unsigned()) return std::nullopt;
    return number.get<std::uint64_t>();
  }

  std::shared_ptr<const std::vector<std::byte>> data_;
};

// nlohmann's parser does not limit depth, and copying deeply nested values recurses.
void check_depth(std::string_view text) {
  int depth = 0;
  bool is_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_text && c == '\\') ++i;
    if (c == '"') is_text = !is_text;
    if (is_text) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > deepest) throw Error("expected at most " + std::to_string(deepest) + " levels of lists and objects");
  }
}

}  // namespace

plain::Dict dict_of_json(std::string_view text, const std::shared_ptr<const std::vector<std::byte>>& data) {
  check_depth(text);
  const nlohmann::json object = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!object.is_object()) throw Error("expected a JSON object, got " + excerpt(text));
  return JsonReader(data).dict(object, 0);
}

}  // namespace lanthorn::program
