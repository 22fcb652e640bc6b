// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "film/filter.h"

#include <algorithm>
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
    axis.plus.integral = 2 * radius;
    return axis;
  }
  const double width = 2.0 * static_cast<double>(radius) / cells;
  std::vector<double> plus{0}, minus{0};
  for (std::size_t i = 0; i < cells; ++i) {
    const auto f =
        static_cast<double>(axis.evaluate(static_cast<float>((static_cast<double>(i) + 0.5) * width) - radius));
    plus.push_back(plus.back() + std::fmax(0.0, f) * width);
    minus.push_back(minus.back() + std::fmax(0.0, -f) * width);
  }
  constexpr double least_remainder = 1e-6;  // of what the lobes leave
  if (!(plus.back() - minus.back() > least_remainder * (plus.back() + minus.back())))
    throw Error("pixel filter: its integral must be positive; change its parameters");
  axis.plus = make_part(plus);
  axis.minus = make_part(minus);
  return axis;
}

// `sums`: of the part's integral, by cell.
Filter::AxisPart Filter::make_part(const std::vector<double>& sums) {
  AxisPart part;
  part.integral = static_cast<float>(sums.back());
  if (!(part.integral > 0)) return part;
  for (const double sum : sums) part.cdf.push_back(static_cast<float>(sum / sums.back()));
  for (std::size_t i = 0, cell = 0; i < cells; ++i) {
    while (part.cdf[cell + 1] <= static_cast<float>(i) / cells) ++cell;
    part.guide.push_back(static_cast<std::uint16_t>(cell));
  }
  return part;
}

float Filter::Axis::sample(const AxisPart& part, float u) const {
  if (part.cdf.empty()) return (2 * u - 1) * radius;
  std::size_t cell = part.guide[static_cast<std::size_t>(u * cells)];
  while (part.cdf[cell + 1] <= u) ++cell;
  const float inside = (u - part.cdf[cell]) / (part.cdf[cell + 1] - part.cdf[cell]);
  const float offset = (static_cast<float>(cell) + inside) * (2 * radius / cells) - radius;
  return std::min(radius * one_minus_epsilon, offset);
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
  const auto [first, second] = products_of(FilterPart::negative);
  negative_share_ = (first.integral() + second.integral()) / integral();
}

// f is the product of its axes: positive where both have the same sign.
std::array<Filter::Product, 2> Filter::products_of(FilterPart part) const {
  const auto& [x, y] = axes_;
  if (part == FilterPart::positive) return {{{x.plus, y.plus}, {x.minus, y.minus}}};
  return {{{x.plus, y.minus}, {x.minus, y.plus}}};
}

FilterPlace Filter::place_of_sample(std::uint64_t number) const {
  if (negative_share_ == 0) return {FilterPart::positive, number};
  const auto share = static_cast<double>(negative_share_);
  const auto negative_before = [&](std::uint64_t count) {
    return static_cast<std::uint64_t>(static_cast<double>(count) * (share / (1 + 2 * share)) + 0.5);
  };
  const std::uint64_t negative = negative_before(number);
  if (negative_before(number + 1) > negative) return {FilterPart::negative, negative};
  return {FilterPart::positive, number - negative};
}

Vec2 Filter::sample(const Vec2& u, FilterPart part) const {
  const auto [first, second] = products_of(part);
  const float a = first.integral(), b = second.integral();
  const auto place = [this](const Product& product, float x, float y) {
    return Vec2(axes_[0].sample(product.x, x), axes_[1].sample(product.y, y));
  };
  if (b == 0) return place(first, u.x, u.y);
  // One number chooses the product and the place along x.
  const float share = a / (a + b);
  return u.x < share ? place(first, std::min(u.x / share, one_minus_epsilon), u.y)
                     : place(second, std::min((u.x - share) / (1 - share), one_minus_epsilon), u.y);
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
