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

// Facets whose shading normal equals the geometric one up to rounding are not bent.
constexpr float least_bent_cosine = 1 - 1e-6f;

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

std::optional<Bsdf> bent(const Bsdf& bsdf, const Normal& plane, const Normal& horizon) {
  if (!(plane.z < least_bent_cosine)) return {};
  return std::visit(
      [&](const auto& closure) -> std::optional<Bsdf> {
        if constexpr (std::is_same_v<std::decay_t<decltype(closure)>, DiffuseTransmission>) {
          if (closure.transmittance.is_black()) return with_planes(Diffuse{closure.reflectance}, plane, horizon);
        } else if constexpr (requires { Bsdf(with_planes(closure, plane, horizon)); }) {
          return with_planes(closure, plane, horizon);
        }
        return {};
      },
      bsdf);
}

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

// Split-sum shading takes light from the whole hemisphere of the shading normal, so what `with_planes` has added goes.
static SplitTerms split_terms(const Bent<Diffuse>& facet, const Vec3& /*any*/) {
  return {.diffuse = facet.closure.reflectance * share_above_horizon(facet)};
}

SplitTerms split_terms(const Bsdf& bsdf, const Vec3& wi) {
  return std::visit([&](const auto& closure) { return split_terms(closure, wi); }, bsdf);
}

}  // namespace lanthorn
