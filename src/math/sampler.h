// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The random numbers of every path are a pure function of (seed, stream, pass, index, dimension): nothing to save, and
// no result depends on which thread drew first.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "math/hash.h"
#include "math/primary_samples.h"
#include "math/vec.h"

namespace lanthorn {

/// Separate universes of random numbers, so that eye and light paths never correlate. Methods outside of the library
/// make their own by `stream_of`.
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
  shadow
};

/// A stream by name, of which nobody else knows (FNV-1a; the streams above are its small numbers).
constexpr Stream stream_of(std::string_view name) {
  std::uint32_t hash = 0x811c9dc5u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x01000193u;
  return static_cast<Stream>(hash | 0x80000000u);
}

/// Random numbers of one path, in groups of four dimensions. The first groups are Owen-scrambled Sobol' points,
/// shuffled independently per group (Burley 2020, "Practical Hash-based Owen Scrambling"); later ones are hashes.
class Sampler {
 public:
  /// An eye path: stratified over the passes of its pixel.
  static Sampler for_pixel(std::uint64_t seed, Stream stream, std::uint32_t pixel, std::uint32_t pass);
  /// Photon `index` of light `light`: stratified over the photons that this light emits in the pass.
  static Sampler for_light_path(std::uint64_t seed, Stream stream, std::uint32_t light, std::uint32_t pass,
                                std::uint32_t index);
  /// What a whole pass shares (time, wavelengths): stratified over passes.
  static Sampler for_pass(std::uint64_t seed, std::uint32_t pass);
  /// A path of a Markov chain, whose numbers are those of `samples`, which must outlive the sampler.
  explicit Sampler(PrimarySamples& samples) : samples_(&samples) {}

  /// Goes to the first of the four dimensions of `group`.
  void seek(std::uint32_t group) {
    group_ = group;
    cursor_ = group_size;
  }
  /// As many independent numbers as one likes, for the inside of what happens at the group's dimensions: no
  /// low-discrepancy, and no effect on the dimensions.
  HashRng generator(std::uint32_t group) const {
    return HashRng(samples_ ? samples_->seed_of(group) : hash_words({key_, index_, group}));
  }
  /// Numbers of a path that branches off at the group: as well stratified, and independent. Not of a Markov chain.
  Sampler fork(std::uint32_t group) const { return {hash_words({key_, group}), index_}; }
  /// Next dimension, in [0,1). After the fourth of a group comes the first of the next.
  float next() {
    if (cursor_ >= group_size) draw_group();
    return values_[cursor_++];
  }
  /// Next two dimensions of one group (skips the last of this group if only that is left).
  Vec2 next2() {
    if (cursor_ + 1 >= group_size) draw_group();
    const Vec2 u{values_[cursor_], values_[cursor_ + 1]};
    cursor_ += 2;
    return u;
  }

 private:
  static constexpr std::uint32_t group_size = PrimarySamples::group_size;
  /// Groups that are low-discrepancy; beyond, the gain is gone and hashes are cheaper.
  static constexpr std::uint32_t sobol_groups = 8;

  Sampler(std::uint64_t key, std::uint32_t index) : key_(key), index_(index) {}
  void draw_group();

  PrimarySamples* samples_ = nullptr;  // none: the numbers are functions of the next two
  std::uint64_t key_ = 0;
  std::uint32_t index_ = 0;  // position in the Sobol' sequence
  std::uint32_t group_ = 0;  // the group that the next draw_group() makes
  std::uint32_t cursor_ = group_size;
  std::array<float, group_size> values_{};
};

}  // namespace lanthorn
