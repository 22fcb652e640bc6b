// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/tensor_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "lanthorn/error.h"
#include "lanthorn/text.h"

namespace lanthorn {

namespace {

static_assert(std::endian::native == std::endian::little, "tensor files are little-endian");

constexpr std::array<char, 12> magic_bytes{"tensor_file"};  // including the final zero
constexpr std::string_view magic(magic_bytes.data(), magic_bytes.size());
constexpr std::uint32_t most_fields = 1024;
constexpr std::size_t most_dimensions = 8;

// Size of a number in bytes, by type code: signed and unsigned integers of 1, 2, 4 and 8 bytes, floats of 2, 4 and 8.
constexpr std::size_t type_sizes[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};

std::string dimensions_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " dimension" : " dimensions");
}

}  // namespace

TensorFile::TensorFile(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {
  if (!bytes_.starts_with(magic)) fail("is not a tensor file");
  std::size_t at = magic.size();
  const auto major = read<std::uint8_t>(at), minor = read<std::uint8_t>(at);
  if (major != 1)
    fail("is a tensor file of version " + std::to_string(major) + "." + std::to_string(minor) +
         "; version 1 can be read");
  const auto count = read<std::uint32_t>(at);
  if (count > most_fields) fail("has " + std::to_string(count) + " fields, more than " + std::to_string(most_fields));
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string field(take(at, read<std::uint16_t>(at)));
    if (!fields_.try_emplace(field, read_field(at)).second) fail("has two fields " + in_quotes(field));
  }
}

void TensorFile::fail(const std::string& message) const { throw Error(SourceLocation{name_}, message); }

std::string_view TensorFile::take(std::size_t& at, std::size_t count) const {
  if (count > bytes_.size() - at) fail("ends inside its header");
  const std::string_view taken = bytes_.substr(at, count);
  at += count;
  return taken;
}

template <class T>
T TensorFile::read(std::size_t& at) const {
  T value{};
  std::memcpy(&value, take(at, sizeof(T)).data(), sizeof(T));
  return value;
}

TensorFile::Field TensorFile::read_field(std::size_t& at) const {
  Field field;
  const auto dimensions = read<std::uint16_t>(at);
  field.type = read<std::uint8_t>(at);
  const auto offset = read<std::uint64_t>(at);
  if (dimensions > most_dimensions) fail("has a field of " + dimensions_text(dimensions));
  if (field.type == 0 || field.type >= std::size(type_sizes))
    fail("has a field of the unknown type " + std::to_string(field.type));
  std::uint64_t size = type_sizes[field.type];
  for (std::uint16_t d = 0; d < dimensions; ++d) {
    const auto extent = read<std::uint64_t>(at);
    // Prevents overflow, and allocations larger than the file.
    if (extent == 0 || size > bytes_.size() / extent) fail("has a field that is empty or larger than the file");
    size *= extent;
    field.shape.push_back(static_cast<std::size_t>(extent));
  }
  if (offset > bytes_.size() || size > bytes_.size() - offset) fail("has a field that extends beyond the file");
  field.bytes = bytes_.substr(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
  return field;
}

const TensorFile::Field& TensorFile::find(const std::string& field, std::size_t dimensions) const {
  const auto it = fields_.find(field);
  if (it == fields_.end()) fail("has no field " + in_quotes(field));
  if (it->second.shape.size() != dimensions)
    fail("field " + in_quotes(field) + " has " + dimensions_text(it->second.shape.size()) + ", not " +
         std::to_string(dimensions));
  return it->second;
}

const std::vector<std::size_t>& TensorFile::shape(const std::string& field, std::size_t dimensions) const {
  return find(field, dimensions).shape;
}

std::vector<float> TensorFile::floats(const std::string& field, std::size_t dimensions) const {
  const Field& found = find(field, dimensions);
  if (found.type != static_cast<std::uint8_t>(Type::f32))
    fail("field " + in_quotes(field) + " is not of 32-bit floats");
  std::vector<float> values(found.bytes.size() / sizeof(float));
  if (!values.empty()) std::memcpy(values.data(), found.bytes.data(), found.bytes.size());
  if (!std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); }))
    fail("field " + in_quotes(field) + " has a value that is not finite");
  return values;
}

std::uint8_t TensorFile::byte(const std::string& field) const {
  const Field& found = find(field, 1);
  if (found.type != static_cast<std::uint8_t>(Type::u8)) fail("field " + in_quotes(field) + " is not of bytes");
  return static_cast<std::uint8_t>(found.bytes.front());
}

}  // namespace lanthorn
