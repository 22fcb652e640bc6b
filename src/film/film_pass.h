// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/prefetch.h"
#include "film/film.h"

namespace lanthorn {

/// Adds the contributions of one pass to a film, which must outlive it. Any thread may call any function at any time,
/// also for several passes at once: sums do not depend on the order.
class FilmPass {
 public:
  /// `splat_share`: weight of splats, 1 / parts if the pass is rendered in parts that each splat the pass's full light.
  FilmPass(Film& film, std::uint64_t pass, float splat_share = 1)
      : film_(film),
        pass_(pass),
        half_(film.halves_[static_cast<std::size_t>(half_of_pass(pass))]),
        splat_share_(splat_share) {}

  const FilmContents& contents() const { return film_.contents(); }

  /// Adds a sample to a pixel (row-major index in the crop window).
  void add(std::uint32_t pixel, const PixelSample& sample) const;

  /// Adds to the light layer of this index (repeated layers come last). `value`: radiance, already divided by the
  /// number of light paths of the pass, or of its part, and multiplied by the filter's weight; `Film::resolve` divides
  /// by the number of passes. The film must have splats.
  void splat(std::uint32_t pixel, std::size_t layer, const Rgb& value) const;
  /// Adds the same light to the spectral buckets, which the film must have. `weight`: the filter's weight, applied
  /// here.
  void splat_spectrum(std::uint32_t pixel, const SpectralRadiance& value, float weight) const;

  /// Prefetches the sums of a pixel to which a sample will soon be added. If the film exceeds the caches, waiting for
  /// the sums takes longer than adding to them.
  [[gnu::always_inline]] void prefetch(std::uint32_t pixel) const {  // samples of f⁻ are few
    prefetch(half_.samples.front(), film_.samples_stride(), pixel);
    if (film_.parts_stride() > 0) prefetch(film_.parts_.front(), film_.parts_stride(), pixel);
  }
  /// Prefetches the sums to which light will be splatted.
  [[gnu::always_inline]] void prefetch_splats(std::uint32_t pixel) const {
    prefetch(half_.splats, film_.splats_stride(), pixel);
  }

 private:
  using Values = Film::SampleValues;

  [[gnu::always_inline]] static void prefetch(const std::vector<std::int64_t>& sums, std::size_t stride,
                                              std::uint32_t pixel) {
    prefetch_to_write(sums.data() + std::size_t{pixel} * stride, stride * sizeof(std::int64_t));
  }
  std::int64_t to_steps(double value, double steps_per_unit, std::uint32_t pixel, unsigned slot) const;
  void note(Film::Problem& problem, std::uint32_t pixel) const;
  Values values_of(const PixelSample& sample, float factor) const;
  template <class Stride>
  bool add_ordinary(std::int64_t* sums, const Values& values, Stride stride) const;
  void add_values(std::uint32_t pixel, std::size_t filter_part, const Values& values) const;
  void add_parts(std::uint32_t pixel, const PixelSample& sample, double factor) const;
  void add_spectrum(std::uint32_t pixel, const PixelSample& sample, double factor) const;

  Film& film_;
  std::uint64_t pass_;
  Film::Half& half_;
  float splat_share_;
};

}  // namespace lanthorn
