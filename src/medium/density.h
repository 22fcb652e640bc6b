// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Densities that vary in space. Each gives its value at a point, the box outside of which it is 0, and an upper bound
// inside a part of that box, all in the medium's space.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "lanthorn/file_access.h"
#include "math/vec.h"

namespace lanthorn {

/// Samples at the cell centres of a regular grid over a box; 0 outside the box. Trilinear interpolation between them;
/// from the outermost centres to the box's faces, interpolates as if zeros lay beyond.
template <class T>
struct SampledGrid {
  std::array<int, 3> size{};  ///< cells along x, y, z, each at least 1
  std::vector<T> values;      ///< x runs fastest
  Bounds box{Point(0), Point(1)};

  T at(const Point& p) const;
  /// Calls `visit` for every sample that `at` may use inside `region`.
  template <class Visit>
  void for_each_in(const Bounds& region, Visit&& visit) const;

 private:
  T sample(int x, int y, int z) const {
    if (x < 0 || y < 0 || z < 0 || x >= size[0] || y >= size[1] || z >= size[2]) return T{};
    return values[(static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(y)) *
                      static_cast<std::size_t>(size[0]) +
                  static_cast<std::size_t>(x)];
  }
  Vec3 cells(const Point& p) const {
    return (p - box.min) / box.extent() *
               Vec3(static_cast<float>(size[0]), static_cast<float>(size[1]), static_cast<float>(size[2])) -
           Vec3(0.5f);
  }
};

template <class T>
T SampledGrid<T>::at(const Point& p) const {
  if (glm::any(glm::lessThan(p, box.min)) || glm::any(glm::greaterThan(p, box.max))) return T{};
  const Vec3 c = cells(p);
  const Vec3 low = glm::floor(c);
  const Vec3 f = c - low;
  const int x = static_cast<int>(low.x), y = static_cast<int>(low.y), z = static_cast<int>(low.z);
  const auto along_x = [&](int yi, int zi) { return (1 - f.x) * sample(x, yi, zi) + f.x * sample(x + 1, yi, zi); };
  const auto along_y = [&](int zi) { return (1 - f.y) * along_x(y, zi) + f.y * along_x(y + 1, zi); };
  return (1 - f.z) * along_y(z) + f.z * along_y(z + 1);
}

template <class T>
template <class Visit>
void SampledGrid<T>::for_each_in(const Bounds& region, Visit&& visit) const {
  const Vec3 first = glm::floor(cells(region.min)), last = glm::floor(cells(region.max)) + Vec3(1);
  for (int z = static_cast<int>(first.z); z <= static_cast<int>(last.z); ++z)
    for (int y = static_cast<int>(first.y); y <= static_cast<int>(last.y); ++y)
      for (int x = static_cast<int>(first.x); x <= static_cast<int>(last.x); ++x) visit(sample(x, y, z));
}

/// Values on a regular grid, given by the scene.
struct GridDensity {
  SampledGrid<float> grid;

  float at(const Point& p) const { return grid.at(p); }
  Bounds box() const { return grid.box; }
  float bound(const Bounds& cell) const;
};

/// A sparse grid of floats in a NanoVDB file (Museth 2021).
class VdbDensity {
 public:
  /// Throws Error, without location, if the file cannot be read or has no valid grid of floats with that name.
  VdbDensity(const std::string& file, const std::string& grid, const FileAccess& access = {});

  float at(const Point& p) const;
  Bounds box() const;
  float bound(const Bounds& cell) const;
  std::size_t bytes() const;

 private:
  struct Grid;
  std::shared_ptr<const Grid> grid_;
};

/// A procedural cloud from noise, denser towards its lower side (pbrt 4e, §11.4.5, after Fedkiw, Stam & Jensen 2001).
struct CloudDensity {
  Bounds region{Point(0), Point(1)};
  float density = 1, wispiness = 1, frequency = 5;

  float at(const Point& p) const;
  Bounds box() const { return region; }
  float bound(const Bounds&) const { return 1; }
};

using Density = std::variant<GridDensity, VdbDensity, CloudDensity>;

inline float density_at(const Density& density, const Point& p) {
  return std::visit([&](const auto& d) { return d.at(p); }, density);
}

}  // namespace lanthorn
