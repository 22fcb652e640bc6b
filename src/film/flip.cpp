// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Section numbers refer to Andersson et al. 2020.
#include "lanthorn/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "film/display.h"
#include "film/plane.h"
#include "lanthorn/error.h"
#include "math/vec.h"

namespace lanthorn {
namespace {

/// Applies f to each element of a plane.
template <class T, class F>
auto mapped(const PixelPlane<T>& in, F&& f) {
  return PixelPlane<decltype(f(in[0]))>::of(in.width(), in.height(), [&](std::size_t i) { return f(in[i]); });
}

// Linear Rec.709 to XYZ (columns), exact for the primaries and D65 of IEC 61966-2-1.
const glm::mat3 xyz_from_rgb{{10135552.0 / 24577794, 2613072.0 / 12288897, 1425312.0 / 73733382},
                             {8788810.0 / 24577794, 8788810.0 / 12288897, 8788810.0 / 73733382},
                             {4435075.0 / 24577794, 887015.0 / 12288897, 70074185.0 / 73733382}};
const glm::mat3 rgb_from_xyz = glm::inverse(xyz_from_rgb);
const Vec3 white = xyz_from_rgb * Vec3(1.0f);

/// The opponent space of section 4.1.1: like L*a*b* without its cube roots.
Vec3 ycxcz_from_rgb(const Vec3& rgb) {
  const Vec3 n = xyz_from_rgb * rgb / white;
  return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}
Vec3 rgb_from_ycxcz(const Vec3& c) {
  const float y = (c.x + 16) / 116;
  return rgb_from_xyz * (Vec3(y + c.y / 500, y, y - c.z / 200) * white);
}

/// CIELAB with chroma scaled by lightness (Hunt effect, section 4.1.2).
Vec3 hunt_lab_from_rgb(const Vec3& rgb) {
  const auto root = [](float t) {
    constexpr float delta = 6.0f / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29;
  };
  const Vec3 n = xyz_from_rgb * rgb / white;
  const float x = root(n.x), y = root(n.y), z = root(n.z), lightness = 116 * y - 16;
  return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

/// HyAB distance (section 4.1.3).
float hyab(const Vec3& a, const Vec3& b) {
  const Vec3 d = a - b;
  return std::fabs(d.x) + std::hypot(d.y, d.z);
}

using Kernel = std::vector<float>;  ///< odd size, centred

template <class F>
Kernel make_kernel(int radius, F&& f) {
  Kernel kernel;
  for (int x = -radius; x <= radius; ++x) kernel.push_back(static_cast<float>(f(static_cast<double>(x))));
  return kernel;
}

Plane convolved_along(const Plane& in, const Kernel& kernel, int dx, int dy) {
  Plane out(in.width(), in.height());
  const int radius = static_cast<int>(kernel.size() / 2);
  in.for_each_row([&](int y) {
    for (int x = 0; x < in.width(); ++x)
      for (int i = -radius; const float weight : kernel) {
        const int from_x = std::clamp(x + i * dx, 0, in.width() - 1),
                  from_y = std::clamp(y + i * dy, 0, in.height() - 1);
        out.row(y)[x] += weight * in.row(from_y)[from_x];
        ++i;
      }
  });
  return out;
}

/// Convolution with a separable filter; edge pixels are repeated beyond the edge.
Plane convolved(const Plane& in, const Kernel& horizontal, const Kernel& vertical) {
  return convolved_along(convolved_along(in, horizontal, 1, 0), vertical, 0, 1);
}

/// One Gaussian of a contrast sensitivity function (section 4.1.1, table 1), as a filter kernel of volume `weight`.
struct SensitivityTerm {
  double a, b;
  double volume = 0;
  Kernel kernel;
};

/// Normalises the volumes over the terms of one channel.
std::vector<SensitivityTerm> sensitivity(std::vector<SensitivityTerm> terms, double pixels_per_degree) {
  constexpr double widest_b = 0.04, pi_d = std::numbers::pi;
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest_b / (2 * pi_d * pi_d)) * pixels_per_degree));
  double total = 0;
  for (SensitivityTerm& term : terms) {
    const auto gaussian = [&](double x) {
      return std::exp(-pi_d * pi_d * (x * x / (pixels_per_degree * pixels_per_degree)) / term.b);
    };
    double sum = 0;
    for (int x = -radius; x <= radius; ++x) sum += gaussian(x);
    term.kernel = make_kernel(radius, [&](double x) { return gaussian(x) / sum; });
    term.volume = term.a * std::sqrt(pi_d / term.b) * sum * sum;
    total += term.volume;
  }
  for (SensitivityTerm& term : terms) term.volume /= total;
  return terms;
}

/// Filters a picture in the opponent space by contrast sensitivity; the result is Hunt-adjusted L*a*b*.
PixelPlane<Vec3> perceived(const PixelPlane<Vec3>& ycxcz, double pixels_per_degree) {
  const std::array<std::vector<SensitivityTerm>, 3> channels{
      sensitivity({{1, 0.0047, 0, {}}}, pixels_per_degree), sensitivity({{1, 0.0053, 0, {}}}, pixels_per_degree),
      sensitivity({{34.1, 0.04, 0, {}}, {13.5, 0.025, 0, {}}}, pixels_per_degree)};
  PixelPlane<Vec3> filtered(ycxcz.width(), ycxcz.height());
  for (int c = 0; c < 3; ++c) {
    const Plane channel = mapped(ycxcz, [c](const Vec3& v) { return v[c]; });
    for (const SensitivityTerm& term : channels[static_cast<std::size_t>(c)]) {
      const Plane part = convolved(channel, term.kernel, term.kernel);
      for (std::size_t i = 0; i < part.size(); ++i) filtered[i][c] += static_cast<float>(term.volume) * part[i];
    }
  }
  return mapped(filtered, [](const Vec3& c) { return hunt_lab_from_rgb(glm::clamp(rgb_from_ycxcz(c), 0.0f, 1.0f)); });
}

/// Strength of edges and points in the achromatic channel (section 4.2).
struct Features {
  Plane edges, points;
};

/// Scales the positive weights to sum to 1 and the negative ones to -1.
Kernel balanced(Kernel kernel) {
  double positive = 0, negative = 0;
  for (const float w : kernel) (w > 0 ? positive : negative) += static_cast<double>(w);
  for (float& w : kernel) w = static_cast<float>(static_cast<double>(w) / (w > 0 ? positive : -negative));
  return kernel;
}

Plane feature_strength(const Plane& y, const Kernel& derivative, const Kernel& smooth) {
  Plane across = convolved(y, derivative, smooth);
  const Plane down = convolved(y, smooth, derivative);
  for (std::size_t i = 0; i < across.size(); ++i) across[i] = std::hypot(across[i], down[i]);
  return across;
}

Features features(const PixelPlane<Vec3>& ycxcz, double pixels_per_degree) {
  constexpr double edge_width = 0.082;  // degrees from peak to trough
  const double sigma = 0.5 * edge_width * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sigma));
  const auto gaussian = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
  const Kernel smooth = balanced(make_kernel(radius, gaussian));
  const Kernel first = balanced(make_kernel(radius, [&](double x) { return -x * gaussian(x); }));
  const Kernel second =
      balanced(make_kernel(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * gaussian(x); }));
  const Plane y = mapped(ycxcz, [](const Vec3& c) { return (c.x + 16) / 116; });
  return {feature_strength(y, first, smooth), feature_strength(y, second, smooth)};
}

/// Maps colour differences to [0,1] (section 4.1.4): most of the range covers the smaller 40 % of them.
float redistributed(float distance, float largest) {
  constexpr float qc = 0.7f, pc = 0.4f, pt = 0.95f;
  const float e = std::pow(distance, qc), e_max = std::pow(largest, qc), knee = pc * e_max;
  return e < knee ? pt / knee * e : pt + (e - knee) / (e_max - knee) * (1 - pt);
}

/// LDR-FLIP of colours in [0,1].
std::vector<float> flip_map(const PixelPlane<Vec3>& image, const PixelPlane<Vec3>& reference,
                            double pixels_per_degree) {
  const float largest = hyab(hunt_lab_from_rgb({0, 1, 0}), hunt_lab_from_rgb({0, 0, 1}));
  const PixelPlane<Vec3> a = mapped(image, ycxcz_from_rgb), b = mapped(reference, ycxcz_from_rgb);
  const PixelPlane<Vec3> seen_a = perceived(a, pixels_per_degree), seen_b = perceived(b, pixels_per_degree);
  const Features in_a = features(a, pixels_per_degree), in_b = features(b, pixels_per_degree);
  std::vector<float> map(a.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    const float color = redistributed(hyab(seen_a[i], seen_b[i]), largest);
    const float edges = std::fabs(in_a.edges[i] - in_b.edges[i]);
    const float points = std::fabs(in_a.points[i] - in_b.points[i]);
    const float feature = std::sqrt(std::fmax(edges, points) / std::numbers::sqrt2_v<float>);  // q_f = 1/2
    map[i] = std::pow(std::clamp(color, 0.0f, 1.0f), 1 - std::fmin(feature, 1.0f));
  }
  return map;
}

PixelPlane<Vec3> color_plane(const Image& image) {
  const auto color = select_layer(image, "color");
  if (!color) throw Error("FLIP needs pictures with channels R, G, B");
  if (color->width < 1 || color->height < 1) throw Error("FLIP needs pictures of at least one pixel");
  const auto finite = [&](std::size_t i) {
    const float x = color->pixels[i];
    return std::isfinite(x) ? std::fmax(x, 0.0f) : 0.0f;
  };
  return PixelPlane<Vec3>::of(color->width, color->height,
                              [&](std::size_t i) { return Vec3(finite(3 * i), finite(3 * i + 1), finite(3 * i + 2)); });
}

struct PlanePair {
  PixelPlane<Vec3> image, reference;
};
PlanePair color_planes(const Image& image, const Image& reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw Error("FLIP needs pictures of equal size");
  return {color_plane(image), color_plane(reference)};
}

FlipResult with_mean(std::vector<float> map) {
  double sum = 0;
  for (const float e : map) sum += static_cast<double>(e);
  const double count = static_cast<double>(map.size());
  return {std::move(map), sum / count};
}

/// First exposure (stops) and the number of exposures of HDR-FLIP, about one stop apart (2021, section 4).
struct Exposures {
  double first = 0, step = 0;
  int count = 1;
};

/// The luminance at which Narkowicz's curve without its pre-exposure of 0.6 reaches 0.85; beyond it, highlights lose
/// contrast.
double shoulder() {
  constexpr double t = 0.85, a = 0.36 * (2.51 - 2.43 * t), b = 0.6 * (0.03 - 0.59 * t), c = -0.14 * t;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

Exposures exposures(const PixelPlane<Vec3>& reference) {
  std::vector<float> luminances;
  for (std::size_t i = 0; i < reference.size(); ++i)
    if (const float y = luminance({reference[i].x, reference[i].y, reference[i].z}); y > 0) luminances.push_back(y);
  if (luminances.empty()) return {};
  // Black pixels would require infinite exposure. If most pixels are black, the median is taken over the other pixels.
  const std::size_t black = reference.size() - luminances.size();
  std::sort(luminances.begin(), luminances.end());
  const auto at_rank = [&](std::size_t rank) {
    return static_cast<double>(luminances[rank >= black ? rank - black : luminances.size() / 2]);
  };
  const std::size_t count = reference.size();
  const double median = 0.5 * (at_rank((count - 1) / 2) + at_rank(count / 2));
  const double first = std::log2(shoulder() / static_cast<double>(luminances.back()));
  const double last = std::log2(shoulder() / median);
  const int steps = std::max(2, static_cast<int>(std::ceil(last - first)));
  return {first, (last - first) / (steps - 1), steps};
}

}  // namespace

FlipResult ldr_flip(const Image& image, const Image& reference, const FlipOptions& options) {
  const PlanePair planes = color_planes(image, reference);
  const auto clamp = [](const Vec3& c) { return glm::min(c, Vec3(1)); };
  return with_mean(flip_map(mapped(planes.image, clamp), mapped(planes.reference, clamp), options.pixels_per_degree));
}

FlipResult hdr_flip(const Image& image, const Image& reference, const FlipOptions& options) {
  const PlanePair planes = color_planes(image, reference);
  const Exposures range = exposures(planes.reference);
  std::vector<float> worst(planes.reference.size());
  for (int i = 0; i < range.count; ++i) {
    const auto gain = static_cast<float>(std::exp2(range.first + i * range.step));
    const auto tone_map = [gain](const Vec3& c) {
      Vec3 out;
      for (int k = 0; k < 3; ++k) out[k] = std::fmin(filmic_curve(std::fmin(0.6f * gain * c[k], 1e4f)), 1.0f);
      return out;
    };
    const std::vector<float> map =
        flip_map(mapped(planes.image, tone_map), mapped(planes.reference, tone_map), options.pixels_per_degree);
    for (std::size_t p = 0; p < map.size(); ++p) worst[p] = std::fmax(worst[p], map[p]);
  }
  return with_mean(std::move(worst));
}

Image flip_colors(const FlipResult& flip, int width, int height) {
  // sRGB bytes of matplotlib's "magma" (van der Walt & Smith 2015, CC0) at 0, 1/4 ... 1.
  constexpr std::array<std::array<float, 3>, 5> stops{
      {{0, 0, 4}, {81, 18, 124}, {183, 55, 121}, {252, 137, 97}, {252, 253, 191}}};
  Image image(width, height, {"R", "G", "B"});
  for (std::size_t i = 0; i < flip.map.size(); ++i) {
    const float at = std::clamp(flip.map[i], 0.0f, 1.0f) * (stops.size() - 1);
    const std::size_t stop = std::min<std::size_t>(static_cast<std::size_t>(at), stops.size() - 2);
    for (std::size_t c = 0; c < 3; ++c) {
      const float byte = lerp(at - static_cast<float>(stop), stops[stop][c], stops[stop + 1][c]);
      image.pixels[i * 3 + c] = linear_from_srgb(byte / 255);
    }
  }
  return image;
}

}  // namespace lanthorn
