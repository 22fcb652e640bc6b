// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/media/volume_gather.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "support/scene_text.h"

namespace lanthorn::volume_gather_test {
namespace {

constexpr std::array radii{0.8f, 0.4f, 0.2f, 0.1f};  // m
constexpr float height = 0.25f, depth = 3;           // of the photon, above the eye ray and along it, m

// One photon or flight in fog, and a ray and a vertex of an eye path near it.
class OnePhoton {
 public:
  explicit OnePhoton(VolumeEstimator estimator) : estimator_(estimator) {
    Photon photon{Spectrum(1), {0, height, depth}, {1, 0, 0}, {1, 0, 0}, {.eye_scatterings = 9}};
    const bool is_beam = records_for(estimator) == MediumRecords::beams;
    if (is_beam) photon.position.x = 2;
    chunks_ = {{MediumPhoton{photon, MediumId(1), is_beam ? 4.0f : 0.0f}}};
  }

  /// The estimate by one kernel.
  float gathered(float radius) const {
    const VolumeGather gather = gather_by(radius);
    const GatheredLight light = is_at_point(estimator_) ? gather.at(path_, vertex_) : gather.along(path_, flight_);
    return sum_of(light.caustic + light.indirect);
  }
  /// The estimate by all kernels. The eye path has flown this far before.
  std::array<float, radii.size()> compared(float flown, float near) const {
    std::vector<KernelIn> kernels;
    for (const float radius : radii) kernels.emplace_back(kernel_dimensions(estimator_), kernel, radius);
    const KernelLadder ladder{kernels, near};
    std::array<float, radii.size()> sums{};
    const VolumeGather gather = gather_by(radii[0]);
    const std::size_t found = is_at_point(estimator_) ? gather.compare_at(path_, vertex_, flown, ladder, sums)
                                                      : gather.compare_along(path_, flight_, flown, ladder, sums);
    EXPECT_EQ(found, 1u);
    return sums;
  }

 private:
  static constexpr Kernel kernel{KernelShape::epanechnikov};
  VolumeGather gather_by(float radius) const { return {estimator_, kernel, radius, chunks_, ColorMode::rgb}; }

  const Scene scene_ = test::world(R"(MakeNamedMedium "fog" "string type" "homogeneous"
)");
  const Wavelengths w_ = Wavelengths::rgb(0.5f);
  mutable Sampler sampler_ = Sampler::for_pixel(0, Stream::camera, 0, 0);
  mutable RayCounts counts_;
  const PathContext path_{scene_, w_, sampler_, counts_, {9, 9}};
  const WalkState state_{.depth = 1, .medium = MediumId(1)};
  const FlownSegment flight_{state_, {{0, 0, 0}, {0, 0, 1}, 5}, 5, false, Spectrum(1), 0, {}};
  const HenyeyGreenstein phase_{0};
  const MediumVertex vertex_{state_, {0, 0, depth}, {0, 0, -1}, phase_, 0, true};
  VolumeEstimator estimator_;
  std::vector<std::vector<MediumPhoton>> chunks_;
};

class KernelLadders : public testing::TestWithParam<VolumeEstimator> {};

TEST_P(KernelLadders, FindWhatEachKernelFinds) {
  const OnePhoton photon(GetParam());
  const auto sums = photon.compared(1, 0);
  for (std::size_t k = 0; k < radii.size(); ++k) EXPECT_FLOAT_EQ(sums[k], photon.gathered(radii[k])) << radii[k];
  EXPECT_GT(sums[1], 0);
  EXPECT_EQ(sums.back(), 0);
}

// Weighted by t² / (t² + near²), with the distance t along the eye path to the point where the ray passes the photon,
// or to the vertex.
TEST_P(KernelLadders, CountLessNearTheEye) {
  const OnePhoton photon(GetParam());
  const auto all = photon.compared(1, 0);
  for (const float flown : {0.0f, 1.0f, 5.0f})
    for (const float near : {0.5f, 3.0f, 20.0f}) {
      const float t = is_at_point(GetParam()) ? flown : flown + depth;
      const auto sums = photon.compared(flown, near);
      for (std::size_t k = 0; k < radii.size(); ++k)
        EXPECT_FLOAT_EQ(sums[k], all[k] * (t * t / (t * t + near * near))) << flown << ' ' << near << ' ' << radii[k];
    }
}

INSTANTIATE_TEST_SUITE_P(Estimators, KernelLadders,
                         testing::Values(VolumeEstimator::point, VolumeEstimator::beam, VolumeEstimator::photon_beam,
                                         VolumeEstimator::beams));

}  // namespace
}  // namespace lanthorn::volume_gather_test
