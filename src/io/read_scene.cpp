// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/read_scene.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <map>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "io/gltf/reader.h"
#include "io/gzip.h"
#include "io/obj/reader.h"
#include "io/pbrt/reader.h"
#include "lanthorn/file.h"
#include "lanthorn/text.h"
#include "math/hash.h"

namespace lanthorn {

namespace {

// Files that cannot be read have no hash. The code that needs the content reports the error, with its place in the
// scene.
std::optional<std::uint64_t> hash_file(const std::filesystem::path& path, const FileAccess& access) {
  try {
    const std::string bytes = access.read(path);
    return hash_bytes(std::as_bytes(std::span(bytes)));
  } catch (const Error&) {
    return std::nullopt;
  }
}

void hash_files(std::map<std::string, description::File>& files, const FileAccess& access) {
  std::vector<description::File*> all;
  all.reserve(files.size());
  for (auto& entry : files)
    if (!entry.second.hash) all.push_back(&entry.second);
  parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) { all[i]->hash = hash_file(all[i]->path, access); });
}

SceneDescription completed(ModelFile model, const ReadOptions& options) {
  model.lacking.gets_environment = !options.environment.source.empty();
  return with_stand_ins(std::move(model));
}

// In lower case, without that of gzipped files.
std::string scene_extension(const std::filesystem::path& path) {
  return lower_extension(lower_extension(path) == ".gz" ? path.stem() : path);
}

// Completes the scene description: hash and files, and the access through which its other files will be read.
SceneDescription finished(SceneDescription scene, std::string_view bytes, const FileAccess& access) {
  scene.hash = hash_bytes(std::as_bytes(std::span(bytes)));
  scene.access = access;
  hash_files(scene.files, access);
  return scene;
}

void refuse_utf16(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF"))
    throw Error({name, 1, 1}, "expected text in UTF-8, found UTF-16: save the file in UTF-8");
}

FileReader reader(const FileAccess& access) {
  return [access](const std::filesystem::path& path) { return access.read(path); };
}

FileReader decompressing_reader(const FileAccess& access) {
  return [access](const std::filesystem::path& path) { return decompressed(access.read(path), path.string()); };
}

FileAccess access_for(const std::filesystem::path& folder, const ReadOptions& options) {
  FileAccess access{{}, options.max_pixels, options.skip_missing};
  if (options.sandbox) access.sandbox = std::filesystem::canonical(folder.empty() ? "." : folder);
  return access;
}

// In a sandbox, messages must not show the content of files, because a scene may name any file. In any case, control
// characters in file names must not reach the terminal.
Error shown(const FileAccess& access, SourceLocation where, const std::string& message) {
  where.file = printable(where.file);
  return {where, printable(access.is_sandboxed() ? without_quotations(message) : message)};
}

template <class Read>
auto discreet(const FileAccess& access, const std::string& name, Read&& read) {
  try {
    auto scene = read();
    for (description::Warning& warning : scene.warnings) {
      const Error problem = shown(access, warning.location, warning.message);
      warning = {problem.where, problem.message};
    }
    return scene;
  } catch (const Error& problem) {
    throw shown(access, problem.where, problem.message);
  } catch (const std::bad_alloc&) {
    throw Error({name}, "the scene needs more memory than there is");
  } catch (const std::length_error&) {
    throw Error({name}, "the scene needs more memory than there is");
  }
}

}  // namespace

bool is_scene_file(const std::filesystem::path& path) {
  const std::string extension = scene_extension(path);
  return extension == ".pbrt" || extension == ".gltf" || extension == ".glb" || extension == ".obj";
}

SceneDescription read_scene_file(const std::filesystem::path& path, const ReadOptions& options,
                                 const FindMethod& methods) {
  const std::string name = path.string();
  const std::string extension = scene_extension(path);
  const bool is_gltf = extension == ".gltf" || extension == ".glb";
  if (!is_scene_file(path))
    throw Error(name +
                ": not a kind of scene file that Lanthorn reads (.pbrt, .gltf, .glb, .obj, all of them also as .gz)");
  const std::filesystem::path folder = path.parent_path();
  if (options.at && !is_gltf) throw Error(name + ": --at, --frames: only glTF files have animations");
  if (!options.camera.empty() && !is_gltf) throw Error(name + ": --camera: only glTF files have several cameras");
  const FileAccess access = access_for(folder, options);
  return discreet(access, name, [&] {
    const std::string bytes = decompressed(access.read(path), name);
    refuse_utf16(bytes, name);
    if (is_gltf) {
      SceneDescription model = finished(
          completed(gltf::read(bytes, folder, name, reader(access), {options.at, options.camera}, &access), options),
          bytes, access);
      if (!options.camera.empty())
        model.hash = hash_words({model.hash, hash_bytes(std::as_bytes(std::span(options.camera)))});
      if (options.at) model.hash = hash_words({model.hash, std::bit_cast<std::uint64_t>(*options.at)});
      return model;
    }
    const FileReader read = decompressing_reader(access);
    return finished(extension == ".obj" ? completed(obj::read(bytes, folder, name, read, &access), options)
                                        : pbrt::read(bytes, folder, name, methods, read, &access),
                    bytes, access);
  });
}

UpgradedScene upgrade_pbrt(const std::filesystem::path& path, const std::filesystem::path& target,
                           const ReadOptions& options) {
  const std::string name = path.string();
  const std::filesystem::path folder = path.parent_path();
  if (scene_extension(path) != ".pbrt") throw Error(name + ": expected a file of pbrt-v3 (.pbrt, or .pbrt.gz)");
  const FileAccess access = access_for(folder, options);
  return discreet(access, name, [&] {
    return pbrt::upgrade(decompressed(access.read(path), name), folder, target, name, decompressing_reader(access));
  });
}

SceneDescription read_pbrt_text(std::string_view text, const std::filesystem::path& folder, const std::string& name,
                                const FindMethod& methods) {
  const FileAccess access;
  return finished(pbrt::read(text, folder, name, methods, decompressing_reader(access)), text, access);
}

}  // namespace lanthorn
