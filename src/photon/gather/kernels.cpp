// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/gather/kernels.h"

#include <array>
#include <numbers>

namespace lanthorn {

KernelMoments moments_of(const Kernel& kernel) {
  // Midpoint rule over rings of equal area.
  constexpr int rings = 256;
  double squares = 0, moment = 0;
  for (int i = 0; i < rings; ++i) {
    const float u = (static_cast<float>(i) + 0.5f) / rings;
    const auto profile = static_cast<double>(kernel.profile(u));
    squares += profile * profile;
    moment += profile * static_cast<double>(u);
  }
  return {static_cast<float>(squares / rings) * inv_pi, static_cast<float>(moment / (2 * rings))};
}

KernelIn::KernelIn(int dimensions, const Kernel& kernel, float radius)
    : kernel_(kernel),
      dimensions_(dimensions),
      radius_(radius),
      support_(kernel.support(radius)),
      box_size_(0),
      scale_(0) {
  // Mean of the profile over the ball, by the midpoint rule over shells.
  constexpr int shells = 1024;
  double mean = 0;
  for (int i = 0; i < shells; ++i) {
    const double x = (i + 0.5) / shells;
    mean += dimensions * std::pow(x, dimensions - 1) / shells *
            static_cast<double>(kernel.profile(static_cast<float>(x * x)));
  }
  constexpr std::array<double, 4> unit_ball{1, 2, std::numbers::pi, 4 * std::numbers::pi / 3};
  const auto ball = [&](float r) {
    return unit_ball[static_cast<std::size_t>(dimensions)] * std::pow(static_cast<double>(r), dimensions);
  };
  box_size_ = static_cast<float>(ball(radius));
  scale_ = static_cast<float>(1 / (mean * ball(support_)));
}

std::optional<GatherDisc> gather_disc(std::span<const Neighbour> found, std::size_t k, float max_radius) {
  const bool bounded_by_kth = found.size() == k && k > 0;
  const float support2 = bounded_by_kth ? found.front().dist2 : max_radius * max_radius;
  const auto counted = bounded_by_kth ? found.subspan(1) : found;
  if (!(support2 > 0) || counted.empty()) return std::nullopt;
  return GatherDisc{support2, counted};
}

}  // namespace lanthorn
