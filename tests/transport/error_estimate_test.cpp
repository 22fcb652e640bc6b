// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A render's own error estimate against the true error from many renders.
#include "lanthorn/error_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "support/render_scene.h"
#include "support/runs.h"

namespace lanthorn::error_estimate_test {
namespace {

const Scene& cornell() {
  static const Scene scene(read_scene(LANTHORN_SOURCE_DIR "/scenes/cornell-caustics.pbrt"));
  return scene;
}

constexpr int size = 48;
RenderOptions options_of(const std::string& method, std::uint64_t passes, std::uint64_t seed) {
  RenderOptions options;
  options.integrator = method;
  options.resolution = {size, size};
  options.passes = passes;
  options.photons = size * size;
  options.seed = seed;
  return options;
}

// Independent renders: their pictures and their error estimates.
struct Runs {
  std::vector<Image> pictures;
  std::vector<ErrorEstimate> said;
  Image mean;

  Runs(const std::string& method, std::uint64_t passes, unsigned count,
       const std::map<std::string, std::string>& parameters = {}) {
    for (unsigned seed = 0; seed < count; ++seed) {
      RenderOptions options = options_of(method, passes, seed);
      options.set = parameters;
      const RenderState state = test::render_state(cornell(), options);
      said.push_back(estimate_error(state));
      pictures.push_back(*select_layer(picture_of(state), "color"));
    }
    mean = pictures.front();
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
      double sum = 0;
      for (const Image& picture : pictures) sum += static_cast<double>(picture.pixels[i]);
      mean.pixels[i] = static_cast<float>(sum / count);
    }
  }

  // The root of the mean of min(1, square / (r² + .01 m²)).
  template <class Square>
  static double relative(const Image& truth, Square&& square) {
    double m = 0, sum = 0;
    for (const float r : truth.pixels) m += static_cast<double>(r) / static_cast<double>(truth.pixels.size());
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
      const auto r = static_cast<double>(truth.pixels[i]);
      sum += std::min(1.0, square(i) / (r * r + 0.01 * m * m));
    }
    return std::sqrt(sum / static_cast<double>(truth.pixels.size()));
  }
  // Root mean square of the pictures' errors. The mean of the pictures is closer to each of them than the truth.
  double true_noise() const {
    const auto count = static_cast<double>(pictures.size());
    double sum = 0;
    for (const Image& picture : pictures) {
      const auto off = [&](std::size_t i) {
        return static_cast<double>(picture.pixels[i]) - static_cast<double>(mean.pixels[i]);
      };
      sum += std::pow(relative(mean, [&](std::size_t i) { return off(i) * off(i) * count / (count - 1); }), 2);
    }
    return std::sqrt(sum / count);
  }
};

class NoiseOf : public testing::TestWithParam<const char*> {};

TEST_P(NoiseOf, AMethodIsKnownWithinAFifth) {
  const Runs runs(GetParam(), 32, 12);
  double said = 0;
  for (const ErrorEstimate& error : runs.said) said += error.noise / static_cast<double>(runs.said.size());
  EXPECT_NEAR(said / runs.true_noise(), 1, 0.2);
}
INSTANTIATE_TEST_SUITE_P(Methods, NoiseOf,
                         testing::Values("path", "light", "bdpt", "vcm", "auto", "probppm", "sppm", "mlt"));

// A radius that does not shrink, so that the bias far exceeds the noise.
class BiasOf : public testing::TestWithParam<const char*> {};

TEST_P(BiasOf, AMethodIsKnown) {
  const Runs biased(GetParam(), 32, 8, {{"radius", "0.15"}, {"alpha", "1"}});
  static const Image truth = Runs("bdpt", 512, 4).mean;
  const double true_bias = Runs::relative(truth, [&](std::size_t i) {
    return std::pow(static_cast<double>(biased.mean.pixels[i]) - static_cast<double>(truth.pixels[i]), 2);
  });
  double said = 0;
  for (const ErrorEstimate& error : biased.said) said += error.bias / static_cast<double>(biased.said.size());
  EXPECT_NEAR(said / true_bias, 1, 0.3);
}
INSTANTIATE_TEST_SUITE_P(Methods, BiasOf, testing::Values("vcm", "probppm", "sppm"));

// Renders that stop when their estimated error is below a bound, compared with a far better picture. The 90 % bound
// must hold about as often, over scenes and methods of different kinds.
class Promise : public testing::TestWithParam<double> {};

RenderState render_to(const Scene& scene, const std::string& method, double noise, std::uint64_t seed) {
  constexpr std::uint64_t most_passes = 1 << 14;
  RenderOptions options = options_of(method, most_passes, seed);
  options.noise = noise;
  return test::render_state(scene, options);
}

TEST_P(Promise, IsKept) {
  struct Kind {
    const char* scene;
    std::vector<const char*> methods;
  };
  const std::vector<Kind> kinds{{"cornell-diffuse", {"auto", "path", "bdpt", "vcm", "probppm"}},
                                {"glossy", {"auto", "path", "vcm", "sppm"}},
                                {"cornell-caustics", {"auto", "vcm", "probppm", "sppm"}},
                                {"ring", {"auto", "vcm", "probppm"}},
                                {"lamp-in-glass", {"auto", "vcm", "probppm"}},
                                {"ball-in-fog", {"auto", "vcm"}}};
  constexpr unsigned runs = 10, seed_of_truth = 1000;
  int kept = 0, all = 0;
  for (const Kind& kind : kinds) {
    const Scene scene(read_scene(std::string(LANTHORN_SOURCE_DIR "/scenes/") + kind.scene + ".pbrt"));
    const RenderState best = render_to(scene, "vcm", GetParam() / 4, seed_of_truth);
    const Image truth = *select_layer(picture_of(best), "color");
    const double own = estimate_error(best).error;
    for (const char* const method : kind.methods) {
      int kept_by_method = 0;
      for (unsigned seed = 0; seed < runs; ++seed) {
        const RenderState state = render_to(scene, method, GetParam(), seed);
        ASSERT_TRUE(estimate_error(state).is_below(GetParam())) << kind.scene << " by " << method;
        const Image color = *select_layer(picture_of(state), "color");
        const double error = Runs::relative(truth, [&](std::size_t i) {
          return std::pow(static_cast<double>(color.pixels[i]) - static_cast<double>(truth.pixels[i]), 2);
        });
        kept_by_method += error * error - own * own < GetParam() * GetParam() ? 1 : 0;
      }
      std::printf("%s by %s: %d of %u\n", kind.scene, method, kept_by_method, runs);
      kept += kept_by_method;
      all += static_cast<int>(runs);
    }
  }
  EXPECT_GE(kept, 0.85 * all) << "of " << all;
}
INSTANTIATE_TEST_SUITE_P(Nightly, Promise, testing::Values(0.1));

}  // namespace
}  // namespace lanthorn::error_estimate_test
