// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Everything that knows NanoVDB.
#include <iostream>  // NanoVDB forgets it

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/GridValidator.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/SampleFromVoxels.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lanthorn/error.h"
#include "medium/density.h"

namespace lanthorn {

struct VdbDensity::Grid {
  nanovdb::GridHandle<> handle;
  const nanovdb::FloatGrid* floats = nullptr;
};

VdbDensity::VdbDensity(const std::string& file, const std::string& name) {
  auto grid = std::make_shared<Grid>();
  try {
    grid->handle = nanovdb::io::readGrid(file, name);
  } catch (const std::exception& problem) {
    throw Error("cannot read grid \"" + name + "\" of NanoVDB file \"" + file + "\": " + problem.what());
  }
  grid->floats = grid->handle.grid<float>();
  if (grid->floats == nullptr)
    throw Error("NanoVDB file \"" + file + "\" has no grid of floats that is called \"" + name + "\"");
  if (!nanovdb::isValid(*grid->floats, true)) throw Error("NanoVDB file \"" + file + "\" is damaged");
  grid_ = std::move(grid);
}

float VdbDensity::at(const Point& p) const {
  const nanovdb::Vec3f index = grid_->floats->worldToIndexF(nanovdb::Vec3f(p.x, p.y, p.z));
  const auto accessor = grid_->floats->getAccessor();
  return std::max(0.0f, nanovdb::SampleFromVoxels<decltype(accessor), 1, false>(accessor)(index));
}

Bounds VdbDensity::box() const {
  const auto world = grid_->floats->worldBBox();
  const auto point = [](const auto& v) {
    return Point(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
  };
  return {point(world.min()), point(world.max())};
}

float VdbDensity::bound(const Bounds& cell) const {
  Bounds voxels;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const nanovdb::Vec3f v = grid_->floats->worldToIndexF(nanovdb::Vec3f(corner & 1 ? cell.max.x : cell.min.x,
                                                                         corner & 2 ? cell.max.y : cell.min.y,
                                                                         corner & 4 ? cell.max.z : cell.min.z));
    voxels.extend({v[0], v[1], v[2]});
  }
  const auto all = grid_->floats->indexBBox();
  const auto accessor = grid_->floats->getAccessor();
  const auto first = [&](int axis) {
    return std::max(all.min()[axis], static_cast<int>(std::floor(voxels.min[axis])) - 1);
  };
  const auto last = [&](int axis) {
    return std::min(all.max()[axis], static_cast<int>(std::ceil(voxels.max[axis])) + 1);
  };
  float largest = 0;
  for (int x = first(0); x <= last(0); ++x)
    for (int y = first(1); y <= last(1); ++y)
      for (int z = first(2); z <= last(2); ++z) largest = std::max(largest, accessor.getValue({x, y, z}));
  return largest;
}

std::size_t VdbDensity::bytes() const { return grid_->handle.size(); }

}  // namespace lanthorn
