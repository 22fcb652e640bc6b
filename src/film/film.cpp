// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "film/film.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <type_traits>

#include "base/parallel.h"
#include "film/fixed_point.h"

namespace lanthorn {
namespace {

constexpr int largest_radiance_bits = 40;
constexpr double number_steps = 0x1p28;  // also for positions: coarser but larger range, from millimetres to kilometres

// Slot of the hit count, counted from the end of the light's sums among a pixel's sample sums.
constexpr std::size_t hit_slot = feature_channels;
template <class Value>
constexpr double steps_of = is_number<Value> || std::is_same_v<Value, Position> ? number_steps : unit_steps;
constexpr std::size_t chunk_pixels = 4096, chunk_sums = std::size_t{1} << 16;

std::uint64_t count_saturated(std::span<const std::int64_t> sums) {
  std::atomic<std::uint64_t> count = 0;
  parallel_chunks(sums.size(), chunk_sums, [&](std::size_t, std::size_t begin, std::size_t end) {
    const auto part = sums.subspan(begin, end - begin);
    count += static_cast<std::uint64_t>(
        std::count_if(part.begin(), part.end(), [](std::int64_t sum) { return std::abs(sum) >= sum_limit; }));
  });
  return count;
}

// Channel names of Fichet, Pacanowski & Wilkie 2021, "An OpenEXR Layout for Spectral Images", §3: S0 is unpolarised
// emission; a comma replaces the decimal point, which separates layers in OpenEXR.
std::string spectral_channel(double nm) {
  constexpr int parts = 10000;  // of a nanometre
  const long rounded = std::lround(nm * parts);
  std::string fraction = std::to_string(rounded % parts);
  fraction.insert(0, 4 - fraction.size(), '0');
  while (fraction.size() > 1 && fraction.back() == '0') fraction.pop_back();
  return "S0." + std::to_string(rounded / parts) + "," + fraction + "nm";
}

void add_color(std::vector<std::string>& channels, const std::string& layer) {
  for (const char* component : {".R", ".G", ".B"}) channels.push_back(layer + component);
}

// Channels of the light layers, features and samples.
std::vector<std::string> surface_channels(const FilmContents& contents) {
  std::vector<std::string> names;
  for (const std::string& layer : contents.light) add_color(names, layer);
  for (const std::string& layer : contents.repeated) add_color(names, layer);
  Features{}.for_each([&](const std::string& layer, const auto& value) {
    for (const char channel : channels_of(value)) names.push_back(layer + "." + channel);
  });
  names.emplace_back("samples");
  return names;
}

std::vector<std::string> resolved_channels(const FilmContents& contents) {
  std::vector<std::string> names{"R", "G", "B"};
  for (std::string& name : surface_channels(contents)) names.push_back(std::move(name));
  const Decomposition& d = contents.decomposition;
  for (const std::string& part : d.parts) add_color(names, part);
  if (!d.splats.empty()) add_color(names, d.splats);
  if (d.shares) add_color(names, d.shares->name);
  for (std::size_t b = 0; b < (contents.buckets ? contents.buckets->count : 0); ++b)
    names.push_back(spectral_channel(contents.buckets->centre(b)));
  return names;
}

}  // namespace

Film::Film(int width, int height, float largest_radiance, const FilmContents& contents) {
  int exponent = 0;
  if (std::isfinite(largest_radiance) && largest_radiance > 0) {
    const float mantissa = std::frexp(largest_radiance, &exponent);
    if (mantissa == 0.5f) --exponent;
  }
  *this = with_exponent(width, height, exponent - largest_radiance_bits, contents);
}

std::size_t Film::stride(const FilmContents& contents) {
  const std::size_t count = contents.buckets ? contents.buckets->count : 0;
  const std::size_t light = 3 * contents.layer_count();
  const std::size_t samples = light + (contents.bias ? 3 : 0) + surface_slots, splats = contents.splats ? light : 0;
  const std::size_t of_samples = 2 * samples + 3 * contents.decomposition.parts.size() + 2 * count;
  return (contents.negative_share == 0 ? 1 : filter_parts) * of_samples + 2 * splats + (contents.splats ? count : 0);
}

Film Film::with_exponent(int width, int height, int step_exponent, const FilmContents& contents) {
  assert(width > 0 && height > 0);
  assert(!contents.light.empty() && contents.layer_count() <= most_light_layers);
  assert(contents.decomposition.parts.size() <= most_light_layers);
  Film film;
  film.width_ = width;
  film.height_ = height;
  film.step_exponent_ = step_exponent;
  film.contents_ = contents;
  film.radiance_steps_ = std::ldexp(1.0, -step_exponent);
  film.sample_steps_.fill(unit_steps);
  std::fill_n(film.sample_steps_.begin(), film.light_slots(), film.radiance_steps_);
  double* steps = &film.sample_steps_[film.light_slots()];
  Features{}.for_each([&]<class Value>(const char*, const Value& value) {
    steps = std::fill_n(steps, channels_of(value).size(), steps_of<Value>);
  });
  for_each_sum(film, [&](Sums& sums, std::size_t stride) { sums.resize(stride * film.pixel_count()); });
  return film;
}

std::uint32_t Film::pixel_of_full_film(std::uint32_t pixel) const {
  if (full_width_ == 0) return pixel;
  const auto width = static_cast<std::uint32_t>(width_);
  const auto x = static_cast<std::uint32_t>(window_.x0) + pixel % width;
  const auto y = static_cast<std::uint32_t>(window_.y0) + pixel / width;
  return y * static_cast<std::uint32_t>(full_width_) + x;
}

void Film::write_spectrum(std::uint32_t pixel, std::uint64_t passes, float* out) const {
  const double step = std::ldexp(1.0, step_exponent_);
  const std::size_t count = contents_.buckets->count;
  for (std::size_t b = 0; b < count; ++b) {
    std::array<std::int64_t, filter_parts> light{}, weights{};
    for (std::size_t part = 0; part < filter_parts && !spectra_[part].empty(); ++part) {
      const std::int64_t* sums = &spectra_[part][std::size_t{pixel} * spectra_stride()];
      light[part] = sums[b];
      weights[part] = sums[count + b];
    }
    const PartFactors factors = factors_of(weights);
    double mean = 0;
    for (std::size_t part = 0; part < filter_parts; ++part)
      mean += static_cast<double>(light[part]) * (factors[part] * step * unit_steps);
    if (contents_.splats && passes > 0)
      mean +=
          static_cast<double>(spectral_splats_[std::size_t{pixel} * count + b]) * step / static_cast<double>(passes);
    out[b] = static_cast<float>(mean);
  }
}

Film::PixelSums Film::sums_of_half(FilmHalf half, std::uint32_t pixel) const {
  const Half& own = halves_[static_cast<std::size_t>(half)];
  PixelSums sums{};
  for (std::size_t part = 0; part < filter_parts && !own.samples[part].empty(); ++part)
    std::copy_n(&own.samples[part][std::size_t{pixel} * samples_stride()], samples_stride(),
                sums.samples[part].begin());
  if (contents_.splats)
    std::copy_n(&own.splats[std::size_t{pixel} * splats_stride()], splats_stride(), sums.splats.begin());
  return sums;
}

Film::PixelSums Film::sums_of(std::uint32_t pixel) const {
  PixelSums sums = sums_of_half(FilmHalf::first, pixel);
  const PixelSums second = sums_of_half(FilmHalf::second, pixel);
  for (std::size_t part = 0; part < filter_parts; ++part)
    for (std::size_t i = 0; i < samples_stride(); ++i) saturating_add(sums.samples[part][i], second.samples[part][i]);
  for (std::size_t i = 0; i < splats_stride(); ++i) saturating_add(sums.splats[i], second.splats[i]);
  return sums;
}

Film::PartFactors Film::factors_of(const std::array<std::int64_t, filter_parts>& counts) const {
  const auto share = static_cast<double>(contents_.negative_share);
  const auto& [plus, minus] = counts;
  const auto over = [](double weight, std::int64_t count) {
    return count != 0 ? weight / static_cast<double>(count) : 0;
  };
  const bool has_both = plus != 0 && minus != 0;
  return has_both ? PartFactors{over(1 + share, plus), over(-share, minus)}
                  : PartFactors{over(1, plus), over(1, minus)};
}

Film::PartFactors Film::factors_of(const PixelSums& sums) const {
  return factors_of(std::array{sums.samples[0][count_slot()], sums.samples[1][count_slot()]});
}

Film::LightMeans Film::light_means(const PixelSums& sums, std::uint64_t passes) const {
  LightMeans means{};
  const double step = std::ldexp(1.0, step_exponent_);
  const std::size_t values = splats_stride();
  const PartFactors factors = factors_of(sums);
  for (std::size_t part = 0; part < filter_parts; ++part) {
    const double scale = factors[part] * step * unit_steps;
    for (std::size_t i = 0; i < values && scale != 0; ++i)
      means[i] += static_cast<double>(sums.samples[part][i]) * scale;
  }
  if (contents_.splats && passes > 0) {
    const double scale = step / static_cast<double>(passes);
    for (std::size_t i = 0; i < values; ++i) means[i] += static_cast<double>(sums.splats[i]) * scale;
  }
  return means;
}

namespace {

/// Multiplies the colour of each light layer.
void scale_colours(const Rgb& balance, std::span<double> light) {
  const std::array<double, 3> factors{static_cast<double>(balance.r), static_cast<double>(balance.g),
                                      static_cast<double>(balance.b)};
  for (std::size_t i = 0; i < light.size(); ++i) light[i] *= factors[i % 3];
}

/// Sums the light layers by component.
void write_color(std::span<const double> light, float* out) {
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = light[c];
    for (std::size_t i = 3 + c; i < light.size(); i += 3) sum += light[i];
    out[c] = static_cast<float>(sum);
  }
}

float* write(const Rgb& light, float* out) {
  for (const float component : {light.r, light.g, light.b}) *out++ = component;
  return out;
}

}  // namespace

Film::PartMeans Film::part_means(std::uint32_t pixel, const PartFactors& factors) const {
  PartMeans light{};
  const double step = std::ldexp(1.0, step_exponent_);
  const auto mean = [&](std::size_t slot) {
    double sum = 0;
    for (std::size_t part = 0; part < filter_parts && !parts_[part].empty(); ++part)
      sum += static_cast<double>(parts_[part][std::size_t{pixel} * parts_stride() + slot]) *
             (factors[part] * step * unit_steps);
    return static_cast<float>(sum);
  };
  for (std::size_t p = 0; p < contents_.decomposition.parts.size(); ++p)
    light[p] = {mean(3 * p), mean(3 * p + 1), mean(3 * p + 2)};
  return light;
}

// Mean splatted light, summed over the light layers.
Rgb Film::splat_mean(const SplatSums& splats, std::uint64_t passes) const {
  const double step = std::ldexp(1.0, step_exponent_);
  Rgb sum;
  for (std::size_t layer = 0; layer < contents_.light.size() && contents_.splats && passes > 0; ++layer) {
    const auto mean = [&](std::size_t component) {
      return static_cast<float>(static_cast<double>(splats[3 * layer + component]) * step /
                                static_cast<double>(passes));
    };
    sum += {mean(0), mean(1), mean(2)};
  }
  return sum;
}

float* Film::write_decomposition(std::uint32_t pixel, std::uint64_t passes, const PixelSums& sums, const Rgb& balance,
                                 float* out) const {
  const Decomposition& d = contents_.decomposition;
  PartMeans light = part_means(pixel, factors_of(sums));
  for (Rgb& part : light) part = balance * part;
  for (std::size_t p = 0; p < d.parts.size(); ++p) out = write(light[p], out);
  const Rgb splats = balance * splat_mean(sums.splats, passes);
  if (!d.splats.empty()) out = write(splats, out);
  if (!d.shares) return out;
  std::array<float, 3> shares{};
  float all = 0;
  for (std::size_t g = 0; g < shares.size(); ++g)
    for (const std::size_t p : d.shares->groups[g])
      shares[g] += std::max(0.0f, luminance(p < d.parts.size() ? light[p] : splats));
  for (const float share : shares) all += share;
  for (const float share : shares) *out++ = all > 0 ? share / all : 0.0f;
  return out;
}

float* Film::write_light(const LightMeans& means, float* out) const {
  return std::transform(means.begin(), means.begin() + static_cast<std::ptrdiff_t>(splats_stride()), out,
                        [](double x) { return static_cast<float>(x); });
}

float* Film::write_features(const PixelSums& sums, float* out) const {
  const auto both = [&](std::size_t slot) {
    return static_cast<double>(sums.samples[0][slot]) + static_cast<double>(sums.samples[1][slot]);
  };
  std::size_t slot = light_slots();
  const PartFactors factors = factors_of(sums);
  const double hits = both(slot + hit_slot);
  Features{}.for_each([&]<class Value>(const char*, const Value& value) {
    for (std::size_t c = 0; c < channels_of(value).size(); ++c, ++slot) {
      double mean = 0;
      if constexpr (is_number<Value>)  // a mean over hits, in which parts of both signs could cancel
        mean = hits != 0 ? both(slot) / hits : 0;
      else
        mean = factors[0] * static_cast<double>(sums.samples[0][slot]) +
               factors[1] * static_cast<double>(sums.samples[1][slot]);
      *out++ = static_cast<float>(mean * (unit_steps / steps_of<Value>));
    }
  });
  *out++ = static_cast<float>(both(count_slot()) / unit_steps);
  return out;
}

template <class Body>
void Film::for_each_pixel(Body&& body) const {
  parallel_chunks(pixel_count(), chunk_pixels, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) body(static_cast<std::uint32_t>(pixel));
  });
}

Image Film::resolve(std::uint64_t passes, const Rgb& balance) const {
  Image image(width_, height_, resolved_channels(contents_));
  const std::size_t stride = image.channel_count();
  for_each_pixel([&](std::uint32_t pixel) {
    float* out = &image.pixels[pixel * stride];
    const PixelSums sums = sums_of(pixel);
    LightMeans means = light_means(sums, passes);
    scale_colours(balance, means);
    write_color(std::span(means).first(3 * contents_.light.size()), out);
    out = write_features(sums, write_light(means, out + 3));
    if (parts_stride() > 0) out = write_decomposition(pixel, passes, sums, balance, out);
    if (contents_.buckets) write_spectrum(pixel, passes, out);
  });
  return image;
}

Image Film::resolve_color(std::uint64_t passes, const Rgb& balance) const {
  Image image(width_, height_, {"R", "G", "B"});
  for_each_pixel([&](std::uint32_t pixel) {
    LightMeans light = light_means(sums_of(pixel), passes);
    scale_colours(balance, light);
    write_color(std::span(light).first(3 * contents_.light.size()), &image.pixels[std::size_t{pixel} * 3]);
  });
  return image;
}

Image Film::resolve_first_half(std::uint64_t passes, const Rgb& balance) const {
  Image image(width_, height_, surface_channels(contents_));
  const std::size_t stride = image.channel_count();
  for_each_pixel([&](std::uint32_t pixel) {
    const PixelSums sums = sums_of_half(FilmHalf::first, pixel);
    LightMeans means = light_means(sums, passes);
    scale_colours(balance, means);
    write_features(sums, write_light(means, &image.pixels[pixel * stride]));
  });
  return image;
}

HalfPicture Film::resolve_half(FilmHalf half, std::uint64_t passes, const Rgb& balance) const {
  const Image black(width_, height_, {"R", "G", "B"});
  HalfPicture picture{black, contents_.bias ? black : Image()};
  const std::array<float, 3> factors{balance.r, balance.g, balance.b};
  const double step = std::ldexp(1.0, step_exponent_), per_pass = passes > 0 ? step / static_cast<double>(passes) : 0.0;
  for_each_pixel([&](std::uint32_t pixel) {
    const PixelSums sums = sums_of_half(half, pixel);
    PartFactors per_sample = factors_of(sums);
    for (double& factor : per_sample) factor *= step * unit_steps;
    for (std::size_t c = 0; c < 3; ++c) {
      double light = 0, splatted = 0, bias = 0;
      for (std::size_t part = 0; part < filter_parts; ++part) {
        double sum = 0;
        for (std::size_t layer = 0; layer < contents_.light.size(); ++layer)
          sum += static_cast<double>(sums.samples[part][3 * layer + c]);
        light += sum * per_sample[part];
        if (contents_.bias) bias += static_cast<double>(sums.samples[part][splats_stride() + c]) * per_sample[part];
      }
      for (std::size_t layer = 0; layer < contents_.light.size(); ++layer)
        splatted += static_cast<double>(sums.splats[3 * layer + c]);
      const std::size_t place = std::size_t{pixel} * 3 + c;
      picture.color.pixels[place] = factors[c] * static_cast<float>(light + splatted * per_pass);
      if (contents_.bias) picture.bias.pixels[place] = factors[c] * static_cast<float>(bias);
    }
  });
  return picture;
}

FilmReport Film::report() const {
  const auto place = [](const Problem& problem) -> std::optional<FilmPlace> {
    if (problem.count == 0) return std::nullopt;
    return FilmPlace{problem.first >> 32, static_cast<std::uint32_t>(problem.first)};
  };
  std::uint64_t saturated = 0;
  for_each_sum(*this, [&](const Sums& sums, std::size_t) { saturated += count_saturated(sums); });
  return {.non_finite = non_finite_.count,
          .too_large = too_large_.count,
          .saturated = saturated,
          .first_non_finite = place(non_finite_),
          .first_too_large = place(too_large_)};
}

void Film::add_problem(Problem& sum, const Problem& more) {
  sum.count += more.count;
  sum.first = std::min(sum.first, more.first);
}

void Film::add_report(const FilmReport& report) {
  const auto problem = [](std::uint64_t count, const std::optional<FilmPlace>& first) {
    Problem p{.count = count};
    if (first) p.first = std::min<std::uint64_t>(first->pass, 0xffffffffu) << 32 | first->pixel;
    return p;
  };
  add_problem(non_finite_, problem(report.non_finite, report.first_non_finite));
  add_problem(too_large_, problem(report.too_large, report.first_too_large));
}

bool Film::compatible(const Film& other) const {
  return width_ == other.width_ && height_ == other.height_ && step_exponent_ == other.step_exponent_ &&
         contents_ == other.contents_;
}

void Film::merge(const Film& other) {
  assert(compatible(other));
  std::vector<const Sums*> others;
  for_each_sum(other, [&](const Sums& sums, std::size_t) { others.push_back(&sums); });
  std::size_t number = 0;
  for_each_sum(*this, [&](Sums& sums, std::size_t) {
    const Sums& more = *others[number++];
    parallel_chunks(sums.size(), chunk_sums, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) saturating_add(sums[i], more[i]);
    });
  });
  for (const auto problem : {&Film::non_finite_, &Film::too_large_}) add_problem(this->*problem, other.*problem);
}

std::size_t Film::plane_count() const { return stride(contents_); }

// The sums of the film itself, or of a const film, which the caller does not modify.
template <class Array, class Self>
Film::PlanePlace<Array> Film::find_plane(Self& film, std::size_t index) {
  assert(index < film.plane_count());
  PlanePlace<Array> place;
  std::size_t before = 0;
  for_each_sum(film, [&](Array& sums, std::size_t stride) {
    if (index >= before && index - before < stride) place = {&sums, stride, index - before};
    before += stride;
  });
  return place;
}

std::vector<std::int64_t> Film::plane(std::size_t index) const {
  std::vector<std::int64_t> values(pixel_count());
  copy_sums(index, 0, values);
  return values;
}

void Film::copy_sums(std::size_t plane, std::size_t first, std::span<std::int64_t> out) const {
  assert(first + out.size() <= pixel_count());
  const auto [sums, stride, slot] = find_plane<const Sums>(*this, plane);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = (*sums)[(first + i) * stride + slot];
}

void Film::add_sums(std::size_t plane, std::size_t first, std::span<const std::int64_t> values) {
  assert(first + values.size() <= pixel_count());
  const auto [sums, stride, slot] = find_plane<Sums>(*this, plane);
  for (std::size_t i = 0; i < values.size(); ++i)
    saturating_add((*sums)[(first + i) * stride + slot], std::clamp(values[i], -sum_limit, sum_limit));
}

}  // namespace lanthorn
