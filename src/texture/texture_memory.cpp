// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "texture/texture_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "base/memory.h"
#include "base/scratch_file.h"

namespace lanthorn {

namespace {

// Enough tiles for the lookups of some threads: with fewer, a tile would be dropped while its neighbour is read.
constexpr std::uint64_t smallest_cache = std::uint64_t{4} << 20;

void require_disk(std::uint64_t bytes, std::uint64_t memory, std::uint64_t bound) {
  const std::filesystem::path folder = scratch_folder();
  const std::uint64_t left = free_space(folder);
  if (bytes <= left) return;
  const auto text = [](std::uint64_t count) { return memory_text(static_cast<double>(count)); };
  throw Error(fmt::format(
      "the textures take {} of memory, but --texture-memory allows {}; the tiles of those that do not fit take {} on "
      "disk, but {} has only {} left: allow more memory, or set TMPDIR to a folder with more room",
      text(memory), text(bound), text(bytes), folder.string(), text(left)));
}

}  // namespace

std::uint64_t default_texture_memory() {
  const std::optional<std::uint64_t> available = available_memory();
  return available ? *available / 2 : ~std::uint64_t{0};
}

std::vector<bool> TextureMemory::plan(const std::vector<TextureImage::Need>& needs) {
  if (!bound_) bound_ = default_texture_memory();
  std::vector<bool> is_cached(needs.size(), false);
  std::uint64_t all = 0;
  for (const TextureImage::Need& need : needs) all += need.memory;
  if (used_ + all <= *bound_) {
    used_ += all;
    return is_cached;
  }
  std::vector<std::size_t> order(needs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return needs[a].memory < needs[b].memory; });
  std::uint64_t on_disk = 0;
  for (const std::size_t i : order) {
    if (used_ + needs[i].memory <= *bound_ / 2) {
      used_ += needs[i].memory;
      continue;
    }
    is_cached[i] = true;
    on_disk += needs[i].disk;
  }
  require_disk(on_disk, all, *bound_);
  if (!cache_) cache_ = std::make_shared<TextureCache>(std::max(*bound_ - std::min(used_, *bound_), smallest_cache));
  return is_cached;
}

}  // namespace lanthorn
