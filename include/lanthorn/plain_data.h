// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reads values of C++ from plain data (dicts, lists, numbers, arrays), and writes them.
//
// A struct is a dict with one key per member. A std::variant is a dict whose key "type" names the alternative.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lanthorn/plain_value.h"

namespace lanthorn::plain {

/// The index of each named entry of a table.
using NameTable = std::map<std::string, std::uint32_t>;

/// State of reading a value and everything in it: tracks the current path for messages, and hashes what it reads.
class Reader {
 public:
  std::map<std::string, std::shared_ptr<const NameTable>> names;  ///< by table ("materials", ...)
  std::uint64_t hash = 0;                                         ///< of all that has been read
  bool is_hashing = true;                                         ///< false: nobody asks for `hash`

  /// The names of a table; empty if it has none.
  const NameTable& names_in(const std::string& table) const;

  void mix(const void* bytes, std::size_t count);
  void mix(std::string_view text) { mix(text.data(), text.size()); }
  /// Calls `read` for a part of the value; `step` extends the path: ".radius", "[2]".
  template <class Read>
  void at(const std::string& step, Read&& read) {
    const std::size_t before = path_.size();
    path_ += step;
    mix(step);
    read();
    path_.resize(before);
  }
  /// Throws Error: "shapes[2].radius: expected a number, got 'wide'".
  [[noreturn]] void fail(const std::string& expected, const Value& got) const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  std::string path_;
};

/// How values of a C++ type are read and written.
struct Type;
/// Defined for the types that the library and its programs read and write, such as bool, double, Vec3, Transform, and
/// std::vector<Vec3>. Other types do not link: plain/members.cpp ends with the list.
template <class T>
const Type& type_of();

/// Reads `data` into a value of this type. Throws Error with the path to the part of `data` that is wrong.
void read(Reader& reader, const Value& data, const Type& type, void* out);
template <class T>
void read(Reader& reader, const Value& data, T& out) {
  read(reader, data, type_of<T>(), &out);
}
Value write(const Type& type, const void* value);
template <class T>
Value write(const T& value) {
  return write(type_of<T>(), &value);
}

using Shape = std::vector<std::size_t>;
/// Numbers with their shape, the last index running fastest.
template <class T>
struct NumberArray {
  Shape shape;
  std::vector<T> values;
};
/// Reads an array or nested lists of any shape. Defined for float and double.
template <class T>
NumberArray<T> number_array(Reader& reader, const Value& data, const std::string& expected);

using Keys = std::vector<std::string>;
/// Fails if `data` is not a dict.
const Dict& dict_of(Reader& reader, const Value& data);
void refuse_other_keys(Reader& reader, const Dict& data, const Keys& known);

}  // namespace lanthorn::plain
