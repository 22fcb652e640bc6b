// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lanthorn {

/// A file of named arrays in the format of EPFL's Realistic Graphics Lab material database (".bsdf").
/// Little-endian:
///   "tensor_file\0"  u8 major, minor version (1.0)  u32 number of fields
///   per field:  u16 length of its name, name, u16 dimensions, u8 type, u64 offset in the file, u64 sizes, slowest
///   first
class TensorFile {
 public:
  enum class Type : std::uint8_t { u8 = 1, f32 = 10 };  ///< supported types; files may contain others

  /// Checks the header and that every field lies within the file. Copies nothing: `bytes` must outlive the object.
  /// Throws Error at `name`.
  TensorFile(std::string_view bytes, std::string name);

  bool has(const std::string& field) const { return fields_.contains(field); }
  /// These three functions throw Error if the field is missing, or its number of dimensions or its type differs.
  const std::vector<std::size_t>& shape(const std::string& field, std::size_t dimensions) const;
  /// All values are finite.
  std::vector<float> floats(const std::string& field, std::size_t dimensions) const;
  std::uint8_t byte(const std::string& field) const;

  [[noreturn]] void fail(const std::string& message) const;

 private:
  struct Field {
    std::uint8_t type = 0;
    std::vector<std::size_t> shape;
    std::string_view bytes;
  };

  const Field& find(const std::string& field, std::size_t dimensions) const;
  Field read_field(std::size_t& at) const;
  template <class T>
  T read(std::size_t& at) const;
  std::string_view take(std::size_t& at, std::size_t count) const;

  std::string_view bytes_;
  std::string name_;
  std::map<std::string, Field> fields_;
};

}  // namespace lanthorn
