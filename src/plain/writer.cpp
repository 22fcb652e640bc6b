// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>

#include "lanthorn/plain_data.h"
#include "plain/type.h"

namespace lanthorn::plain {

namespace {

Value write_number(Scalar scalar, const void* value) {
  return with_type(scalar, [&](const auto* type) -> Value {
    std::decay_t<decltype(*type)> number{};
    std::memcpy(&number, value, sizeof(number));
    if (!is_integer(scalar)) return static_cast<double>(number);
    if (std::is_signed_v<decltype(number)>) return static_cast<std::int64_t>(number);
    return static_cast<std::uint64_t>(number);
  });
}

// `Type` and `Member` give parts of values that may change; the writer changes none.
const void* item_of(const Type& type, const void* value, std::size_t index) {
  return type.item(const_cast<void*>(value), index);
}

Value write_row(const Type& type, const void* value) {
  List list;
  for (std::size_t i = 0; i < type.count; ++i)
    list.push_back(write_number(type.scalar, static_cast<const std::byte*>(value) + i * bytes_of(type.scalar)));
  return list;
}

Value write_rows(const Type& type, const void* value) {
  Shape shape{type.size(value)};
  if (type.count > 1) shape.push_back(type.count);
  return array_of(type.scalar, std::move(shape), item_of(type, value, 0));
}

Value write_list(const Type& type, const void* value) {
  List list;
  for (std::size_t i = 0; i < type.size(value); ++i) list.push_back(write(*type.items[0], item_of(type, value, i)));
  return list;
}

void write_keys(Dict& data, const Type& type, const void* value) {
  if (type.kind != Kind::variant) return write_members(data, type, value);
  const Type& alternative = *type.items[type.size(value)];
  data.set("type", std::string(alternative.name));
  write_members(data, alternative, item_of(type, value, 0));
}

Value write_dict(const Type& type, const void* value) {
  Dict data;
  write_keys(data, type, value);
  return data;
}

}  // namespace

Value write(const Type& type, const void* value) {
  switch (type.kind) {
    case Kind::flag:
      return *static_cast<const bool*>(value);
    case Kind::number:
      return write_number(type.scalar, value);
    case Kind::text:
      return *static_cast<const std::string*>(value);
    case Kind::choice:
      return std::string(type.names[*static_cast<const std::uint8_t*>(value)]);
    case Kind::row:
      return write_row(type, value);
    case Kind::rows:
      return write_rows(type, value);
    case Kind::optional:
      return type.size(value) > 0 ? write(*type.items[0], item_of(type, value, 0)) : Value();
    case Kind::list:
      return write_list(type, value);
    case Kind::variant:
    case Kind::structure:
      return write_dict(type, value);
    case Kind::special:
      break;
  }
  return type.write(value);
}

void write_members(Dict& data, const Type& type, const void* value) {
  for (const Member& member : type.members) write_member(data, member, value);
}

void write_member(Dict& data, const Member& member, const void* owner) {
  const void* const value = member.of(const_cast<void*>(owner));
  if (member.name == nullptr) return write_keys(data, *member.type, value);
  data.set(member.name, write(*member.type, value));
}

}  // namespace lanthorn::plain
