// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/frame/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <tuple>
#include <vector>

#include "lanthorn/metrics.h"
#include "realtime/lights/light_views.h"
#include "support/edited.h"
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
  settings.technique = TechniqueChoice("ispm");
  settings.photons = 2000;
  EXPECT_EQ(frame_of(plane_and_point, settings).pixels, frame_of(plane_and_point, settings).pixels);
}

// A ball on a square plane, in the sun. `h`: half the plane's width.
std::string ball_on_plane(const std::string& h) {
  return R"(
LookAt 0 1.5 -3.5  0 .5 0  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [96] "integer yresolution" [80]
WorldBegin
LightSource "distant" "point3 from" [1 2 -1.5] "point3 to" [0 0 0]
Material "diffuse"
AttributeBegin
Scale )" +
         h + " 1 " + h + R"(
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 -1  1 0 -1  1 0 1  -1 0 1]
AttributeEnd
Translate 0 .6 0
Shape "sphere" "float radius" [.6]
)";
}

// Pixels that maps shade differently than rays do, relative to the pixels in shadow.
struct MapErrors {
  int others = 0, shadowed = 0;
};
MapErrors map_errors(const Scene& scene, FrameSettings settings) {
  const View view = make_view(scene.description().view);
  Renderer renderer(scene);
  const auto frame = [&](ShadowKind shadows) {
    settings.shadows = shadows;
    renderer.draw(view, settings);
    return renderer.read_layers();
  };
  const Image maps = frame(ShadowKind::maps), traced = frame(ShadowKind::traced), lit = frame(ShadowKind::none);
  MapErrors errors;
  for (int y = 0; y < maps.height; ++y)
    for (int x = 0; x < maps.width; ++x) {
      if (maps.at(x, y, 3) != traced.at(x, y, 3)) ++errors.others;
      if (traced.at(x, y, 3) != lit.at(x, y, 3)) ++errors.shadowed;
    }
  return errors;
}

// With maps of few texels, the ball does not shadow itself, but has a shadow.
TEST_F(RendererTest, MapsShadeRoundShapesAsRaysDo) {
  FrameSettings settings;
  settings.views.map_size = 64;
  const auto [others, shadowed] = map_errors(test::scene_from_text(ball_on_plane("4")), settings);
  EXPECT_GT(shadowed, 150);
  // Differences at the edges of the shadow.
  EXPECT_LT(others, 0.4 * shadowed) << shadowed;
}

// A floor under a spot light, half in the shadow of a blade above the camera, with an oblique edge.
constexpr const char* floor_and_blade = R"(
LookAt 0 1.5 0  0 0 0  0 0 1
Camera "perspective" "float fov" [60]
Film "rgb" "integer xresolution" [128] "integer yresolution" [96]
WorldBegin
LightSource "spot" "rgb I" [20 20 20] "point3 from" [0 4 0] "point3 to" [0 0 0] "float coneangle" [35]
Material "diffuse"
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-4 0 -4  4 0 -4  4 0 4  -4 0 4]
Translate 0 2 0
Rotate 15 0 1 0
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [.02 0 -4  4 0 -4  4 0 4  .02 0 4]
)";

// Seen through the blade, the floor has its colour or its shadow.
TEST_F(RendererTest, ShapesHiddenFromTheCameraHaveShadows) {
  const std::string scene = floor_and_blade;
  const std::string text = "LookAt 0 3 0  0 0 0  0 0 1\n" + scene.substr(scene.find("Camera"));
  SceneDescription description = read_pbrt_string(text, ".", "test scene");
  ASSERT_EQ(description.shapes.size(), 2u);
  description.shapes[1].visible_to_camera = false;
  const Scene hidden(description);
  description.shapes.edit().pop_back();
  const Scene without(description);
  const View view = make_view(hidden.description().view);
  for (const ShadowKind shadows : {ShadowKind::maps, ShadowKind::traced}) {
    FrameSettings settings;
    settings.shadows = shadows;
    const auto frame = [&](const Scene& drawn) {
      Renderer renderer(drawn);
      renderer.draw(view, settings);
      return renderer.read_layers();
    };
    const Image shadowed = frame(hidden), lit = frame(without);
    int dark = 0, bright = 0;
    for (int y = 0; y < lit.height; ++y)
      for (int x = 0; x < lit.width; ++x) {
        const float seen = shadowed.at(x, y, 3);
        if (lit.at(x, y, 3) == 0) continue;  // beyond the cone
        ++(seen == 0 ? dark : bright);
        ASSERT_TRUE(seen == 0 || std::fabs(seen / lit.at(x, y, 3) - 1) < 1e-5f) << x << ' ' << y;
      }
    EXPECT_GT(dark, 1000);
    EXPECT_GT(bright, 1000);
  }
}

// A view has no profile, but the light's power.
TEST_F(RendererTest, AreaLightsWithASpreadKeepTheirPower) {
  SceneDescription description =
      read_pbrt_string(std::string(floor_and_blade) + R"(AreaLightSource "diffuse" "rgb L" [3 2 1] Shape "disk"
)",
                       ".", "test scene");
  description.lights.clear();
  const auto views_of = [&] {
    const Scene scene(description);
    return light_views(scene, LightViewSettings{});
  };
  const std::vector<LightView> diffuse = views_of();
  EXPECT_TRUE(light_limitations(Scene(description)).empty());
  description.area_lights.back().spread = 40;
  const std::vector<LightView> narrow = views_of();
  ASSERT_EQ(diffuse.size(), 1u);
  ASSERT_EQ(narrow.size(), 1u);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(narrow[0].colour[c] / diffuse[0].colour[c], 1, 1e-3f) << c;
  EXPECT_EQ(light_limitations(Scene(description)),
            std::vector<std::string>{
                "the spread of 1 area light is not supported: it shines in all directions, with the same power"});
}

// Jaggedness of a straight shadow edge: root mean square of its second differences from row to row, pixels.
double roughness_of_edge(const Scene& scene, FrameSettings settings) {
  const View view = make_view(scene.description().view);
  Renderer renderer(scene);
  renderer.draw(view, settings);
  const Image shadowed = renderer.read_layers();
  settings.shadows = ShadowKind::none;
  renderer.draw(view, settings);
  const Image lit = renderer.read_layers();
  std::vector<double> edges;
  for (int y = 0; y < lit.height; ++y) {
    double& edge = edges.emplace_back();
    for (int x = 0; x < lit.width; ++x) edge += static_cast<double>(shadowed.at(x, y, 3) / lit.at(x, y, 3));
  }
  double sum = 0;
  for (std::size_t y = 1; y + 1 < edges.size(); ++y) {
    const double bend = edges[y + 1] - 2 * edges[y] + edges[y - 1];
    sum += bend * bend;
  }
  return std::sqrt(sum / static_cast<double>(edges.size()));
}

// A texel is five pixels wide. Single texels give a saw-toothed edge. The mean of four texels would keep 0.24 of the
// teeth, the mean of nine keeps 0.13 (both confirmed by simulating the filters).
TEST_F(RendererTest, SoftEdgesHaveNoTeeth) {
  const Scene scene = test::scene_from_text(floor_and_blade);
  double ratios = 0;
  constexpr int count = 8;
  for (std::uint32_t seed = 0; seed < count; ++seed) {
    FrameSettings settings;
    settings.views.map_size = 64;
    settings.views.seed = seed;
    const double hard = roughness_of_edge(scene, settings);
    EXPECT_GT(hard, 0.5) << seed;
    settings.has_soft_edges = true;
    ratios += roughness_of_edge(scene, settings) / hard;
  }
  EXPECT_LT(ratios / count, 0.16);
}

// A texel of the whole plane would be 4 m wide.
TEST_F(RendererTest, SmallThingsHaveShadowsInLargeScenes) {
  const Scene scene = test::scene_from_text(ball_on_plane("400"));
  FrameSettings settings;
  EXPECT_GT(map_errors(scene, settings).others, 150);
  settings.has_light_focus = true;
  const auto [others, shadowed] = map_errors(scene, settings);
  EXPECT_GT(shadowed, 150);
  EXPECT_LT(others, 0.4 * shadowed) << shadowed;
}

// A square 1 cm in front of the eye, on a plane 2 km wide.
TEST_F(RendererTest, NearThingsAreSeenInLargeScenes) {
  FrameSettings settings;
  settings.shadows = ShadowKind::none;
  const Image image = frame_of(R"(
LookAt 0 1 0  0 1 1  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [16] "integer yresolution" [12]
WorldBegin
LightSource "point" "point3 from" [0 1 0]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1000 0 -1000  1000 0 -1000  1000 0 1000  -1000 0 1000]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 .01  1 0 .01  1 2 .01  -1 2 .01]
)",
                               settings);
  EXPECT_GT(image.at(8, 2, 3), 0);
}

// A corner of a room, with an instanced block and a lamp at the given positions.
std::string corner(const std::string& block, const std::string& lamp) {
  return R"(
LookAt 0 1.2 -3.4  0 .6 0  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [48] "integer yresolution" [40]
PixelFilter "box"
WorldBegin
LightSource "point" "rgb I" [3 2 1] "point3 from" [)" +
         lamp + R"(]
Material "diffuse" "rgb reflectance" [.7 .6 .5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 1  1 0 1  1 0 -1  -1 0 -1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 1  1 0 1  1 2 1  -1 2 1]
Material "conductor" "float roughness" [0]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 -1  -1 0 1  -1 2 1  -1 2 -1]
Material "diffuse" "rgb reflectance" [.2 .6 .3]
ObjectBegin "block"
  Shape "trianglemesh" "integer indices" [0 1 4 1 2 4 2 3 4 3 0 4] "point3 P" [-.4 0 0  .3 0 0  .3 0 .6  -.4 0 .6  0 .8 .3]
ObjectEnd
AttributeBegin
Translate )" +
         block + R"(
ObjectInstance "block"
AttributeEnd
)";
}

struct Look {
  const char* name;
  TechniqueChoice technique;
};

Image frame_of(Renderer& renderer, const Scene& scene, const Look& look) {
  FrameSettings settings(look.technique);
  settings.photons = 2000;
  settings.views.map_size = 64;
  renderer.draw(make_view(scene.description().view), settings);
  return renderer.read_layers();
}

// While the eye moves, a pixel of the mirror may show the light of another pixel in its block. All else is the same.
TEST_F(RendererTest, EyePathsMayStandForBlocksOfPixels) {
  const Scene scene = test::scene_from_text(corner("-.2 0 0", ".4 1.5 -.2"));
  const View view = make_view(scene.description().view);
  Renderer renderer(scene);
  FrameSettings settings;
  const auto frame = [&](int spacing) {
    settings.eye_path_spacing = spacing;
    renderer.draw(view, settings);
    return renderer.read_layers();
  };
  const Image exact = frame(1), coarse = frame(4);
  const auto texel = [](const Image& image, int x, int y) {
    std::vector<float> values;
    for (std::size_t c = 0; c < image.channels.size(); ++c) values.push_back(image.at(x, y, c));
    return values;
  };
  int others = 0;
  for (int y = 0; y < exact.height; ++y)
    for (int x = 0; x < exact.width; ++x) {
      const std::vector<float> shown = texel(coarse, x, y);
      if (shown == texel(exact, x, y)) continue;
      ++others;
      bool is_of_block = false;
      for (int v = y / 4 * 4; v < std::min(y / 4 * 4 + 4, exact.height); ++v)
        for (int u = x / 4 * 4; u < x / 4 * 4 + 4; ++u) is_of_block = is_of_block || shown == texel(exact, u, v);
      EXPECT_TRUE(is_of_block) << x << ' ' << y;
    }
  EXPECT_GT(others, 100);
  EXPECT_EQ(frame(1).pixels, exact.pixels);
}

// After a lamp, an object or both have moved, frames are the same as after a fresh start.
TEST_F(RendererTest, FramesFollowObjectsAndLamps) {
  const std::string block_here = "-.2 0 0", block_there = ".4 .1 -.3", lamp_here = ".4 1.5 -.2",
                    lamp_there = "-.6 1.6 -.5";
  const Scene scene = test::scene_from_text(corner(block_here, lamp_here));
  const auto with = [&](bool block, bool lamp) {
    return test::edited(scene, [&](SceneDescription& description) {
      if (block) description.instances[0].object_to_world = AnimatedTransform(translate({0.4, 0.1, -0.3}));
      Transform& place = description.lights[0].light_to_world;
      if (lamp) place = translate({-1, 0.1, -0.3}) * place;
    });
  };
  const std::array looks{Look{"direct", TechniqueChoice("direct", {{"shadows", "maps"}})},
                         Look{"traced", TechniqueChoice("direct", {{"shadows", "traced"}})},
                         Look{"photons", TechniqueChoice("ispm", {{"shadows", "maps"}, {"radius", "0.3"}})},
                         Look{"voxels", TechniqueChoice("voxelcones", {{"shadows", "maps"}, {"bounces", "1"}})}};
  Renderer renderer(scene);
  std::vector<Image> first;
  for (const Look& look : looks) first.push_back(frame_of(renderer, scene, look));
  for (const auto& [moved, block_at, lamp_at] : {std::tuple{with(true, false), block_there, lamp_here},
                                                 {with(false, true), block_here, lamp_there},
                                                 {with(true, true), block_there, lamp_there}}) {
    renderer.update(*moved);
    const Scene there = test::scene_from_text(corner(block_at, lamp_at));
    Renderer fresh(there);
    for (std::size_t i = 0; i < looks.size(); ++i) {
      const Image after = frame_of(renderer, *moved, looks[i]);
      EXPECT_EQ(after.pixels, frame_of(fresh, there, looks[i]).pixels)
          << looks[i].name << ", block at " << block_at << ", lamp at " << lamp_at;
      EXPECT_GT(image_errors(after, first[i]).rel_mse, 0.01) << looks[i].name;
    }
    renderer.update(scene);
  }
}

// A driver that reports a reset.
TEST_F(RendererTest, LostContextIsAnError) {
  const Scene scene = test::scene_from_text(plane_and_point);
  const View view = make_view(scene.description().view);
  Renderer renderer(scene);
  renderer.draw(view, {});
  const auto told = glGetGraphicsResetStatus;
  glGetGraphicsResetStatus = []() -> GLenum { return GL_GUILTY_CONTEXT_RESET; };
  const auto is_told = [](const auto& call) {
    try {
      call();
    } catch (const gl::Unavailable& e) {
      return e.message.find("context was lost") != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(is_told([&] { renderer.draw(view, {}); }));
  EXPECT_TRUE(is_told([&] { renderer.read_layers(); }));
  glGetGraphicsResetStatus = told;
  EXPECT_NO_THROW(renderer.draw(view, {}));
}

// Driver remarks, such as NVIDIA's about recompiled shaders, must not end a frame.
TEST_F(RendererTest, RemarksOfDriversAreNoErrors) {
  const gl::DebugLog log;
  const auto say = [](GLenum type) {
    glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, type, 1, GL_DEBUG_SEVERITY_HIGH, -1, "a remark");
  };
  for (const GLenum type :
       {GL_DEBUG_TYPE_PERFORMANCE, GL_DEBUG_TYPE_PORTABILITY, GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR, GL_DEBUG_TYPE_OTHER})
    say(type);
  EXPECT_NO_THROW(log.check());
  say(GL_DEBUG_TYPE_ERROR);
  EXPECT_THROW(log.check(), Error);
  say(GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR);
  EXPECT_THROW(log.check(), Error);
}

// Exits with 0 if the lack of OpenGL is reported.
void make_context_without_drivers() {
  unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");  // takes precedence over the other
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
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a process whose EGL has no drivers yet
  EXPECT_EXIT(make_context_without_drivers(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace lanthorn::renderer_test
