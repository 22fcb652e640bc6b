// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The only file that includes NanoVDB.
#include <iostream>  // missing in NanoVDB's headers

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/GridValidator.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/SampleFromVoxels.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "base/memory.h"
#include "lanthorn/error.h"
#include "lanthorn/text.h"
#include "medium/density.h"

namespace lanthorn {

namespace {

// Largest compression ratio of Deflate.
constexpr double largest_ratio = 1032;

[[noreturn]] void damaged(const std::string& file) {
  throw Error("NanoVDB file \"" + printable(file) + "\" is damaged");
}

template <class T>
T header_at(std::string_view bytes, std::size_t at, const std::string& file) {
  if (at > bytes.size() || bytes.size() - at < sizeof(T)) damaged(file);
  T header;
  std::memcpy(static_cast<void*>(&header), bytes.data() + at, sizeof(T));
  return header;
}

// Files of other versions have other headers.
void check_version(const nanovdb::io::Header& header, const std::string& file) {
  const std::string name = "file \"" + printable(file) + "\"";
  if (header.magic != NANOVDB_MAGIC_NUMBER) throw Error(name + " is not a NanoVDB file");
  const nanovdb::Version& version = header.version;
  if (version.getMajor() == NANOVDB_MAJOR_VERSION_NUMBER) return;
  const std::string read = std::to_string(NANOVDB_MAJOR_VERSION_NUMBER);
  throw Error("NanoVDB " + name + " has version " + std::to_string(version.getMajor()) + "." +
              std::to_string(version.getMinor()) + "." + std::to_string(version.getPatch()) +
              " of the format; expected version " + read +
              ".x. OpenVDB's nanovdb_convert makes such a file from the .vdb file");
}

// Checks the sizes in a file's headers, which NanoVDB trusts: it would allocate whatever they claim, and loop for ever
// if they are negative.
void check_headers(std::string_view bytes, const std::string& file) {
  for (std::size_t at = 0; at < bytes.size();) {
    const auto segment = header_at<nanovdb::io::Header>(bytes, at, file);
    check_version(segment, file);
    at += sizeof(segment);
    std::size_t grids = 0;
    for (unsigned i = 0; i < segment.gridCount; ++i) {
      const auto grid = header_at<nanovdb::io::MetaData>(bytes, at, file);
      at += sizeof(grid);
      if (grid.nameSize == 0 || grid.nameSize > bytes.size() - at || bytes[at + grid.nameSize - 1] != '\0')
        damaged(file);
      at += grid.nameSize;
      if (grid.fileSize > bytes.size() - grids) damaged(file);
      grids += grid.fileSize;
      const double ratio = segment.codec == nanovdb::io::Codec::NONE ? 1 : largest_ratio;
      const auto size = static_cast<double>(grid.gridSize);
      if (size > ratio * static_cast<double>(grid.fileSize)) damaged(file);
      require_memory(size, {}, "NanoVDB file \"" + printable(file) + "\"");
    }
    if (grids > bytes.size() - at) damaged(file);
    at += grids;
  }
}

// Whether all voxels and tiles of a node and of its children are finite.
template <class Node>
bool are_finite(const Node& node) {
  if constexpr (Node::LEVEL == 0) {
    for (std::uint32_t i = 0; i < Node::SIZE; ++i)
      if (!std::isfinite(node.getValue(i))) return false;
  } else {
    for (auto tile = node.beginValue(); tile; ++tile)
      if (!std::isfinite(*tile)) return false;
    for (auto child = node.beginChild(); child; ++child)
      if (!are_finite(*child)) return false;
  }
  return true;
}

}  // namespace

struct VdbDensity::Grid {
  nanovdb::GridHandle<> handle;
  const nanovdb::FloatGrid* floats = nullptr;
};

VdbDensity::VdbDensity(const std::string& file, const std::string& name, const FileAccess& access) {
  auto grid = std::make_shared<Grid>();
  std::string bytes = access.read(file);
  check_headers(bytes, file);
  try {
    std::istringstream stream(std::move(bytes));
    grid->handle = nanovdb::io::readGrid(stream, name);
  } catch (const std::exception& problem) {
    throw Error("cannot read grid " + in_quotes(name) + " of NanoVDB file \"" + printable(file) +
                "\": " + printable(problem.what()));
  }
  grid->floats = grid->handle.grid<float>();
  if (grid->floats == nullptr)
    throw Error("NanoVDB file \"" + printable(file) + "\" has no grid of floats called " + in_quotes(name));
  if (!nanovdb::isValid(*grid->floats, true)) damaged(file);
  const auto& root = grid->floats->tree().root();
  if (!std::isfinite(root.background()) || !are_finite(root))
    throw Error("grid " + in_quotes(name) + " of NanoVDB file \"" + printable(file) +
                "\" has a value that is infinite or not a number");
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
