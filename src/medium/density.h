// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Densities that vary in space. Each gives its value at a point, the box outside of which it is 0, and an upper bound
// inside a part of that box, all in the medium's space.
#pragma once

#include <memory>
#include <string>
#include <variant>

#include "lanthorn/file_access.h"
#include "medium/grid.h"

namespace lanthorn {

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
