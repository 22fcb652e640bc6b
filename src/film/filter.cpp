// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "film/filter.h"

#include <algorithm>
#include <numbers>
#include <type_traits>

#include "lanthorn/error.h"
#include "lanthorn/scene_description.h"

namespace lanthorn {
namespace {

constexpr std::size_t cells = 1024;

float gaussian(float x, float sigma) { return std::exp(-0.5f * sqr(x / sigma)); }

float mitchell(float x, float b, float c) {
  x = std::fabs(x);
  if (x >= 2) return 0;
  if (x < 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
  return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) / 6;
}

float sinc(float x) {
  x *= pi;
  return std::fabs(x) < 1e-3f ? 1 - x * x / 6 : std::sin(x) / x;
}

struct EvaluateAxis {
  float x, radius;
  float operator()(const BoxFilter&) const { return 1; }
  float operator()(const TriangleFilter&) const { return std::fmax(0.0f, radius - std::fabs(x)); }
  float operator()(const GaussianFilter& f) const {
    return std::fmax(0.0f, gaussian(x, f.sigma) - gaussian(radius, f.sigma));
  }
  float operator()(const MitchellFilter& f) const { return mitchell(2 * x / radius, f.b, f.c); }
  float operator()(const SincFilter& f) const { return sinc(x) * sinc(x / f.tau); }
};

void check(const FilterShape& shape, const Vec2& radius) {
  const auto positive = [](float x) { return std::isfinite(x) && x > 0; };
  if (!positive(radius.x) || !positive(radius.y) || radius.x > 64 || radius.y > 64)
    throw Error("pixel filter: xradius and yradius must be greater than 0 and at most 64 pixels");
  if (const auto* f = std::get_if<GaussianFilter>(&shape); f && !positive(f->sigma))
    throw Error("pixel filter: the gaussian's sigma must be greater than 0");
  if (const auto* f = std::get_if<SincFilter>(&shape); f && !positive(f->tau))
    throw Error("pixel filter: the sinc's tau must be greater than 0");
}

}  // namespace

float Filter::Axis::evaluate(float x) const {
  if (x < -radius || x >= radius) return 0;
  return std::visit(EvaluateAxis{x, radius}, shape);
}

Filter::Axis Filter::make_axis(const FilterShape& shape, float radius) {
  Axis axis;
  axis.shape = shape;
  axis.radius = radius;
  if (std::holds_alternative<BoxFilter>(shape)) {
    axis.integral = axis.absolute = 2 * radius;
    return axis;
  }
  const double width = 2.0 * static_cast<double>(radius) / cells;
  std::vector<double> sums{0};
  double integral = 0;
  for (std::size_t i = 0; i < cells; ++i) {
    const float f = axis.evaluate(static_cast<float>((static_cast<double>(i) + 0.5) * width) - radius);
    integral += static_cast<double>(f) * width;
    sums.push_back(sums.back() + std::fabs(static_cast<double>(f)) * width);
    axis.minus.push_back(f < 0);
  }
  axis.integral = static_cast<float>(integral);
  axis.absolute = static_cast<float>(sums.back());
  if (!(axis.integral > 1e-6f * axis.absolute))
    throw Error("pixel filter: its integral must be positive; change its parameters");
  for (const double sum : sums) axis.cdf.push_back(static_cast<float>(sum / sums.back()));
  for (std::size_t i = 0, cell = 0; i < cells; ++i) {
    while (axis.cdf[cell + 1] <= static_cast<float>(i) / cells) ++cell;
    axis.guide.push_back(static_cast<std::uint16_t>(cell));
  }
  return axis;
}

Filter::AxisSample Filter::Axis::sample(float u) const {
  if (cdf.empty()) return {(2 * u - 1) * radius, 1};
  std::size_t cell = guide[static_cast<std::size_t>(u * cells)];
  while (cdf[cell + 1] <= u) ++cell;
  const float inside = (u - cdf[cell]) / (cdf[cell + 1] - cdf[cell]);
  const float offset = (static_cast<float>(cell) + inside) * (2 * radius / cells) - radius;
  return {std::min(radius * one_minus_epsilon, offset), minus[cell] ? -1.0f : 1.0f};
}

Filter::PixelRange Filter::Axis::covering(float p, int pixels) const {
  // Centres c with -radius <= p - c < radius, so that a box of one pixel covers exactly one pixel. NaN gives an empty
  // range.
  const auto clamp = [&](float x) { return static_cast<int>(std::max(0.0f, std::min(static_cast<float>(pixels), x))); };
  return {clamp(std::floor(p - 0.5f - radius) + 1), clamp(std::floor(p - 0.5f + radius) + 1)};
}

Filter::Filter(const FilterShape& shape)
    : shape_(shape), radius_(std::visit([](const auto& f) { return f.radius; }, shape)) {
  check(shape, radius_);
  axes_[0] = make_axis(shape, radius_.x);
  axes_[1] = radius_.x == radius_.y ? axes_[0] : make_axis(shape, radius_.y);
  weight_ = axes_[0].absolute / axes_[0].integral * (axes_[1].absolute / axes_[1].integral);
}

FilterSample Filter::sample(const Vec2& u) const {
  const AxisSample x = axes_[0].sample(u.x), y = axes_[1].sample(u.y);
  return {{x.offset, y.offset}, x.sign * y.sign * weight_};
}

FilterShape filter_shape(const description::Filter& filter) {
  switch (filter.kind) {
    case description::FilterKind::box:
      return BoxFilter{filter.radius};
    case description::FilterKind::triangle:
      return TriangleFilter{filter.radius};
    case description::FilterKind::mitchell:
      return MitchellFilter{filter.radius, filter.b, filter.c};
    case description::FilterKind::sinc:
      return SincFilter{filter.radius, filter.tau};
    case description::FilterKind::gaussian:
      break;
  }
  return GaussianFilter{filter.radius, filter.sigma};
}

}  // namespace lanthorn
