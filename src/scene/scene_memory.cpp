// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "shape/triangle_memory.h"
#include "texture/image_texture.h"

namespace lanthorn {

namespace {

using ImageKey = std::tuple<std::string, std::optional<description::Index>, description::Encoding, float, ColorSpace>;
struct ImageUse {
  const description::ImageTexture* image = nullptr;
  const SourceLocation* location = nullptr;
  bool levels = false;
};

// Adds the shapes of one of Embree's scenes.
void add(const std::vector<description::Shape>& shapes, SceneMemory& memory) {
  std::uint64_t triangles = 0, curves = 0, pieces = 0;
  for (const description::Shape& shape : shapes) {
    if (const auto* mesh = std::get_if<description::TriangleMesh>(&shape.geometry)) {
      const bool has_attributes =
          !(mesh->normals.empty() && mesh->uvs.empty() && mesh->tangents.empty() && mesh->colors.empty());
      memory.geometry += mesh_bytes(static_cast<double>(mesh->positions.size()),
                                    static_cast<double>(mesh->triangles.size()), has_attributes);
      triangles += mesh->triangles.size();
    } else if (const auto* patches = std::get_if<description::BilinearMesh>(&shape.geometry)) {
      memory.geometry += static_cast<double>(patches->positions.size()) * sizeof(Vertex) +
                         static_cast<double>(patches->patches.size()) * sizeof(patches->patches[0]);
      triangles += 2 * patches->patches.size();
    } else if (const auto* strands = std::get_if<description::Curves>(&shape.geometry)) {
      const bool is_ribbon = strands->kind == description::CurveKind::ribbon;
      const std::uint64_t segments = strands->segments.size() * (is_ribbon ? ribbon_pieces : 1);
      (is_ribbon ? pieces : curves) += segments;
      // A segment of four points becomes pieces that share their ends, with a normal at each point.
      constexpr double points_of_ribbon = (3 * ribbon_pieces + 1) / 4.0;
      const double of_point =
          is_ribbon ? points_of_ribbon * (sizeof(glm::vec4) + sizeof(Normal)) : double{sizeof(glm::vec4)};
      memory.geometry += static_cast<double>(strands->points.size()) * of_point +
                         static_cast<double>(segments) * sizeof(strands->segments[0]);
    }
  }
  memory.triangles += triangles;
  memory.curves += curves + pieces;
  memory.trees += static_cast<double>(triangles) * tree_bytes_per_triangle +
                  static_cast<double>(curves) * tree_bytes_per_curve +
                  static_cast<double>(pieces) * tree_bytes_per_ribbon_piece;
  memory.building = std::max(memory.building, static_cast<double>(triangles) * building_bytes_per_triangle +
                                                  static_cast<double>(curves + pieces) * building_bytes_per_curve);
}

// The images that textures and normal maps name, each once; true for those that may get coarser levels.
std::map<ImageKey, ImageUse> images_of(const SceneDescription& scene) {
  std::map<ImageKey, ImageUse> images;
  const auto add_image = [&](const description::ImageTexture& image, const SourceLocation& location, bool levels) {
    ImageUse& use = images[{image.filename, image.embedded, image.encoding, image.gamma, image.space}];
    use.image = &image;
    use.location = &location;
    use.levels = use.levels || levels;
  };
  const auto add_all = [&](const auto& textures, bool levels) {
    for (const auto& texture : textures)
      if (const auto* image = std::get_if<description::ImageTexture>(&texture.node))
        add_image(*image, texture.location, levels);
  };
  add_all(scene.float_textures, false);
  add_all(scene.spectrum_textures, true);
  for (const description::Material& material : scene.materials)
    if (material.normal_map) add_image(material.normal_map->image, material.location, false);
  return images;
}

}  // namespace

SceneMemory expected_memory(const SceneDescription& scene) {
  SceneMemory memory;
  add(scene.shapes, memory);
  for (const description::Object& object : scene.objects) add(object.shapes, memory);
  return memory;
}

std::uint64_t expected_texture_memory(const SceneDescription& scene) {
  const std::map<ImageKey, ImageUse> by_key = images_of(scene);
  std::vector<ImageUse> images;
  images.reserve(by_key.size());
  for (const auto& [key, use] : by_key) images.push_back(use);
  std::vector<std::uint64_t> bytes(images.size());
  parallel_for(std::size_t{0}, images.size(), [&](std::size_t i) {
    const auto& [image, location, levels] = images[i];
    const ImageWish wish{{image->encoding, image->gamma, image->space}, levels};
    try {
      const ImageSource source =
          image->embedded ? ImageSource(scene.embedded_images.at(*image->embedded)) : ImageSource(image->filename);
      bytes[i] = TextureImage::need(source, scene.access, wish, *location).memory;
    } catch (const Error&) {  // thrown again when it is read, if anything uses it
    }
  });
  return std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0});
}

void require_scene_memory(SceneDescription& scene) {
  const SceneMemory memory = expected_memory(scene);
  const double geometry = memory.geometry + memory.trees + memory.building;
  const SourceLocation file{scene.filename};
  const std::string primitives = memory.curves > 0
                                     ? fmt::format("{} triangles, {} curves", memory.triangles, memory.curves)
                                     : fmt::format("{} triangles", memory.triangles);
  const std::string what = fmt::format("the geometry ({}) with its search trees", primitives);
  require_memory(geometry, file, what);
  const auto available = static_cast<double>(available_memory().value_or(~std::uint64_t{0}));
  std::optional<std::uint64_t>& textures = scene.access.texture_memory;
  if (!textures) textures = static_cast<std::uint64_t>(std::max(0.0, available - geometry) / 2);
  // Headers of images are read only if the images may not fit.
  if (geometry + static_cast<double>(*textures) <= available) return;
  const double needed = static_cast<double>(std::min(*textures, expected_texture_memory(scene)));
  require_memory(geometry + needed, file, fmt::format("{}, and {} of textures,", what, memory_text(needed)));
}

}  // namespace lanthorn
