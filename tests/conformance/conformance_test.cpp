// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Agreement with an independent renderer's images: ../shared/conformance, by the test that its README gives. Built
// twice: with the passes that fit CI, and (label nightly) with CONFORMANCE_EFFORT times as many.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "film/metrics.h"
#include "io/image.h"
#include "support/render_scene.h"
#include "support/shared_dir.h"

namespace lanthorn {
namespace {

struct Case {
  std::string scene;
  std::string integrator;
  std::uint64_t passes;  ///< per run in CI
};

// c06 (all light through the globe), c07 and c14 get the samples that a path tracer needs for their caustics.
std::vector<Case> cases() {
  return {{"c01-furnace", "path", 32},
          {"c02-cornell", "path", 32},
          {"c03-cornell-spheres", "path", 48},
          {"c04-cornell-glossy", "path", 32},
          {"c05-ring", "path", 96},
          {"c06-lamp", "path", 64},
          {"c07-pool", "path", 96},
          {"c08-environment", "path", 64},
          {"c09-textures", "path", 32},
          {"c10-lights", "path", 32},
          {"c11-dof", "path", 48},
          {"c12-instances", "path", 32},
          {"c13-fog", "path", 32},
          {"c14-prism", "path", 96},
          {"c15-layers", "path", 32},
          {"c16-motion", "path", 32},
          {"c02-cornell", "probppm", 24},
          {"c03-cornell-spheres", "probppm", 24},
          {"c04-cornell-glossy", "probppm", 24},
          {"c05-ring", "probppm", 24},
          {"c06-lamp", "probppm", 24},
          {"c07-pool", "probppm", 24},
          {"c08-environment", "probppm", 24},
          {"c10-lights", "probppm", 24},
          {"c11-dof", "probppm", 24},
          {"c12-instances", "probppm", 24},
          {"c13-fog", "probppm", 16},
          {"c14-prism", "probppm", 48},
          {"c16-motion", "probppm", 48}};
}

class Conformance : public testing::TestWithParam<Case> {};

TEST_P(Conformance, AgreesWithReference) {
  const auto shared = test::shared_dir("conformance");
  if (!shared) GTEST_SKIP();
  const std::filesystem::path folder = *shared;
  const Case& c = GetParam();

  const Scene scene(read_scene(folder / (c.scene + ".pbrt")));
  std::vector<Image> runs;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    RenderOptions options = test::options_for(c.integrator, c.passes * CONFORMANCE_EFFORT, seed);
    options.color = ColorMode::spectral;
    runs.push_back(*select_layer(test::render_image(scene, options), "color"));
  }
  const Image reference = *select_layer(read_image(folder / "refs" / (c.scene + ".exr")), "color");
  const Image sem = *select_layer(read_image(folder / "refs" / (c.scene + ".sem.exr")), "color");
  const Agreement result = agreement_with_reference(reference, sem, runs);
  std::printf("%s by %s, 3 x %llu passes: mean %+.2f %% (standard error %.2f %%), %.1f %% of tiles off, relMSE %.1e\n",
              c.scene.c_str(), c.integrator.c_str(), static_cast<unsigned long long>(c.passes * CONFORMANCE_EFFORT),
              100 * result.mean_difference, 100 * result.mean_error, 100 * result.outliers, result.rel_mse);
  EXPECT_TRUE(result.agrees);
  if (!result.agrees) {
    const std::string file = "conformance-" + c.scene + "-" + c.integrator + ".exr";
    write_exr(file, runs.front());
    std::printf("the first run is in %s\n", std::filesystem::absolute(file).c_str());
  }
}

std::string case_name(const testing::TestParamInfo<Case>& info) {
  std::string name = info.param.scene + "_" + info.param.integrator;
  for (char& c : name)
    if (c == '-') c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Conformance, testing::ValuesIn(cases()), case_name);

}  // namespace
}  // namespace lanthorn
