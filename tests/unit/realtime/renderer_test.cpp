// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "support/opengl.h"
#include "support/render_scene.h"

namespace lanthorn::renderer_test {
namespace {

// A plane under a point light of 5 W/sr at height 2, seen from above.
constexpr const char* plane_and_point = R"(
LookAt 0 3 0  0 0 0  0 0 1
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [32] "integer yresolution" [24]
WorldBegin
LightSource "point" "rgb I" [5 5 5] "point3 from" [0 2 0]
Material "diffuse" "rgb reflectance" [.5 .25 .125]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-4 0 -4  4 0 -4  4 0 4  -4 0 4]
)";

class RendererTest : public test::OpenGl {};

Image frame_of(const std::string& text, const FrameSettings& settings) {
  const Scene scene = test::scene_from_text(text);
  Renderer renderer(scene);
  renderer.draw(make_view(scene.description().view), settings);
  EXPECT_TRUE(renderer.log().messages().empty());
  return renderer.read_layers();
}

TEST_F(RendererTest, DirectLightOfAPointIsThatOfTheInverseSquareLaw) {
  for (const ShadowKind shadows : {ShadowKind::maps, ShadowKind::traced}) {
    FrameSettings settings;
    settings.shadows = shadows;
    const Image image = frame_of(plane_and_point, settings);
    const Scene scene = test::scene_from_text(plane_and_point);
    const View view = make_view(scene.description().view);
    for (int y = 0; y < image.height; y += 5)
      for (int x = 0; x < image.width; x += 5) {
        const Ray ray =
            view.camera.sample_ray(Vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f, Vec2(0), 0).ray;
        const Point p = ray.origin - ray.origin.y / ray.direction.y * ray.direction;
        const float d2 = distance_squared(p, Point(0, 2, 0)), cos = 2 / std::sqrt(d2);
        EXPECT_NEAR(image.at(x, y, 3), 5 * cos / d2 * 0.5f * inv_pi, 2e-4f) << x << ' ' << y;
        EXPECT_NEAR(image.at(x, y, 5), 5 * cos / d2 * 0.125f * inv_pi, 1e-4f) << x << ' ' << y;
      }
  }
}

TEST_F(RendererTest, FramesAreTheSameFromRunToRun) {
  FrameSettings settings;
  settings.indirect = IndirectLight::photons;
  settings.photons.count = 2000;
  EXPECT_EQ(frame_of(plane_and_point, settings).pixels, frame_of(plane_and_point, settings).pixels);
}

// Exits with 0 if the lack of OpenGL is told.
void make_context_without_drivers() {
  setenv("__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent", 1);
  try {
    gl::Context::headless();
  } catch (const gl::Unavailable& e) {
    const std::string text = e.what();
    std::exit(text.find("OpenGL 4.5 core is needed") == 0 && text.find("Install") != std::string::npos ? 0 : 2);
  }
  std::exit(1);
}

TEST(Context, WithoutDriversSaysWhatIsMissing) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a process in which EGL has no drivers yet
  EXPECT_EXIT(make_context_without_drivers(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace lanthorn::renderer_test
