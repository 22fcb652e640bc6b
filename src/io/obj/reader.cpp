// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The format: Wavefront, "Object Files (.obj)", Advanced Visualizer manual, appendix B1 (1995).
#include "io/obj/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "film/display.h"
#include "io/counted_warnings.h"
#include "io/missing_files.h"
#include "io/obj/faces.h"
#include "io/obj/materials.h"
#include "io/obj/words.h"
#include "lanthorn/text.h"
#include "math/hash.h"

namespace lanthorn::obj {

namespace {

using namespace description;

struct CornerHash {
  std::size_t operator()(const Corner& c) const {
    return mix_bits((std::uint64_t{c.v} << 32 | c.vt) ^ mix_bits(std::uint64_t{c.vn} + 1));
  }
};

/// The faces of one material that all have or all lack texture coordinates, and likewise normals.
struct Part {
  TriangleMesh mesh;
  std::unordered_map<Corner, std::uint32_t, CornerHash> vertices;
  SourceLocation location;  ///< of the first face
};

class Reader {
 public:
  Reader(std::string_view text, const std::filesystem::path& folder, const std::string& name, FileReader read_file,
         const FileAccess* access)
      : words_(text, name), folder_(folder), read_file_(std::move(read_file)), access_(access) {
    scene_.filename = name;
  }

  ModelFile read() {
    while (words_.next_line()) read_line(words_.word("a keyword"));
    add_bare_faces();
    for (auto& [key, part] : parts_) add_shape(key.material, part);
    if (!colors_.empty()) add_vertex_colors(scene_);
    suggest_texture();
    std::vector<Index> lamps;
    for (Index i = 0; i < scene_.area_lights.size(); ++i)
      if (!scene_.area_lights[i].radiance.texture) lamps.push_back(i);
    // Faces are wound as seen from their front: an open box is best viewed from inside.
    std::set<Index> materials;
    for (Index i = 0; i < scene_.materials.size(); ++i) materials.insert(materials.end(), i);
    const bool is_lit = is_lit_by(scene_, lamps);
    ModelFile file{std::move(scene_), {true, !is_lit, {std::move(materials), false}}};
    for (const auto& [name, box] : objects_) file.lacking.parts.push_back(box);
    return file;
  }

 private:
  struct PartKey {
    std::string material;
    bool has_uvs = false, has_normals = false;
    // clang-tidy 14 mistakes the comparison's 0 for a pointer.
    friend auto operator<=>(const PartKey&, const PartKey&) = default;  // NOLINT(modernize-use-nullptr)
  };

  /// Consecutive faces of one material without normals.
  struct BareRun {
    std::string material;
    std::size_t first_face = 0;
    Word key;  // of the first face
  };

  void warn(const std::string& key, const SourceLocation& place, const std::string& message) {
    warnings_.add(scene_.warnings, key, place, message);
  }
  void warn_of_name(const std::string& key, const SourceLocation& place, const std::string& name,
                    const MessageOfNames& message_of) {
    warnings_.add_name(scene_.warnings, key, place, name, message_of);
  }

  void read_line(const Word& key) {
    const std::string_view word = key.text;
    if (word == "v") {
      read_vertex(key);
    } else if (word == "vn") {
      normals_.push_back(vec3());
    } else if (word == "vt") {
      const float u = words_.number("u");
      const auto v = words_.find_word();
      uvs_.emplace_back(u, v ? words_.number(*v) : 0.0f);
    } else if (word == "f" || word == "fo") {
      read_face(key);
    } else if (word == "usemtl") {
      use_material(std::string(words_.rest().text));
    } else if (word == "mtllib") {
      read_libraries();
    } else if (word == "s") {
      read_smoothing();
    } else if (word == "g" || word == "o") {
      object_ = &objects_[std::string(words_.rest().text)];
    } else {
      warn_of_name("keyword", words_.location(key), std::string(word), [](const auto& names) {
        return quoted_list(names) + " " + is_or_are(names) + " not supported: ignored";
      });
    }
  }

  // Three numbers after the position are an sRGB colour, as written by scanners and sculpting programs; a single one is
  // the weight of a rational curve.
  void read_vertex(const Word& key) {
    positions_.push_back(vec3());
    std::optional<Vec3> color;
    if (const auto r = words_.find_word(), g = words_.find_word(), b = words_.find_word(); r && g && b) {
      color = Vec3(component(*r), component(*g), component(*b));
      if (!std::isfinite(color->x + color->y + color->z)) {
        color.reset();
        warn("vertex colours", words_.location(key), "vertex colours that are not numbers are read as white");
      }
    }
    if (!color && colors_.empty()) return;
    colors_.resize(positions_.size(), Vec3(1));
    if (!color) return;
    colors_.back() = *color;
    largest_color_ = std::max({largest_color_, color->x, color->y, color->z});
  }

  // NaN if the word is not a number.
  static float component(const Word& word) {
    float value = 0;
    const char* const end = word.text.data() + word.text.size();
    const auto [last, error] = std::from_chars(word.text.data(), end, value);
    return error == std::errc{} && last == end ? value : std::numeric_limits<float>::quiet_NaN();
  }

  Vec3 vec3() {
    const float x = words_.number("x"), y = words_.number("y");
    return {x, y, words_.number("z")};
  }

  void use_material(const std::string& name) {
    material_ = name;
    part_ = {nullptr, nullptr, nullptr, nullptr};
  }

  void read_smoothing() {
    names_smoothing_groups_ = true;
    const auto word = words_.find_word();
    if (!word || word->text == "off" || word->text == "0" || word->text == "null")
      smoothing_group_ = flat_group;
    else
      smoothing_group_ =
          smoothing_groups_.try_emplace(std::string(word->text), smoothing_groups_.size() + 1).first->second;
  }

  // Reads one file whose name may contain blanks, or several separated by blanks.
  void read_libraries() {
    constexpr std::string_view blanks = " \t";
    const Word all = words_.rest();
    const std::string_view text = all.text;
    std::optional<Error> problem = read_library(all);
    if (problem && text.find_first_of(blanks) != text.npos) {
      problem.reset();
      for (std::size_t at = 0; at != text.npos;) {
        const std::size_t end = text.find_first_of(blanks, at);
        Word file = all;
        file.text = text.substr(at, end - at);
        file.column += static_cast<int>(at);
        if (const auto missing = read_library(file)) warn_of_library(*missing);
        at = text.find_first_not_of(blanks, end);
      }
    }
    if (problem) warn_of_library(*problem);
  }

  void warn_of_library(const Error& problem) {
    warn_of_name("mtllib", problem.where, problem.message, [](const auto& problems) {
      constexpr std::size_t most = 8;
      const std::span named(problems.data(), std::min(problems.size(), most));
      return fmt::format("{}{}: {} materials are left out", fmt::join(named, ", "),
                         problems.size() > most ? ", ..." : "", problems.size() > 1 ? "their" : "its");
    });
  }

  // Returns the error if the file cannot be read.
  std::optional<Error> read_library(const Word& file) {
    std::string called(file.text);
    std::replace(called.begin(), called.end(), '\\', '/');
    const std::filesystem::path path = find_file(folder_, called, access_, [&](const std::string& message) {
      warn("elsewhere", words_.location(file), message);
    });
    if (libraries_.contains(path)) return {};  // already read
    const std::string name = path.string();
    scene_.files.try_emplace(called, File{path, {}, words_.location(file)});
    std::string text;
    try {
      text = read_file_(path);
    } catch (const Error& problem) {
      scene_.files.erase(called);
      return Error(words_.location(file), problem.what());
    }
    libraries_.insert(path);
    read_materials(text, path.parent_path(), name, access_, scene_, materials_,
                   {[&](const std::string& key, const SourceLocation& place, const std::string& message) {
                      warn(key, place, message);
                    },
                    [&](const std::string& key, const SourceLocation& place, const std::string& word,
                        const MessageOfNames& message_of) { warn_of_name(key, place, word, message_of); }});
    return {};
  }

  // A number of a corner: counted from 1, or backwards from -1.
  std::int64_t number(const char*& at, const char* end, const Word& word) const {
    std::int64_t i = 0;
    const auto [next, error] = std::from_chars(at, end, i);
    if (error != std::errc{})
      throw Error(words_.location(word),
                  "expected a corner such as 1, 1/2, 1//3 or 1/2/3, found " + in_quotes(word.text));
    at = next;
    return i;
  }

  // The index of one of `count` elements.
  std::uint32_t index(std::int64_t i, std::size_t count, const Word& word, const char* what) const {
    const auto n = static_cast<std::int64_t>(count);
    if (i == 0 || i > n || i < -n)
      throw Error(words_.location(word), std::string("there is no ") + what + " " + std::to_string(i) + " here: only " +
                                             std::to_string(count) + " precede this line");
    return static_cast<std::uint32_t>(i > 0 ? i - 1 : n + i);
  }

  // An index of texture coordinates or normals. Some files use such indices although they contain no such elements.
  std::uint32_t attribute(std::int64_t i, std::size_t count, const Word& word, const char* what) {
    if (count > 0) return index(i, count, word, what);
    warn(what, words_.location(word), std::string("faces refer to a ") + what + ", but none precedes them: ignored");
    return none;
  }

  Corner corner(const Word& word) {
    const char* at = word.text.data();
    const char* const end = at + word.text.size();
    Corner c;
    c.v = index(number(at, end, word), positions_.size(), word, "vertex");
    if (at != end && *at == '/') {
      ++at;
      if (at != end && *at != '/') c.vt = attribute(number(at, end, word), uvs_.size(), word, "texture coordinate");
      if (at != end && *at == '/') {
        ++at;
        if (at != end) c.vn = attribute(number(at, end, word), normals_.size(), word, "normal");
      }
    }
    if (at != end)
      throw Error(words_.location(word),
                  "expected a corner such as 1, 1/2, 1//3 or 1/2/3, found " + in_quotes(word.text));
    return c;
  }

  void read_face(const Word& key) {
    corners_.clear();
    while (const auto word = words_.find_word()) corners_.push_back(corner(*word));
    if (corners_.size() < 3) {
      warn("small faces", words_.location(key), "faces of fewer than three corners are left out");
      return;
    }
    if (object_ != nullptr)
      for (const Corner& c : corners_) object_->extend(positions_[c.v]);
    if (all_have(&Corner::vn)) return add_face(key);
    const BareFace face{bare_corners_.size(), static_cast<std::uint32_t>(corners_.size()), smoothing_group_};
    bare_corners_.insert(bare_corners_.end(), corners_.begin(), corners_.end());
    bare_faces_.push_back(face);
    if (bare_runs_.empty() || bare_runs_.back().material != material_)
      bare_runs_.push_back({material_, bare_faces_.size() - 1, key});
  }

  // Faces without normals are added once all smoothing groups are known. Files without groups are mostly scans and
  // standard models of many small triangles, or boxes and rooms: smoothing by angle keeps the former smooth and the
  // latter sharp.
  void add_bare_faces() {
    for (Corner& c : bare_corners_) c.vn = none;
    if (!names_smoothing_groups_)
      for (BareFace& face : bare_faces_) face.group = group_by_angle;
    add_smooth_normals(positions_, bare_faces_, bare_corners_, normals_);
    for (std::size_t r = 0; r < bare_runs_.size(); ++r) {
      use_material(bare_runs_[r].material);
      const std::size_t end = r + 1 < bare_runs_.size() ? bare_runs_[r + 1].first_face : bare_faces_.size();
      for (std::size_t i = bare_runs_[r].first_face; i < end; ++i) {
        const auto first = bare_corners_.begin() + static_cast<std::ptrdiff_t>(bare_faces_[i].first);
        corners_.assign(first, first + bare_faces_[i].count);
        add_face(bare_runs_[r].key);
      }
    }
  }

  bool all_have(std::uint32_t Corner::*member) const {
    return std::all_of(corners_.begin(), corners_.end(), [&](const Corner& c) { return c.*member != none; });
  }

  // Adds the current corners as a face of the current material.
  void add_face(const Word& key) {
    const bool has_uvs = all_have(&Corner::vt), has_normals = all_have(&Corner::vn);
    Part& part = part_for(has_uvs, has_normals, key);
    vertices_.clear();
    for (Corner c : corners_) {
      if (!has_uvs) c.vt = none;
      if (!has_normals) c.vn = none;
      vertices_.push_back(vertex(part, c));
    }
    if (corners_.size() == 3) {
      part.mesh.triangles.push_back({vertices_[0], vertices_[1], vertices_[2]});
      return;
    }
    polygon_.clear();
    for (const Corner& c : corners_) polygon_.push_back(positions_[c.v]);
    for (const auto& [a, b, c] : triangulate(polygon_, tests_left_))
      part.mesh.triangles.push_back({vertices_[a], vertices_[b], vertices_[c]});
    if (tests_left_ < polygon_.size())
      warn("polygons", words_.location(key),
           "the file's polygons have so many corners that from about here on they become triangle fans");
  }

  Part& part_for(bool has_uvs, bool has_normals, const Word& key) {
    Part*& found = part_[(has_uvs ? 1u : 0u) + (has_normals ? 2u : 0u)];
    if (found == nullptr) {
      const auto [it, is_new] = parts_.try_emplace(PartKey{material_, has_uvs, has_normals});
      if (is_new) it->second.location = words_.location(key);
      found = &it->second;
    }
    return *found;
  }

  std::uint32_t vertex(Part& part, const Corner& c) {
    const auto [it, is_new] = part.vertices.emplace(c, static_cast<std::uint32_t>(part.mesh.positions.size()));
    if (is_new) {
      part.mesh.positions.push_back(positions_[c.v]);
      if (c.vt != none) part.mesh.uvs.push_back(uvs_[c.vt]);
      if (c.vn != none) part.mesh.normals.push_back(normals_[c.vn]);
      if (!colors_.empty()) {
        part.mesh.colors.resize(part.mesh.positions.size(), glm::vec4(1));
        if (c.v < colors_.size()) part.mesh.colors.back() = glm::vec4(colors_[c.v], 1);
      }
    }
    return it->second;
  }

  const Surface& surface(const std::string& material, const SourceLocation& place) {
    if (const auto found = materials_.find(material); found != materials_.end()) return found->second;
    if (!material.empty())
      warn_of_name("material", place, material, [&](const auto& names) {
        return (names.size() > 1 ? "there are no materials " : "there is no material ") + quoted_list(names) +
               (colors_.empty() ? ": grey is used" : ": the colours of the vertices are used");
      });
    const auto [it, is_new] = materials_.try_emplace("");
    if (is_new) {
      it->second.material = static_cast<Index>(scene_.materials.size());
      Material& plain = scene_.materials.emplace_back();
      plain.location.file = scene_.filename;
      if (!colors_.empty()) plain.node = DiffuseMaterial{{1.0f, {}}};
    }
    return it->second;
  }

  // Colours range from 0 to 1, or to 255 in files with larger numbers.
  void make_colors_linear(std::vector<glm::vec4>& colors) const {
    const float scale = largest_color_ > 1 ? 1 / 255.0f : 1.0f;
    for (glm::vec4& color : colors)
      for (glm::length_t c = 0; c < 3; ++c) color[c] = linear_from_srgb(std::clamp(scale * color[c], 0.0f, 1.0f));
  }

  void add_shape(const std::string& material, Part& part) {
    const Surface& s = surface(material, part.location);
    scene_.files.insert(s.files.begin(), s.files.end());
    has_images_ = has_images_ || !s.files.empty();
    if (!part.mesh.colors.empty()) {
      part.mesh.colors.resize(part.mesh.positions.size(), glm::vec4(1));
      make_colors_linear(part.mesh.colors);
    }
    Shape shape;
    shape.geometry = std::move(part.mesh);
    shape.material = s.material;
    shape.area_light = s.area_light;
    shape.alpha = s.alpha;
    shape.location = part.location;
    scene_.shapes.push_back(std::move(shape));
  }

  void suggest_texture() {
    if (access_ == nullptr || has_images_ || uvs_.empty() || parts_.empty()) return;
    const std::filesystem::path model = scene_.filename;
    const auto picture = texture_beside(model);
    if (!picture) return;
    const std::string map = "\"map_Kd " + *picture + "\"", library = model.stem().string() + ".mtl";
    const std::string& used = parts_.begin()->first.material;
    const std::string material = used.empty() ? "skin" : used;
    const std::string how = libraries_.empty()
                                ? "begin the file with \"mtllib " + library + "\"" +
                                      (used.empty() ? " and \"usemtl " + material + "\"" : "") + ", and write " +
                                      library + " of the lines \"newmtl " + material + "\" and " + map
                                : "add the line " + map + " to its material";
    warn("texture beside", {scene_.filename, 1, 1},
         "no material has a picture, but " + file_in_quotes(*picture) + " lies beside the file: to use it, " + how);
  }

  Words words_;
  const std::filesystem::path& folder_;
  FileReader read_file_;
  const FileAccess* access_;
  SceneDescription scene_;
  Materials materials_;
  std::set<std::filesystem::path> libraries_;
  CountedWarnings warnings_;
  std::vector<Point> positions_;
  std::vector<Normal> normals_;
  std::vector<Vec2> uvs_;
  std::vector<Vec3> colors_;               // one per position; empty until one has a colour
  float largest_color_ = 0;                // largest colour component
  std::string material_;                   // current
  std::map<std::string, Bounds> objects_;  // boxes, by the names of o and g
  Bounds* object_ = nullptr;               // current
  std::map<std::string, std::uint32_t> smoothing_groups_;
  std::uint32_t smoothing_group_ = flat_group;  // current
  bool names_smoothing_groups_ = false, has_images_ = false;
  // Faces without normals, in file order.
  std::vector<BareFace> bare_faces_;
  std::vector<Corner> bare_corners_;
  std::vector<BareRun> bare_runs_;
  std::map<PartKey, Part> parts_;
  std::array<Part*, 4> part_{};  // of the current material, by attributes
  // Of the current face.
  std::vector<Corner> corners_;
  std::vector<std::uint32_t> vertices_;
  std::vector<Point> polygon_;
  std::uint64_t tests_left_ = std::uint64_t{1} << 32;  // remaining corner tests for triangulation, in the whole file
};

}  // namespace

ModelFile read(std::string_view text, const std::filesystem::path& folder, const std::string& name,
               FileReader read_file, const FileAccess* access) {
  ModelFile file = Reader(text, folder, name, std::move(read_file), access).read();
  if (access != nullptr) warn_of_missing_files(file.scene, *access);  // a model has its shape without its pictures
  return file;
}

}  // namespace lanthorn::obj
