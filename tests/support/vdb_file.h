// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <iostream>  // NanoVDB does not include it

#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>

#include "math/vec.h"

namespace lanthorn::test {

/// Writes a NanoVDB file, using NanoVDB itself, with a grid "density": voxels 0 to `last` along each axis have the
/// value `value(index)`. Voxels are `voxel` metres wide, and the first is at `origin`.
template <class Value>
void write_vdb(const std::filesystem::path& file, int last, float voxel, const Point& origin, Value&& value,
               nanovdb::io::Codec codec = nanovdb::io::Codec::NONE) {
  nanovdb::GridBuilder<float> builder(0.0f);
  auto voxels = builder.getAccessor();
  for (int x = 0; x <= last; ++x)
    for (int y = 0; y <= last; ++y)
      for (int z = 0; z <= last; ++z) voxels.setValue({x, y, z}, value(Vec3(x, y, z)));
  const auto grid = builder.getHandle(double{voxel}, nanovdb::Vec3d(origin.x, origin.y, origin.z), "density");
  nanovdb::io::writeGrid(file.string(), grid, codec);
}

}  // namespace lanthorn::test
