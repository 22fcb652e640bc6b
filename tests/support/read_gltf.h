// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reads glTF files from memory. Other files that they name are missing.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/gltf/reader.h"
#include "support/error_text.h"
#include "support/gltf_writer.h"

namespace lanthorn::test {

inline std::string no_files(const std::filesystem::path& path) { throw Error({path.string()}, "no such file"); }

inline SceneDescription read_gltf(const std::string& bytes, std::optional<double> seconds = {}) {
  return with_stand_ins(gltf::read(bytes, "", "t.gltf", no_files, {seconds}));
}
inline SceneDescription read_gltf(const GltfWriter& file, std::optional<double> seconds = {}) {
  return read_gltf(file.text(), seconds);
}
/// Message of the Error that `read_gltf` throws.
template <class File>
std::string gltf_error(const File& file, std::optional<double> seconds = {}) {
  return error_text([&] { read_gltf(file, seconds); });
}

inline std::vector<std::string> warnings(const SceneDescription& scene) {
  std::vector<std::string> result;
  for (const description::Warning& w : scene.warnings) result.push_back(w.location.file + ": " + w.message);
  return result;
}

}  // namespace lanthorn::test
