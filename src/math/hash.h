// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>

#include "math/vec.h"

namespace lanthorn {

/// A bijection of 64-bit words in which every output bit depends on every input bit (variant 13 of Stafford's mixers).
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// Hash of a few words; their order matters.
constexpr std::uint64_t hash_words(std::initializer_list<std::uint64_t> words) {
  std::uint64_t h = 0x9e3779b97f4a7c15ull;
  for (const std::uint64_t w : words) h = mix_bits(h ^ (w + 0x9e3779b97f4a7c15ull + (h << 6)));
  return h;
}
/// Hash of the content of a file.
inline std::uint64_t hash_bytes(std::span<const std::byte> bytes) {
  std::uint64_t h = hash_words({bytes.size()});
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, &bytes[i], std::min(sizeof(word), bytes.size() - i));
    h = mix_bits(h ^ word) + 0x9e3779b97f4a7c15ull;
  }
  return h;
}
inline std::uint64_t hash_vec(const Vec3& v, std::uint64_t seed = 0) {
  return hash_words(
      {seed, std::bit_cast<std::uint32_t>(v.x), std::bit_cast<std::uint32_t>(v.y), std::bit_cast<std::uint32_t>(v.z)});
}

/// The top 24 bits as a float in [0,1).
constexpr float unit_float(std::uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1p-24f; }
constexpr float unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// Small sequential generator for a function that needs a few random numbers from a hash (stochastic evaluation of
/// layers, alpha). Paths use `Sampler`.
class HashRng {
 public:
  constexpr explicit HashRng(std::uint64_t seed) : state_(seed) {}
  constexpr float next() { return unit_float(mix_bits(state_ += 0x9e3779b97f4a7c15ull)); }
  Vec2 next2() {
    const float x = next();
    return {x, next()};
  }

 private:
  std::uint64_t state_;
};

}  // namespace lanthorn
