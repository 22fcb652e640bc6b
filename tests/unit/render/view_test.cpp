// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/view.h"

#include <gtest/gtest.h>

#include <string>

#include "support/error_text.h"
#include "support/open_box.h"
#include "support/render_scene.h"

namespace lanthorn {
namespace {

Image render_by(const Scene& scene, const View& view, const RenderOptions& options) {
  Session session = open_session(scene, view, options);
  RenderStatistics statistics;
  const RenderState state = render(scene, session, Observer{}, statistics);
  return state.film.resolve(state.pass_count());
}

// One scene, seen from where another file's camera stands: the picture is that of the other file.
TEST(View, IsNoPartOfTheScene) {
  const Scene scene = test::scene_from_text(test::camera + test::box);
  const Scene other = test::scene_from_text(
      "LookAt 0.5 1.5 3  0 0.8 0  0 1 0\n"
      "Camera \"perspective\" \"float fov\" [50] \"float lensradius\" [0.05] \"float focaldistance\" [3]\n"
      "Film \"rgb\" \"integer xresolution\" [20] \"integer yresolution\" [16]\nPixelFilter \"triangle\"\nWorldBegin\n" +
      test::box);
  for (const char* integrator : {"path", "light", "probppm", "sppm", "vcm", "mlt", "photonmap"}) {
    RenderOptions options = test::options_for(integrator, 2);
    options.photons = 1000;
    options.crop = {2, 1, 18, 15};
    const View view = make_view(other.description(), options);
    const Image moved = render_by(scene, view, options);
    EXPECT_EQ(moved.width, 16);
    EXPECT_EQ(moved.pixels, test::render_image(other, options).pixels) << integrator;
  }
}

TEST(View, ErrorsSayWhatWasExpected) {
  const SceneDescription description = read_pbrt_string(test::camera, ".", "t.pbrt");
  const auto error_of = [&](const ViewOptions& options) {
    return test::error_text([&] { make_view(description, options); });
  };
  EXPECT_EQ(error_of({}), "no error");
  EXPECT_NE(error_of({{{0, 4}}, {}}).find("--resolution 0x4: expected WIDTHxHEIGHT"), std::string::npos);
  EXPECT_NE(error_of({{}, {{0, 0, 25, 4}}}).find("--crop 0,0,25,4: expected x0,y0,x1,y1"), std::string::npos);
  EXPECT_EQ(error_of({{{100, 100}}, {{0, 0, 25, 4}}}), "no error");
}

}  // namespace
}  // namespace lanthorn
