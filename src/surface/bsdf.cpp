// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/bsdf.h"

#include <variant>

namespace lanthorn {

BsdfValue evaluate(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts) {
  return std::visit([&](const auto& closure) { return evaluate(closure, wi, wo, transport, parts); }, bsdf);
}

std::optional<BsdfSample> sample(const Bsdf& bsdf, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport) {
  return std::visit([&](const auto& closure) { return sample(closure, wi, u_lobe, u, transport); }, bsdf);
}

Spectrum albedo(const Bsdf& bsdf, const Vec3& wi) {
  return std::visit([&](const auto& closure) { return albedo(closure, wi); }, bsdf);
}

LobeWeights lobe_weights(const Bsdf& bsdf, const Vec3& wi) {
  return std::visit([&](const auto& closure) { return lobe_weights(closure, wi); }, bsdf);
}

SplitTerms split_terms(const Bsdf& bsdf, const Vec3& wi) {
  return std::visit([&](const auto& closure) { return split_terms(closure, wi); }, bsdf);
}

namespace {

template <class C>
Bent<C> with_planes(const C& closure, const Normal& plane, const Normal& horizon) {
  return {closure, plane, horizon};
}
Bent<Diffuse> with_planes(Diffuse closure, const Normal& plane, const Normal& horizon) {
  Bent<Diffuse> result{closure, plane, horizon};
  result.closure.reflectance /= share_above_horizon(result);
  return result;
}

}  // namespace

bool is_bendable(const Bsdf& bsdf) {
  const auto* sheet = std::get_if<DiffuseTransmission>(&bsdf);
  return sheet != nullptr ? sheet->transmittance.is_black() : is_opaque(bsdf);
}

bool bend(PointBsdf& bsdf, const Normal& plane, const Normal& horizon) {
  constexpr float least_cosine = 1 - 1e-6f;
  if (!(plane.z < least_cosine)) return false;
  return std::visit(
      [&](const auto& closure) {
        if constexpr (std::is_same_v<std::decay_t<decltype(closure)>, DiffuseTransmission>) {
          bsdf.emplace(with_planes(Diffuse{closure.reflectance}, plane, horizon));
          return true;
        } else if constexpr (requires { Bsdf(with_planes(closure, plane, horizon)); }) {
          bsdf.emplace(with_planes(closure, plane, horizon));
          return true;
        }
        return false;
      },
      bsdf.get());
}

}  // namespace lanthorn
