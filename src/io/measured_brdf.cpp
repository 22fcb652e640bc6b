// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Dupuy & Jakob 2018, "An Adaptive Parameterization for Efficient Material Acquisition and Rendering".
#include "io/measured_brdf.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "math/vec.h"

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
  TensorFile(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {
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

  bool has(const std::string& field) const { return fields_.contains(field); }
  /// These three functions throw Error if the field is missing, or its number of dimensions or its type differs.
  const std::vector<std::size_t>& shape(const std::string& field, std::size_t dimensions) const {
    return find(field, dimensions).shape;
  }

  /// All values are finite.
  std::vector<float> floats(const std::string& field, std::size_t dimensions) const {
    const Field& found = find(field, dimensions);
    if (found.type != static_cast<std::uint8_t>(Type::f32))
      fail("field " + in_quotes(field) + " is not of 32-bit floats");
    std::vector<float> values(found.bytes.size() / sizeof(float));
    if (!values.empty()) std::memcpy(values.data(), found.bytes.data(), found.bytes.size());
    if (!std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); }))
      fail("field " + in_quotes(field) + " has a value that is not finite");
    return values;
  }

  std::uint8_t byte(const std::string& field) const {
    const Field& found = find(field, 1);
    if (found.type != static_cast<std::uint8_t>(Type::u8)) fail("field " + in_quotes(field) + " is not of bytes");
    return static_cast<std::uint8_t>(found.bytes.front());
  }

  [[noreturn]] void fail(const std::string& message) const { throw Error(SourceLocation{name_}, message); }

 private:
  struct Field {
    std::uint8_t type = 0;
    std::vector<std::size_t> shape;
    std::string_view bytes;
  };

  const Field& find(const std::string& field, std::size_t dimensions) const {
    const auto it = fields_.find(field);
    if (it == fields_.end()) fail("has no field " + in_quotes(field));
    if (it->second.shape.size() != dimensions)
      fail("field " + in_quotes(field) + " has " + dimensions_text(it->second.shape.size()) + ", not " +
           std::to_string(dimensions));
    return it->second;
  }

  Field read_field(std::size_t& at) const {
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

  template <class T>
  T read(std::size_t& at) const {
    T value{};
    std::memcpy(&value, take(at, sizeof(T)).data(), sizeof(T));
    return value;
  }

  std::string_view take(std::size_t& at, std::size_t count) const {
    if (count > bytes_.size() - at) fail("ends inside its header");
    const std::string_view taken = bytes_.substr(at, count);
    at += count;
    return taken;
  }

  std::string_view bytes_;
  std::string name_;
  std::map<std::string, Field> fields_;
};

constexpr float angle_tolerance = 0.02f;  // radians
constexpr std::size_t most_incidences = std::size_t{1} << 24;

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : file_(bytes, name) {}

  MeasuredData read() {
    data_.phi = ascending("phi_i");
    data_.theta = ascending("theta_i");
    check_angles();
    data_.ndf = grids("ndf", {});
    data_.sigma = grids("sigma", {});
    data_.vndf = grids("vndf", {data_.phi.size(), data_.theta.size()});
    make_densities(data_.vndf);
    data_.luminance = grids("luminance", {data_.phi.size(), data_.theta.size()});
    data_.weighted = file_.byte("jacobian") != 0;
    const bool is_spectral = file_.has("spectra");
    if (!is_spectral && !file_.has("rgb")) file_.fail("has neither a field \"spectra\" nor \"rgb\"");
    if (is_spectral) data_.wavelengths = ascending("wavelengths");
    data_.reflectance =
        grids(is_spectral ? "spectra" : "rgb", {data_.phi.size(), data_.theta.size(), data_.channel_count()});
    return std::move(data_);
  }

 private:
  std::vector<float> ascending(const std::string& field) const {
    std::vector<float> values = file_.floats(field, 1);
    if (std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) != values.end())
      file_.fail("the values of " + in_quotes(field) + " are not ascending");
    return values;
  }

  void check_angles() {
    if (data_.theta.front() < 0 || data_.theta.back() > pi / 2 + angle_tolerance)
      file_.fail("\"theta_i\" is not between 0 and pi / 2");
    if (data_.theta.size() > most_incidences / data_.phi.size()) file_.fail("has too many incident directions");
    if (data_.is_isotropic()) return;
    const float range = data_.phi.back() - data_.phi.front();
    const auto spans = [&](int symmetry) {
      return std::fabs(range - 2 * pi / static_cast<float>(symmetry)) <= angle_tolerance;
    };
    for (const int symmetry : {1, 2, 4})
      if (spans(symmetry)) data_.symmetry = symmetry;
    if (!spans(data_.symmetry)) file_.fail("\"phi_i\" spans neither a full, a half nor a quarter turn");
    if (data_.symmetry > 1 && std::fabs(data_.phi.front() + pi) > angle_tolerance)
      file_.fail("\"phi_i\" must begin at -pi if it spans less than a full turn");
  }

  // The last two dimensions are the grid; the outer ones must equal `outer`.
  NodeGrids grids(const std::string& field, const std::vector<std::size_t>& outer) const {
    const std::size_t dimensions = outer.size() + 2;
    const std::vector<std::size_t>& shape = file_.shape(field, dimensions);
    if (!std::equal(outer.begin(), outer.end(), shape.begin()))
      file_.fail("the size of " + in_quotes(field) + " does not fit the numbers of directions and wavelengths");
    NodeGrids result{shape[dimensions - 1], shape[dimensions - 2], {}};
    if (result.width < 2 || result.height < 2) file_.fail("the grid of " + in_quotes(field) + " is too small");
    result.values = file_.floats(field, dimensions);
    return result;
  }

  void make_densities(NodeGrids& vndf) const {
    for (float& value : vndf.values) value = std::max(value, 0.0f);
    const auto size = static_cast<std::ptrdiff_t>(vndf.size_of_grid());
    for (auto it = vndf.values.begin(); it != vndf.values.end(); it += size)
      if (std::all_of(it, it + size, [](float x) { return x == 0; }))
        file_.fail("\"vndf\" has no visible normal for some incident direction");
  }

  TensorFile file_;
  MeasuredData data_;
};

}  // namespace

MeasuredData parse_measured_brdf(std::string_view bytes, const std::string& name) { return Reader(bytes, name).read(); }

}  // namespace lanthorn
