// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "ibl/environment.h"

#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <utility>

#include "base/parallel.h"
#include "lanthorn/error.h"
#include "math/octahedral.h"

namespace lanthorn {

const char* layout_name(EnvironmentLayout layout) {
  switch (layout) {
    case EnvironmentLayout::equirectangular:
      return "equirectangular";
    case EnvironmentLayout::octahedral:
      return "octahedral";
    case EnvironmentLayout::cube:
      return "cube";
  }
  return "";
}

std::optional<EnvironmentLayout> layout_of(const Image& image) {
  if (image.width < 1) return std::nullopt;
  if (image.width == 2 * image.height) return EnvironmentLayout::equirectangular;
  if (image.width == image.height) return EnvironmentLayout::octahedral;
  if (image.width == cube_faces * image.height) return EnvironmentLayout::cube;
  return std::nullopt;
}

namespace {

// Light belongs to a sun if it is this many times brighter than the mean of the rest.
constexpr float sun_contrast = 20;
// Limits the number of sun points, at a spacing of `finest_sun_spacing`.
constexpr std::uint64_t most_sun_points = 1024;
constexpr float finest_sun_spacing = 0.006f;

bool is_usable(float x) { return x >= 0 && x <= largest_environment_radiance; }
float usable(float x) { return is_usable(x) ? x : 0.0f; }
float luminance_of(const Spectrum& s) { return luminance(Rgb{s[0], s[1], s[2]}); }

// Histogram bins of floats by exponent and the first three bits of the mantissa: an eighth of an octave each.
struct LuminanceHistogram {
  static constexpr int shift = 20;
  struct Bin {
    std::uint64_t texels = 0;
    double solid_angle = 0, flux = 0;
  };
  std::vector<Bin> bins = std::vector<Bin>(std::size_t{1} << (31 - shift));
  std::uint64_t unusable = 0;

  static std::size_t bin_of(float x) { return std::bit_cast<std::uint32_t>(x) >> shift; }
  static float start_of(std::size_t bin) { return std::bit_cast<float>(static_cast<std::uint32_t>(bin << shift)); }

  void add(float value, double omega) {
    Bin& bin = bins[bin_of(value)];
    ++bin.texels;
    bin.solid_angle += omega;
    bin.flux += omega * static_cast<double>(value);
  }
  void add(const LuminanceHistogram& other) {
    for (std::size_t i = 0; i < bins.size(); ++i) {
      bins[i].texels += other.bins[i].texels;
      bins[i].solid_angle += other.bins[i].solid_angle;
      bins[i].flux += other.bins[i].flux;
    }
    unusable += other.unusable;
  }
  /// Mean over the sphere of values clamped to `limit`.
  double mean_below(float limit) const {
    double flux = 0, omega = 0;
    for (const Bin& bin : bins) {
      flux += std::min(bin.flux, static_cast<double>(limit) * bin.solid_angle);
      omega += bin.solid_angle;
    }
    return flux / omega;
  }
};

// The fixed point of threshold = sun_contrast * mean_below(threshold).
float contrast_threshold(const LuminanceHistogram& histogram) {
  constexpr int most_iterations = 50;
  float threshold = std::numeric_limits<float>::max();
  for (int i = 0; i < most_iterations; ++i) {
    const auto next = static_cast<float>(
        std::min(static_cast<double>(threshold), static_cast<double>(sun_contrast) * histogram.mean_below(threshold)));
    if (next > 0.999f * threshold) break;
    threshold = next;
  }
  return threshold;
}

float raised_to_fit(const LuminanceHistogram& histogram, float threshold, std::uint64_t most_texels) {
  std::uint64_t above = 0;
  const std::size_t lowest = LuminanceHistogram::bin_of(threshold);
  for (std::size_t bin = histogram.bins.size(); bin-- > lowest;) {
    above += histogram.bins[bin].texels;
    if (above > most_texels) return LuminanceHistogram::start_of(bin + 1);
  }
  return threshold;
}

}  // namespace

Environment::Environment(const Image& image) : image_(image) {
  const std::optional<EnvironmentLayout> layout = layout_of(image);
  const auto r = image.find_channel("R"), g = image.find_channel("G"), b = image.find_channel("B"),
             y = image.find_channel("Y");
  if (!layout || !(y || (r && g && b)))
    throw Error("is no environment: it needs channels R, G, B and a shape of 2:1, 1:1 or 6:1");
  layout_ = *layout;
  red_ = y ? *y : *r;
  green_ = y ? *y : *g;
  blue_ = y ? *y : *b;
  if (layout_ == EnvironmentLayout::equirectangular) {
    const auto angles = [](int count, float first, float step) {
      std::vector<Angle> result;
      for (int i = 0; i < count; ++i) {
        const float angle = first + step * (static_cast<float>(i) + 0.5f);
        result.push_back({std::cos(angle), std::sin(angle)});
      }
      return result;
    };
    azimuths_ = angles(width(), -pi, 2 * pi / static_cast<float>(width()));
    polar_angles_ = angles(height(), 0, pi / static_cast<float>(height()));
    solid_angle_by_sine_ = 4 * pi / static_cast<float>(width()) * std::sin(0.5f * pi / static_cast<float>(height()));
  }
  find_suns();
}

float Environment::texels_per_face() const {
  if (layout_ == EnvironmentLayout::equirectangular) return static_cast<float>(width()) / 4;
  // The octahedral square represents the whole sphere, a cube face a sixth of it.
  if (layout_ == EnvironmentLayout::octahedral) return static_cast<float>(width()) / std::sqrt(6.0f);
  return static_cast<float>(height());
}

int Environment::pieces_for_smooth_kernels() const {
  constexpr float texels_needed = 256;
  return std::max(1, static_cast<int>(std::ceil(texels_needed / texels_per_face())));
}

Direction Environment::direction_at(float x, float y) const {
  const Vec2 at(x / static_cast<float>(width()), y / static_cast<float>(height()));
  if (layout_ == EnvironmentLayout::equirectangular) {
    const float azimuth = 2 * pi * at.x - pi, polar = pi * at.y;
    return {std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)};
  }
  if (layout_ == EnvironmentLayout::octahedral) {
    const Direction d = direction_from_octahedral(at);
    return {d.x, d.z, -d.y};
  }
  const int face = std::clamp(static_cast<int>(at.x * cube_faces), 0, cube_faces - 1);
  return cube_direction(face, {at.x * cube_faces - static_cast<float>(face), at.y});
}

Direction Environment::direction_of_texel(int x, int y) const {
  if (layout_ != EnvironmentLayout::equirectangular)
    return direction_at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
  const Angle azimuth = azimuths_[static_cast<std::size_t>(x)], polar = polar_angles_[static_cast<std::size_t>(y)];
  return {polar.sin * azimuth.cos, polar.cos, polar.sin * azimuth.sin};
}

float Environment::solid_angle(int x, int y) const {
  if (layout_ == EnvironmentLayout::equirectangular)
    return solid_angle_by_sine_ * polar_angles_[static_cast<std::size_t>(y)].sin;
  return solid_angle_of_cell(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 1);
}

float Environment::solid_angle_of_cell(float x, float y, float cell) const {
  const auto w = static_cast<float>(width()), h = static_cast<float>(height());
  if (layout_ == EnvironmentLayout::octahedral) return 4 * pi * sqr(cell) / (w * h);
  if (layout_ == EnvironmentLayout::equirectangular)
    return 4 * pi * cell / w * std::sin(pi * y / h) * std::sin(0.5f * pi * cell / h);
  // Its area divided by the cube of its distance; the error is of the order of its width squared.
  const float s = 2 * std::fmod(x, h) / h - 1, t = 2 * y / h - 1, distance2 = 1 + s * s + t * t;
  return 4 * sqr(cell / h) / (distance2 * std::sqrt(distance2));
}

Spectrum Environment::texel(int x, int y) const {
  const float* const p = image_.pixels.data() + image_.index(x, y);
  return {usable(p[red_]), usable(p[green_]), usable(p[blue_]), 0};
}

Spectrum Environment::texel_without_sun(int x, int y) const {
  const Spectrum value = texel(x, y);
  const float brightness = luminance_of(value);
  return brightness > threshold_ ? value * (threshold_ / brightness) : value;
}

void Environment::find_suns() {
  constexpr std::size_t chunks = 32;
  const auto rows = static_cast<std::size_t>(height());
  const std::size_t rows_each = (rows + chunks - 1) / chunks;
  std::vector<LuminanceHistogram> parts((rows + rows_each - 1) / rows_each);
  parallel_chunks(rows, rows_each, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    LuminanceHistogram& part = parts[chunk];
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < width(); ++x) {
        const float* const p = image_.pixels.data() + image_.index(x, y);
        for (const std::size_t c : {red_, green_, blue_}) part.unusable += is_usable(p[c]) ? 0 : 1;
        part.add(luminance_of(texel(x, y)), static_cast<double>(solid_angle(x, y)));
      }
  });
  LuminanceHistogram histogram;
  for (const LuminanceHistogram& part : parts) histogram.add(part);
  unusable_ = histogram.unusable;
  const float texel_width = 0.5f * pi / texels_per_face();
  const float points_per_texel = std::max(1.0f, sqr(texel_width / finest_sun_spacing));
  const float texels_per_point = std::max(1.0f, sqr(finest_sun_spacing / texel_width));
  const auto most_texels =
      static_cast<std::uint64_t>(static_cast<float>(most_sun_points) * texels_per_point / points_per_texel);
  threshold_ = raised_to_fit(histogram, contrast_threshold(histogram), most_texels);
  for (int y = 0; y < height(); ++y)
    for (int x = 0; x < width(); ++x) {
      const Spectrum value = texel(x, y);
      if (luminance_of(value) > threshold_) suns_.push_back({x, y, value - texel_without_sun(x, y)});
    }
}

std::vector<PointFlux> Environment::sun_points(float spacing) const {
  const float texel_width = 0.5f * pi / texels_per_face();
  const int pieces = std::max(1, static_cast<int>(std::lround(texel_width / spacing)));
  const float step = 1 / static_cast<float>(pieces);
  // Grid cells as wide as the spacing. An ordered map makes sums reproducible.
  const int cells = std::max(1, static_cast<int>(0.5f * pi / spacing));
  std::map<std::array<int, 3>, std::pair<Vec3, Spectrum>> merged;
  for (const Sun& sun : suns_) {
    const Spectrum flux = sun.excess * (solid_angle(sun.x, sun.y) * step * step);
    for (int j = 0; j < pieces; ++j)
      for (int i = 0; i < pieces; ++i) {
        const Direction d = direction_at(static_cast<float>(sun.x) + (static_cast<float>(i) + 0.5f) * step,
                                         static_cast<float>(sun.y) + (static_cast<float>(j) + 0.5f) * step);
        const CubePoint p = cube_point(d);
        const auto cell = [&](float v) { return static_cast<int>(v * static_cast<float>(cells)); };
        auto& [weighted, sum] = merged[{p.face, cell(p.at.x), cell(p.at.y)}];
        weighted += luminance_of(flux) * d;
        sum += flux;
      }
  }
  std::vector<PointFlux> points;
  points.reserve(merged.size());
  for (const auto& [cell, light] : merged) points.push_back({normalize(light.first), light.second});
  return points;
}

Vec2 Environment::place_of(const Direction& d) const {
  const auto w = static_cast<float>(width()), h = static_cast<float>(height());
  if (layout_ == EnvironmentLayout::equirectangular) {
    const float azimuth = d.x == 0 && d.z == 0 ? 0.0f : std::atan2(d.z, d.x);
    return {(azimuth / (2 * pi) + 0.5f) * w, std::atan2(std::hypot(d.x, d.z), d.y) / pi * h};
  }
  if (layout_ == EnvironmentLayout::octahedral) {
    const Vec2 p = octahedral_from_direction({d.x, -d.z, d.y});
    return {p.x * w, p.y * h};
  }
  const CubePoint p = cube_point(d);
  return {(static_cast<float>(p.face) + p.at.x) * h, p.at.y * h};
}

Spectrum Environment::radiance_without_suns(const Direction& direction) const {
  const Vec2 place = place_of(direction) - Vec2(0.5f);
  const float left = std::floor(place.x), top = std::floor(place.y);
  const float fx = place.x - left, fy = place.y - top;
  const int w = width(), h = height();
  // The face of a cube; other layouts have a single one.
  const int face_width = layout_ == EnvironmentLayout::cube ? h : w;
  const int face_begin = std::clamp(static_cast<int>(place.x + 0.5f), 0, w - 1) / face_width * face_width;
  const auto at = [&](int x, int y) {
    if (layout_ == EnvironmentLayout::equirectangular) return texel_without_sun((x + w) % w, std::clamp(y, 0, h - 1));
    if (layout_ == EnvironmentLayout::octahedral) {
      // Beyond an edge the layout continues with the same edge, reversed.
      if (x < 0 || x >= w) return texel_without_sun(std::clamp(x, 0, w - 1), std::clamp(h - 1 - y, 0, h - 1));
      if (y < 0 || y >= h) return texel_without_sun(w - 1 - x, std::clamp(y, 0, h - 1));
      return texel_without_sun(x, y);
    }
    return texel_without_sun(std::clamp(x, face_begin, face_begin + face_width - 1), std::clamp(y, 0, h - 1));
  };
  const auto x = static_cast<int>(left), y = static_cast<int>(top);
  return (1 - fy) * ((1 - fx) * at(x, y) + fx * at(x + 1, y)) + fy * ((1 - fx) * at(x, y + 1) + fx * at(x + 1, y + 1));
}

CubeMap Environment::cube_without_suns(int size) const {
  CubeMap map(size);
  if (layout_ == EnvironmentLayout::cube && size == height()) {
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < width(); ++x) map.texel(x / size, x % size, y) = texel_without_sun(x, y);
    map.close_seams();
    return map;
  }
  // One look-up for each texel of the image, and at least four.
  const int samples = std::max(2, static_cast<int>(std::ceil(texels_per_face() / static_cast<float>(size) - 0.01f)));
  const float step = 1 / static_cast<float>(samples), scale = 1 / static_cast<float>(size);
  parallel_for(0, cube_faces * size, [&](int row) {
    const int face = row / size, y = row % size;
    for (int x = 0; x < size; ++x) {
      Spectrum sum;
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i) {
          const Vec2 place(static_cast<float>(x) + (static_cast<float>(i) + 0.5f) * step,
                           static_cast<float>(y) + (static_cast<float>(j) + 0.5f) * step);
          sum += radiance_without_suns(cube_direction(face, place * scale));
        }
      map.texel(face, x, y) = sum * (step * step);
    }
  });
  map.close_seams();
  return map;
}

}  // namespace lanthorn
