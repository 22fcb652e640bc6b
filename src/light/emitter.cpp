// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/emitter.h"

#include <type_traits>

#include "light/emitter_sampling.h"

namespace lanthorn {
namespace {

template <class Shape>
constexpr bool samples_directions = requires(const Shape& s) {
  s.sample_towards(Point(0), Vec2(0));
};

template <class Shape>
constexpr bool inverts_samples = requires(const Shape& s) {
  s.invert_sample_area(Point(0));
};

}  // namespace

float area(const EmitterShape& shape) {
  return std::visit([](const Emitter auto& s) { return s.area; }, shape);
}
EmitterPoint sample_area(const EmitterShape& shape, const Vec2& u) {
  return std::visit([&](const Emitter auto& s) { return s.sample_area(u); }, shape);
}
std::optional<Vec2> invert_sample_area(const EmitterShape& shape, const Point& point) {
  return std::visit(
      [&](const Emitter auto& s) -> std::optional<Vec2> {
        if constexpr (inverts_samples<std::decay_t<decltype(s)>>) return s.invert_sample_area(point);
        return {};
      },
      shape);
}
std::optional<EmitterDirection> sample_towards(const EmitterShape& shape, const Point& from, const Vec2& u) {
  return std::visit(
      [&](const Emitter auto& s) {
        if constexpr (samples_directions<std::decay_t<decltype(s)>>) return s.sample_towards(from, u);
        return direction_to(s.sample_area(u), s.area, from);
      },
      shape);
}
float pdf_towards(const EmitterShape& shape, const Point& from, const Point& hit, const Normal& normal) {
  return std::visit(
      [&](const Emitter auto& s) {
        if constexpr (samples_directions<std::decay_t<decltype(s)>>) return s.pdf_towards(from, hit, normal);
        return pdf_by_area(s.area, from, hit, normal);
      },
      shape);
}
Bounds bounds(const EmitterShape& shape) {
  return std::visit([](const Emitter auto& s) { return s.bounds(); }, shape);
}
NormalCone normal_cone(const EmitterShape& shape) {
  return std::visit([](const Emitter auto& s) { return s.normal_cone(); }, shape);
}

}  // namespace lanthorn
