// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <optional>
#include <variant>

#include "math/vec.h"
#include "spectrum/spectrum.h"
#include "surface/sample.h"
#include "surface/split_terms.h"

namespace lanthorn {

/// Functions that every closure must have; for meanings, units and conventions see `Bsdf` in bsdf.h. A type that lacks
/// one cannot be an alternative of `Bsdf`. Without this check, a call would find the function of `Bsdf` itself, to
/// which closures convert, and never return.
template <class C>
concept Closure = requires(const C c, const Vec3 w, float u_lobe, const Vec2 u, Transport transport, BsdfParts parts) {
  { C::traits } -> std::convertible_to<ClosureTraits>;
  { evaluate(c, w, w, transport, parts) } -> std::same_as<BsdfValue>;
  { sample(c, w, u_lobe, u, transport) } -> std::same_as<std::optional<BsdfSample>>;
  { albedo(c, w) } -> std::same_as<Spectrum>;
  { lobe_weights(c, w) } -> std::same_as<LobeWeights>;
  { has_non_delta(c) } -> std::same_as<bool>;
  { is_dispersive(c) } -> std::same_as<bool>;
  { split_terms(c, w) } -> std::same_as<SplitTerms>;
};

template <Closure... Closures>
using ClosureVariant = std::variant<Closures...>;

}  // namespace lanthorn
