// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/bsdf.h"

namespace lanthorn {

Spectrum eval(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo, Transport transport) {
  return std::visit([&](const auto& closure) { return eval(closure, wi, wo, transport); }, bsdf);
}

float pdf(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo) {
  return std::visit([&](const auto& closure) { return pdf(closure, wi, wo); }, bsdf);
}

BsdfValue eval_and_pdf(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo, Transport transport) {
  return std::visit(
      [&](const auto& closure) -> BsdfValue {
        if constexpr (requires { eval_and_pdfs_of(closure, wi, wo); }) return eval_and_pdfs_of(closure, wi, wo);
        const Spectrum f = eval(closure, wi, wo, transport);
        return {f, f.is_black() ? 0.0f : pdf(closure, wi, wo)};
      },
      bsdf);
}

float pdf_reverse(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo) {
  return std::visit([&](const auto& closure) { return pdf_reverse(closure, wi, wo); }, bsdf);
}

BsdfValues eval_and_pdfs(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo, Transport transport) {
  return std::visit(
      [&](const auto& closure) -> BsdfValues {
        if constexpr (requires { eval_and_pdfs_of(closure, wi, wo); }) return eval_and_pdfs_of(closure, wi, wo);
        const Spectrum f = eval(closure, wi, wo, transport);
        if (f.is_black()) return {};
        return {{f, pdf(closure, wi, wo)}, pdf_reverse(closure, wi, wo)};
      },
      bsdf);
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

}  // namespace lanthorn
