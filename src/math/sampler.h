// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The random numbers of every path are a pure function of (seed, stream, pass, index, dimension). No generator state is
// saved, and no result depends on the order in which threads draw.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "math/hash.h"
#include "math/primary_samples.h"
#include "math/vec.h"

namespace lanthorn {

/// Independent streams of random numbers, so that eye paths and light paths are uncorrelated. Methods outside the
/// library create their own with `stream_of`.
enum class Stream : std::uint32_t {
  camera,
  light,
  pass,
  pilot_camera,
  pilot_light,
  bootstrap,
  pilot_bootstrap,
  chain,
  gather,
  caustic,
  pilot_emission,
  irradiance,
  shadow,
  camera_of_second_half
};

/// A stream by name (FNV-1a hash), distinct from the streams above, which are small numbers.
constexpr Stream stream_of(std::string_view name) {
  std::uint32_t hash = 0x811c9dc5u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x01000193u;
  return static_cast<Stream>(hash | 0x80000000u);
}

/// The second coordinate of Sobol' point number `i`, as a 32-bit fraction (Kollig & Keller 2002, "Efficient
/// Multidimensional Sampling"); the first coordinate is the bit reversal of i. The second coordinates of the first 2^m
/// points are the multiples of 2^-m.
constexpr std::uint32_t second_sobol_coordinate(std::uint32_t i) {
  std::uint32_t sum = 0;
  for (std::uint32_t direction = 1u << 31; i != 0; i >>= 1, direction ^= direction >> 1)
    if (i & 1) sum ^= direction;
  return sum;
}

/// Random numbers of one path, in groups of four dimensions. The first groups are Owen-scrambled Sobol' points,
/// shuffled independently per group (Burley 2020, "Practical Hash-based Owen Scrambling"); later groups are hashes.
class Sampler {
 public:
  /// Eye path: stratified over the passes of its pixel, which `pass` numbers.
  static Sampler for_pixel(std::uint64_t seed, Stream stream, std::uint32_t pixel, std::uint32_t pass);
  /// Photon `index` of light `light`: stratified over the photons that this light emits in the pass.
  static Sampler for_light_path(std::uint64_t seed, Stream stream, std::uint32_t light, std::uint32_t pass,
                                std::uint32_t index);
  /// Values shared by a whole pass: stratified over passes.
  static Sampler for_pass(std::uint64_t seed, std::uint32_t pass);
  /// Path of a Markov chain: its numbers come from `samples`, which must outlive the sampler and not change before its
  /// end.
  explicit Sampler(PrimarySamples& samples) : samples_(&samples) {}

  /// Moves to the first of the four dimensions of `group`.
  void seek(std::uint32_t group) { position_ = group_size * group; }
  /// Like `seek`, but draws the group's numbers now (for an odd group also the numbers of the group before it). Beside
  /// a long computation that does not depend on them, they are nearly free.
  void draw_ahead(std::uint32_t group) {
    seek(group);
    if (samples_ == nullptr && !is_drawn()) draw();
  }
  /// Generator of any number of independent random numbers for the event at the group's dimensions. Not
  /// low-discrepancy; does not advance the dimensions.
  HashRng generator(std::uint32_t group) const {
    return HashRng(samples_ ? samples_->seed_of(group) : hash_words({key_, index_, group}));
  }
  /// Sampler of a path that branches off at the group: equally well stratified, and independent. Not for paths of a
  /// Markov chain.
  Sampler fork(std::uint32_t group) const { return {hash_words({key_, group}), index_}; }
  /// The next dimension, in [0,1). The first of the next group follows the fourth of a group.
  float next() {
    if (!is_drawn()) draw();
    const float value = values_[position_ / group_size % 2][position_ % group_size];
    ++position_;
    return value;
  }
  /// The next two dimensions of one group (skips the last dimension of this group if only that is left).
  Vec2 next2() {
    if (position_ % group_size == group_size - 1) ++position_;
    const float x = next();
    return {x, next()};
  }

 private:
  using Group = PrimarySamples::Group;
  static constexpr std::uint32_t group_size = PrimarySamples::group_size;
  /// Number of low-discrepancy groups; further groups gain nothing from it, and hashes are cheaper.
  static constexpr std::uint32_t sobol_groups = 8;

  Sampler(std::uint64_t key, std::uint32_t index);
  bool is_drawn() const { return position_ - drawn_from_ < drawn_; }
  void draw();
  void draw_group(std::uint32_t group);

  PrimarySamples* samples_ = nullptr;  // null: the numbers are functions of key_ and index_
  std::uint64_t key_ = 0;
  std::uint32_t index_ = 0;           // position in the Sobol' sequence
  std::uint32_t reversed_index_ = 0;  // its bits reversed
  std::uint32_t position_ = 0;        // the next dimension
  // Groups 2i and 2i + 1, of which drawn_ dimensions from drawn_from_ on are valid. Both are drawn together, because an
  // eye walk mostly needs both (its visitor the odd group, the walk the even one) and two take hardly longer than one.
  std::uint32_t drawn_from_ = 0, drawn_ = 0;
  std::array<Group, 2> values_{};
};

}  // namespace lanthorn
