// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The format: G. Turk, "The PLY Polygon File Format" (1994).
#include "io/ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/memory.h"
#include "io/finite_mesh.h"
#include "io/gzip.h"
#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "shape/triangle_memory.h"

namespace lanthorn {

namespace {

enum class Format : std::uint8_t { ascii, little_endian, big_endian };
enum class Number : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

struct NumberName {
  std::string_view name;
  Number type;
};
constexpr std::array<NumberName, 16> number_names = {{{"char", Number::i8},
                                                      {"uchar", Number::u8},
                                                      {"short", Number::i16},
                                                      {"ushort", Number::u16},
                                                      {"int", Number::i32},
                                                      {"uint", Number::u32},
                                                      {"float", Number::f32},
                                                      {"double", Number::f64},
                                                      {"int8", Number::i8},
                                                      {"uint8", Number::u8},
                                                      {"int16", Number::i16},
                                                      {"uint16", Number::u16},
                                                      {"int32", Number::i32},
                                                      {"uint32", Number::u32},
                                                      {"float32", Number::f32},
                                                      {"float64", Number::f64}}};

std::size_t size_of(Number type) {
  constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

struct Property {
  std::string name;
  Number type = Number::f32;
  std::optional<Number> count_type;  ///< set for lists
};
struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};
struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
  std::size_t size = 0;  ///< bytes up to the first byte of the body
  int lines = 0;
};

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Header read() {
    if (next_line() != std::vector<std::string_view>{"ply"}) fail("is not a PLY file: its first line is not \"ply\"");
    bool has_format = false;
    while (true) {
      const auto words = next_line();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format")
        has_format = read_format(words);
      else if (words[0] == "element")
        read_element(words);
      else if (words[0] == "property")
        read_property(words);
      else
        fail("unknown header line " + in_quotes(words[0]));
    }
    if (!has_format) fail("the header has no format line");
    header_.size = at_;
    header_.lines = line_;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw Error(SourceLocation{name_, line_, 1}, message); }

  std::vector<std::string_view> next_line() {
    ++line_;
    if (at_ >= bytes_.size()) fail("the file ends inside its header");
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    std::string_view line = bytes_.substr(at_, end - at_);
    at_ = std::min(end + 1, bytes_.size());
    constexpr std::string_view blanks = " \t\r";
    std::vector<std::string_view> words;
    for (std::size_t first = line.find_first_not_of(blanks); first != line.npos;
         first = line.find_first_not_of(blanks)) {
      line.remove_prefix(first);
      const std::size_t length = std::min(line.find_first_of(blanks), line.size());
      words.push_back(line.substr(0, length));
      line.remove_prefix(length);
    }
    return words;
  }

  bool read_format(const std::vector<std::string_view>& words) {
    if (words.size() < 3 || words[2] != "1.0") fail("expected \"format ENCODING 1.0\"");
    if (words[1] == "ascii")
      header_.format = Format::ascii;
    else if (words[1] == "binary_little_endian")
      header_.format = Format::little_endian;
    else if (words[1] == "binary_big_endian")
      header_.format = Format::big_endian;
    else
      fail("unknown encoding " + in_quotes(words[1]));
    return true;
  }

  void read_element(const std::vector<std::string_view>& words) {
    if (words.size() != 3) fail("expected \"element NAME COUNT\"");
    Element element;
    element.name = words[1];
    const char* last = words[2].data() + words[2].size();
    const auto [end, error] = std::from_chars(words[2].data(), last, element.count);
    if (error != std::errc{} || end != last) fail("expected a count after the element's name");
    header_.elements.push_back(std::move(element));
  }

  Number number(std::string_view name) const {
    for (const NumberName& n : number_names)
      if (n.name == name) return n.type;
    fail("unknown type " + in_quotes(name));
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a property before the first element");
    auto& properties = header_.elements.back().properties;
    if (words.size() == 5 && words[1] == "list") {
      const Number count_type = number(words[2]);
      if (count_type == Number::f32 || count_type == Number::f64) fail("a list's count must be an integer");
      properties.push_back({std::string(words[4]), number(words[3]), count_type});
    } else if (words.size() == 3) {
      properties.push_back({std::string(words[2]), number(words[1]), {}});
    } else {
      fail("expected \"property TYPE NAME\" or \"property list TYPE TYPE NAME\"");
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 0;
  Header header_;
};

// AsciiBody and BinaryBody provide numbers through the same interface.
class AsciiBody {
 public:
  AsciiBody(std::string_view bytes, const Header& header, const std::string& name)
      : at_(bytes.data() + header.size), end_(bytes.data() + bytes.size()), line_(header.lines + 1), name_(name) {}

  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  // Smallest size of one number in bytes, including the blank before the next.
  static std::size_t smallest(Number) { return 2; }

  double number(Number) {
    skip_blanks();
    double value = 0;
    const auto [end, error] = std::from_chars(at_, end_, value);
    if (error == std::errc::invalid_argument) fail(at_ == end_ ? "the file is truncated" : "expected a number");
    at_ = end;
    return error == std::errc::result_out_of_range ? 0 : value;
  }
  SourceLocation place() const { return {name_, line_}; }
  [[noreturn]] void fail(const std::string& message) const { throw Error(place(), message); }

 private:
  void skip_blanks() {
    for (; at_ != end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\r' || *at_ == '\n'); ++at_)
      if (*at_ == '\n') ++line_;
  }

  const char* at_;
  const char* end_;
  int line_;
  const std::string& name_;
};

template <class T, bool swap>
T load(const char* p) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), p, sizeof(T));
  if constexpr (swap) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

template <bool swap>
double load_number(Number type, const char* p) {
  switch (type) {
    case Number::i8:
      return load<std::int8_t, swap>(p);
    case Number::u8:
      return load<std::uint8_t, swap>(p);
    case Number::i16:
      return load<std::int16_t, swap>(p);
    case Number::u16:
      return load<std::uint16_t, swap>(p);
    case Number::i32:
      return load<std::int32_t, swap>(p);
    case Number::u32:
      return load<std::uint32_t, swap>(p);
    case Number::f32:
      return static_cast<double>(load<float, swap>(p));
    case Number::f64:
      break;
  }
  return load<double, swap>(p);
}

template <bool swap>
class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, const Header& header, const std::string& name)
      : at_(bytes.data() + header.size), end_(bytes.data() + bytes.size()), name_(name) {}

  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  static std::size_t smallest(Number type) { return size_of(type); }

  double number(Number type) {
    const std::size_t size = size_of(type);
    if (remaining() < size) fail("the file is truncated");
    const double value = load_number<swap>(type, at_);
    at_ += size;
    return value;
  }
  SourceLocation place() const { return {name_}; }
  [[noreturn]] void fail(const std::string& message) const { throw Error(place(), message); }

 private:
  const char* at_;
  const char* end_;
  const std::string& name_;
};

// The vertex attributes that are read, and their names.
enum Attribute : std::uint8_t { x, y, z, nx, ny, nz, u, v, attribute_count };
std::optional<Attribute> attribute_named(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, Attribute>, 14> names = {{{"x", x},
                                                                             {"y", y},
                                                                             {"z", z},
                                                                             {"nx", nx},
                                                                             {"ny", ny},
                                                                             {"nz", nz},
                                                                             {"u", u},
                                                                             {"v", v},
                                                                             {"s", u},
                                                                             {"t", v},
                                                                             {"texture_u", u},
                                                                             {"texture_v", v},
                                                                             {"texture_s", u},
                                                                             {"texture_t", v}}};
  for (const auto& [known, attribute] : names)
    if (known == name) return attribute;
  return {};
}

float to_float(double value) {
  constexpr double largest = std::numeric_limits<float>::max();
  return static_cast<float>(std::isfinite(value) ? std::clamp(value, -largest, largest) : value);
}

struct Vertices {
  std::vector<Point> positions;
  std::vector<Normal> normals;
  std::vector<Vec2> uvs;
};
struct Faces {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 4>> quads;
  std::uint64_t polygons = 0, degenerate = 0;
};

PlyNeed need_of(const Header& header) {
  double vertices = 0, faces = 0;
  bool has_attributes = false;
  for (const Element& element : header.elements) {
    if (element.name == "vertex") {
      vertices = static_cast<double>(element.count);
      for (const Property& p : element.properties) has_attributes = has_attributes || attribute_named(p.name) > z;
    }
    if (element.name == "face") faces = static_cast<double>(element.count);
  }
  const double trees = faces * (tree_bytes_per_triangle + building_bytes_per_triangle);
  return {faces, mesh_bytes(vertices, faces, has_attributes) + trees};
}

template <class Body>
class BodyReader {
 public:
  explicit BodyReader(Body body) : body_(std::move(body)) {}

  void read(const Header& header) {
    require_memory_of(header);
    for (const Element& element : header.elements) {
      check_size(element);
      if (element.name == "vertex" && !has_vertices_)
        read_vertices(element);
      else if (element.name == "face" && !has_faces_)
        read_faces(element);
      else if (element.name == "tristrips")
        read_strips(element);
      else
        skip(element);
    }
    if (!has_vertices_) body_.fail("the file has no vertices");
    if (!has_faces_) body_.fail("the file has no faces");
    check_indices();
  }

  Vertices vertices;
  Faces faces;

 private:
  // Rejects a mesh that is too large to build, before any of it is read.
  void require_memory_of(const Header& header) const {
    for (const Element& element : header.elements) check_size(element);
    const PlyNeed need = need_of(header);
    require_memory(need.bytes, body_.place(), fmt::format("the mesh ({:.0f} faces) with its search tree", need.faces));
  }

  // Checks, before memory is allocated, that the file is long enough for the header's counts.
  void check_size(const Element& element) const {
    std::size_t smallest = 0;
    for (const Property& p : element.properties) smallest += Body::smallest(p.count_type.value_or(p.type));
    if (element.properties.empty() && element.count > 0)
      body_.fail("element " + in_quotes(element.name) + " has no properties");
    // The last number of an ascii file needs no blank after it.
    if (smallest > 0 && element.count > (body_.remaining() + 1) / smallest)
      body_.fail("the file is too short for " + std::to_string(element.count) + " times element " +
                 in_quotes(element.name));
  }

  std::uint64_t list_length(const Property& p) {
    const double count = body_.number(*p.count_type);
    if (!(count >= 0) || count > static_cast<double>(body_.remaining())) body_.fail("a list has an invalid length");
    return static_cast<std::uint64_t>(count);
  }

  void skip(const Property& p) {
    const std::uint64_t count = p.count_type ? list_length(p) : 1;
    for (std::uint64_t i = 0; i < count; ++i) body_.number(p.type);
  }

  void skip(const Element& element) {
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const Property& p : element.properties) skip(p);
  }

  void read_vertices(const Element& element) {
    has_vertices_ = true;
    std::vector<std::optional<Attribute>> targets;
    std::array<bool, attribute_count> found{};
    for (const Property& p : element.properties) {
      auto target = p.count_type ? std::nullopt : attribute_named(p.name);
      if (target && std::exchange(found[*target], true)) target.reset();
      targets.push_back(target);
    }
    if (!found[x] || !found[y] || !found[z]) body_.fail("the vertices have no x, y and z");
    const bool has_normals = found[nx] && found[ny] && found[nz], has_uvs = found[u] && found[v];
    const auto count = static_cast<std::size_t>(element.count);
    const std::size_t vertex_bytes = sizeof(Point) + (has_normals ? sizeof(Normal) : 0) + (has_uvs ? sizeof(Vec2) : 0);
    require_memory(static_cast<double>(count) * static_cast<double>(vertex_bytes), body_.place(), "the mesh");
    vertices.positions.resize(count);
    if (has_normals) vertices.normals.resize(count);
    if (has_uvs) vertices.uvs.resize(count);
    std::array<float, attribute_count> row{};
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < targets.size(); ++k) {
        if (targets[k])
          row[*targets[k]] = to_float(body_.number(element.properties[k].type));
        else
          skip(element.properties[k]);
      }
      vertices.positions[i] = {row[x], row[y], row[z]};
      if (has_normals) vertices.normals[i] = {row[nx], row[ny], row[nz]};
      if (has_uvs) vertices.uvs[i] = {row[u], row[v]};
    }
  }

  void read_faces(const Element& element) {
    require_memory(static_cast<double>(element.count) * sizeof(faces.triangles[0]), body_.place(), "the mesh");
    faces.triangles.reserve(static_cast<std::size_t>(element.count));
    read_corners(element, [&](const Property& p) { read_face(p); });
  }

  // Scans from Stanford and Cyberware store triangles as strips.
  void read_strips(const Element& element) {
    read_corners(element, [&](const Property& p) { read_strip(p); });
  }

  // Calls `read` for each list of vertex_indices.
  template <class Read>
  void read_corners(const Element& element, const Read& read) {
    has_faces_ = true;
    const auto is_corners = [](const Property& p) {
      return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::count_if(element.properties.begin(), element.properties.end(), is_corners) != 1)
      body_.fail("the faces need one list of vertex_indices");
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const Property& p : element.properties) {
        if (is_corners(p))
          read(p);
        else
          skip(p);
      }
  }

  std::uint32_t corner(Number type) { return vertex_index(body_.number(type)); }

  std::uint32_t vertex_index(double index) {
    if (!(index >= 0 && index < 4294967295.0) || index != std::floor(index))
      body_.fail("a face has an invalid vertex index");
    const auto result = static_cast<std::uint32_t>(index);
    largest_index_ = std::max(largest_index_, result);
    return result;
  }

  void read_face(const Property& p) {
    const std::uint64_t count = list_length(p);
    if (count < 3) {
      ++faces.degenerate;
      for (std::uint64_t i = 0; i < count; ++i) corner(p.type);
      return;
    }
    const std::uint32_t first = corner(p.type), second = corner(p.type);
    std::uint32_t last = corner(p.type);
    if (count == 4) {
      // The file lists the corners in order around the face; a bilinear patch stores them row by row.
      faces.quads.push_back({first, second, corner(p.type), last});
      return;
    }
    faces.triangles.push_back({first, second, last});
    if (count > 3) ++faces.polygons;
    for (std::uint64_t i = 3; i < count; ++i) {
      const std::uint32_t next = corner(p.type);
      faces.triangles.push_back({first, last, next});
      last = next;
    }
  }

  // Each corner forms a triangle with the two before it, with alternating winding; -1 starts a new strip. Triangles
  // with two equal corners only connect parts of a strip.
  void read_strip(const Property& p) {
    const std::uint64_t count = list_length(p);
    std::array<std::uint32_t, 2> last{};
    std::uint64_t length = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const double index = body_.number(p.type);
      if (index == -1) {
        length = 0;
        continue;
      }
      const std::uint32_t next = vertex_index(index);
      if (length >= 2 && last[0] != last[1] && last[0] != next && last[1] != next) {
        const bool is_turned = length % 2 == 1;
        faces.triangles.push_back({last[is_turned ? 1 : 0], last[is_turned ? 0 : 1], next});
      }
      last = {last[1], next};
      ++length;
    }
  }

  void check_indices() const {
    const bool any = !faces.triangles.empty() || !faces.quads.empty() || faces.degenerate > 0 || largest_index_ > 0;
    if (any && largest_index_ >= vertices.positions.size())
      body_.fail("a face uses vertex " + std::to_string(largest_index_) + ", but there are " +
                 std::to_string(vertices.positions.size()));
  }

  Body body_;
  bool has_vertices_ = false, has_faces_ = false;
  std::uint32_t largest_index_ = 0;
};

PlyMesh assemble(Vertices vertices, Faces faces) {
  PlyMesh mesh;
  const auto warn = [&](std::uint64_t count, const char* what) {
    if (count > 0) mesh.warnings.push_back(std::to_string(count) + what);
  };
  warn(faces.polygons, " faces of more than four corners: fanned into triangles");
  warn(faces.degenerate, " faces of fewer than three corners: left out");
  warn(erase_not_finite(faces.triangles, vertices.positions) + erase_not_finite(faces.quads, vertices.positions),
       " faces with a corner that is not finite: left out");
  warn(replace_not_finite(vertices.normals, Normal(0)) + replace_not_finite(vertices.uvs, Vec2(0)),
       " normals or texture coordinates that are not finite: read as 0");
  mesh.triangles.triangles = std::move(faces.triangles);
  mesh.quads.patches = std::move(faces.quads);
  if (mesh.triangles.triangles.empty() && mesh.quads.patches.empty()) {
    mesh.warnings.emplace_back("the mesh has no faces: left out");
    return mesh;
  }
  // No face uses these vertices any more. They are moved onto one that is used, so that the bounding box stays tight.
  const Point place =
      vertices.positions[mesh.triangles.triangles.empty() ? mesh.quads.patches[0][0] : mesh.triangles.triangles[0][0]];
  replace_not_finite(vertices.positions, place);
  if (!mesh.quads.patches.empty()) {
    const bool shared = !mesh.triangles.triangles.empty();
    mesh.quads.positions = shared ? vertices.positions : std::move(vertices.positions);
    mesh.quads.normals = shared ? vertices.normals : std::move(vertices.normals);
    mesh.quads.uvs = shared ? vertices.uvs : std::move(vertices.uvs);
  }
  if (!mesh.triangles.triangles.empty()) {
    mesh.triangles.positions = std::move(vertices.positions);
    mesh.triangles.normals = std::move(vertices.normals);
    mesh.triangles.uvs = std::move(vertices.uvs);
  }
  return mesh;
}

template <class Body>
PlyMesh parse_body(std::string_view bytes, const Header& header, const std::string& name) {
  BodyReader<Body> reader(Body(bytes, header, name));
  reader.read(header);
  return assemble(std::move(reader.vertices), std::move(reader.faces));
}

PlyMesh parse_plain(std::string_view bytes, const std::string& name) {
  const Header header = HeaderReader(bytes, name).read();
  constexpr bool swap_little = std::endian::native != std::endian::little;
  switch (header.format) {
    case Format::ascii:
      return parse_body<AsciiBody>(bytes, header, name);
    case Format::little_endian:
      return parse_body<BinaryBody<swap_little>>(bytes, header, name);
    case Format::big_endian:
      break;
  }
  return parse_body<BinaryBody<!swap_little>>(bytes, header, name);
}

}  // namespace

std::optional<PlyNeed> need_of_ply(std::string_view start) {
  if (is_gzip(start)) return std::nullopt;
  const std::string unnamed;
  try {
    return need_of(HeaderReader(start, unnamed).read());
  } catch (const Error&) {  // thrown again when the file is read
    return std::nullopt;
  }
}

PlyMesh parse_ply(std::string_view bytes, const std::string& name) {
  return is_gzip(bytes) ? parse_plain(gunzip(bytes, name), name) : parse_plain(bytes, name);
}

}  // namespace lanthorn
