// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "io/stand_ins.h"
#include "lanthorn/file.h"

namespace lanthorn::gltf {

class Document;

/// What of a file is read.
struct Choice {
  std::optional<double> seconds{};  ///< into the first animation; none: at rest
  std::string camera{};             ///< its name, or that of its node, or its number from 1 on; empty: the first one
};

/// A glTF file that is read once, for descriptions of several moments.
class File {
 public:
  /// As `read`. The bytes must outlive it.
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

/// Reads a glTF 2.0 file, text or binary (distinguished by content). Relative URIs start at `folder`. Messages call the
/// file `name`. Other files are read through `read_file` only. If they are on disk, `access` tells which are missing:
/// these are named together, or left out if it says so. Throws Error at FILE#POINTER (a JSON pointer), for JSON syntax
/// errors with line and column.
ModelFile read(std::string_view bytes, std::filesystem::path folder, const std::string& name, FileReader read_file,
               const Choice& choice = {}, const FileAccess* access = nullptr);

}  // namespace lanthorn::gltf
