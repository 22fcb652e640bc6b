// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/read_scene.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/parallel.h"
#include "io/gltf/reader.h"
#include "io/gzip.h"
#include "io/obj/reader.h"
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

SceneDescription with_hashes(SceneDescription scene, std::string_view bytes) {
  scene.hash = hash_bytes(std::as_bytes(std::span(bytes)));
  hash_files(scene.files);
  return scene;
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

SceneDescription read_scene(const std::filesystem::path& path) {
  const std::string extension = lower_extension(lower_extension(path) == ".gz" ? path.stem() : path);
  const bool is_gltf = extension == ".gltf" || extension == ".glb";
  if (extension != ".pbrt" && extension != ".obj" && !is_gltf)
    throw Error(path.string() +
                ": not a kind of scene file that Lanthorn reads (.pbrt, .gltf, .glb, .obj, all of them also as .gz)");
  const std::string bytes = read_decompressed(path);
  const std::filesystem::path folder = path.parent_path();
  if (is_gltf) return with_hashes(gltf::read(bytes, folder, path.string(), read_file), bytes);
  if (extension == ".obj") return with_hashes(obj::read(bytes, folder, path.string(), read_decompressed), bytes);
  return read_pbrt_string(bytes, folder, path.string());
}

SceneDescription read_pbrt_string(std::string_view text, const std::filesystem::path& folder, const std::string& name) {
  return with_hashes(pbrt::read(text, folder, name, read_decompressed), text);
}

}  // namespace lanthorn
