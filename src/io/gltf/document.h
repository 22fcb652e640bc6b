// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "io/counted_warnings.h"
#include "io/gltf/value.h"
#include "lanthorn/file.h"
#include "lanthorn/scene_description.h"

namespace lanthorn::gltf {

/// A parsed file, its bytes, and the scene description built from it.
class Document {
 public:
  /// Parses the JSON of `bytes`, which are text or the binary container and must outlive the document. Throws Error,
  /// with line and column for JSON syntax errors.
  Document(std::string_view bytes, std::filesystem::path folder, std::string name, FileReader read_file,
           const FileAccess* access = nullptr);
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  SceneDescription scene;
  /// Starts another description of the same file. Embedded images keep their indices.
  void start_again();

  Value root() const { return {json_, "", source_}; }
  /// An object without members.
  Value nothing() const { return {nothing_, "", source_}; }
  const std::string& name() const { return source_.name; }
  /// Number of elements of the root's array; 0 if it is missing.
  std::size_t count(std::string_view array) const;
  /// Element of the root's array.
  Value element(std::string_view array, std::size_t i) const;
  /// The element of the root's array with the index `reference`.
  Value follow(std::string_view array, const Value& reference) const { return element(array, index(array, reference)); }
  /// The number `reference`; throws Error unless it is an index into the root's array.
  std::size_t index(std::string_view array, const Value& reference) const;

  /// Bytes of a buffer view, decompressed if necessary; valid as long as the document.
  struct View {
    std::string_view bytes;
    std::size_t stride = 0;  ///< bytes between elements; 0: the size of an element
  };
  View buffer_view(const Value& reference);
  /// Bytes of a data URI (RFC 2397, base64); nullopt for other kinds of URI.
  static std::optional<std::string> data_uri(const Value& uri);
  /// Adds the file with this relative URI to the scene's files and returns its path. If the URI leads out of the
  /// folder, as paths of other machines do, uses the file of its last component in the folder; throws Error if there is
  /// none.
  std::filesystem::path add_file(const Value& uri);
  /// True if this file of the scene is missing and is to be skipped.
  bool leaves_out(const std::filesystem::path& file) const {
    return access_ != nullptr && access_->skip_missing && access_->is_missing(file);
  }

  /// The scene's embedded image for an element of "images" without a file. Each is copied into the scene only once.
  description::Index embedded_image(const Value& image);

  /// Calls `read`. Returns false if it needs a missing file that is to be skipped; a warning follows at the end of
  /// reading.
  template <class Read>
  bool reads(Read&& read) {
    try {
      read();
      return true;
    } catch (const MissingFile&) {
      return false;
    }
  }

  /// Adds the warning, or counts it in an earlier one with this `key`: one warning per kind of problem.
  void warn(const std::string& key, const Value& place, const std::string& message);

 private:
  struct MissingFile {};

  std::string_view buffer(const Value& reference);
  std::string read_buffer(const Value& uri);
  void add_all_files();
  std::string decompressed(const Value& view, const Value& compression);

  Source source_;
  std::filesystem::path folder_;
  FileReader read_file_;
  const FileAccess* access_;
  nlohmann::json json_, nothing_ = nlohmann::json::object();
  std::optional<std::string_view> binary_;  // chunk of the binary container
  std::map<std::size_t, std::string> buffers_;
  std::map<std::size_t, std::string> decompressed_;
  std::map<std::string, description::Index> embedded_;  // by the image's JSON pointer
  std::vector<Value> embedded_images_;                  // by index
  std::size_t embedded_bytes_ = 0;
  CountedWarnings warnings_;
  std::set<std::string> replaced_;  // JSON pointers of values with a warning: some are read several times
};

}  // namespace lanthorn::gltf
