// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A toy closure with the optional members. If one of them were missing, it would not satisfy the concept, and could not
// become an alternative of `Bsdf`.
#include <gtest/gtest.h>

#include <type_traits>
#include <utility>

#include "surface/bsdf.h"

namespace lanthorn::closure_test {
namespace {

enum class Part { traits, evaluate, sample, albedo, lobe_weights, has_non_delta, is_dispersive, split_terms, none };

struct WithTraits {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = false};
};
struct WithoutTraits {};

// A grey mirror.
template <Part missing>
struct Toy : std::conditional_t<missing == Part::traits, WithoutTraits, WithTraits> {
  Spectrum reflectance{0.5f};

  friend BsdfValue evaluate(const Toy&, const Vec3&, const Vec3&, Transport,
                            BsdfParts) requires(missing != Part::evaluate) {
    return {};
  }
  friend std::optional<BsdfSample> sample(const Toy& toy, const Vec3& wi, float, const Vec2&,
                                          Transport) requires(missing != Part::sample) {
    return BsdfSample{.wo = {-wi.x, -wi.y, wi.z}, .weight = toy.reflectance, .pdf = 1, .delta = true};
  }
  friend Spectrum albedo(const Toy& toy, const Vec3&) requires(missing != Part::albedo) { return toy.reflectance; }
  friend LobeWeights lobe_weights(const Toy&, const Vec3&) requires(missing != Part::lobe_weights) {
    return {.delta = 1};
  }
  friend bool has_non_delta(const Toy&) requires(missing != Part::has_non_delta) { return false; }
  friend bool is_dispersive(const Toy&) requires(missing != Part::is_dispersive) { return false; }
  friend SplitTerms split_terms(const Toy& toy, const Vec3&) requires(missing != Part::split_terms) {
    return {.f0 = toy.reflectance, .f90 = toy.reflectance};
  }
};

TEST(Closure, AToyIsOne) {
  static_assert(Closure<Toy<Part::none>>);
  const ClosureVariant<Toy<Part::none>, Diffuse> bsdf = Toy<Part::none>{};
  const auto s = std::visit(
      [](const auto& c) { return sample(c, Vec3(0.6f, 0, 0.8f), 0.5f, Vec2(0.5f), Transport::radiance); }, bsdf);
  EXPECT_EQ(s->wo, Vec3(-0.6f, 0, 0.8f));
}

TEST(Closure, MissesNothing) {
  static_assert(!Closure<Toy<Part::traits>>);
  static_assert(!Closure<Toy<Part::evaluate>>);
  static_assert(!Closure<Toy<Part::sample>>);
  static_assert(!Closure<Toy<Part::albedo>>);
  static_assert(!Closure<Toy<Part::lobe_weights>>);
  static_assert(!Closure<Toy<Part::has_non_delta>>);
  static_assert(!Closure<Toy<Part::is_dispersive>>);
  static_assert(!Closure<Toy<Part::split_terms>>);
}

}  // namespace
}  // namespace lanthorn::closure_test
