// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/bsdf.h"

namespace lanthorn {

namespace {

constexpr Transport opposite(Transport t) {
  return t == Transport::radiance ? Transport::importance : Transport::radiance;
}

// `pdf` for the kind of walk that chooses wo, for closures that distinguish them.
template <class C>
float pdf_by(const C& closure, const Vec3& wi, const Vec3& wo, Transport transport) {
  if constexpr (requires { pdf_of(closure, wi, wo, transport); }) return pdf_of(closure, wi, wo, transport);
  return pdf(closure, wi, wo);
}
template <class C>
float pdf_reverse_by(const C& closure, const Vec3& wi, const Vec3& wo, Transport transport) {
  if constexpr (requires { reversed(closure); }) return pdf_of(reversed(closure), wo, wi, opposite(transport));
  if constexpr (requires { pdf_of(closure, wo, wi, transport); }) return pdf_of(closure, wo, wi, opposite(transport));
  return pdf_reverse(closure, wi, wo);
}

}  // namespace

Spectrum eval(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo, Transport transport) {
  return std::visit([&](const auto& closure) { return eval(closure, wi, wo, transport); }, bsdf);
}

float pdf(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo, Transport transport) {
  return std::visit([&](const auto& closure) { return pdf_by(closure, wi, wo, transport); }, bsdf);
}

BsdfValue eval_and_pdf(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo, Transport transport) {
  return std::visit(
      [&](const auto& closure) -> BsdfValue {
        if constexpr (requires { eval_and_pdfs_of(closure, wi, wo); }) return eval_and_pdfs_of(closure, wi, wo);
        const Spectrum f = eval(closure, wi, wo, transport);
        return {f, f.is_black() ? 0.0f : pdf_by(closure, wi, wo, transport)};
      },
      bsdf);
}

float pdf_reverse(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo, Transport transport) {
  return std::visit([&](const auto& closure) { return pdf_reverse_by(closure, wi, wo, transport); }, bsdf);
}

BsdfValues eval_and_pdfs(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo, Transport transport) {
  return std::visit(
      [&](const auto& closure) -> BsdfValues {
        if constexpr (requires { eval_and_pdfs_of(closure, wi, wo); }) return eval_and_pdfs_of(closure, wi, wo);
        const Spectrum f = eval(closure, wi, wo, transport);
        if (f.is_black()) return {};
        return {{f, pdf_by(closure, wi, wo, transport)}, pdf_reverse_by(closure, wi, wo, transport)};
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

SplitTerms split_terms(const Bsdf& bsdf, const Vec3& wi) {
  return std::visit([&](const auto& closure) { return split_terms(closure, wi); }, bsdf);
}

}  // namespace lanthorn
