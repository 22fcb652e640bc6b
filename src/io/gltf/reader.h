// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "lanthorn/file.h"
#include "staging/stand_ins.h"

namespace lanthorn::gltf {

class Document;

/// Options that select what is read from a file.
struct Choice {
  std::optional<double> seconds{};  ///< into the first animation; nullopt: the rest pose
  std::string camera{};             ///< its name, that of its node, or its number starting at 1; empty: the first one
  std::string variant{};            ///< of materials: its name, or its number starting at 1; empty: the file's default
};

/// A glTF file that is parsed once, for descriptions at several times.
class File {
 public:
  /// As `read`. The bytes must outlive this object.
  File(std::string_view bytes, std::filesystem::path folder, const std::string& name, FileReader read_file,
       const FileAccess* access = nullptr);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  ModelFile read(const Choice& choice);

 private:
  std::unique_ptr<Document> document_;
  const FileAccess* access_;
  bool has_been_read_ = false;
};

/// Reads a glTF 2.0 file, text or binary (distinguished by content). Relative URIs are resolved in `folder`. Messages
/// call the file `name`. Other files are read only through `read_file`. If they are on disk, `access` determines which
/// ones are missing: a single Error names them all, or they are skipped if `access` says so. Throws Error at
/// FILE#POINTER (a JSON pointer), with line and column for JSON syntax errors.
ModelFile read(std::string_view bytes, std::filesystem::path folder, const std::string& name, FileReader read_file,
               const Choice& choice = {}, const FileAccess* access = nullptr);

}  // namespace lanthorn::gltf
