// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Tests which photons contribute at a vertex.
#include "photon/gather/photon_hit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "math/hash.h"

namespace lanthorn::photon_hit_test {
namespace {

struct TestPhoton {
  Point place{0};
  Direction incident{0, 0, 1};
  float last_flight = 10;
  PhotonFlags path_flags{.eye_scatterings = 9};

  Point position() const { return place; }
  Direction wi() const { return incident; }
  std::optional<Normal> normal() const { return {}; }
  PhotonFlags flags() const { return path_flags; }
  float flight() const { return last_flight; }
};

// A disc of radius 1 on the plane z = 0.
TEST(PhotonHit, PhotonsOfOtherSurfacesAreLeftOut) {
  const auto is_met = [](float height, float cosine, float flight) {
    return is_on_surface(height, cosine, flight, 1.0f) &&
           lies_on(TestPhoton{{0.5f, 0, height}, {std::sqrt(1 - cosine * cosine), 0, cosine}, flight}, {0, 0, 0},
                   {0, 0, 1}, 1.0f);
  };
  EXPECT_TRUE(is_met(0, 1, 0.01f)) << "in the plane, however short its flight";
  EXPECT_TRUE(is_met(0.1f, 1, 0.01f)) << "over the plane";
  EXPECT_TRUE(is_met(0.19f, 1, 10)) << "a little over the plane";
  EXPECT_FALSE(is_met(0.21f, 1, 10)) << "far over it";
  EXPECT_FALSE(is_met(-0.21f, 1, 10)) << "far under it";
  EXPECT_TRUE(is_met(-0.1f, 1, 10)) << "under the plane, but it set out over it";
  EXPECT_FALSE(is_met(-0.1f, 1, 0.09f)) << "under the plane, where it set out";
  EXPECT_TRUE(is_met(-0.1f, 0.5f, 0.25f)) << "0.125 along the normal";
  EXPECT_FALSE(is_met(-0.1f, 0.5f, 0.19f)) << "0.095 along the normal";
  EXPECT_TRUE(is_met(-0.1f, -1, 0.09f)) << "under the plane, whose lower side it lights";
  EXPECT_FALSE(is_met(0.1f, -1, 0.09f)) << "over the plane, whose lower side it would light";
}

TEST(PhotonHit, LanesAreAsOneByOne) {
  HashRng rng(1);
  int on_surface = 0, others = 0;
  for (int n = 0; n < 10'000; ++n) {
    const float reach = 0.1f + rng.next(), flight = 0.3f * rng.next();
    std::array<float, Lanes::width> height{}, cosine{};
    for (std::size_t i = 0; i < Lanes::width; ++i) {
      // Some photons are in the plane, some fly parallel to it.
      height[i] = rng.next() < 0.1f ? 0.0f : 0.5f * reach * (2 * rng.next() - 1);
      cosine[i] = rng.next() < 0.1f ? 0.0f : 2 * rng.next() - 1;
    }
    const LaneMask met = are_on_surface(Lanes(height), Lanes(cosine), flight, reach);
    const std::array<float, Lanes::width> found = select(met, Lanes(1), Lanes(0)).stored();
    for (std::size_t i = 0; i < Lanes::width; ++i) {
      const bool expected = is_on_surface(height[i], cosine[i], flight, reach);
      ASSERT_EQ(found[i], expected ? 1 : 0) << height[i] << ' ' << cosine[i] << ' ' << flight << ' ' << reach;
      ++(expected ? on_surface : others);
    }
  }
  EXPECT_GT(on_surface, 10'000);
  EXPECT_GT(others, 10'000);
}

TEST(PhotonHit, VerticesAreMetByPathsThatAreShortEnough) {
  WalkState state;
  SurfacePoint at;
  at.normal = {0, 0, 1};
  at.shading = Frame(at.normal);
  at.bsdf = Diffuse{Spectrum(0.5f)};
  const SurfaceVertex vertex{state, at, {0, 0, 1}, {0, 0, 1}, true};
  for (const int depth : {1, 2, 3}) {
    state.depth = depth;
    const TestPhoton photon{.path_flags = {.eye_scatterings = 1}};
    const std::optional<PhotonHit> hit = GatherVertex(vertex).meet(photon, 1);
    ASSERT_EQ(hit.has_value(), depth <= 2) << depth;
    if (hit) {
      EXPECT_FLOAT_EQ(hit->f[0], 0.5f * inv_pi);
      EXPECT_FLOAT_EQ(hit->ratio, 1);
    }
  }
  state.depth = 1;
  EXPECT_FALSE(GatherVertex(vertex).meet(TestPhoton{.place = {0, 0, 0.3f}}, 1)) << "over the disc";
  EXPECT_FALSE(GatherVertex(vertex).meet(TestPhoton{.incident = {0, 0, -1}}, 1)) << "from the other side";
  EXPECT_FALSE(GatherVertex(vertex).is_dispersed(false));
  EXPECT_TRUE(GatherVertex(vertex).is_dispersed(true));
  state.dispersed = true;
  EXPECT_TRUE(GatherVertex(vertex).is_dispersed(false));
}

}  // namespace
}  // namespace lanthorn::photon_hit_test
