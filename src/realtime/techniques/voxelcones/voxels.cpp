// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/voxelcones/voxels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "realtime/scene/materials.h"

namespace lanthorn {

namespace {

/// A corner of a piece of a triangle: place in voxels, texture coordinates.
struct Corner {
  Vec3 at{0};
  Vec2 uv{0};
};

/// A convex piece. Each of the six planes of a voxel may add a corner to a triangle.
struct Piece {
  std::array<Corner, 12> corners;
  std::size_t count = 0;

  void add(const Corner& c) {
    if (count < corners.size()) corners[count++] = c;
  }
};

using Cell = std::array<int, 3>;

struct Halves {
  Piece below, above;
};

// Pieces that lie in the plane count as below it.
Halves cut(const Piece& piece, int axis, float plane) {
  Halves halves;
  const auto height = [&](const Corner& c) { return c.at[axis] - plane; };
  for (std::size_t i = 0; i < piece.count; ++i) {
    const Corner &a = piece.corners[i], &b = piece.corners[(i + 1) % piece.count];
    const float ha = height(a), hb = height(b);
    (ha <= 0 ? halves.below : halves.above).add(a);
    if ((ha <= 0) == (hb <= 0)) continue;
    const float t = ha / (ha - hb);
    Corner c{a.at + t * (b.at - a.at), a.uv + t * (b.uv - a.uv)};
    c.at[axis] = plane;
    halves.below.add(c);
    halves.above.add(c);
  }
  return halves;
}

// Calls `visit(cell, piece)` for the parts of a piece in the cells from `low` until before `high`.
template <class Visit>
void for_cells(const Piece& piece, const Cell& low, const Cell& high, const Visit& visit) {
  if (piece.count < 3) return;
  std::size_t axis = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (high[a] - low[a] > high[axis] - low[axis]) axis = a;
  if (high[axis] - low[axis] <= 1) {
    visit(low, piece);
    return;
  }
  const int middle = (low[axis] + high[axis]) / 2;
  const Halves halves = cut(piece, static_cast<int>(axis), static_cast<float>(middle));
  Cell until = high, from = low;
  until[axis] = middle;
  from[axis] = middle;
  for_cells(halves.below, low, until, visit);
  for_cells(halves.above, from, high, visit);
}

/// Sums over the surfaces of a side, weighted by area.
struct SideSum {
  float area = 0;
  Vec3 position{0}, normal{0}, albedo{0}, through{0};
};
using CellSums = std::array<SideSum, 6>;  // +x -x +y -y +z -z

struct Albedo {
  Vec3 reflected{0}, through{0};
};

Albedo albedo_of(const GpuMaterial& m) {
  const auto rgb = [](const glm::vec4& v) { return Vec3(v); };
  if (m.kind == gpu::kind_diffuse) return {rgb(m.colour), rgb(m.through)};
  const GpuMaterial plastic = as_plastic(m);
  const Vec3 f0 = rgb(plastic.through);
  return {f0 + (1.0f - f0) * rgb(plastic.colour), Vec3(0)};
}

/// Adds the triangles of draws to the sums of their cells.
class Voxeliser {
 public:
  Voxeliser(const Scene& scene, const GpuScene& gpu_scene, Voxels& voxels)
      : scene_(scene),
        gpu_scene_(gpu_scene),
        shapes_(shapes_of(scene)),
        voxels_(voxels),
        grid_(voxels.grid),
        cells_(static_cast<std::size_t>(grid_.size) * static_cast<std::size_t>(grid_.size) *
                   static_cast<std::size_t>(grid_.size),
               no_sums) {}

  void add(const GpuDraw& draw, const std::array<GpuVertex, 3>& triangle);
  void finish();

 private:
  static constexpr std::uint32_t no_sums = ~0u;

  CellSums& sums_of(const Cell& cell);
  void add_piece(const Cell& cell, const Piece& piece, const GpuDraw& draw);

  const Scene& scene_;
  const GpuScene& gpu_scene_;
  const std::vector<const ShapeStore*> shapes_;  // by mesh
  Voxels& voxels_;
  const VoxelGrid grid_;
  std::vector<std::uint32_t> cells_;  // into sums_
  std::vector<CellSums> sums_;
  std::vector<Cell> places_;
};

CellSums& Voxeliser::sums_of(const Cell& cell) {
  const auto index = [&](std::size_t a) { return static_cast<std::size_t>(cell[a]); };
  const auto n = static_cast<std::size_t>(grid_.size);
  std::uint32_t& at = cells_[(index(2) * n + index(1)) * n + index(0)];
  if (at == no_sums) {
    at = static_cast<std::uint32_t>(sums_.size());
    sums_.emplace_back();
    places_.push_back(cell);
  }
  return sums_[at];
}

void Voxeliser::add_piece(const Cell& cell, const Piece& piece, const GpuDraw& draw) {
  // A fan around the first corner: twice the area along the normal, and the centre.
  Vec3 twice_area{0}, centre{0};
  Vec2 uv{0};
  float weights = 0;
  for (std::size_t i = 1; i + 1 < piece.count; ++i) {
    const Corner &a = piece.corners[0], &b = piece.corners[i], &c = piece.corners[i + 1];
    const Vec3 along = cross(b.at - a.at, c.at - a.at);
    const float weight = std::sqrt(length_squared(along));
    twice_area += along;
    centre += weight / 3 * (a.at + b.at + c.at);
    uv += weight / 3 * (a.uv + b.uv + c.uv);
    weights += weight;
  }
  if (!(weights > 0)) return;
  const Vec3 normal = twice_area / std::sqrt(length_squared(twice_area));
  const float opacity = opacity_at(*shapes_[draw.mesh], uv / weights);
  if (!(opacity > 0)) return;
  const float area = opacity * 0.5f * weights * sqr(grid_.side);
  const GpuMaterial& material = gpu_scene_.materials()[draw.material];
  const bool is_textured = (material.flags & gpu::flag_textured) != 0;
  const Albedo albedo = albedo_of(is_textured ? material_at(scene_, draw.material, uv / weights) : material);
  const Point position = grid_.corner + grid_.side / weights * centre;
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (std::fabs(normal[a]) > std::fabs(normal[axis])) axis = a;
  CellSums& sums = sums_of(cell);
  for (const float sign : {1.0f, -1.0f}) {
    SideSum& sum = sums[2 * static_cast<std::size_t>(axis) + (sign * normal[axis] > 0 ? 0u : 1u)];
    sum.area += area;
    sum.position += area * position;
    sum.normal += sign * area * normal;
    sum.albedo += area * albedo.reflected;
    sum.through += area * albedo.through;
  }
}

void Voxeliser::add(const GpuDraw& draw, const std::array<GpuVertex, 3>& triangle) {
  if (gpu_scene_.materials()[draw.material].kind == gpu::kind_none) return;
  Piece piece;
  Vec3 low(infinity), high(-infinity);
  for (const GpuVertex& v : triangle) {
    const Point world = Point(draw.to_world * glm::vec4(v.position, 1));
    const Vec3 at = (world - grid_.corner) / grid_.side;
    low = min(low, at);
    high = max(high, at);
    piece.add({at, Vec2(v.u, v.v)});
  }
  Cell from{}, until{};
  const auto size = static_cast<float>(grid_.size);
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    if (low[a] > size || high[a] <= 0) return;
    if (low[a] <= 0) piece = cut(piece, a, 0).above;
    if (high[a] > size) piece = cut(piece, a, size).below;
    // A triangle in the plane between two cells belongs to the lower one, as in `cut`.
    from[i] = std::clamp(static_cast<int>(std::ceil(std::max(low[a], 0.0f))) - 1, 0, grid_.size - 1);
    until[i] = std::clamp(static_cast<int>(std::ceil(std::min(high[a], size))), from[i] + 1, grid_.size);
  }
  for_cells(piece, from, until, [&](const Cell& cell, const Piece& part) { add_piece(cell, part, draw); });
}

void Voxeliser::finish() {
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const auto place = [&](std::size_t a) { return static_cast<std::uint32_t>(places_[i][a]); };
    VoxelLeaf leaf{place(0), place(1), place(2), static_cast<std::uint32_t>(voxels_.sides.size()), 0, 0, 0, 0};
    for (const SideSum& sum : sums_[i]) {
      if (!(sum.area > 0) || !(length_squared(sum.normal) > 0)) continue;
      voxels_.sides.push_back({sum.position / sum.area, sum.area, glm::vec4(normalize(sum.normal), 0),
                               glm::vec4(sum.albedo / sum.area, 0), glm::vec4(sum.through / sum.area, 0)});
      ++leaf.side_count;
    }
    if (leaf.side_count > 0) voxels_.leaves.push_back(leaf);
  }
}

template <class Visit>
void for_triangles(const GpuScene& gpu_scene, const GpuTriangles& triangles, const Visit& visit) {
  for (const GpuDraw& draw : gpu_scene.draws())
    for (std::uint32_t i = draw.first_index; i < draw.first_index + draw.index_count; i += 3) {
      const auto corner = [&](std::uint32_t c) {
        return triangles.vertices[draw.base_vertex + triangles.indices[i + c]];
      };
      visit(draw, std::array{corner(0), corner(1), corner(2)});
    }
}

}  // namespace

int voxel_grid_limit(int size) {
  // Six directions of four half floats, and an eighth more for each coarser level.
  constexpr std::int64_t most_bytes = std::int64_t{2} << 30, bytes_of_voxel = 6 * 8;
  const std::int64_t voxels = std::int64_t{size} * size * size, bytes = voxels * bytes_of_voxel * 8 / 7;
  return static_cast<int>(std::clamp<std::int64_t>(most_bytes / bytes, 1, gpu::most_voxel_grids));
}

std::vector<VoxelGrid> voxel_grids(const Bounds& bounds, int size, const ViewFocus& focus, int count) {
  constexpr float width_by_distance = 1.5f;
  constexpr int steps = 8;  // of a corner along the grid's edge
  // Centres the surfaces in the grid, so that the outermost walls lie in the middles of voxels.
  VoxelGrid whole;
  whole.size = size;
  const float widest = bounds.empty() ? 0 : max_component(bounds.extent());
  whole.side = widest > 0 && widest < infinity ? widest / static_cast<float>(size - 3) : 1;
  whole.corner = (bounds.empty() ? Point(0) : bounds.centre()) - 0.5f * whole.edge();
  std::vector<VoxelGrid> grids{whole};
  const int limit = count > 0 ? std::min(count, voxel_grid_limit(size)) : voxel_grid_limit(size);
  while (static_cast<int>(grids.size()) < limit) {
    VoxelGrid next = grids.back();
    next.side *= 0.5f;
    if (count == 0 && !(next.edge() >= width_by_distance * focus.distance)) break;
    const float step = next.edge() / steps;
    for (int axis = 0; axis < 3; ++axis) {
      const float wanted = (focus.centre[axis] - 0.5f * next.edge() - whole.corner[axis]) / step;
      const float last = (whole.edge() - next.edge()) / step;
      next.corner[axis] = whole.corner[axis] + step * std::clamp(std::round(wanted), 0.0f, last);
    }
    grids.push_back(next);
  }
  return grids;
}

Bounds bounds_of(const GpuScene& gpu_scene, const GpuTriangles& triangles) {
  Bounds bounds;
  for_triangles(gpu_scene, triangles, [&](const GpuDraw& draw, const std::array<GpuVertex, 3>& triangle) {
    for (const GpuVertex& v : triangle) bounds.extend(Point(draw.to_world * glm::vec4(v.position, 1)));
  });
  return bounds;
}

Voxels voxelise(const Scene& scene, const GpuScene& gpu_scene, const GpuTriangles& triangles, const VoxelGrid& grid) {
  Voxels voxels;
  voxels.grid = grid;
  Voxeliser voxeliser(scene, gpu_scene, voxels);
  for_triangles(gpu_scene, triangles,
                [&](const GpuDraw& draw, const std::array<GpuVertex, 3>& t) { voxeliser.add(draw, t); });
  voxeliser.finish();
  return voxels;
}

}  // namespace lanthorn
