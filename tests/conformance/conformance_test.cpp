// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Compares renders with an independent renderer's images, by the test described in README.md: with few passes in CI,
// and nightly with 32 times as many, and photons on more scenes.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lanthorn/image_file.h"
#include "lanthorn/metrics.h"
#include "support/render_scene.h"
#include "support/statistics.h"

namespace lanthorn::conformance_test {
namespace {

struct Case {
  std::string scene;
  std::string integrator;
  std::uint64_t passes;  ///< of all runs together
};

// c06 (all light through the globe), c07 and c14 get the samples that a path tracer needs for their caustics. Photons
// are tested on scenes that are hard for path tracing, with fog and with motion. On the other scenes, path tracing
// shows that scenes are read and lit correctly, and transport tests show that photons agree with it.
std::vector<Case> cases() {
  return {{"c01-furnace", "path", 96},
          {"c02-cornell", "path", 96},
          {"c03-cornell-spheres", "path", 144},
          {"c04-cornell-glossy", "path", 96},
          {"c05-ring", "path", 288},
          {"c06-lamp", "path", 192},
          {"c07-pool", "path", 288},
          {"c08-environment", "path", 192},
          {"c09-textures", "path", 96},
          {"c10-lights", "path", 96},
          {"c11-dof", "path", 144},
          {"c12-instances", "path", 96},
          {"c13-fog", "path", 96},
          {"c14-prism", "path", 288},
          {"c15-layers", "path", 96},
          {"c16-motion", "path", 96},
          {"c05-ring", "probppm", 72},
          {"c06-lamp", "probppm", 72},
          {"c07-pool", "probppm", 72},
          {"c13-fog", "probppm", 48},
          {"c14-prism", "probppm", 144},
          {"c16-motion", "probppm", 144}};
}

std::vector<Case> nightly_cases() {
  std::vector<Case> all = cases();
  for (const char* scene : {"c02-cornell", "c03-cornell-spheres", "c04-cornell-glossy", "c08-environment", "c10-lights",
                            "c11-dof", "c12-instances"})
    all.push_back({scene, "probppm", 72});
  for (Case& c : all) c.passes *= 32;
  return all;
}

class Conformance : public testing::TestWithParam<Case> {};

TEST_P(Conformance, AgreesWithReference) {
  const std::filesystem::path folder = LANTHORN_SOURCE_DIR "/tests/conformance";
  const Case& c = GetParam();

  const Scene scene(read_scene(folder / "scenes" / (c.scene + ".pbrt")));
  std::vector<Image> runs;
  // A few runs underestimate the noise of tiles with caustics. Photon radii shrink from pass to pass: use fewer runs.
  const std::uint64_t count = c.integrator == "path" ? 12 : 4;
  const std::uint64_t passes = c.passes / count;
  for (std::uint64_t run = 1; run <= count; ++run) {
    RenderOptions options = test::options_for(c.integrator, passes, run);
    options.color = ColorMode::spectral;
    runs.push_back(*select_layer(test::render_image(scene, options), "color"));
  }
  const Image reference = *select_layer(read_image(folder / "references" / (c.scene + ".exr")), "color");
  const Image sem = *select_layer(read_image(folder / "references" / (c.scene + ".sem.exr")), "color");
  const Agreement result = agreement_with_reference(reference, sem, runs);
  std::printf(
      "%s by %s, %llu x %llu passes: mean %+.2f %% (standard error %.2f %%), %.1f %% of tiles off, relMSE %.1e\n",
      c.scene.c_str(), c.integrator.c_str(), static_cast<unsigned long long>(count),
      static_cast<unsigned long long>(passes), 100 * result.mean_difference, 100 * result.mean_error,
      100 * result.outliers, result.rel_mse);
  test::note_share_of_limit(
      std::fmax(result.outliers / 0.03, std::fabs(result.mean_difference) / std::fmax(0.01, 4 * result.mean_error)));
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
INSTANTIATE_TEST_SUITE_P(Nightly, Conformance, testing::ValuesIn(nightly_cases()), case_name);

}  // namespace
}  // namespace lanthorn::conformance_test
