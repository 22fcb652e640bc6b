// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "support/chi2.h"
#include "surface/bsdf.h"

namespace lanthorn::test {

/// The non-delta part of a closure, seen from wi, as a sampler for chi2.h and jacobian.h.
inline auto bsdf_sampler(const Bsdf& bsdf, const Vec3& wi, Transport transport = Transport::radiance) {
  return DirectionSampler{[=](float u1, const Vec2& u) -> std::optional<Vec3> {
                            const auto s = sample(bsdf, wi, u1, u, transport);
                            if (!s || s->delta) return std::nullopt;
                            return s->wo;
                          },
                          [=](const Vec3& wo) { return evaluate(bsdf, wi, wo, transport, {.pdf = true}).pdf; }};
}

/// Unit vector at these angles, degrees.
inline Vec3 at_angles(double theta, double phi) {
  const double to_radians = 0.017453292519943295;
  const double sin = std::sin(theta * to_radians);
  return {static_cast<float>(sin * std::cos(phi * to_radians)), static_cast<float>(sin * std::sin(phi * to_radians)),
          static_cast<float>(std::cos(theta * to_radians))};
}

}  // namespace lanthorn::test
