// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/parallel.h"

namespace lanthorn {

/// Items grouped by key: those of key k are order[start[k]] .. order[start[k + 1] - 1], in ascending item number.
struct KeyGroups {
  std::unique_ptr<std::uint32_t[]> start;  ///< keys + 1 offsets
  std::vector<std::uint32_t> order;
};

/// Stable parallel counting sort of the items 0 .. count-1 by `key_of(item)` < keys; count and keys below 2^32.
/// Two passes, both cache-friendly: by the keys' high bits with one histogram per fixed-size chunk, then each of these
/// buckets on its own by the low bits. The result does not depend on the thread count.
template <class KeyOf>
KeyGroups counting_sort(std::size_t count, std::size_t keys, KeyOf&& key_of) {
  struct Item {
    std::uint32_t key, number;
  };
  constexpr std::size_t chunk = 1u << 15;
  constexpr int bucket_bits = 10;
  const int shift = std::max(0, static_cast<int>(std::bit_width(keys)) - bucket_bits);
  const std::size_t buckets = (keys >> shift) + 1;
  const std::size_t chunks = (count + chunk - 1) / chunk;

  const auto key = std::make_unique_for_overwrite<std::uint32_t[]>(count);
  std::vector<std::uint32_t> place(chunks * buckets);  // first the size, then the next free place, of chunk × bucket
  parallel_chunks(count, chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    std::uint32_t* sizes = place.data() + c * buckets;
    for (std::size_t i = begin; i < end; ++i) {
      key[i] = key_of(i);
      ++sizes[key[i] >> shift];
    }
  });
  std::vector<std::uint32_t> bucket_start(buckets + 1);
  std::uint32_t total = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    bucket_start[b] = total;
    for (std::size_t c = 0; c < chunks; ++c) {
      const std::uint32_t size = place[c * buckets + b];
      place[c * buckets + b] = total;
      total += size;
    }
  }
  bucket_start[buckets] = total;

  const auto items = std::make_unique_for_overwrite<Item[]>(count);
  parallel_chunks(count, chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    std::uint32_t* next = place.data() + c * buckets;
    for (std::size_t i = begin; i < end; ++i) items[next[key[i] >> shift]++] = {key[i], static_cast<std::uint32_t>(i)};
  });

  KeyGroups groups{std::make_unique_for_overwrite<std::uint32_t[]>(keys + 1), std::vector<std::uint32_t>(count)};
  groups.start[keys] = total;
  parallel_chunks(buckets, 16, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> next(std::size_t{1} << shift);
    for (std::size_t b = begin; b < end; ++b) {
      std::fill(next.begin(), next.end(), 0u);
      const std::uint32_t first_key = static_cast<std::uint32_t>(b << shift);
      for (std::uint32_t i = bucket_start[b]; i < bucket_start[b + 1]; ++i) ++next[items[i].key - first_key];
      std::uint32_t offset = bucket_start[b];
      for (std::size_t k = 0; k < next.size() && first_key + k < keys; ++k) {
        groups.start[first_key + k] = offset;
        const std::uint32_t size = next[k];
        next[k] = offset;
        offset += size;
      }
      for (std::uint32_t i = bucket_start[b]; i < bucket_start[b + 1]; ++i)
        groups.order[next[items[i].key - first_key]++] = items[i].number;
    }
  });
  return groups;
}

}  // namespace lanthorn
