// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The film: exact, order-independent sums of samples and splats. An image is therefore a function of scene, settings,
// seed and passes: the same bytes for any number of threads, also if resumed or merged from shards.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/spin_locks.h"
#include "film/features.h"
#include "film/filter.h"
#include "film/pixel_window.h"
#include "film/sensor.h"
#include "lanthorn/color.h"
#include "lanthorn/image.h"
#include "lanthorn/state.h"
#include "math/vec.h"
#include "spectrum/spectrum.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Maximum number of light layers of a film, including repeated ones, and of parts of its decomposition.
inline constexpr std::size_t most_light_layers = 8;

/// A second decomposition of a film's light, besides its light layers.
struct Decomposition {
  std::vector<std::string>
      parts{};           ///< names of the parts' layers, in the order of PixelSample::parts; empty: no decomposition
  std::string splats{};  ///< name of a further part for the splatted light; empty: none
  /// A false-colour layer: the shares of three groups of parts in the total. Groups list parts by index; the index of
  /// `splats` is parts.size().
  struct Shares {
    std::string name{};
    std::array<std::vector<std::size_t>, 3> groups{};
    friend bool operator==(const Shares&, const Shares&) = default;
  };
  std::optional<Shares> shares{};
  friend bool operator==(const Decomposition&, const Decomposition&) = default;
};

/// One sample of a pixel.
struct PixelSample {
  /// Radiance in each of the film's light layers, then in the repeated layers; may be negative.
  std::array<Rgb, most_light_layers> light{};
  std::array<Rgb, most_light_layers> parts{};  ///< the same light in the film's decomposition, if it has one
  Rgb bias{};                                  ///< estimate of the expected error of the light, if the film stores it
  Features features{};
  /// Sum of the light layers, for films with spectral buckets.
  std::optional<SpectralRadiance> spectrum{};
  FilterPart filter_part = FilterPart::positive;  ///< from which the sample's position was drawn
};

/// Quantities that a film accumulates. Every film also has the layers of `Features`, and samples.
struct FilmContents {
  /// Names of the light layers, 1 to most_light_layers. `color` is their exact sum, by definition.
  std::vector<std::string> light{"light"};
  /// Names of further layers. They repeat a part of the light of the layers above, so `color` excludes them.
  std::vector<std::string> repeated{};
  Decomposition decomposition{};
  bool splats = false;  ///< `splat` will be called
  bool bias = false;    ///< samples have an estimate of their bias
  std::optional<SpectralBuckets> buckets{};
  /// N of the pixel filter (film/filter.h). If it is not 0, the film keeps further sums for the samples of f⁻.
  float negative_share = 0;
  std::size_t layer_count() const { return light.size() + repeated.size(); }
  friend bool operator==(const FilmContents&, const FilmContents&) = default;
};

/// Splits the passes of a render into two halves, whose difference measures the noise of the picture. Each half gets
/// one of the passes 2k and 2k + 1, by the parity of the ones in the pass's number (Thue & Morse), so that quantities
/// ordered by bit reversal, such as the parts of the shutter interval, are as evenly distributed in each half as in
/// all. Eye paths and wavelengths of each half have their own random numbers.
enum class FilmHalf : std::uint8_t { first, second };
inline FilmHalf half_of_pass(std::uint64_t pass) {
  return std::popcount(pass) % 2 == 0 ? FilmHalf::first : FilmHalf::second;
}
/// The index of a pass within its half.
inline std::uint64_t number_in_half(std::uint64_t pass) { return pass / 2; }

/// R, G, B of one half of the passes.
struct HalfPicture {
  Image color, bias;
};

/// Exact order-independent sums in 64-bit fixed point, of samples and splats for each half of the passes.
///
/// Scale: 2^40 steps represent a radiance of `largest_radiance` (rounded up to a power of two). A sum saturates at 2^62
/// steps (4 million samples of the largest radiance); one contribution is clamped at 2^56 steps (65536 times the
/// largest radiance). Floats above 2^-17 of the largest radiance are stored without rounding. Values below 2^12 steps
/// are rounded stochastically, by a hash of pass, pixel of the full film and value, so that sums of tiny contributions
/// stay unbiased. Counts and features use 2^40 steps per unit, features that are numbers or positions 2^28.
///
/// For filters with negative lobes, the film keeps the sums of the samples of f⁺ and of f⁻ apart. A pixel is
/// (1 + N) (mean over f⁺) - N (mean over f⁻). As long as one part has no samples, it is the mean of the other: the
/// first passes show the picture as f⁺ alone filters it. A constant stays constant, and no pixel exceeds 1 + 2 N times
/// its largest sample.
///
/// Spectral buckets, if present, hold the mean radiance of all light within them, per nanometre. A value at a
/// wavelength is weighted by 1 / (4 pdf width). Buckets of samples are divided by the sum of these weights, so that a
/// constant spectrum stays constant however few wavelengths were sampled. Buckets of splats are divided by the number
/// of passes instead.
class Film {
 public:
  Film() = default;
  /// `width`, `height` > 0: size of the crop window, pixels. `largest_radiance` > 0: expected maximum of a pixel,
  /// W/(m^2 sr) (values that are not positive and finite count as 1).
  Film(int width, int height, float largest_radiance, const FilmContents& contents = {});

  int width() const { return width_; }
  int height() const { return height_; }
  std::uint32_t pixel_count() const { return static_cast<std::uint32_t>(width_) * static_cast<std::uint32_t>(height_); }
  const FilmContents& contents() const { return contents_; }
  const std::optional<SpectralBuckets>& buckets() const { return contents_.buckets; }
  /// Radiance is stored in steps of 2^exponent.
  int step_exponent() const { return step_exponent_; }
  /// Memory used, in bytes.
  std::size_t memory() const {
    std::size_t integers = 0;
    for_each_sum(*this, [&](const std::vector<std::int64_t>& sums, std::size_t) { integers += sums.capacity(); });
    return integers * sizeof(std::int64_t);
  }

  /// Sets the processing of later samples and splats. Not saved: it belongs to the view.
  void set_sensor(const Sensor& sensor) { sensor_ = sensor; }

  /// Sets the position of this film, a crop window, in a full film of this width, so that it rounds as the full film
  /// does. Not saved.
  void set_window(const PixelWindow& window, int full_width) {
    window_ = window;
    full_width_ = full_width;
  }

  /// The image after `passes` passes (divides splats by `passes`, samples by their number). Channels, in
  /// this order: R, G, B (color); the light layers by their names (emission.R ... caustic.B, media.R ...); albedo.R ..
  /// B; normal.X .. Z (mean, not unit length); position.X .. Z; depth.Z (mean over hits, 0 without hits); samples
  /// (their number); the parts of the decomposition by their names (technique.hit.R ..., term.A.R ...), its splats and
  /// its shares (red, green and blue are the luminance shares of the first, second and third group); the spectral
  /// buckets by their centres (S0.360,5nm ...). Pixels without samples are 0, and so are buckets in which no wavelength
  /// was sampled. `balance`: factors applied to the colours of light; other channels are unaffected.
  Image resolve(std::uint64_t passes, const Rgb& balance = {1, 1, 1}) const;
  /// Only R, G, B of `resolve`, for previews.
  Image resolve_color(std::uint64_t passes, const Rgb& balance = {1, 1, 1}) const;
  /// The light layers and features of the first half of the passes, and its samples, named as by `resolve`. `passes`:
  /// number in this half.
  Image resolve_first_half(std::uint64_t passes, const Rgb& balance = {1, 1, 1}) const;
  /// R, G, B of one half, which has `passes` passes, and its estimate of the bias, if the film has one.
  HalfPicture resolve_half(FilmHalf half, std::uint64_t passes, const Rgb& balance = {1, 1, 1}) const;

  FilmReport report() const;

  /// True if both films can be added: equal sizes, scale and contents.
  bool compatible(const Film& other) const;
  /// Adds another compatible film exactly.
  void merge(const Film& other);

  // The raw sums, one plane of `pixel_count` integers per quantity, for saving.
  std::size_t plane_count() const;
  std::vector<std::int64_t> plane(std::size_t index) const;
  /// A part of a plane: `out.size()` pixels, starting at pixel `first`.
  void copy_sums(std::size_t plane, std::size_t first, std::span<std::int64_t> out) const;
  /// Adds to a part of a plane, clamping to the limit of the sums. Several threads may add to different pixels or
  /// planes.
  void add_sums(std::size_t plane, std::size_t first, std::span<const std::int64_t> values);
  /// Adds the counts of a report except `saturated`, which is counted from the sums.
  void add_report(const FilmReport& report);

  /// A film with a given step exponent, for loading: equivalent to a largest radiance of 2^(exponent + 40).
  static Film with_exponent(int width, int height, int step_exponent, const FilmContents& contents = {});
  /// Integers per pixel of a film with these contents.
  static std::size_t stride(const FilmContents& contents);

 private:
  friend class FilmPass;  // adds to the sums

  struct Problem {
    std::uint64_t count = 0;
    /// Low 32 bits of the pass << 32 | pixel: one word, so that threads can atomically compute the minimum.
    std::uint64_t first = ~std::uint64_t{0};
  };
  static void add_problem(Problem& sum, const Problem& more);
  using LightMeans = std::array<double, most_light_layers * 3>;  ///< 0 for missing layers
  static constexpr std::size_t surface_slots =
      feature_channels + 2;  ///< of a sample, after its light: including hits and the number of samples
  static constexpr std::size_t most_slots = (most_light_layers + 1) * 3 + surface_slots;  ///< of a sample
  using SampleValues = std::array<double, most_slots>;
  using SampleSums = std::array<std::int64_t, most_slots>;
  using SplatSums = std::array<std::int64_t, most_light_layers * 3>;  ///< 0 for missing layers
  using Sums = std::vector<std::int64_t>;
  static constexpr std::size_t filter_parts = 2;

  /// Integers per pixel: splats, samples, and the parts of samples.
  std::size_t splats_stride() const { return 3 * contents_.layer_count(); }
  std::size_t light_slots() const { return splats_stride() + (contents_.bias ? 3 : 0); }  ///< of a sample
  std::size_t samples_stride() const { return light_slots() + surface_slots; }
  std::size_t parts_stride() const { return 3 * contents_.decomposition.parts.size(); }
  std::size_t spectra_stride() const { return contents_.buckets ? 2 * contents_.buckets->count : 0; }
  std::size_t count_slot() const { return samples_stride() - 1; }

  std::uint32_t pixel_of_full_film(std::uint32_t pixel) const;
  void write_spectrum(std::uint32_t pixel, std::uint64_t passes, float* out) const;
  /// Calls `visit(sums, stride)` for each array of sums, in the order of the planes.
  template <class Self, class Visit>
  static void for_each_sum(Self& film, Visit&& visit) {
    for (std::size_t part = 0; part < (film.contents_.negative_share == 0 ? 1 : filter_parts); ++part) {
      for (auto& half : film.halves_) {
        visit(half.samples[part], film.samples_stride());
        if (part == 0 && film.contents_.splats) visit(half.splats, film.splats_stride());
      }
      visit(film.parts_[part], film.parts_stride());
      visit(film.spectra_[part], film.spectra_stride());
      if (part == 0 && film.contents_.splats) visit(film.spectral_splats_, film.spectra_stride() / 2);
    }
  }
  /// The array of sums that holds a plane, and the plane's position in it.
  template <class Array>
  struct PlanePlace {
    Array* sums = nullptr;
    std::size_t stride = 0, slot = 0;
  };
  template <class Array, class Self>
  static PlanePlace<Array> find_plane(Self& film, std::size_t index);
  template <class Body>
  void for_each_pixel(Body&& body) const;
  /// Sums of one pixel; splats are 0 if the film has none, and so are samples of f⁻.
  struct PixelSums {
    std::array<SampleSums, filter_parts> samples;
    SplatSums splats;
  };
  PixelSums sums_of_half(FilmHalf half, std::uint32_t pixel) const;
  PixelSums sums_of(std::uint32_t pixel) const;
  /// Factors of a pixel's sums of f⁺ and f⁻, whose sum with the factors is its mean.
  using PartFactors = std::array<double, filter_parts>;
  /// `counts`: of the samples of each part, in any unit.
  PartFactors factors_of(const std::array<std::int64_t, filter_parts>& counts) const;
  PartFactors factors_of(const PixelSums& sums) const;
  LightMeans light_means(const PixelSums& sums, std::uint64_t passes) const;
  float* write_light(const LightMeans& means, float* out) const;
  float* write_features(const PixelSums& sums, float* out) const;
  using PartMeans = std::array<Rgb, most_light_layers>;
  PartMeans part_means(std::uint32_t pixel, const PartFactors& factors) const;
  Rgb splat_mean(const SplatSums& splats, std::uint64_t passes) const;
  float* write_decomposition(std::uint32_t pixel, std::uint64_t passes, const PixelSums& sums, const Rgb& balance,
                             float* out) const;

  int width_ = 0;
  int height_ = 0;
  int step_exponent_ = -40;
  FilmContents contents_;
  Sensor sensor_;
  PixelWindow window_;
  int full_width_ = 0;              ///< 0: this is the full film
  double radiance_steps_ = 0x1p40;  ///< steps per unit of radiance
  SampleValues sample_steps_{};     ///< steps per unit of each quantity of a sample
  Problem non_finite_;
  Problem too_large_;
  struct Half {
    std::array<Sums, filter_parts> samples;  ///< samples_stride() per pixel; those of f⁻ may be empty
    Sums splats;                             ///< splats_stride() per pixel, or empty
  };
  std::array<Half, 2> halves_;              ///< by half_of_pass
  std::array<Sums, filter_parts> parts_;    ///< parts_stride() per pixel, or empty
  std::array<Sums, filter_parts> spectra_;  ///< per pixel the buckets and then their weights, or empty
  Sums spectral_splats_;                    ///< the buckets of each pixel, or empty
  SpinLocks pixel_locks_;                   ///< for all sums except splats
};

}  // namespace lanthorn
