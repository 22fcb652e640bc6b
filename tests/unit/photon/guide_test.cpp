// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Guides built from known photons.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "math/hash.h"
#include "math/sampling.h"
#include "photon/guides/guide_photons.h"

namespace lanthorn::guide_test {
namespace {

const Direction left = normalize(Vec3(-1, 0, 1)), right = normalize(Vec3(1, 0, 1));

/// Photons on the square [0,1]² of the plane z = 0, from about this direction.
std::vector<Photon> photons_from(const Direction& direction, PhotonFlags flags, std::uint64_t seed) {
  std::vector<Photon> photons;
  HashRng rng(seed);
  for (int i = 0; i < 4000; ++i) {
    const Vec2 at = rng.next2();
    const Direction wi = normalize(direction + 0.1f * sample_uniform_sphere(rng.next2()));
    photons.push_back({Spectrum(1), {at.x, at.y, 0}, wi, {0, 0, 1}, flags});
  }
  return photons;
}

GuidePhotons guides_of(const std::vector<Photon>& photons) {
  return GuidePhotons::build(std::span(&photons, 1), Wavelengths::rgb(0.5f),
                             [](const PhotonFlags& flags) { return !flags.direct; });
}

/// The guide of a walk at a diffuse surface, unless another closure is given.
Guidance find(const GuidePhotons& guides, const Point& p, const Normal& normal, const Direction& wi,
              const Bsdf& bsdf = Diffuse{Spectrum(0.5f)}) {
  WalkState state;
  SurfacePoint at;
  at.position = p;
  at.normal = normal;
  at.shading = Frame(normal);
  at.bsdf = bsdf;
  return guides.find({state, at, wi, at.shading.to_local(wi), true});
}

constexpr Point middle{0.5f, 0.5f, 0};
constexpr Normal up{0, 0, 1};

TEST(GuidePhotons, LeadToWherePhotonsCameFrom) {
  const GuidePhotons guides = guides_of(photons_from(left, {}, 1));
  const Guidance guidance = find(guides, middle, up, up);
  ASSERT_NE(guidance.guide, nullptr);
  EXPECT_EQ(guidance.share, 0.5f);
  EXPECT_GT(guidance.guide->pdf(left), 8 * pdf_cosine_hemisphere(left.z));
  EXPECT_EQ(guidance.guide->pdf(right), 0);
}

TEST(GuidePhotons, KnowAcceptedPhotonsAlone) {
  std::vector<Photon> photons = photons_from(left, {.direct = true}, 1);
  EXPECT_EQ(guides_of(photons).size(), 0);
  EXPECT_EQ(find(guides_of(photons), middle, up, up).guide, nullptr);
  const std::vector<Photon> others = photons_from(right, {}, 2);
  photons.insert(photons.end(), others.begin(), others.end());
  const GuidePhotons guides = guides_of(photons);
  const Guidance guidance = find(guides, middle, up, up);
  ASSERT_NE(guidance.guide, nullptr);
  EXPECT_GT(guidance.guide->pdf(right), 0);
  EXPECT_EQ(guidance.guide->pdf(left), 0);
}

TEST(GuidePhotons, AreOfTheirSurfaceAndSide) {
  const GuidePhotons guides = guides_of(photons_from(left, {}, 1));
  EXPECT_EQ(find(guides, middle, up, -up).guide, nullptr);  // seen from below
  EXPECT_EQ(find(guides, middle, {1, 0, 0}, {1, 0, 0}).guide, nullptr);
  EXPECT_EQ(find(guides, middle + Vec3(0, 0, 0.3f), up, up).guide, nullptr);
  // A shape turned inside out is the same surface.
  EXPECT_NE(find(guides, middle, -up, up).guide, nullptr);
}

TEST(GuidePhotons, OfBothSidesOfASheetStayApart) {
  std::vector<Photon> photons = photons_from(left, {}, 1);
  const std::vector<Photon> below = photons_from({right.x, 0, -right.z}, {}, 2);
  photons.insert(photons.end(), below.begin(), below.end());
  const GuidePhotons guides = guides_of(photons);
  const Guidance above = find(guides, middle, up, up), under = find(guides, middle, up, -up);
  ASSERT_NE(above.guide, nullptr);
  ASSERT_NE(under.guide, nullptr);
  EXPECT_GT(above.guide->pdf(left), 0);
  EXPECT_EQ(above.guide->pdf(right), 0);
  EXPECT_GT(under.guide->pdf({right.x, 0, -right.z}), 0);
}

TEST(GuidePhotons, LeaveNarrowLobesToTheirClosures) {
  const GuidePhotons guides = guides_of(photons_from(left, {}, 1));
  const auto share = [&](float alpha) {
    return find(guides, middle, up, up, Conductor{Spectrum(0.2f), Spectrum(3), alpha, alpha}).share;
  };
  EXPECT_EQ(share(0), 0);
  EXPECT_GT(share(0.05f), 0);
  EXPECT_LT(share(0.05f), share(0.5f));
  EXPECT_LT(share(0.5f), 0.5f);
}

}  // namespace
}  // namespace lanthorn::guide_test
