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
  return 2 * (samples + splats) + 3 * contents.decomposition.parts.size() + (contents.splats ? 3 : 2) * count;
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
  const std::size_t buckets = contents.buckets ? contents.buckets->count : 0;
  for (Half& half : film.halves_) {
    half.samples.resize(film.samples_stride() * film.pixel_count());
    if (contents.splats) half.splats.resize(film.splats_stride() * film.pixel_count());
  }
  film.spectra_.resize(2 * buckets * film.pixel_count());
  film.parts_.resize(film.parts_stride() * film.pixel_count());
  if (contents.splats) film.spectral_splats_.resize(buckets * film.pixel_count());
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
  const std::int64_t* sums = &spectra_[std::size_t{pixel} * 2 * count];
  for (std::size_t b = 0; b < count; ++b) {
    const auto weight = static_cast<double>(sums[count + b]);
    double mean = weight != 0 ? static_cast<double>(sums[b]) * step * unit_steps / weight : 0.0;
    if (contents_.splats && passes > 0)
      mean +=
          static_cast<double>(spectral_splats_[std::size_t{pixel} * count + b]) * step / static_cast<double>(passes);
    out[b] = static_cast<float>(mean);
  }
}

Film::PixelSums Film::sums_of_half(FilmHalf half, std::uint32_t pixel) const {
  const Half& own = halves_[static_cast<std::size_t>(half)];
  PixelSums sums{};
  std::copy_n(&own.samples[std::size_t{pixel} * samples_stride()], samples_stride(), sums.samples.begin());
  if (contents_.splats)
    std::copy_n(&own.splats[std::size_t{pixel} * splats_stride()], splats_stride(), sums.splats.begin());
  return sums;
}

Film::PixelSums Film::sums_of(std::uint32_t pixel) const {
  PixelSums sums = sums_of_half(FilmHalf::first, pixel);
  const PixelSums second = sums_of_half(FilmHalf::second, pixel);
  for (std::size_t i = 0; i < samples_stride(); ++i) saturating_add(sums.samples[i], second.samples[i]);
  for (std::size_t i = 0; i < splats_stride(); ++i) saturating_add(sums.splats[i], second.splats[i]);
  return sums;
}

Film::LightMeans Film::light_means(const PixelSums& sums, std::uint64_t passes) const {
  LightMeans means{};
  const double step = std::ldexp(1.0, step_exponent_);
  const std::size_t values = splats_stride();
  if (sums.samples[weight_slot()] != 0) {
    const double scale = step * unit_steps / static_cast<double>(sums.samples[weight_slot()]);
    for (std::size_t i = 0; i < values; ++i) means[i] = static_cast<double>(sums.samples[i]) * scale;
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

Film::PartMeans Film::part_means(std::uint32_t pixel, double weight) const {
  PartMeans light{};
  if (weight == 0) return light;
  const double step = std::ldexp(1.0, step_exponent_);
  const std::int64_t* sums = &parts_[std::size_t{pixel} * parts_stride()];
  const auto mean = [&](std::int64_t sum) {
    return static_cast<float>(static_cast<double>(sum) * step / (weight / unit_steps));
  };
  for (std::size_t p = 0; p < contents_.decomposition.parts.size(); ++p, sums += 3)
    light[p] = {mean(sums[0]), mean(sums[1]), mean(sums[2])};
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
  PartMeans light = part_means(pixel, static_cast<double>(sums.samples[weight_slot()]));
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

float* Film::write_features(const SampleSums& samples, float* out) const {
  const std::int64_t* sums = &samples[light_slots()];
  const auto weight = static_cast<double>(samples[weight_slot()]) / unit_steps,
             hits = static_cast<double>(sums[hit_slot]) / unit_steps;
  Features{}.for_each([&]<class Value>(const char*, const Value& value) {
    const double count = is_number<Value> ? hits : weight;
    for (std::size_t c = 0; c < channels_of(value).size(); ++c, ++sums)
      *out++ = count != 0 ? static_cast<float>(static_cast<double>(*sums) / steps_of<Value> / count) : 0.0f;
  });
  *out++ = static_cast<float>(weight);
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
    out = write_features(sums.samples, write_light(means, out + 3));
    if (!parts_.empty()) out = write_decomposition(pixel, passes, sums, balance, out);
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
    write_features(sums.samples, write_light(means, &image.pixels[pixel * stride]));
  });
  return image;
}

HalfPicture Film::resolve_half(FilmHalf half, std::uint64_t passes, const Rgb& balance) const {
  const Half& own = halves_[static_cast<std::size_t>(half)];
  const Image black(width_, height_, {"R", "G", "B"});
  HalfPicture picture{black, contents_.bias ? black : Image()};
  const std::array<float, 3> factors{balance.r, balance.g, balance.b};
  const double step = std::ldexp(1.0, step_exponent_), per_pass = passes > 0 ? step / static_cast<double>(passes) : 0.0;
  for_each_pixel([&](std::uint32_t pixel) {
    const std::int64_t* sums = &own.samples[std::size_t{pixel} * samples_stride()];
    const double per_sample =
        sums[weight_slot()] != 0 ? step * unit_steps / static_cast<double>(sums[weight_slot()]) : 0;
    for (std::size_t c = 0; c < 3; ++c) {
      double light = 0, splatted = 0;
      for (std::size_t layer = 0; layer < contents_.light.size(); ++layer) {
        light += static_cast<double>(sums[3 * layer + c]);
        if (contents_.splats)
          splatted += static_cast<double>(own.splats[std::size_t{pixel} * splats_stride() + 3 * layer + c]);
      }
      const std::size_t place = std::size_t{pixel} * 3 + c;
      picture.color.pixels[place] = factors[c] * static_cast<float>(light * per_sample + splatted * per_pass);
      if (contents_.bias)
        picture.bias.pixels[place] =
            factors[c] * static_cast<float>(static_cast<double>(sums[splats_stride() + c]) * per_sample);
    }
  });
  return picture;
}

FilmReport Film::report() const {
  const auto place = [](const Problem& problem) -> std::optional<FilmPlace> {
    if (problem.count == 0) return std::nullopt;
    return FilmPlace{problem.first >> 32, static_cast<std::uint32_t>(problem.first)};
  };
  std::uint64_t saturated = count_saturated(parts_) + count_saturated(spectra_) + count_saturated(spectral_splats_);
  for (const Half& half : halves_) saturated += count_saturated(half.samples) + count_saturated(half.splats);
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
  const auto add = [](std::vector<std::int64_t>& sums, const std::vector<std::int64_t>& others) {
    parallel_chunks(sums.size(), chunk_sums, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) saturating_add(sums[i], others[i]);
    });
  };
  for (std::size_t h = 0; h < halves_.size(); ++h) {
    add(halves_[h].samples, other.halves_[h].samples);
    add(halves_[h].splats, other.halves_[h].splats);
  }
  for (const auto sums : {&Film::parts_, &Film::spectra_, &Film::spectral_splats_}) add(this->*sums, other.*sums);
  for (const auto problem : {&Film::non_finite_, &Film::too_large_}) add_problem(this->*problem, other.*problem);
}

std::size_t Film::plane_count() const { return stride(contents_); }

// The sums of the film itself, or of a const film, which the caller does not modify.
template <class Sums, class Self>
Film::PlanePlace<Sums> Film::find_plane(Self& film, std::size_t index) {
  assert(index < film.plane_count());
  const std::size_t count = film.contents_.buckets ? film.contents_.buckets->count : 0;
  const std::size_t splats = film.contents_.splats ? film.splats_stride() : 0;
  for (auto& half : film.halves_)
    for (const auto& [sums, stride] :
         {std::pair{&half.samples, film.samples_stride()}, std::pair{&half.splats, splats}}) {
      if (index < stride) return {sums, stride, index};
      index -= stride;
    }
  if (index < film.parts_stride()) return {&film.parts_, film.parts_stride(), index};
  index -= film.parts_stride();
  if (index < 2 * count) return {&film.spectra_, 2 * count, index};
  return {&film.spectral_splats_, count, index - 2 * count};
}

std::vector<std::int64_t> Film::plane(std::size_t index) const {
  std::vector<std::int64_t> values(pixel_count());
  copy_sums(index, 0, values);
  return values;
}

void Film::copy_sums(std::size_t plane, std::size_t first, std::span<std::int64_t> out) const {
  assert(first + out.size() <= pixel_count());
  const auto [sums, stride, slot] = find_plane<const std::vector<std::int64_t>>(*this, plane);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = (*sums)[(first + i) * stride + slot];
}

void Film::add_sums(std::size_t plane, std::size_t first, std::span<const std::int64_t> values) {
  assert(first + values.size() <= pixel_count());
  const auto [sums, stride, slot] = find_plane<std::vector<std::int64_t>>(*this, plane);
  for (std::size_t i = 0; i < values.size(); ++i)
    saturating_add((*sums)[(first + i) * stride + slot], std::clamp(values[i], -sum_limit, sum_limit));
}

}  // namespace lanthorn
