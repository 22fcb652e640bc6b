// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/read_scene.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "io/gltf/reader.h"
#include "io/gzip.h"
#include "io/obj/reader.h"
#include "io/pbrt/reader.h"
#include "io/ply.h"
#include "lanthorn/file.h"
#include "lanthorn/scene.h"
#include "lanthorn/text.h"
#include "math/hash.h"

namespace lanthorn {

namespace {

// Unreadable files have no hash. The code that needs the content reports the error, with its location in the scene.
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

// In lower case, ignoring ".gz".
std::string scene_extension(const std::filesystem::path& path) {
  return lower_extension(lower_extension(path) == ".gz" ? path.stem() : path);
}

// Completes the scene description with hash and files, and the access through which its other files will be read.
// `known`: files that have been read before.
SceneDescription finished(SceneDescription scene, std::string_view bytes, const FileAccess& access,
                          const std::map<std::string, description::File>& known = {}) {
  scene.hash = hash_bytes(std::as_bytes(std::span(bytes)));
  scene.access = access;
  for (const auto& [name, file] : known) scene.files.insert_or_assign(name, file);
  hash_files(scene.files, access);
  return scene;
}

bool is_gltf(const std::filesystem::path& path) {
  const std::string extension = scene_extension(path);
  return extension == ".gltf" || extension == ".glb";
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
  FileAccess access{{}, options.max_pixels, options.skip_missing, options.texture_memory};
  if (options.sandbox) access.sandbox = std::filesystem::canonical(folder.empty() ? "." : folder);
  return access;
}

// In a sandbox, messages must not reveal the content of files, because a scene may name any file. Control characters in
// file names must never reach the terminal.
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
    throw Error({name}, "the scene needs more memory than is available");
  } catch (const std::length_error&) {
    throw Error({name}, "the scene needs more memory than is available");
  }
}

// How to render a scene of another format, for a message.
const char* way_of_other_formats(const std::string& extension) {
  if (extension == ".blend") return "the add-on renders Blender's files (docs/blender.md)";
  if (extension == ".xml") return "docs/from-mitsuba.md has the ways from Mitsuba";
  return "many programs, such as Blender, export .glb";
}

}  // namespace

bool is_scene_file(const std::filesystem::path& path) {
  const std::string extension = scene_extension(path);
  return extension == ".pbrt" || extension == ".gltf" || extension == ".glb" || extension == ".obj";
}

SceneSource::SceneSource(const std::filesystem::path& path, const ReadOptions& options, FindMethod methods)
    : name_(path.string()),
      folder_(path.parent_path()),
      options_(options),
      methods_(std::move(methods)),
      access_(access_for(folder_, options)) {
  if (!is_scene_file(path))
    throw Error(name_ + ": unknown kind of scene file; expected .pbrt, .gltf, .glb or .obj, each also as .gz; " +
                way_of_other_formats(scene_extension(path)));
  if (!options.camera.empty() && !is_gltf(path))
    throw Error(name_ + ": --camera: only glTF files have several cameras");
  if (!options.variant.empty() && !is_gltf(path))
    throw Error(name_ + ": --variant: only glTF files have variants of their materials");
}
SceneSource::~SceneSource() = default;

SceneDescription SceneSource::read(const std::optional<double>& seconds, const MeshObserver& observer) {
  if (seconds && !is_gltf(name_)) throw Error(name_ + ": --at, --frames: only glTF files have animations");
  SceneDescription scene = discreet(access_, name_, [&] {
    if (bytes_.empty()) bytes_ = decompressed(access_.read(name_), name_);
    refuse_utf16(bytes_, name_);
    if (is_gltf(name_)) return finished(read_model(seconds), bytes_, access_, files_);
    const FileReader read = decompressing_reader(access_);
    return finished(scene_extension(name_) == ".obj"
                        ? completed(obj::read(bytes_, folder_, name_, read, &access_), options_)
                        : pbrt::read(bytes_, folder_, name_, methods_, read, &access_, observer),
                    bytes_, access_, files_);
  });
  files_ = scene.files;
  if (!options_.camera.empty())
    scene.hash = hash_words({scene.hash, hash_bytes(std::as_bytes(std::span(options_.camera)))});
  if (!options_.variant.empty()) {
    const std::string variant = "variant " + options_.variant;  // differs from a camera of this name
    scene.hash = hash_words({scene.hash, hash_bytes(std::as_bytes(std::span(variant)))});
  }
  if (seconds) scene.hash = hash_words({scene.hash, std::bit_cast<std::uint64_t>(*seconds)});
  return scene;
}

SceneDescription SceneSource::read_model(const std::optional<double>& seconds) {
  if (!gltf_) gltf_ = std::make_unique<gltf::File>(bytes_, folder_, name_, reader(access_), &access_);
  return completed(gltf_->read({seconds, options_.camera, options_.variant}), options_);
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

std::vector<description::Shape> read_mesh(const std::filesystem::path& path) {
  const std::string name = path.string();
  PlyMesh mesh = parse_ply(decompressed(read_file(path), name), name);
  std::vector<description::Shape> shapes;
  const auto add = [&](auto&& geometry) {
    description::Shape& shape = shapes.emplace_back();
    shape.geometry = std::forward<decltype(geometry)>(geometry);
    shape.location.file = name;
  };
  if (!mesh.triangles.positions.empty()) add(std::move(mesh.triangles));
  if (!mesh.quads.positions.empty()) add(std::move(mesh.quads));
  return shapes;
}

}  // namespace lanthorn
