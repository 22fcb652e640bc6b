// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "index/bucket_kdtree.h"
#include "index/hash_grid.h"
#include "index/left_balanced_kdtree.h"
#include "math/hash.h"
#include "math/sampling.h"
#include "photon/gather/kernels.h"
#include "photon/gather/radius_schedule.h"
#include "photon/photon.h"
#include "photon/photon_map.h"

namespace lanthorn::photon_map_test {
namespace {

Point random_point(HashRng& rng) { return {rng.next(), rng.next(), rng.next()}; }

constexpr std::array shapes{KernelShape::box, KernelShape::cone, KernelShape::epanechnikov, KernelShape::gaussian};

double integral_over_disc(const Kernel& kernel, float support) {
  const int steps = 20000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const float d = support * (static_cast<float>(i) + 0.5f) / static_cast<float>(steps);
    sum += kernel.weight(d * d, support * support) * 2 * std::numbers::pi * d * support / steps;
  }
  return sum;
}

TEST(Kernel, IntegratesToOneOverItsDisc) {
  for (const KernelShape shape : shapes)
    EXPECT_NEAR(integral_over_disc({shape}, 0.37f), 1, 1e-5) << static_cast<int>(shape);
  for (const float slope : {1.0f, 1.1f, 2.0f, 10.0f})
    EXPECT_NEAR(integral_over_disc({KernelShape::cone, slope}, 2.0f), 1, 1e-5) << slope;
}

// Sums over shells, in each dimension of volume estimates. Light L(x) = 1 + c x² has a bias of c times the kernel's
// second moment; constant light has none.
TEST(KernelIn, KnowsItsBias) {
  constexpr double c = 0.7;
  for (const KernelShape shape :
       {KernelShape::box, KernelShape::cone, KernelShape::epanechnikov, KernelShape::gaussian})
    for (int dimensions = 1; dimensions <= 3; ++dimensions) {
      const KernelIn kernel(dimensions, {shape}, 0.8f);
      const double r = static_cast<double>(kernel.support());
      constexpr int steps = 20000;
      double estimate = 0, bias = 0, bias_of_even = 0;
      for (int i = 0; i < steps; ++i) {
        const double x = (i + 0.5) * r / steps;
        const auto dist2 = static_cast<float>(x * x);
        const double size = dimensions == 1   ? 2
                            : dimensions == 2 ? 2 * std::numbers::pi * x
                                              : 4 * std::numbers::pi * x * x;
        const double weight = r / steps * size * static_cast<double>(kernel.weight(dist2));
        const double share = static_cast<double>(kernel.bias_share(dist2));
        estimate += weight * (1 + c * x * x);
        bias += weight * share * (1 + c * x * x);
        bias_of_even += weight * share;
      }
      EXPECT_NEAR(bias_of_even, 0, 2e-3) << static_cast<int>(shape) << " in " << dimensions;
      EXPECT_NEAR(bias / (estimate - 1), 1, 0.02) << static_cast<int>(shape) << " in " << dimensions;
    }
}

TEST(KernelIn, IntegratesToOne) {
  constexpr float radius = 0.3f;
  for (const KernelShape shape : shapes)
    for (const int dimensions : {1, 2, 3}) {
      const KernelIn kernel(dimensions, {shape}, radius);
      const double r = static_cast<double>(kernel.support());
      constexpr int steps = 5000;
      double sum = 0;
      for (int i = 0; i < steps; ++i) {
        const double x = r * (i + 0.5) / steps;
        const double shell = dimensions == 1   ? 2
                             : dimensions == 2 ? 2 * std::numbers::pi * x
                                               : 4 * std::numbers::pi * x * x;
        sum += r / steps * shell * static_cast<double>(kernel.weight(static_cast<float>(x * x)));
      }
      EXPECT_NEAR(sum, 1, 1e-4) << dimensions;
    }
}

TEST(Kernel, FallsFromTheCentreAndTheGaussianHasTheBoxRadiusAsDeviation) {
  for (const KernelShape shape : shapes) {
    const Kernel kernel{shape};
    for (float u = 0; u < 1; u += 0.01f)
      EXPECT_GE(kernel.profile(u), kernel.profile(u + 0.01f)) << static_cast<int>(shape);
    EXPECT_GE(kernel.profile(1), -1e-6f) << static_cast<int>(shape);
  }
  const Kernel gaussian{KernelShape::gaussian};
  const float support = gaussian.support(0.2f);
  EXPECT_NEAR(gaussian.weight(0.2f * 0.2f, support * support) / gaussian.weight(0, support * support), std::exp(-0.5f),
              1e-5f);
}

TEST(GatherDisc, IsBoundedByTheKthPointOrTheLargestRadius) {
  const std::array<Neighbour, 3> found{{{4, 0}, {1, 1}, {0, 2}}};
  const auto kth = gather_disc(found, 3, 9).value();
  EXPECT_EQ(kth.support2, 4);
  EXPECT_EQ(kth.counted.size(), 2u);
  const auto few = gather_disc(found, 5, 9).value();
  EXPECT_EQ(few.support2, 81);
  EXPECT_EQ(few.counted.size(), 3u);
  EXPECT_FALSE(gather_disc({}, 5, 9).has_value());
  EXPECT_FALSE(gather_disc(std::span(found).last(1), 1, 9).has_value());
}

TEST(RadiusSchedule, FollowsTheRecurrence) {
  for (const double alpha : {0.1, 2.0 / 3, 0.9, 1.0}) {
    const RadiusSchedule schedule{0.25, alpha};
    EXPECT_EQ(schedule.radius(0), 0.25f);
    double shrink2 = 1;
    for (std::uint64_t pass = 0; pass < 5000; ++pass) {
      const double i = static_cast<double>(pass) + 1;
      ASSERT_NEAR(schedule.shrink2(pass) / shrink2, 1, 1e-10) << "pass " << pass << " alpha " << alpha;
      shrink2 *= (i + alpha) / (i + 1);
    }
  }
  // r² falls like i^(α - 1), for any number of passes.
  const RadiusSchedule schedule;
  EXPECT_NEAR(schedule.shrink2(10'000'000) / schedule.shrink2(80'000'000), 2, 1e-6);
}

// r, r² and r³ have the same shrinkage (Knaus & Zwicker 2011, section 5).
TEST(RadiusSchedule, ShrinksByDimension) {
  const RadiusSchedule schedule{1, 0.6};
  for (const std::uint64_t pass : {0, 1, 7, 1000})
    for (const int dimensions : {1, 2, 3}) {
      const double shrunk = std::pow(static_cast<double>(schedule.shrink(pass, dimensions)), dimensions);
      EXPECT_NEAR(shrunk, schedule.shrink2(pass), 1e-6);
    }
}

TEST(RadiusSchedule, LogGammaIsAccurate) {
  for (const double x : {1e-3, 0.5, 1.0, 1.7, 2.0, 10.0, 15.9, 16.0, 1e3, 1e6})
    EXPECT_NEAR(log_gamma(x), std::lgamma(x), 1e-13 * std::fmax(1, std::fabs(std::lgamma(x)))) << x;
}

TEST(Photon, DirectionsAreRoundedToNearest) {
  HashRng rng(13);
  glm::dvec3 mean_error(0);
  double worst = 0;
  constexpr int count = 200000;
  for (int i = 0; i < count; ++i) {
    const Vec3 v = sample_uniform_sphere(rng.next2());
    const Vec3 error = decode_octahedral<16>(encode_octahedral<16>(v)) - v;
    worst = std::fmax(worst, std::sqrt(length_squared(error)));
    mean_error += glm::dvec3(error);
    ASSERT_LT(std::sqrt(length_squared(decode_octahedral<12>(encode_octahedral<12>(v)) - v)), 1.2e-3f);
  }
  EXPECT_LT(worst, 7e-5);
  // Errors have a standard deviation of about 2e-5 per axis, and the mean of 2e5 errors one of 4.5e-8. Limit: six of
  // these; false alarms < 1e-8.
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(std::fabs(mean_error[axis] / count), 2.7e-7);
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      Vec3 v(0);
      v[axis] = sign;
      EXPECT_EQ(decode_octahedral<16>(encode_octahedral<16>(v)), v);
      EXPECT_EQ(decode_octahedral<12>(encode_octahedral<12>(v)), v);
    }
}

std::vector<Photon> random_photons(std::size_t count, float brightest) {
  HashRng rng(19);
  std::vector<Photon> photons(count);
  for (Photon& p : photons) {
    p.position = random_point(rng);
    p.wi = sample_uniform_sphere(rng.next2());
    p.normal = sample_uniform_sphere(rng.next2());
    p.power = brightest * Spectrum(rng.next(), rng.next(), rng.next(), 0);
    p.flags = PhotonFlags::from_bits(static_cast<int>(64 * rng.next()), static_cast<std::uint32_t>(8 * rng.next()));
    p.flight = std::exp2(22 * rng.next() - 12);
  }
  return photons;
}

TEST(PhotonMap, GivesBackWhatWasStored) {
  for (const ColorMode mode : {ColorMode::rgb, ColorMode::spectral})
    for (const float brightest : {1e-20f, 1.0f, 1e12f}) {
      const std::vector<Photon> photons = random_photons(2000, brightest);
      const auto map = PhotonMap<HashGrid>::build(photons, mode, 0.05f);
      ASSERT_EQ(map.size(), photons.size());
      for (std::size_t i = 0; i < photons.size(); i += 7) {
        const Photon& stored = photons[i];
        int times = 0;
        map.for_each_near(stored.position, 0.05f, [&](const PhotonMap<HashGrid>::Ref& photon, float dist2) {
          ASSERT_LE(dist2, 0.05f * 0.05f);
          if (photon.position() != stored.position) return;
          ++times;
          for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(photon.power()[c], stored.gained_power()[c], max_component(stored.gained_power()) / 511);
          EXPECT_EQ(photon.power()[3], 0);
          EXPECT_GT(dot(photon.wi(), stored.wi), 1 - 1e-6f);
          EXPECT_EQ(photon.normal().has_value(), mode == ColorMode::rgb);
          if (photon.normal()) {
            EXPECT_GT(dot(*photon.normal(), stored.normal), 1 - 1e-5f);
          }
          EXPECT_EQ(photon.flags(), stored.flags);
          EXPECT_LE(photon.flight(), stored.flight);
          if (std::fabs(dot(stored.wi, stored.normal)) > 0.1f) {
            EXPECT_GE(photon.flight(), stored.flight / 8.2f);
          }
        });
        ASSERT_EQ(times, 1);
      }
    }
}

TEST(Photon, AllowsNoMoreEyeScatteringsThanCanBeRecorded) {
  for (const ColorMode mode : {ColorMode::rgb, ColorMode::spectral}) {
    Photon photon{Spectrum(1), {}, {0, 0, 1}, {0, 0, 1}, {.eye_scatterings = 1000, .caustic = true}};
    EXPECT_EQ(PackedPhoton::pack(photon, mode, {}).flags(mode),
              (PhotonFlags{.eye_scatterings = PhotonFlags::most_eye_scatterings, .caustic = true}));
    photon.flags.eye_scatterings = 0;
    EXPECT_EQ(PackedPhoton::pack(photon, mode, {}).flags(mode).eye_scatterings, 0);
  }
}

TEST(PhotonMap, KeepsSpectralPowersOfAnySize) {
  std::vector<Photon> photons(2);
  for (Photon& p : photons) p.wi = p.normal = {0, 0, 1};
  photons[0].power = {1e6f, 1, 0, 3e-2f};
  photons[1].power = {2e-2f, 5e5f, 7, 1e3f};
  photons[1].position = {1, 0, 0};
  const auto map = PhotonMap<LeftBalancedKdTree>::build(photons, ColorMode::spectral);
  std::array<Neighbour, 1> memory;
  for (const Photon& p : photons) {
    const Spectrum power = map[map.nearest(p.position, 0.5f, memory).front().slot].power();
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(power[c], p.power[c], p.power[c] / 2000);
  }
}

TEST(PhotonMap, DoesNotDependOnChunksOrThreads) {
  const std::vector<Photon> photons = random_photons(50000, 1);
  const auto whole = PhotonMap<BucketKdTree>::build(photons, ColorMode::rgb);
  const ThreadLimit limit(3);
  std::vector<std::vector<Photon>> chunks{{}, {photons.begin(), photons.begin() + 777}, {}};
  chunks.emplace_back(photons.begin() + 777, photons.end());
  const auto cut = PhotonMap<BucketKdTree>::build(chunks, ColorMode::rgb);
  ASSERT_EQ(cut.size(), whole.size());
  for (std::uint32_t slot = 0; slot < whole.size(); ++slot) {
    ASSERT_EQ(cut[slot].position(), whole[slot].position());
    ASSERT_EQ(cut[slot].power(), whole[slot].power());
    ASSERT_EQ(cut[slot].wi(), whole[slot].wi());
  }
}

TEST(PhotonMap, MayBeEmpty) {
  const auto map = PhotonMap<HashGrid>::build(std::vector<Photon>{}, ColorMode::rgb, 0.1f);
  EXPECT_EQ(map.size(), 0u);
  map.for_each_near({0, 0, 0}, 0.1f, [](const PhotonMap<HashGrid>::Ref&, float) { FAIL(); });
}

#ifndef LANTHORN_FULL_PRECISION_PHOTONS
TEST(PhotonMap, TakesAtMost24BytesPerPhotonBesidesTheCellTable) {
  const std::vector<Photon> photons = random_photons(100000, 1);
  const auto grid = PhotonMap<HashGrid>::build(photons, ColorMode::rgb, 0.02f);
  EXPECT_LE(grid.memory_bytes() - grid.index().table_bytes(), 24 * photons.size() + 200);
  EXPECT_LE(grid.index().table_bytes(), 12 * photons.size());
  EXPECT_LE(PhotonMap<BucketKdTree>::build(photons, ColorMode::rgb).memory_bytes(),
            25 * photons.size() + photons.size() / 2);
  EXPECT_LE(PhotonMap<LeftBalancedKdTree>::build(photons, ColorMode::rgb).memory_bytes(), 25 * photons.size());
}
#endif

}  // namespace
}  // namespace lanthorn::photon_map_test
