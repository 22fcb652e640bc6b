// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes in which a single term of light transport determines most of the light, so that an integrator without it is
// far from path tracing: Welch's t-test per tile, and of the whole image's mean.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "lanthorn/metrics.h"
#include "photon/photon.h"
#include "support/runs.h"
#include "support/shapes.h"

namespace lanthorn::isolated_terms_test {
namespace {

const std::string film =
    R"(Film "rgb" "integer xresolution" [16] "integer yresolution" [16]
PixelFilter "box" "float xradius" [0.5] "float yradius" [0.5]
WorldBegin
)";

// The camera sees a floor lit only by a panel above it; the spot light's cone misses the floor. The panel's shading
// normal n_s is tilted by 50 degrees from its geometric normal n_g, towards the light: photons that leave it along w
// need the factor |l.n_s| |w.n_g| / (|l.n_g| |w.n_s|) (Veach 1997, eq. 5.19). Integrated over the panel, omitting it
// leaves 0.24 (left) to 0.56 (right) of the floor's light.
const std::string tilted_panel =
    R"(LookAt 0 1.3 2.2  0 0 0  0 1 0
Camera "perspective" "float fov" [24]
)" + film +
    R"(LightSource "spot" "rgb I" [50 50 50] "point3 from" [1.685 0.086 0] "point3 to" [0 1.5 0] "float coneangle" [20] "float conedeltaangle" [0.1]
Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
)" + test::quad("-3 0 3  3 0 3  3 0 -3  -3 0 -3") +
    R"(Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point3 P" [-0.5 1.5 -0.5  0.5 1.5 -0.5  0.5 1.5 0.5  -0.5 1.5 0.5]
  "normal N" [0.766 -0.643 0  0.766 -0.643 0  0.766 -0.643 0  0.766 -0.643 0]
)";

// The same with a mirroring panel, and a lamp behind a screen, so that the floor gets only the panel's reflection. By
// the shading normal alone, some of the reflected directions lead below the panel's surface; the surface's plane
// reflects these once more.
std::string tilted(const std::string& material) {
  return R"(LookAt 0 1.3 2.2  0 0 0  0 1 0
Camera "perspective" "float fov" [24]
)" + film +
         R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [20 20 20]
)" + test::quad("3 0.75 -1  3 0.75 1  3 1.35 1  3 1.35 -1") +
         R"(AttributeEnd
Material "diffuse" "rgb reflectance" [0 0 0]
)" + test::quad("2 -1 -4  2 -1 4  2 0.95 4  2 0.95 -4") +
         R"(Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
)" + test::quad("-1.9 0 3  1.9 0 3  1.9 0 -3  -1.9 0 -3") +
         material +
         R"(Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point3 P" [-0.5 1.5 -0.5  0.5 1.5 -0.5  0.5 1.5 0.5  -0.5 1.5 0.5]
  "normal N" [0.766 -0.643 0  0.766 -0.643 0  0.766 -0.643 0  0.766 -0.643 0]
)";
}
const std::string tilted_mirror = tilted(R"(Material "conductor" "rgb reflectance" [0.8 0.8 0.8]
)");
const std::string tilted_metal = tilted(
    R"(Material "conductor" "rgb reflectance" [0.8 0.8 0.8] "float roughness" [0.2] "bool remaproughness" [false]
)");
const std::string tilted_coat =
    tilted(R"(Material "coateddiffuse" "rgb reflectance" [0.05 0.05 0.05] "float roughness" [0]
)");

// A mirror inside a white emitting sphere. Via the mirror, the eye path has already scattered once before it gathers;
// photons that have scattered max_depth times exceed the limit by one. With them, the light of depth 2 (emission
// reflected once) would be 0.8² / (1 + 0.8) = 36 % too bright, that of depth 3 21 %.
const std::string mirror_in_white_sphere =
    R"(LookAt 0 0 0.3  0 0 -1  0 1 0
Camera "perspective" "float fov" [40]
)" + film +
    R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [0.5 0.5 0.5]
Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
ReverseOrientation
Shape "sphere"
AttributeEnd
Material "conductor" "rgb reflectance" [0.9 0.9 0.9]
Translate 0 0 -0.5
Shape "disk" "float radius" [0.5]
)";

// A metal at whose roughness gathering and walking on are equally likely, under a large light. The walk's hits of the
// light have most of the MIS weight where the lobe (peak density 1 / (4 pi alpha²) = 8 per steradian, half of it in the
// weight) is denser than next-event estimation (about 2 per steradian), and carry half of the light unless their share
// is removed again: the image would be 14 % darker (measured).
const std::string rough_metal_under_light =
    R"(LookAt 0 0 2  0 0 0  0 1 0
Camera "perspective" "float fov" [36]
)" + film +
    R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [1 1 1]
)" + test::quad("-1 1 3  1 1 3  1 -1 3  -1 -1 3") +
    R"(AttributeEnd
Material "conductor" "float roughness" [0.1] "bool remaproughness" [false]
)" + test::quad("-2 -2 0  2 -2 0  2 2 0  -2 2 0");

// A lamp near the floor of a white box: photons are 20 times as dense below it as at the camera's left, and the radii
// of pixels differ accordingly. At least half of the light is indirect.
const std::string lamp_near_floor =
    R"(LookAt 0 0.9 0.9  0 0 -0.2  0 1 0
Camera "perspective" "float fov" [70]
)" + film +
    R"(Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
AttributeBegin
ReverseOrientation
Shape "sphere" "float radius" [1.5]
AttributeEnd
)" + test::quad("-2 0 2  2 0 2  2 0 -2  -2 0 -2") +
    R"(AreaLightSource "diffuse" "rgb L" [20 20 20]
Translate 0.4 0.3 -0.3
Shape "sphere" "float radius" [0.05]
)";

// When the shutter opens, a lid hides the lamp from everything but itself; when it closes, the lid is gone: the floor
// gets part of the unobstructed light, but none from light paths that all use the first moment.
const std::string moving_lid = R"(LookAt 0 1.5 2.2  0 0 0  0 1 0
Camera "perspective" "float fov" [30]
)" + film +
                               R"(LightSource "point" "rgb I" [2 2 2] "point3 from" [0 1.2 0]
Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
)" + test::quad("-2 0 2  2 0 2  2 0 -2  -2 0 -2") +
                               "ActiveTransform EndTime\nTranslate 2 0 0\nActiveTransform All\n" +
                               test::quad("-1 1 1  1 1 1  1 1 -1  -1 1 -1");

// The white sphere again, seen through more invisible panes of glass than photons are recorded for: light scattered in
// the sphere, 2 of 2.5, must be found by the walk.
std::string sphere_behind_panes() {
  std::string scene =
      R"(LookAt 0 0 0.3  0 0 -1  0 1 0
Camera "perspective" "float fov" [40]
)" + film +
      R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [0.5 0.5 0.5]
Material "diffuse" "rgb reflectance" [0.8 0.8 0.8]
ReverseOrientation
Shape "sphere"
AttributeEnd
Material "thindielectric" "float eta" [1]
Translate 0 0 0.298
)";
  for (int i = 0; i < PhotonFlags::most_eye_scatterings + 2; ++i)
    scene += R"(Translate 0 0 -0.002
Shape "disk" "float radius" [0.1]
)";
  return scene;
}

struct Case {
  std::string name;
  std::string scene;
  std::string integrator;  ///< against path
  int max_depth;
  std::uint64_t path_passes;
  std::uint64_t passes;
};

// bpm and mlt trace light paths as vcm and bdpt do.
const std::vector<Case> cases{
    {"adjoint_of_shading_normals", tilted_panel, "light", 4, 48, 2},
    {"adjoint_of_shading_normals", tilted_panel, "probppm", 4, 48, 5},
    {"adjoint_of_shading_normals", tilted_panel, "bdpt", 4, 48, 4},
    {"adjoint_of_bent_mirrors", tilted_mirror, "light", 4, 48, 2},
    {"adjoint_of_bent_mirrors", tilted_mirror, "probppm", 4, 48, 5},
    {"adjoint_of_bent_mirrors", tilted_mirror, "vcm", 4, 48, 4},
    {"adjoint_of_bent_metals", tilted_metal, "light", 4, 48, 2},
    {"adjoint_of_bent_metals", tilted_metal, "vcm", 4, 48, 4},
    {"adjoint_of_bent_coats", tilted_coat, "light", 4, 96, 4},
    {"depth_of_photons_and_eye", mirror_in_white_sphere, "probppm", 2, 4, 1},
    {"depth_of_photons_and_eye", mirror_in_white_sphere, "vcm", 2, 4, 1},
    {"depth_of_photons_and_eye", mirror_in_white_sphere, "probppm", 3, 4, 1},
    {"radius_of_each_pixel", lamp_near_floor, "vcm:radius=pixel", 4, 32, 6},
    {"time_of_light_paths", moving_lid, "light", 2, 16, 2},
    {"time_of_light_paths", moving_lid, "probppm", 2, 16, 2},
    {"time_of_light_paths", moving_lid, "vcm", 2, 16, 2},
    {"time_of_light_paths", moving_lid, "mlt", 2, 16, 1},
    {"eye_beyond_photons", sphere_behind_panes(), "probppm", 100, 2, 1},
    {"share_of_direct_light", rough_metal_under_light, "probppm", 1, 4, 4},
};
const std::vector<Case> nightly_cases{
    {"adjoint_of_shading_normals", tilted_panel, "bpm", 4, 48, 5},
    {"adjoint_of_shading_normals", tilted_panel, "mlt", 4, 48, 2},
};

std::vector<Image> runs(const Scene& scene, const Case& c, const std::string& integrator, std::uint64_t passes,
                        std::uint64_t first_seed) {
  RenderOptions options = test::options_for(integrator, passes);
  options.color = ColorMode::rgb;
  options.max_depth = c.max_depth;
  options.photons = 20'000;
  if (test::has_radius(integrator)) options.set.emplace("radius", "0.03");
  return test::select_layers(test::independent_renders(scene, options, 32, first_seed), "color");
}

class IsolatedTerm : public testing::TestWithParam<Case> {};

TEST_P(IsolatedTerm, AgreesWithPath) {
  const Case& c = GetParam();
  const Scene scene = test::scene_from_text(c.scene);
  const std::vector<Image> reference = runs(scene, c, "path", c.path_passes, 100);
  const std::vector<Image> other = runs(scene, c, c.integrator, c.passes, 200);
  EXPECT_TRUE(test::tiles_agree(other, reference, test::false_alarm_rate / 2));
  EXPECT_TRUE(test::runs_agree(test::mean_of_means(other), test::mean_of_means(reference), 0.005, 0.2,
                               test::false_alarm_rate / 2));
}

std::string case_name(const testing::TestParamInfo<Case>& c) {
  return test::identifier(c.param.name + "_" + c.param.integrator + "_" + std::to_string(c.param.max_depth));
}

INSTANTIATE_TEST_SUITE_P(Cases, IsolatedTerm, testing::ValuesIn(cases), case_name);
INSTANTIATE_TEST_SUITE_P(Nightly, IsolatedTerm, testing::ValuesIn(nightly_cases), case_name);

}  // namespace
}  // namespace lanthorn::isolated_terms_test
