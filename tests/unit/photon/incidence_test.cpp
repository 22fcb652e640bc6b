// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/incidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "index/bucket_kdtree.h"
#include "index/hash_grid.h"
#include "integrators/vcm/merge_map.h"
#include "math/hash.h"
#include "photon/gather/photon_gather.h"
#include "photon/gather/radiance_estimate.h"
#include "photon/photon_map.h"

namespace lanthorn::incidence_test {
namespace {

TEST(Incidence, IsTheRatioOfCosinesOnOneFacet) {
  for (const float geometric : {2e-4f, 0.01f, 0.099f, 0.1f, 0.5f, 1.0f})
    for (const float shading : {0.02f, 0.9f})
      EXPECT_FLOAT_EQ(grazing_gain(geometric) * incidence_ratio(shading, geometric), shading / geometric);
}

// The edge between two facets of a round surface. The facet that is seen is parallel to the light; photons only hit the
// other one.
struct GrazingFacet {
  static constexpr float radius = 0.1f;
  static constexpr float tilt = 0.2f;  // of the other facet, radians
  static constexpr float far = 1e6f;   // the light's distance, m

  GrazingFacet() {
    at.position = {0, 0, -0.2f * radius};
    at.normal = normalize(Normal(0, 1, 1e-4f));
    at.shading = Frame(Normal(0, std::cos(tilt / 2), std::sin(tilt / 2)));
    at.bsdf = Diffuse{Spectrum(1)};
    vertex.wi = at.shading.n;
    vertex.wi_local = {0, 0, 1};
    HashRng rng(1);
    constexpr int count = 4000;
    // One watt per square metre perpendicular to the light.
    const float power = 2 * radius * radius * std::sin(tilt) / count;
    for (int i = 0; i < count; ++i) {
      const Vec2 u = rng.next2();
      const Point p(radius * (2 * u.x - 1), -radius * u.y * std::sin(tilt), radius * u.y * std::cos(tilt));
      photons.push_back(
          {Spectrum(power), p, {0, 0, 1}, {0, std::cos(tilt), std::sin(tilt)}, {.eye_scatterings = 9}, far});
    }
  }
  // With the shading normal, irradiance is sin(tilt / 2) W/m². Half of the disc is on the other facet.
  static void expect_plausible(const Spectrum& radiance) {
    const float irradiance = radiance[0] * pi;
    EXPECT_GT(irradiance, 0.2f * std::sin(tilt / 2));
    EXPECT_LT(irradiance, 2 * std::sin(tilt / 2));
  }

  std::vector<Photon> photons;
  WalkState state;
  SurfacePoint at;
  SurfaceVertex vertex{state, at, {}, {}, true};
};

TEST(Incidence, FacetsAlongTheLightDoNotFlash) {
  GrazingFacet facet;
  facet.state.depth = 1;
  const Wavelengths w = Wavelengths::rgb(0.5f);
  for (const ColorMode mode : {ColorMode::rgb, ColorMode::spectral}) {
    const auto grid = PhotonMap<HashGrid>::build(facet.photons, mode, GrazingFacet::radius);
    const GatherSettings gather{{KernelShape::box}, GrazingFacet::radius};
    GrazingFacet::expect_plausible(gather_photons(grid, facet.vertex, gather, w).indirect);
    const auto tree = PhotonMap<BucketKdTree>::build(facet.photons, mode);
    const EstimateSettings estimate{{KernelShape::box}, 0, GrazingFacet::radius};
    GrazingFacet::expect_plausible(
        estimate_radiance(tree, facet.vertex, estimate, w, [](const PhotonFlags&, float) { return 1.0f; }).light);
  }
}

// A beam at a grazing angle deposits few photons on a facet, and each of them carries more.
TEST(Incidence, MapsKeepWhatGrazingPhotonsBring) {
  const Direction wi(0, std::sqrt(1 - 0.02f * 0.02f), 0.02f);
  const std::vector<Photon> photons{{Spectrum(3), {0, 0, 0}, wi, {0, 0, 1}, {}}};
  for (const ColorMode mode : {ColorMode::rgb, ColorMode::spectral})
    EXPECT_NEAR((PhotonMap<HashGrid>::build(photons, mode, 1.0f)[0].power()[0]), 3 * grazing_gain(0.02f), 0.02f);
  LightVertices vertices;
  vertices.begin(1);
  LightVertices::Chunk& chunk = vertices.chunk(0);
  chunk.clear();
  LightVertex vertex;
  vertex.beta = Spectrum(3);
  vertex.wi = wi;
  vertex.depth = 2;
  vertex.at.bsdf = Diffuse{Spectrum(1)};
  chunk.vertices.push_back(vertex);
  chunk.ends.push_back(1);
  const MergeMap map(vertices, 2, 1.0f, 0);
  int met = 0;
  map.for_each_near({0, 0, 0}, 1, [&](const MergePhoton& photon, const Point&, float) {
    EXPECT_NEAR(photon.power[0], 3 * grazing_gain(0.02f), 1e-3f);
    ++met;
  });
  EXPECT_EQ(met, 1);
}

}  // namespace
}  // namespace lanthorn::incidence_test
