// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "path/direction_guide.h"

#include <algorithm>
#include <array>

#include "math/sampling.h"
#include "path/mis.h"
#include "path/vertex.h"

namespace lanthorn {

namespace {

constexpr std::size_t side = 16;  // cells along an edge of the square
using Grid = std::array<float, side * side>;

Vec2 place(const Vec3& local) { return invert_concentric_disk({local.x, local.y}); }

// Binomial filter (1 2 1) / 4 along both axes; at the edges of the square a cell stands in for its missing neighbour.
// Fills the holes between few photons.
Grid smoothed(const Grid& grid) {
  const auto along = [](const Grid& from, std::size_t step, std::size_t across) {
    Grid to;
    for (std::size_t line = 0; line < side; ++line)
      for (std::size_t i = 0; i < side; ++i) {
        const auto at = [&](std::size_t k) { return from[line * across + k * step]; };
        to[line * across + i * step] =
            0.25f * at(i > 0 ? i - 1 : i) + 0.5f * at(i) + 0.25f * at(std::min(i + 1, side - 1));
      }
    return to;
  };
  return along(along(grid, 1, side), side, 1);
}

}  // namespace

DirectionGuide::DirectionGuide(const Normal& normal, std::span<const Seen> light) : frame_(normal) {
  Grid flux{};
  for (const Seen& seen : light) {
    const Vec3 local = frame_.to_local(seen.from);
    if (!(local.z > 0)) continue;
    const Vec2 at = place(local) * static_cast<float>(side);
    const auto cell = [](float x) { return std::min(static_cast<std::size_t>(x), side - 1); };
    flux[cell(at.y) * side + cell(at.x)] += seen.flux;
  }
  const Grid cells = smoothed(flux);
  density_ = PiecewiseConstant2d({cells.begin(), cells.end()}, side, side);
}

std::optional<Direction> DirectionGuide::sample(const Vec2& u) const {
  const std::optional<PiecewiseConstant2d::Sample> s = density_.sample(u);
  return s ? std::optional(frame_.to_world(sample_cosine_hemisphere(s->at))) : std::nullopt;
}

float DirectionGuide::pdf(const Direction& direction) const {
  const Vec3 local = frame_.to_local(direction);
  return local.z > 0 ? density_.pdf(place(local)) * pdf_cosine_hemisphere(local.z) : 0.0f;
}

std::size_t DirectionGuide::table_bytes() { return (2 * side + 1) * side * sizeof(float); }

std::optional<Direction> Guidance::sample(const Vec2& u) const { return guide->sample(u); }

float Guidance::pdf(float closure_pdf, const Direction& direction) const {
  return guide == nullptr ? closure_pdf : mixture_pdf(closure_pdf, guide->pdf(direction), share);
}

}  // namespace lanthorn
