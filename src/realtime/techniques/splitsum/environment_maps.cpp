// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/splitsum/environment_maps.h"

#include <algorithm>

#include "realtime/techniques/splitsum/splitsum_constants.h"

namespace lanthorn {

namespace {

int faces_height(int size) { return cube_faces * (size + 2); }

gl::Texture make_atlas(int size, int levels) {
  int beside = 0;
  for (int l = 1; l < levels; ++l) beside += faces_height(size >> l);
  const int width = size + 2 + (levels > 1 ? size / 2 + 2 : 0);
  return {GL_RGBA32F, width, std::max(faces_height(size), beside)};
}

gl::Texture upload_brdf(const Image& table) {
  std::vector<Vec2> texels;
  for (int y = 0; y < table.height; ++y)
    for (int x = 0; x < table.width; ++x) texels.emplace_back(table.at(x, y, 0), table.at(x, y, 1));
  gl::Texture texture(GL_RG32F, table.width, table.height);
  texture.write({GL_RG, GL_FLOAT}, texels.data());
  return texture;
}

}  // namespace

CubeAtlas::CubeAtlas(int size, int levels) : size_(size), levels_(levels), texture_(make_atlas(size, levels)) {}

CubeAtlas::CubeAtlas(const std::vector<CubeMap>& levels)
    : CubeAtlas(levels.front().size(), static_cast<int>(levels.size())) {
  for (int l = 0; l < levels_; ++l) write(l, levels[static_cast<std::size_t>(l)]);
}

CubeAtlas::Corner CubeAtlas::corner(int level) const {
  if (level == 0) return {};
  int y = 0;
  for (int l = 1; l < level; ++l) y += faces_height(size_ >> l);
  return {size_ + 2, y};
}

void CubeAtlas::write(int level, const CubeMap& map) {
  const Corner at = corner(level);
  texture_.write_part({}, map.data(), at.x, at.y, map.stride(), faces_height(map.size()));
}

CubeMap CubeAtlas::read(int level) const {
  const auto texels = texture_.read<glm::vec4>({GL_RGBA, GL_FLOAT}, 1);
  const Corner from = corner(level);
  CubeMap map(size_ >> level);
  for (int face = 0; face < cube_faces; ++face)
    for (int y = -1; y <= map.size(); ++y)
      for (int x = -1; x <= map.size(); ++x) {
        const int row = from.y + face * map.stride() + y + 1;
        const glm::vec4& t =
            texels[static_cast<std::size_t>(row * texture_.width()) + static_cast<std::size_t>(from.x + x + 1)];
        map.texel(face, x, y) = {t.x, t.y, t.z, t.w};
      }
  return map;
}

EnvironmentMaps::EnvironmentMaps(const SplitSum& maps)
    : reflections(maps.levels()), irradiance({maps.irradiance_map()}), brdf(upload_brdf(maps.table())) {}

void EnvironmentMaps::bind(const gl::Program& program) const {
  reflections.texture().bind(gpu::unit_reflections);
  irradiance.texture().bind(gpu::unit_irradiances);
  brdf.bind(gpu::unit_brdf_terms);
  program.set("level_count", reflections.levels());
  program.set("first_size", reflections.size());
  program.set("irradiance_size", irradiance.size());
}

}  // namespace lanthorn
