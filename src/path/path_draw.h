// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "film/film.h"
#include "math/hash.h"
#include "math/sampler.h"
#include "path/render_job.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Time and wavelengths, shared by all vertices of a path. Methods that cache light paths draw the wavelengths once per
/// pass (`PassDraw`), other methods once per path.
struct PathDraw {
  float time = 0;
  Wavelengths w;
};

/// Wavelengths from two numbers in [0,1). The four wavelengths of spectral mode are an offset within a quarter of the
/// range and its three shifts: the offset decides the tint and must itself be stratified over paths or passes. Which of
/// the four is the hero is drawn separately. RGB mode uses the offset alone.
inline Wavelengths wavelengths_of(ColorMode mode, float offset, float hero) {
  if (mode == ColorMode::rgb) return Wavelengths::rgb(offset);
  return Wavelengths::spectral(0.25f * (offset + std::floor(4 * hero)));
}

/// Draws both from the sampler's group 1.
inline PathDraw draw_time_and_wavelengths(const Camera& camera, ColorMode mode, Sampler& sampler) {
  sampler.seek(1);
  const float time = camera.time(sampler.next()), offset = sampler.next();
  return {time, wavelengths_of(mode, offset, sampler.next())};
}

/// True if it matters at what time a path sees the scene.
inline bool depends_on_time(const RenderJob& job) { return job.scene.has_motion() || job.view.camera.moves(); }

/// Draws time and wavelengths of each path separately. If nothing depends on them, all paths share the same values and
/// no random numbers are drawn: in RGB mode only dispersion needs a wavelength.
class OwnPathDraw {
 public:
  explicit OwnPathDraw(const RenderJob& job) : camera_(job.view.camera), mode_(job.settings.color) {
    if (!depends_on_time(job) && mode_ == ColorMode::rgb && !job.scene.has_dispersion())
      same_for_all_ = PathDraw{camera_.time(0), wavelengths_of(mode_, 0.5f, 0)};
  }
  PathDraw operator()(Sampler& sampler) const {
    return same_for_all_ ? *same_for_all_ : draw_time_and_wavelengths(camera_, mode_, sampler);
  }

 private:
  const Camera& camera_;
  ColorMode mode_;
  std::optional<PathDraw> same_for_all_;
};

/// Where a pass, or a part of it, stands in the random sequences of its half of the film. Each half has its own
/// sequences: the halves are independent, and each is stratified over its passes.
struct PlaceInHalf {
  FilmHalf half = FilmHalf::first;
  std::uint32_t number = 0;
};
/// `number` counts the parts of all passes before it (`RenderSettings::parts`).
inline PlaceInHalf place_in_half(std::uint32_t number, std::uint32_t parts) {
  const std::uint32_t pass = number / parts;
  return {half_of_pass(pass), static_cast<std::uint32_t>(number_in_half(pass)) * parts + number % parts};
}

/// The wavelengths of sequence `seed`, each of which all paths of a pass share. The first 2^m offsets are equidistant,
/// shifted by a number that depends on the seed: their mean is a rectangle rule with 4 · 2^m nodes, which for smooth
/// spectra converges much faster than stratified random offsets. The parts of the shutter interval are ordered by bit
/// reversal, the first Sobol' coordinate; the offset is the second, so that the colour of a pass does not follow its
/// time.
///
/// If something `disperses`, dispersed light has the colour of the hero wavelengths alone, so these must be as evenly
/// spread as the offsets. In spectral mode, 32 consecutive numbers then form a block of eight offsets, each used four
/// times, with each of its four wavelengths as the hero once. Over a block, the heroes form the same rectangle rule
/// with 32 nodes as all wavelengths do. Eight consecutive numbers use all eight offsets, and their heroes lie in
/// different eighths of the range. Among the orders with these properties, this is one whose heroes have the best
/// colour after 2, 4, 8 and 16 numbers. `round` changes which offsets go with which quarter of the shutter interval, so
/// that heroes go with all quarters equally.
inline Wavelengths wavelengths_in_order(std::uint64_t seed, ColorMode mode, std::uint32_t number, bool disperses) {
  const float shift = unit_float(hash_words({seed, static_cast<std::uint64_t>(Stream::pass), 1}));
  const auto shifted = [shift](float u) { return u + shift < 1 ? u + shift : u + shift - 1; };
  if (mode == ColorMode::rgb || !disperses) {
    Sampler sampler = Sampler::for_pass(seed, number);
    sampler.seek(1);
    return wavelengths_of(mode, shifted(unit_float(second_sobol_coordinate(number))), sampler.next());
  }
  constexpr std::uint32_t offsets = 8, heroes = 4;
  const std::uint32_t block = number / (offsets * heroes), round = number / offsets % heroes;
  const std::uint32_t offset = (number % offsets) ^ round;
  const std::uint32_t hero = (offset % 2 * 2 + offset / 4) ^ round;
  const float place = unit_float(second_sobol_coordinate(block * offsets + offset));
  return Wavelengths::spectral(shifted((static_cast<float>(hero) + place) / heroes));
}

/// The wavelengths of a pass or a part of it, in the order of its half of the film.
inline Wavelengths wavelengths_of_pass(std::uint64_t seed, ColorMode mode, const PlaceInHalf& place, bool disperses) {
  const std::uint64_t own = place.half == FilmHalf::first ? seed : hash_words({seed, 1});
  return wavelengths_in_order(own, mode, place.number, disperses);
}

/// The hero of a pixel's eye paths, as an index: the four pixels of a square of two by two have all four, in an order
/// that differs from square to square. `x`, `y`: in the full film.
inline unsigned hero_of_pixel(int x, int y) {
  const auto square = [](int i) { return static_cast<std::uint64_t>(static_cast<unsigned>(i) / 2); };
  const auto place = static_cast<unsigned>(x % 2 + 2 * (y % 2));
  return place ^ static_cast<unsigned>(hash_words({square(x), square(y)}) % 4);
}

/// Values that the paths of a pass share in methods that cache light paths: their wavelengths, and a part of the
/// shutter interval. Every path has its own time in that part, and in spectral mode its own hero among the wavelengths
/// if something disperses: dispersed light would otherwise tint a whole pass with a single wavelength. A photon is seen
/// by eye paths of other times, but of the same part. Over 16 passes the parts cover the interval once, over the next
/// 64 once more in quarters of these, and so on: the time between photon and eye tends to 0, and any number of passes
/// is spread over the whole interval.
struct PassDraw {
  float begin = 0, length = 0;  ///< times, s; length 0 also if nothing depends on the time
  Wavelengths w;  ///< with the hero of pixels whose `hero_of_pixel` is 0, and of all paths if they share it
  bool heroes_differ = false;

  /// True if all paths have the same time.
  bool is_of_one_time() const { return length == 0; }
  /// Draws the time from the sampler's first number of group 1, and the hero from the second.
  PathDraw of_path(Sampler& sampler) const {
    if (!heroes_differ) return {time_of_path(sampler), w};
    sampler.seek(1);
    const float time = begin + length * sampler.next();
    return {time, w.with_hero(static_cast<unsigned>(4 * sampler.next()))};
  }
  /// The same for the eye path of a pixel, whose hero does not depend on the sampler. Over the passes, the hero of a
  /// pixel follows `wavelengths_in_order`, shifted by a number of its own.
  PathDraw of_eye_path(Sampler& sampler, int x, int y) const {
    return {time_of_path(sampler), heroes_differ ? w.with_hero(hero_of_pixel(x, y)) : w};
  }

 private:
  float time_of_path(Sampler& sampler) const {
    if (is_of_one_time()) return begin;
    sampler.seek(1);
    return begin + length * sampler.next();
  }
};

/// The part of the shutter interval of a pass, in [0,1): its begin and length.
struct ShutterPart {
  float begin = 0, length = 1;
};
inline ShutterPart shutter_part(std::uint64_t seed, std::uint32_t pass) {
  int bits = 4;
  std::uint64_t number = pass;
  for (; number >= std::uint64_t{1} << bits; bits += 2) number -= std::uint64_t{1} << bits;
  // Bit reversal spreads the first few of the parts over the interval, in an order that depends on the seed.
  const std::uint64_t scramble = hash_words({seed, static_cast<std::uint64_t>(bits)});
  std::uint64_t part = 0;
  for (int bit = 0; bit < bits; ++bit) part |= (number >> bit & 1) << (bits - 1 - bit);
  part ^= scramble & ((std::uint64_t{1} << bits) - 1);
  const float length = std::ldexp(1.0f, -bits);
  return {static_cast<float>(part) * length, length};
}

inline PassDraw draw_for_pass(const RenderJob& job, std::uint32_t pass) {
  const ShutterPart part = shutter_part(job.settings.seed, pass);
  const float open = job.view.camera.time(part.begin);
  return {open, depends_on_time(job) ? job.view.camera.time(part.begin + part.length) - open : 0.0f,
          wavelengths_of_pass(job.settings.seed, job.settings.color, place_in_half(pass, job.settings.parts),
                              job.scene.has_dispersion()),
          job.settings.color == ColorMode::spectral && job.scene.has_dispersion()};
}

}  // namespace lanthorn
