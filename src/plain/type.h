// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What the reader and the writer know about a C++ type. `members.cpp` lists the members of each struct; `describe.h`
// makes the types of containers from those of their items. At the end: arrays of numbers (numbers.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "lanthorn/plain_data.h"

namespace lanthorn::plain {

enum class Kind : std::uint8_t {
  flag,
  number,
  text,
  choice,     ///< an enumeration of one byte, whose values have names
  row,        ///< a fixed number of numbers: a colour, a point
  rows,       ///< an array of rows or of numbers
  optional,   ///< has no or one item
  list,       ///< of any number of items of one type
  variant,    ///< its item is the alternative that it holds
  structure,  ///< has members
  special,    ///< has a reader and a writer of its own
};

struct Member {
  const char* name;  ///< its key; null: the keys of this member are keys of its owner
  const Type* type;
  void* (*of)(void* owner);
  const char* table = nullptr;  ///< of an index: the table of the description whose entries it refers to
};

struct Type {
  Kind kind = Kind::special;
  Scalar scalar = Scalar::float32;            ///< number, row, rows
  std::size_t count = 1;                      ///< row, rows: numbers of one row
  std::span<const std::string_view> names{};  ///< choice: of the values 0, 1, ...
  const char* name = nullptr;                 ///< structure: its name as an alternative of a variant
  std::span<const Member> members{};          ///< structure
  std::span<const Type* const> items{};       ///< optional, list: the item's type; variant: its alternatives

  /// Number of items or rows; variant: the index of the alternative that it holds.
  std::size_t (*size)(const void* value) = nullptr;
  /// Replaces all items by new ones, which are as their type initialises them. Null for a fixed number of rows.
  void (*resize)(void* value, std::size_t size) = nullptr;
  /// An item; rows: the first one.
  void* (*item)(void* value, std::size_t index) = nullptr;

  void (*assign)(void* value, const void* other) = nullptr;

  void (*read)(Reader& reader, const Value& data, void* out) = nullptr;  ///< special
  Value (*write)(const void* value) = nullptr;                           ///< special
};

/// Reads those members of the structure that `data` has, and adds all valid keys to `known`.
void read_members(Reader& reader, const Dict& data, const Type& type, void* out, Keys& known);
void read_member(Reader& reader, const Dict& data, const Member& member, void* owner, Keys& known);
/// Reads an index, or the name of an entry of a table.
void read_reference(Reader& reader, const Value& data, const char* table, std::uint32_t& out);

void write_members(Dict& data, const Type& type, const void* value);
void write_member(Dict& data, const Member& member, const void* owner);

// Arrays of numbers, or nested lists of numbers (numbers.cpp).

/// The value as a number; nullopt for everything else, including True and False.
std::optional<double> number_of(const Value& value);

/// The shape of an array or of nested lists of numbers; a single number has no extents. Fails if `data` is neither, if
/// rows have different lengths, and for fractions where whole numbers are required.
Shape shape_of(Reader& reader, const Value& data, bool is_integral, const std::string& expected);

/// Copies the numbers of an array or of nested lists, whose shape is known, to `out`. Fails for numbers out of range.
void copy_numbers(Reader& reader, const Value& data, Scalar scalar, void* out, const std::string& expected);

/// Fails for the first of `count` numbers, in rows of `row`, that is infinite or NaN.
void require_finite(const Reader& reader, Scalar scalar, const void* numbers, std::size_t count, std::size_t row);

/// An array of its own with a copy of the numbers.
Array array_of(Scalar scalar, Shape shape, const void* numbers);

}  // namespace lanthorn::plain
