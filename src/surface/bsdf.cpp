// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/bsdf.h"

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

}  // namespace lanthorn
