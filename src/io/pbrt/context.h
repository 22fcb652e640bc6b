// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What all builders share, and the version of a file (version.cpp).
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>

#include "io/counted_warnings.h"
#include "io/known_method.h"
#include "io/pbrt/parameters.h"
#include "io/pbrt/tokenizer.h"
#include "lanthorn/file.h"
#include "lanthorn/scene_description.h"

namespace lanthorn::pbrt {

/// Evidence of a file's version, such as `Film "image"`.
struct VersionSign {
  bool is_v3 = false;
  std::string text;
  SourceLocation location;
};

/// Finds the first feature in the file, or in one that it includes, that only pbrt-v3 or only pbrt-v4 has, and reads no
/// further. nullopt if there is none, or if the file is malformed, which the parser reports later. `read_included`
/// returns included files by name.
std::optional<VersionSign> find_version_sign(std::string_view text, const std::string& name,
                                             const FileReader& read_included);

/// For messages about an unknown kind: "; it is of pbrt-v4, but …" if the other version has the kind. Otherwise empty.
std::string version_hint(const std::optional<VersionSign>& sign, std::string_view directive, std::string_view kind);

/// State shared by all builders: the scene description, the names defined so far, and access to files.
struct Context {
  SceneDescription scene;
  std::filesystem::path folder;  ///< of the scene file; resolves its relative file names
  FileReader read_file;
  FindMethod methods = [](const std::string&) { return std::optional<KnownMethod>(); };  ///< default: knows none
  const FileAccess* access = nullptr;         ///< for files that are read later; null if the scene is not on disk
  std::optional<VersionSign> version;         ///< first evidence of the file's version
  ColorSpace color_space = ColorSpace::srgb;  ///< current
  std::unordered_map<std::string, description::Index> float_textures;
  std::unordered_map<std::string, description::Index> spectrum_textures;
  /// Images that are missing and skipped, and scaled versions ("scale") of them. Their users substitute a neutral
  /// value.
  std::set<description::Index> lost_float_textures, lost_spectrum_textures;
  std::unordered_map<std::string, description::Index> named_materials;  ///< built so far
  std::unordered_map<std::string, description::Index> measured_brdfs;   ///< by file name
  std::size_t spectrum_bytes_left = std::size_t{1} << 28;               ///< limit for spectrum files; each use rereads
  double subdivided_triangles_left = 1 << 26;                           ///< limit for all subdivision surfaces together

  /// Adds the warning, or counts it in an earlier one with this `key`: one warning per kind of problem.
  void warn(std::string_view key, Place place, const std::string& message) { warn(key, place.location(), message); }
  void warn(std::string_view key, const SourceLocation& place, const std::string& message);
  /// The error for a kind that the file's version does not have. `what`: such as "material".
  Error unknown(std::string_view what, std::string_view directive, const std::string& kind, Place place) const;
  /// Adds the file `name` to the scene's files and returns its path: absolute, or in the scene's folder, or where
  /// `find_file` finds it.
  std::filesystem::path add_file(const std::string& name, const SourceLocation& location);
  std::filesystem::path add_file(const std::string& name, Place place) { return add_file(name, place.location()); }
  /// True if this file of the scene is missing and is to be skipped.
  bool leaves_out(const std::filesystem::path& path) const {
    return access != nullptr && access->skip_missing && access->is_missing(path);
  }
  /// True if the file is missing and will be reported later, together with other missing files; the reader continues
  /// without it. `problem`: the error to report if it is the only one.
  bool defer_missing(const std::filesystem::path& path, const Error& problem);
  /// Throws the error for all files missing so far, or adds warnings for them.
  void report_missing();
  /// True if errors for missing files are pending.
  bool has_deferred() const { return first_missing_ && !access->skip_missing; }
  /// The file's bytes. An Error is located at `place`, and its message names the file.
  std::string read(const std::filesystem::path& path, Place place) const;
  /// As `read`; nullopt if the file is missing and will be reported later.
  std::optional<std::string> read_unless_missing(const std::filesystem::path& path, Place place);

 private:
  std::optional<Error> first_missing_;
  CountedWarnings warnings_;
};

/// Warns about every parameter of the directive that no getter has read, and about parameters given twice.
void report_unused(const ParameterList& list, Context& context);

}  // namespace lanthorn::pbrt
