// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A model in a user-chosen environment, through a user-chosen lens, from all sides.
#include "scene_changes.h"

#include <glm/geometric.hpp>

#include "cli_fixture.h"
#include "lanthorn/error.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "support/gltf_writer.h"

namespace lanthorn::lens_test {
namespace {

using namespace program;

class Lens : public Cli {
 protected:
  Lens() {
    // A long thin box, 4 x 1 x 1, around (5, 0, 0), which the camera frames.
    dir_.write("bar.obj",
               "v 3 -.5 -.5\nv 7 -.5 -.5\nv 7 .5 -.5\nv 3 .5 -.5\nv 3 -.5 .5\nv 7 -.5 .5\nv 7 .5 .5\nv 3 .5 .5\n"
               "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 2 3 7 6\nf 1 5 8 4\n");
    test::GltfWriter file;
    file.mesh({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {0, 1, 2});
    const auto node = file.node({{"mesh", 0}});
    const nlohmann::json sampler = {{"input", file.accessor<float>({0, 2}, 1)},
                                    {"output", file.accessor<float>({0, 0, 0, 8, 0, 0}, 3)}};
    file.add("animations", {{"samplers", {sampler}},
                            {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}});
    for (const auto& [name, z] : {std::pair{"Wide", 4}, std::pair{"Close-up", 2}}) {
      const auto camera = file.add("cameras", {{"type", "perspective"},
                                               {"name", std::string(name) + ".lens"},
                                               {"perspective", {{"yfov", 1.0}, {"znear", .01}}}});
      file.node({{"camera", camera}, {"name", name}, {"translation", {0, 0, z}}});
    }
    dir_.write("moves.gltf", file.text());
  }
  SharedScene scene(const std::string& name) const { return build_scene(read_scene(path(name))); }
  static ViewDescription changed(const Scene& scene, const LensChanges& lens) {
    ViewDescription view = description_of(scene).view;
    change_lens(view, lens, scene, {});
    return view;
  }
  static Point eye_of(const ViewDescription& view) { return camera_placement(view).point(Point(0)); }
  /// One pass of `path`, small and quiet.
  static Words quick(const std::string& name, const Words& more) {
    return Words{"render", name, "-i", "path", "-p", "1", "-r", "16x16", "-q", "--reproducible"} + more;
  }
  static const description::PerspectiveCamera& lens_of(const ViewDescription& view) {
    return std::get<description::PerspectiveCamera>(view.camera.node);
  }
};

// A 50 mm lens with a film height of 24 mm has a field of view of 27 degrees; at f/2 its diameter is 25 mm.
TEST_F(Lens, AnFNumberIsThatOfAPhotographer) {
  const SharedScene tiny = scene("tiny.pbrt");
  const ViewDescription view = changed(*tiny, {.fov = 26.9915f, .aperture = 2.0f, .focus = LensChanges::Focus(3.0f)});
  EXPECT_FLOAT_EQ(lens_of(view).fov, 26.9915f);
  EXPECT_NEAR(lens_of(view).lens_radius, 0.0125f, 1e-6f);
  EXPECT_FLOAT_EQ(lens_of(view).focal_distance, 3);
}

TEST_F(Lens, FocusesOnWhatTheMiddleSees) {
  const SharedScene tiny = scene("tiny.pbrt");
  // The eye is at z = 4.4 and looks through y = 1 at the wall at z = -1; below that, at the front of the glass ball.
  EXPECT_NEAR(lens_of(changed(*tiny, {.aperture = 8.0f})).focal_distance, 5.4f, 1e-4f);
  dir_.write("ball.pbrt", std::string(R"(LookAt 0.2 .4 4.2  0.2 .4 0  0 1 0
Camera "perspective"
)") + std::string(tiny_scene).substr(std::string(tiny_scene).find("Film")));
  EXPECT_NEAR(lens_of(changed(*scene("ball.pbrt"), {.aperture = 8.0f})).focal_distance, 3.6f, 1e-4f);
  // A framed model, in units of the camera.
  const ViewDescription bar = changed(*scene("bar.obj"), {.aperture = 8.0f, .focus = LensChanges::Focus()});
  const Transform to_camera = camera_placement(bar).inverted();
  EXPECT_GT(lens_of(bar).focal_distance, 1);
  EXPECT_LT(lens_of(bar).focal_distance, to_camera.point({5, 0, 0}).z);
  EXPECT_GT(lens_of(bar).focal_distance, to_camera.point({5, 0, 0}).z - 2.2f);
}

// A page shows the lens as the options set it; a pinhole has no focus.
TEST_F(Lens, TellsWhatItIs) {
  const SharedScene tiny = scene("tiny.pbrt");
  const ViewDescription open = changed(*tiny, {.fov = 30.0f, .aperture = 2.0f, .focus = LensChanges::Focus(3.0f)});
  const LensNumbers numbers = program::lens_of(open);
  EXPECT_FLOAT_EQ(numbers.fov.value(), 30);
  EXPECT_FLOAT_EQ(numbers.aperture.value(), 2);
  EXPECT_FLOAT_EQ(numbers.focus.value(), 3);
  ViewDescription closed = open;
  change_lens(closed, {.aperture = LensChanges::Aperture()}, *tiny, {});
  EXPECT_EQ(lens_of(closed).lens_radius, 0);
  EXPECT_FALSE(program::lens_of(closed).aperture);
  EXPECT_FALSE(program::lens_of(closed).focus);
}

// 5.5 pixels below the middle of 16 x 16 pixels over 40 degrees: the floor, a metre below the eye.
TEST_F(Lens, FocusesOnWhatAPixelSees) {
  const SharedScene tiny = scene("tiny.pbrt");
  const ViewDescription& view = description_of(*tiny).view;
  EXPECT_NEAR(focus_at(view, *tiny, {}, {8, 13.5f}), 8 / (5.5f * std::tan(0.34906585f)), 1e-4f);
  EXPECT_NEAR(focus_at(view, *tiny, {}, {8, 8}), 5.4f, 1e-4f);
  EXPECT_THROW(focus_at(view, *tiny, {}, {0.5f, 0.5f}), Error) << "nothing is there";
}

TEST_F(Lens, OrbitsAroundTheMiddleOfTheScene) {
  const SharedScene tiny = scene("tiny.pbrt");
  const Point middle(0, 1, 0);  // centre of the bounds, at the height of the eye
  const auto expect_eye = [&](const Orbit& orbit, const Point& expected) {
    const ViewDescription view = changed(*tiny, {.orbit = orbit});
    EXPECT_LT(glm::length(eye_of(view) - expected), 1e-3f) << orbit.yaw << ' ' << orbit.pitch << ' ' << eye_of(view).x;
    const Vec3 axis = glm::normalize(camera_placement(view).vector({0, 0, 1}));
    EXPECT_LT(glm::length(glm::cross(axis, middle - eye_of(view))), 1e-3f) << "still in the middle";
  };
  const float r = 4.4f;
  // pbrt's worlds are left-handed: -x is to the right of a camera at +z.
  expect_eye({0, 0}, {0, 1, r});
  expect_eye({90, 0}, {-r, 1, 0});
  expect_eye({-90, 0}, {r, 1, 0});
  expect_eye({180, 30}, {0, 1 + r * 0.5f, -r * std::sqrt(0.75f)});
  // The camera does not pass over the pole.
  EXPECT_GT(eye_of(changed(*tiny, {.orbit = Orbit{0, 200}})).z, 0);
  // A framed model, in the right-handed world of OBJ files.
  const SharedScene bar = scene("bar.obj");
  const Point before = eye_of(description_of(*bar).view) - Point(5, 0, 0),
              after = eye_of(changed(*bar, {.orbit = Orbit{90, 0}})) - Point(5, 0, 0);
  EXPECT_NEAR(std::atan2(after.x, after.z) - std::atan2(before.x, before.z), 1.5708f, 0.05f);
  EXPECT_NEAR(after.y / glm::length(after), before.y / glm::length(before), 0.02f) << "as high above the horizon";
}

TEST_F(Lens, ATurntableStaysEquallyFarAway) {
  const SharedScene bar = scene("bar.obj");
  const std::vector<ViewDescription> views = turntable(description_of(*bar).view, *bar, 8);
  ASSERT_EQ(views.size(), 8u);
  const Point middle(5, 0, 0);
  const float distance = glm::length(eye_of(views[0]) - middle);
  for (const ViewDescription& view : views) {
    EXPECT_NEAR(glm::length(eye_of(view) - middle), distance, 1e-3f * distance);
    // All corners are inside the picture.
    const Transform to_camera = camera_placement(view).inverted();
    const float tangent = std::tan(0.5f * lens_of(view).fov * 3.14159f / 180);
    for (int corner = 0; corner < 8; ++corner) {
      const Point p = to_camera.point({corner & 1 ? 3 : 7, corner & 2 ? -.5 : .5, corner & 4 ? -.5 : .5});
      EXPECT_LT(std::fabs(p.y), tangent * p.z);
      EXPECT_LT(std::fabs(p.x), tangent * 16 / 9 * p.z);
    }
  }
  EXPECT_LT(glm::length(eye_of(views[4]) + eye_of(views[0]) - 2.0f * Point(5, eye_of(views[0]).y, 0)), 1e-2f);
}

// The same bar on a much larger ground is framed from every direction as if it stood alone.
TEST_F(Lens, GroundsAreNotFramed) {
  dir_.write("stage.obj", bytes("bar.obj") + "o ground\nusemtl g\nv -90 -.5 -90\nv 90 -.5 -90\nv 90 -.5 90\n" +
                              "v -90 -.5 90\nf 9 12 11 10\n");
  const SharedScene bar = scene("bar.obj"), stage = scene("stage.obj");
  const auto expect_alike = [&](const ViewDescription& a, const ViewDescription& b, int i) {
    EXPECT_LT(glm::length(eye_of(a) - eye_of(b)), 0.02f * glm::length(eye_of(a) - Point(5, 0, 0))) << i;
  };
  expect_alike(changed(*bar, {.orbit = Orbit{40, 10}}), changed(*stage, {.orbit = Orbit{40, 10}}), -1);
  const std::vector<ViewDescription> alone = turntable(description_of(*bar).view, *bar, 4),
                                     staged = turntable(description_of(*stage).view, *stage, 4);
  for (std::size_t i = 0; i < 4; ++i) expect_alike(alone[i], staged[i], static_cast<int>(i));
}

TEST_F(Lens, BadOptionsSayWhatWasExpected) {
  dir_.write("flat.pbrt", R"(Camera "orthographic"
WorldBegin
LightSource "infinite"
Shape "sphere"
)");
  refuse(quick("flat.pbrt", {"--fov", "30", "-o", "a.png"}), "--fov: the scene's camera is not a perspective camera");
  refuse(quick("flat.pbrt", {"--aperture", "8", "-o", "a.png"}), "--aperture: the scene's camera is not a perspective");
  refuse(quick("tiny.pbrt", {"--focus", "3", "-o", "a.png"}), "add --aperture");
  refuse(quick("tiny.pbrt", {"--fov", "180", "-o", "a.png"}), "--fov 180: expected a number from 0.01 to 179");
  refuse(quick("tiny.pbrt", {"--orbit", "30", "-o", "a.png"}), "--orbit 30: expected two numbers of degrees");
  refuse(quick("tiny.pbrt", {"--camera", "Wide", "-o", "a.png"}), "--camera: only glTF files have several cameras");
  refuse(quick("tiny.pbrt", {"--variant", "red", "-o", "a.png"}),
         "--variant: only glTF files have variants of their materials");
  refuse(quick("moves.gltf", {"--variant", "red", "-o", "a.png"}), "the file has no variants of its materials");
  refuse(quick("moves.gltf", {"--camera", "close-up", "-o", "a.png"}),
         R"(--camera close-up: the file has "Wide", "Close-up"; did you mean Close-up?)");
}

TEST_F(Lens, CamerasAreChosenByName) {
  const auto picture = [&](const Words& more) {
    succeed(quick("moves.gltf", Words{"-o", "a.exr", "--environment", "overcast"} + more));
    return read_image(path("a.exr")).pixels;
  };
  const auto wide = picture({}), close = picture({"--camera", "Close-up"});
  EXPECT_NE(wide, close);
  EXPECT_EQ(picture({"--camera", "Wide"}), wide);
  EXPECT_EQ(picture({"--camera", "1"}), wide);
  EXPECT_EQ(picture({"--camera", "2"}), close);
  EXPECT_EQ(picture({"--camera", "Close-up.lens"}), close);
  EXPECT_TRUE(contains(succeed({"info", "moves.gltf"}).out, R"(--camera takes another of "Wide", "Close-up")"));
}

TEST_F(Lens, FramesAreThePicturesOfTheirMoments) {
  succeed(quick("moves.gltf", {"--frames", "1:3@8", "-o", "f.###.exr", "-o", "f.###.png", "--json", "f.###.json"}));
  EXPECT_EQ(files(), (Words{"bar.obj", "f.001.exr", "f.001.json", "f.001.png", "f.002.exr", "f.002.json", "f.002.png",
                            "moves.gltf", "tiny.pbrt"}));
  succeed(quick("moves.gltf", {"--at", "0.25", "-o", "one.exr"}));
  expect_equal_files("f.002.exr", "one.exr");
  EXPECT_NE(bytes("f.001.exr"), bytes("f.002.exr"));
}

double brightness(const Image& image) {
  double sum = 0;
  for (const float value : image.pixels) sum += static_cast<double>(value);
  return sum / static_cast<double>(image.pixels.size());
}

// A ball lit from behind the camera; its dark side is not brightened.
TEST_F(Lens, PicturesOfATurntableHaveOneExposure) {
  dir_.write("moon.pbrt",
             R"(LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 30
Film "rgb"
WorldBegin
LightSource "distant" "point3 from" [0 0 1] "point3 to" [0 0 0] "rgb L" [8 8 8]
LightSource "infinite" "rgb L" [.1 .1 .1]
Shape "sphere"
)");
  Words words = quick("moon.pbrt", {"--turntable", "2", "--exposure", "auto", "-o", "m.#.png"});
  std::erase(words, "-q");
  const std::string said = succeed(words).out;
  EXPECT_TRUE(contains(said, "m.0.png: --exposure "));
  EXPECT_FALSE(contains(said, "m.1.png: --exposure "));
  EXPECT_LT(brightness(read_image(path("m.1.png"))), 0.5 * brightness(read_image(path("m.0.png"))));
}

// In a file without a camera, a triangle that moves to the right moves in the picture.
TEST_F(Lens, FramesWithoutACameraHaveThatOfTheFirst) {
  nlohmann::json file = nlohmann::json::parse(bytes("moves.gltf"));
  file.erase("cameras");
  for (nlohmann::json& node : file["nodes"]) node.erase("camera");
  dir_.write("free.gltf", file.dump());
  succeed(quick("free.gltf", {"--frames", "0:2@4", "-o", "f.#.exr"}));
  const auto column = [&](const std::string& name) {
    const Image seen = *select_layer(read_image(path(name)), "albedo");
    double sum = 0, weight = 0;
    for (int y = 0; y < seen.height; ++y)
      for (int x = 0; x < seen.width; ++x) {
        sum += x * static_cast<double>(seen.at(x, y, 0));
        weight += static_cast<double>(seen.at(x, y, 0));
      }
    return sum / weight;
  };
  EXPECT_GT(column("f.1.exr"), column("f.0.exr") + 2);
}

// The scene causes warnings: about two cameras, and about the studio.
TEST_F(Lens, FramesSayEachWarningOnce) {
  const auto count = [](const std::string& text, const std::string& part) {
    int n = 0;
    for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
    return n;
  };
  const auto expect_once = [&](const Words& more) {
    const Ending ending = succeed(Words{"render", "moves.gltf", "-i", "path", "-p", "1", "-r", "16x16"} + more);
    EXPECT_EQ(count(ending.err, "several cameras"), 1) << ending.err;
    EXPECT_EQ(count(ending.err, "a studio of three soft lamps stands in"), 1) << ending.err;
    EXPECT_EQ(count(ending.err, "color rgb:"), 1) << ending.err;
  };
  expect_once({"--frames", "0:3", "-o", "f.#.png"});
  expect_once({"--turntable", "3", "-o", "t.#.png"});
}

TEST_F(Lens, TurntablesAreThePicturesOfOrbits) {
  succeed(quick("tiny.pbrt", {"--turntable", "4", "-o", "t.#.exr", "--aperture", "8"}));
  EXPECT_EQ(files(), (Words{"bar.obj", "moves.gltf", "t.0.exr", "t.1.exr", "t.2.exr", "t.3.exr", "tiny.pbrt"}));
  succeed(quick("tiny.pbrt", {"--orbit", "90,0", "-o", "one.exr", "--aperture", "8"}));
  expect_equal_files("t.1.exr", "one.exr");
  succeed(quick("tiny.pbrt", {"--turntable", "4", "--frames", "2:3", "-o", "p.#.exr", "--aperture", "8"}));
  expect_equal_files("t.2.exr", "p.2.exr");
  EXPECT_FALSE(fs::exists(path("p.3.exr")));
}

TEST_F(Lens, FramesThatCannotBeSayWhy) {
  refuse(quick("tiny.pbrt", {"--turntable", "4", "-o", "t.exr"}), "-o t.exr: expected #### in the name");
  refuse(quick("tiny.pbrt", {"--turntable", "4"}), "--turntable: expected -o NAME.####.png");
  refuse(quick("tiny.pbrt", {"--turntable", "4", "-o", "t.#.exr", "--json", "t.json"}), "--json t.json: expected ####");
  refuse(quick("tiny.pbrt", {"--turntable", "4", "--frames", "2:5", "-o", "t.#.exr"}),
         "--turntable 4 has the frames 0:4");
  refuse(quick("moves.gltf", {"--frames", "0:2", "--at", "1", "-o", "t.#.exr"}), "have their own times");
  refuse(quick("tiny.pbrt", {"--frames", "0:2", "-o", "t.#.exr"}), "only glTF files have animations");
}

TEST_F(Lens, EnvironmentsLightAnyScene) {
  const auto mean_of = [&](const std::string& name, const Words& more) {
    succeed(quick(name, Words{"-o", "a.exr"} + more));
    const Image color = *select_layer(read_image(path("a.exr")), "color");
    double sum = 0;
    for (const float x : color.pixels) sum += static_cast<double>(x);
    return sum / static_cast<double>(color.pixels.size());
  };
  for (const char* name : {"bar.obj", "moves.gltf", "tiny.pbrt"}) {
    SCOPED_TRACE(name);
    EXPECT_NE(mean_of(name, {"--environment", "studio"}), mean_of(name, {"--environment", "overcast"}));
  }
  const double once = mean_of("bar.obj", {"--environment", "overcast"});
  EXPECT_NEAR(mean_of("bar.obj", {"--environment", "overcast", "--environment-scale", "3"}), 3 * once, 1e-3 * once);
  EXPECT_NE(mean_of("bar.obj", {"--environment", "sunny"}),
            mean_of("bar.obj", {"--environment", "sunny", "--environment-rotate", "180"}));
  refuse(quick("bar.obj", {"-o", "a.png", "--environment", "studoi"}),
         "--environment studoi: expected an existing file, or studio or overcast or sunny; did you mean studio?");
  refuse(quick("bar.obj", {"-o", "b.png", "--environment", "moves.gltf"}),
         "moves.gltf: the file is not a supported image");
}

TEST_F(Lens, PicturesForADisplayHaveManyFormats) {
  for (const char* name : {"a.jpg", "a.tif", "a.png"}) {
    succeed(quick("tiny.pbrt", {"-o", name, "--view-transform", "agx", "--exposure", "+1"}));
    EXPECT_EQ(read_image(path(name)).width, 16) << name;
    EXPECT_EQ(metadata_of(name)["integrator"], "path") << name;
    EXPECT_TRUE(contains(succeed({"info", name}).out, "method     path")) << name;
  }
  succeed(quick("tiny.pbrt", {"-o", "b.png", "--view-transform", "agx", "--exposure", "1"}));
  expect_equal_files("a.png", "b.png");
  succeed(quick("tiny.pbrt", {"-o", "a.exr"}));
  succeed({"develop", "a.exr", "c.tiff", "--exposure", "1", "--view-transform", "agx"});
  EXPECT_EQ(read_image(path("c.tiff")).pixels, read_image(path("a.tif")).pixels);
  succeed(quick("tiny.pbrt", {"-o", "d.png", "--view-transform", "filmic", "--exposure", "1"}));
  EXPECT_NE(bytes("d.png"), bytes("b.png"));
  refuse(quick("tiny.pbrt", {"-o", "a.png", "--filmic"}), "option --filmic was removed; write --view-transform filmic");
  refuse(quick("tiny.pbrt", {"-o", "e.png", "--ocio", "nosuch.ocio"}), "no such file");
}

TEST_F(Lens, AWidthHasItsHeightByTheShape) {
  dir_.write("wide.pbrt",
             R"(Film "rgb" "integer xresolution" [300] "integer yresolution" [200]
WorldBegin
LightSource "infinite"
Shape "sphere"
)");
  succeed({"render", "wide.pbrt", "-i", "path", "-p", "1", "-r", "30", "-q", "-o", "a.exr"});
  const Image image = read_image(path("a.exr"));
  EXPECT_EQ(image.width, 30);
  EXPECT_EQ(image.height, 20);
}

TEST_F(Lens, FirstWordsAreUnderstood) {
  succeed({"tiny.pbrt", "-i", "path", "-p", "1", "-r", "8", "-q", "-o", "a.exr"});
  EXPECT_EQ(read_image(path("a.exr")).width, 8);
  refuse({"tinny.pbrt", "-o", "b.exr"}, "scene tinny.pbrt: expected an existing file; did you mean tiny.pbrt?");
  refuse({"render", "./tinypbrt", "-o", "b.exr"}, "did you mean ./tiny.pbrt?");
  refuse({"info", "a.exrr"}, "did you mean a.exr?");
  refuse({"compare", "a.exr", "b.exr"}, "b.exr: no such file; did you mean a.exr?");
  EXPECT_EQ(succeed({"help"}).out, succeed({"--help"}).out);
  EXPECT_EQ(succeed({"help", "render"}).out, succeed({"render", "--help"}).out);
  EXPECT_EQ(succeed({"-v"}).out, succeed({"--version"}).out);
}

}  // namespace
}  // namespace lanthorn::lens_test
