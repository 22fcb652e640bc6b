// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The limit of scattering events per path, which photons record with few bits.
#include <gtest/gtest.h>

#include "index/hash_grid.h"
#include "photon/gather/photon_gather.h"
#include "photon/photon_map.h"
#include "photon/photon_pass.h"
#include "support/render_scene.h"

namespace lanthorn::photon_depth_test {
namespace {

constexpr float radius = 0.3f;

// The light that an eye path gathers in a white sphere after `eye_scatterings` scatterings, from photons whose paths
// have at most `max_depth` scatterings.
float gathered(const Scene& scene, int max_depth, int eye_scatterings, ColorMode color) {
  Sampler pass_sampler = Sampler::for_pass(0, 0);
  const PathDraw draw = draw_time_and_wavelengths(make_view(scene.description().view).camera, color, pass_sampler);
  PhotonTracer tracer;
  tracer.trace(scene, {0, Stream::light, 0, 200}, {.max_depth = max_depth, .roulette_depth = 1000},
               {draw.time, 0, draw.w});
  const auto map = PhotonMap<HashGrid>::build(tracer.chunks(), color, radius);

  const std::optional<SurfacePoint> at =
      scene.intersect(Ray{Point(0), Direction(0, 0, -1), infinity, draw.time}, draw.w);
  WalkState state;
  state.depth = eye_scatterings + 1;
  const SurfaceVertex vertex{state, at.value(), {0, 0, 1}, at->shading.to_local({0, 0, 1}), true};
  const GatheredLight light = gather_photons(map, vertex, {{KernelShape::box}, radius}, draw.w);
  return light.indirect[0] + light.caustic[0];
}

// Ending the same paths earlier by the eye path's number of scatterings yields exactly the same photons.
TEST(PhotonDepth, EyeAndPhotonTogetherObeyTheLimit) {
  const Scene scene = test::scene_from_text(
      R"(WorldBegin
LightSource "point"
Material "diffuse" "rgb reflectance" [0.99 0.99 0.99]
Shape "sphere"
)");
  for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral})
    for (const int max_depth : {3, 63, 64, 65, 200})
      for (const int eye_scatterings : {0, 1, 20, 63}) {
        if (eye_scatterings >= max_depth) continue;
        const float expected = gathered(scene, max_depth - eye_scatterings, 0, color);
        EXPECT_NEAR(gathered(scene, max_depth, eye_scatterings, color), expected, 1e-5f * expected)
            << max_depth << " " << eye_scatterings;
      }
  EXPECT_GT(gathered(scene, 200, 0, ColorMode::rgb), 1.1f * gathered(scene, 137, 0, ColorMode::rgb))
      << "too dark to tell";
}

}  // namespace
}  // namespace lanthorn::photon_depth_test
