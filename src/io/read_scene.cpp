// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/read_scene.h"

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/parallel.h"
#include "io/gzip.h"
#include "io/pbrt/reader.h"
#include "math/hash.h"

namespace lanthorn {

namespace {

// What cannot be read has no hash: whoever needs its content says where the scene names it.
std::optional<std::uint64_t> hash_file(const std::filesystem::path& path) {
  try {
    const std::string bytes = read_file(path);
    return hash_bytes(std::as_bytes(std::span(bytes)));
  } catch (const Error&) {
    return std::nullopt;
  }
}

void hash_files(std::map<std::string, description::File>& files) {
  std::vector<description::File*> all;
  all.reserve(files.size());
  for (auto& entry : files) all.push_back(&entry.second);
  parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) { all[i]->hash = hash_file(all[i]->path); });
}

}  // namespace

SceneDescription read_scene(const std::filesystem::path& path) {
  const std::filesystem::path plain = path.extension() == ".gz" ? path.stem() : path.filename();
  if (plain.extension() != ".pbrt")
    throw Error(path.string() + ": not a kind of scene file that Lanthorn reads (.pbrt, .pbrt.gz)");
  return read_pbrt_string(read_decompressed(path), path.parent_path(), path.string());
}

SceneDescription read_pbrt_string(std::string_view text, const std::filesystem::path& folder, const std::string& name) {
  SceneDescription scene = pbrt::read(text, folder, name, read_decompressed);
  scene.hash = hash_bytes(std::as_bytes(std::span(text)));
  hash_files(scene.files);
  return scene;
}

}  // namespace lanthorn
