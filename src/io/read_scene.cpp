// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/read_scene.h"

#include "io/file.h"
#include "io/pbrt/reader.h"

namespace lanthorn {

SceneDescription read_scene(const std::filesystem::path& path) {
  const std::filesystem::path plain = path.extension() == ".gz" ? path.stem() : path.filename();
  if (plain.extension() != ".pbrt")
    throw Error(path.string() + ": not a kind of scene file that Lanthorn reads (.pbrt, .pbrt.gz)");
  return read_pbrt_string(read_file(path), path.parent_path(), path.string());
}

SceneDescription read_pbrt_string(std::string_view text, const std::filesystem::path& folder, const std::string& name) {
  return pbrt::read(text, folder, name, read_file);
}

}  // namespace lanthorn
