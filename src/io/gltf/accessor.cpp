// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/accessor.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "lanthorn/text.h"

namespace lanthorn::gltf {

namespace {

// Limit for accessors without a buffer view, which can claim any length.
constexpr std::size_t most_zeros = std::size_t{1} << 20;

template <class T>
T load(const char* at) {
  static_assert(std::endian::native == std::endian::little, "glTF files are little-endian");
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

struct ElementShape {
  std::string_view name;
  std::size_t components;
};
constexpr std::array<ElementShape, 7> shapes = {
    {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};

std::size_t components_of(const Value& type) {
  for (const ElementShape& shape : shapes)
    if (shape.name == type.text()) return shape.components;
  throw type.error("there is no accessor type " + in_quotes(type.text()));
}

}  // namespace

Accessor::Type Accessor::type_of(const Value& value) {
  switch (value.integer()) {
    case 5120:
      return Type::i8;
    case 5121:
      return Type::u8;
    case 5122:
      return Type::i16;
    case 5123:
      return Type::u16;
    case 5125:
      return Type::u32;
    case 5126:
      return Type::f32;
    default:
      throw value.error("there is no component type " + std::to_string(value.integer()));
  }
}

std::size_t Accessor::size_of(Type type) {
  constexpr std::array<std::size_t, 6> sizes = {1, 1, 2, 2, 4, 4};
  return sizes[static_cast<std::size_t>(type)];
}

Accessor::Array Accessor::array(Document& document, const Value& owner, std::size_t count, std::size_t element_size,
                                bool tightly_packed) {
  const Document::View view = document.buffer_view(owner.at("bufferView"));
  Array result;
  result.stride = tightly_packed || view.stride == 0 ? element_size : view.stride;
  if (result.stride < element_size)
    throw owner.error("an element has " + std::to_string(element_size) + " bytes, but the byteStride is only " +
                      std::to_string(result.stride));
  const std::uint64_t offset = owner.integer("byteOffset", 0);
  const std::size_t available = offset < view.bytes.size() ? view.bytes.size() - static_cast<std::size_t>(offset) : 0;
  // The last element does not need a full stride.
  const std::size_t fits = available < element_size ? 0 : (available - element_size) / result.stride + 1;
  if (count > fits)
    throw owner.error(std::to_string(count) + " elements do not fit into the buffer view: only " +
                      std::to_string(fits) + " do");
  result.bytes = view.bytes.substr(std::min<std::size_t>(static_cast<std::size_t>(offset), view.bytes.size()));
  return result;
}

Accessor::Sparse Accessor::sparse(Document& document, const Value& value, std::size_t count, std::size_t element_size) {
  const Value where = value.at("indices");
  const std::uint64_t replaced = value.at("count").integer();
  if (replaced > count)
    throw value.error("replaces " + std::to_string(replaced) + " elements of " + std::to_string(count));
  const auto entries = static_cast<std::size_t>(replaced);
  const Type type = type_of(where.at("componentType"));
  const Array indices = array(document, where, entries, size_of(type), true);
  Sparse result;
  for (std::size_t i = 0; i < entries; ++i) {
    const char* at = indices.bytes.data() + i * indices.stride;
    const std::uint32_t element = type == Type::u8    ? load<std::uint8_t>(at)
                                  : type == Type::u16 ? load<std::uint16_t>(at)
                                                      : load<std::uint32_t>(at);
    if (element >= count || (i > 0 && element <= result.elements.back()))
      throw where.error("the indices must increase and be below " + std::to_string(count) + "; number " +
                        std::to_string(i) + " is " + std::to_string(element));
    result.elements.push_back(element);
  }
  result.values = array(document, value.at("values"), entries, element_size, true);
  return result;
}

Accessor::Accessor(Document& document, const Value& reference, std::size_t components) : reference_(reference) {
  const Value value = document.follow("accessors", reference);
  type_ = type_of(value.at("componentType"));
  normalized_ = value.boolean("normalized", false);
  const std::uint64_t count = value.at("count").integer();
  if (components_of(value.at("type")) != components)
    throw reference.error("accessor " + std::to_string(reference.integer()) + " is a " + value.at("type").text() +
                          ", but elements of " + std::to_string(components) + " numbers are needed");
  count_ = static_cast<std::size_t>(count);
  const std::size_t element_size = components * size_of(type_);
  if (value.find("bufferView"))
    base_ = array(document, value, count_, element_size, false);
  else if (count_ > most_zeros)
    throw value.error(std::to_string(count) +
                      " elements without a bufferView are too many: " + std::to_string(most_zeros) + " are the most");
  if (const auto replaced = value.find("sparse")) sparse_ = sparse(document, *replaced, count_, element_size);
}

bool Accessor::is_unsigned() const { return type_ == Type::u8 || type_ == Type::u16 || type_ == Type::u32; }

const char* Accessor::component(std::size_t element, std::size_t component) const {
  static constexpr std::array<char, 4> zero{};
  const std::size_t offset = component * size_of(type_);
  if (sparse_) {
    const auto& elements = sparse_->elements;
    const auto it = std::lower_bound(elements.begin(), elements.end(), element);
    if (it != elements.end() && *it == element)
      return sparse_->values.bytes.data() + static_cast<std::size_t>(it - elements.begin()) * sparse_->values.stride +
             offset;
  }
  return base_ ? base_->bytes.data() + element * base_->stride + offset : zero.data();
}

float Accessor::number(std::size_t element, std::size_t component) const {
  const char* at = this->component(element, component);
  switch (type_) {
    case Type::i8:
      return normalized_ ? std::max(static_cast<float>(load<std::int8_t>(at)) / 127.0f, -1.0f) : load<std::int8_t>(at);
    case Type::u8:
      return static_cast<float>(load<std::uint8_t>(at)) / (normalized_ ? 255.0f : 1.0f);
    case Type::i16:
      return normalized_ ? std::max(static_cast<float>(load<std::int16_t>(at)) / 32767.0f, -1.0f)
                         : load<std::int16_t>(at);
    case Type::u16:
      return static_cast<float>(load<std::uint16_t>(at)) / (normalized_ ? 65535.0f : 1.0f);
    case Type::u32:
      return static_cast<float>(load<std::uint32_t>(at));
    case Type::f32:
      break;
  }
  return load<float>(at);
}

float Accessor::finite_number(std::size_t element, std::size_t component) const {
  const float value = number(element, component);
  if (!std::isfinite(value))
    throw reference_.error("element " + std::to_string(element) + " of the accessor has a number that is not finite");
  return value;
}

std::uint32_t Accessor::integer(std::size_t element, std::size_t component) const {
  const char* at = this->component(element, component);
  switch (type_) {
    case Type::u8:
      return load<std::uint8_t>(at);
    case Type::u16:
      return load<std::uint16_t>(at);
    default:
      return load<std::uint32_t>(at);
  }
}

}  // namespace lanthorn::gltf
