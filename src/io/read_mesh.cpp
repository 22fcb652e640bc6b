// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "io/gzip.h"
#include "io/ply.h"
#include "lanthorn/file.h"
#include "lanthorn/scene.h"

namespace lanthorn {

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
