// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Pixel reconstruction filters. Pixel samples importance-sample the filter (Ernst et al. 2006, "Filter importance
// sampling"): each sample belongs to a single pixel. Only splats of light tracing evaluate the filter.
//
// A filter with negative lobes is a difference, f = f⁺ - f⁻, and with N = ∫ f⁻ / ∫ f a pixel is
//
//   (1 + N) (mean of the light over f⁺) - N (mean of the light over f⁻).
//
// A sample belongs to one of both parts, and the film keeps their sums apart, so each mean is divided by a number of
// samples of one sign. Weights of both signs in one sum would make the divisor of a pixel nearly 0 by chance. The
// number of a sample in its sequence decides its part, so all pixels have equally many samples of each. The variance is
// least if the parts get samples in proportion to (1 + N) and N: that of f⁻ gets N / (1 + 2 N) of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <variant>
#include <vector>

#include "math/vec.h"

namespace lanthorn {

namespace description {
struct Filter;
}

// Each filter is a product f(x) g(y) around the pixel's centre, 0 outside [-radius.x, radius.x) x [-radius.y,
// radius.y). Radii in pixels; the defaults are pbrt-v4's.

/// 1 everywhere.
struct BoxFilter {
  Vec2 radius{0.5f, 0.5f};
};
/// max(0, radius - |x|).
struct TriangleFilter {
  Vec2 radius{2, 2};
};
/// Normal density of standard deviation sigma (pixels), minus its value at the radius.
struct GaussianFilter {
  Vec2 radius{1.5f, 1.5f};
  float sigma = 0.5f;
};
/// Mitchell & Netravali (1988), eq. 8, stretched so that its support [-2, 2] fills the radius.
struct MitchellFilter {
  Vec2 radius{2, 2};
  float b = 1.0f / 3;
  float c = 1.0f / 3;
};
/// sinc(x) sinc(x / tau), sinc(x) = sin(pi x) / (pi x) (Lanczos; Duchon 1979).
struct SincFilter {
  Vec2 radius{4, 4};
  float tau = 3;
};

using FilterShape = std::variant<BoxFilter, TriangleFilter, GaussianFilter, MitchellFilter, SincFilter>;

/// The parts f⁺ = max(f, 0) and f⁻ = max(-f, 0) of a filter f.
enum class FilterPart : std::uint8_t { positive, negative };

/// The part to which a sample belongs, and the number of samples of that part before it.
struct FilterPlace {
  FilterPart part = FilterPart::positive;
  std::uint64_t number = 0;
};

/// A filter prepared for sampling and evaluation; occupies a few kB (tables for all shapes except the box).
class Filter {
 public:
  /// Box filter over one pixel.
  Filter() : Filter(BoxFilter{}) {}
  /// Throws `lanthorn::Error` unless radii, sigma, tau and the filter's integral are positive.
  explicit Filter(const FilterShape& shape);

  const FilterShape& shape() const { return shape_; }
  Vec2 radius() const { return radius_; }
  /// f at an offset in pixels from the pixel's centre; not normalised.
  float evaluate(const Vec2& offset) const { return axes_[0].evaluate(offset.x) * axes_[1].evaluate(offset.y); }
  /// Integral of f over its support.
  float integral() const { return axes_[0].integral() * axes_[1].integral(); }
  /// N = ∫ f⁻ / ∫ f; 0 for filters without negative lobes.
  float negative_share() const { return negative_share_; }
  /// The place of sample `number` of a pixel's sequence. floor(n N / (1 + 2 N) + 1/2) of the first n samples are
  /// negative; the very first is positive.
  FilterPlace place_of_sample(std::uint64_t number) const;
  /// Samples a part g, f⁺ or f⁻, from u in [0,1)^2: pdf per pixel area g / ∫ g (piecewise constant over 1/1024 of the
  /// support). Returns the offset from the pixel's centre, pixels. f⁻ must not be 0.
  Vec2 sample(const Vec2& u, FilterPart part) const;

  /// Calls `visit(x, y, weight)` for each pixel of [0, width) x [0, height) whose filter covers the raster position `p`
  /// (pixel (i, j) is centred on (i + 1/2, j + 1/2)). weight = f(p - centre) / integral: multiply a splat by it.
  template <class Visit>
  void for_each_pixel(const Vec2& p, int width, int height, Visit&& visit) const {
    const PixelRange columns = axes_[0].covering(p.x, width), rows = axes_[1].covering(p.y, height);
    for (int y = rows.begin; y < rows.end; ++y) {
      const float wy = axes_[1].evaluate(p.y - static_cast<float>(y) - 0.5f) / axes_[1].integral();
      for (int x = columns.begin; x < columns.end; ++x) {
        const float weight = wy * axes_[0].evaluate(p.x - static_cast<float>(x) - 0.5f) / axes_[0].integral();
        if (weight != 0) visit(x, y, weight);
      }
    }
  }

 private:
  struct PixelRange {
    int begin = 0;
    int end = 0;
  };
  /// The positive or the negative part of one axis.
  struct AxisPart {
    float integral = 0;
    std::vector<float> cdf;            ///< by cell, cells + 1 values from 0 to 1; empty for the box, and if it is 0
    std::vector<std::uint16_t> guide;  ///< by cell-sized step of u: the first cell to try
  };
  struct Axis {
    FilterShape shape;
    float radius = 0.5f;
    AxisPart plus, minus;

    float integral() const { return plus.integral - minus.integral; }
    float evaluate(float x) const;
    float sample(const AxisPart& part, float u) const;
    PixelRange covering(float p, int pixels) const;
  };
  /// A product of two axes' parts that lies in f⁺ or f⁻.
  struct Product {
    const AxisPart &x, &y;
    float integral() const { return x.integral * y.integral; }
  };
  std::array<Product, 2> products_of(FilterPart part) const;

  static Axis make_axis(const FilterShape& shape, float radius);
  static AxisPart make_part(const std::vector<double>& sums);

  FilterShape shape_;
  Vec2 radius_;
  std::array<Axis, 2> axes_;
  float negative_share_ = 0;
};

/// The pixel filter that a scene file specifies.
FilterShape filter_shape(const description::Filter& filter);

}  // namespace lanthorn
