// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Uses only the public headers, as an embedding program does.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/image.h"
#include "lanthorn/image_file.h"
#include "lanthorn/photons.h"
#include "lanthorn/rays.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "lanthorn/state.h"
#include "lanthorn/threads.h"
#include "support/temporary_dir.h"

namespace {

using lanthorn::RenderOptions;
using lanthorn::Session;
using lanthorn::SharedScene;

constexpr const char* box = LANTHORN_SOURCE_DIR "/scenes/cornell-caustics.pbrt";

SharedScene load(const std::filesystem::path& file) { return lanthorn::build_scene(lanthorn::read_scene(file)); }

RenderOptions small(const std::string& integrator = "path") {
  RenderOptions options;
  options.integrator = integrator;
  options.passes = 3;
  options.resolution = {24, 16};
  return options;
}

double brightness(const lanthorn::Image& image) {
  const lanthorn::Image color = *lanthorn::select_layer(image, "color");
  return std::accumulate(color.pixels.begin(), color.pixels.end(), 0.0);
}

std::vector<float> pixels_of(const SharedScene& scene, const RenderOptions& options, std::uint64_t passes) {
  Session session(scene, options);
  session.render({.passes = {0, passes}});
  return session.picture().pixels;
}

TEST(Api, RendersALayeredPicture) {
  Session session(load(box), small());
  session.render();
  const lanthorn::Image image = session.picture();
  EXPECT_EQ(image.width, 24);
  EXPECT_EQ(image.height, 16);
  const auto samples = image.find_channel("samples");
  ASSERT_TRUE(samples && image.find_channel("caustic.R") && image.find_channel("R"));
  EXPECT_FLOAT_EQ(image.at(5, 5, *samples), 3);
  double sum = 0;
  for (int x = 0; x < image.width; ++x) sum += static_cast<double>(image.at(x, 8, 0));
  EXPECT_GT(sum, 0.1);
}

TEST(Api, ALayerIsAPictureOfItsOwn) {
  lanthorn::Image image(2, 1, {"R", "G", "B", "caustic.R", "caustic.G", "caustic.B", "depth.Z"});
  image.pixels = {0, 0, 0, 1, 0.2f, 0, 0.5f, 0, 0, 0, 0, 0.2f, 1, 0.25f};
  const lanthorn::Image caustic = *lanthorn::select_layer(image, "caustic");
  EXPECT_EQ(lanthorn::displayed(caustic).pixels, lanthorn::displayed(lanthorn::as_color(caustic)).pixels);
  EXPECT_FLOAT_EQ(lanthorn::displayed(caustic).pixels[0], 1);
  const std::vector<float> depth = lanthorn::displayed(*lanthorn::select_layer(image, "depth")).pixels;
  ASSERT_EQ(depth.size(), 6U);
  EXPECT_GT(depth[2], depth[5]);
  EXPECT_EQ(depth[3], depth[5]);  // grey
  lanthorn::Image without_color(2, 1, {"caustic.R", "caustic.G", "caustic.B", "depth.Z"});
  EXPECT_THROW(lanthorn::displayed(without_color), lanthorn::Error);
}

TEST(Api, PassesOneByOneAreTheSameRender) {
  const SharedScene scene = load(box);
  for (const char* const integrator : {"probppm", "sppm", "vcm", "mlt", "photonmap"}) {
    Session session(scene, small(integrator));
    while (session.pass_count() < 3) ASSERT_TRUE(session.render_pass());
    EXPECT_EQ(session.picture().pixels, pixels_of(scene, small(integrator), 3)) << integrator;
  }
}

TEST(Api, ASandboxedSceneReadsItsOwnFolderAlone) {
  const lanthorn::test::TemporaryDir dir;
  std::filesystem::create_directory(dir.path() / "upload");
  dir.write("outside.pbrt", R"(LightSource "point"
)");
  dir.write("upload/scene.pbrt", R"(WorldBegin
Include "../outside.pbrt"
Shape "sphere"
)");
  EXPECT_NO_THROW(lanthorn::read_scene(dir.path() / "upload/scene.pbrt"));
  EXPECT_THROW(lanthorn::read_scene(dir.path() / "upload/scene.pbrt", {.sandbox = true}), lanthorn::Error);
}

TEST(Api, MeshesAreReadFromPlyFiles) {
  const lanthorn::test::TemporaryDir dir;
  dir.write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 "
      "2 3\n");
  const auto shapes = lanthorn::read_mesh(dir.path() / "a.ply");
  ASSERT_EQ(shapes.size(), 2u);
  EXPECT_EQ(std::get<lanthorn::description::TriangleMesh>(shapes[0].geometry).triangles.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<lanthorn::description::BilinearMesh>(shapes[1].geometry));
  lanthorn::SceneDescription scene;
  scene.materials.emplace_back();
  scene.shapes = shapes;
  EXPECT_EQ(lanthorn::summarize(*lanthorn::build_scene(scene)).triangles, 1u);
  EXPECT_THROW(lanthorn::read_mesh(dir.path() / "b.ply"), lanthorn::Error);
}

// The session keeps its view: the film of 24 x 16 pixels, not that of the new scene.
TEST(Api, AnotherSceneIsSeenThroughTheSameView) {
  Session session(load(box), small());
  session.render_pass();
  const lanthorn::SceneDescription other = lanthorn::read_pbrt_string(
      R"(Film "rgb" "integer xresolution" [7]
Camera "orthographic"
WorldBegin
LightSource "infinite"
)",
      ".", "t");
  const lanthorn::ViewDescription view = lanthorn::description_of(*load(box)).view;
  session.set_scene(lanthorn::build_scene(other));
  EXPECT_EQ(session.pass_count(), 0u);
  ASSERT_TRUE(session.render_pass());
  Session expected(lanthorn::build_scene(other), view, small());
  expected.render_pass();
  EXPECT_EQ(session.picture().pixels, expected.picture().pixels);
}

TEST(Api, APictureThatDoesNotFitIntoMemoryIsRefused) {
  RenderOptions options = small();
  options.memory = 1000;
  EXPECT_THROW(Session(load(box), options), lanthorn::Error);
}

// Stops at some time during a pass: the picture contains only the passes before.
TEST(Api, AStoppedPassLeavesNoTrace) {
  const SharedScene scene = load(box);
  for (const char* const integrator : {"probppm", "sppm", "ppm", "vcm", "bpm", "bdpt", "path", "light", "mlt",
                                       "photonmap", "reversephotonmap", "splitsum"}) {
    SCOPED_TRACE(integrator);
    Session session(scene, small(integrator)), undisturbed(scene, small(integrator));
    session.render({.passes = {0, 2}});
    std::thread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      session.stop();
    });
    while (session.render_pass()) {
    }
    stopper.join();
    undisturbed.render({.passes = {0, session.pass_count()}});
    EXPECT_EQ(session.picture().pixels, undisturbed.picture().pixels) << session.pass_count() << " passes";
    ASSERT_TRUE(session.render_pass()) << "it goes on";
    undisturbed.render_pass();
    EXPECT_EQ(session.picture().pixels, undisturbed.picture().pixels) << "one more pass";
  }
}

// Embree can limit the threads of the whole process.
TEST(Api, ScenesLeaveTheNumberOfThreads) {
  const unsigned before = lanthorn::thread_count();
  const SharedScene scene = load(box);
  EXPECT_EQ(lanthorn::thread_count(), before);
}

TEST(Api, ThePictureCanBeHadWhilePassesRun) {
  const SharedScene scene = load(box);
  Session session(scene, small("probppm"));
  EXPECT_THROW(session.picture(), lanthorn::Error) << "no pass is done";
  std::atomic<bool> enough{false};
  std::thread renderer([&] { session.render({.passes = {0, 100'000}, .drop = &enough}); });
  while (session.pass_count() == 0) std::this_thread::yield();
  float last = 0;
  for (int i = 0; i < 20; ++i) {
    const lanthorn::Image image = session.picture();
    const float samples = image.at(3, 3, *image.find_channel("samples"));
    EXPECT_GE(samples, last);
    last = samples;
  }
  enough = true;
  renderer.join();
  EXPECT_EQ(session.picture().pixels, pixels_of(scene, small("probppm"), session.pass_count()));
}

TEST(Api, AnotherViewNeedsNoNewScene) {
  const SharedScene scene = load(box);
  Session session(scene, small("vcm"));
  session.render();
  const std::vector<float> before = session.picture().pixels;
  const lanthorn::ViewDescription own = lanthorn::description_of(*scene).view;
  lanthorn::ViewDescription narrow = own;
  std::get<lanthorn::description::PerspectiveCamera>(narrow.camera.node).fov /= 2;
  session.set_view(narrow);
  EXPECT_EQ(session.pass_count(), 0u);
  session.render();
  EXPECT_NE(session.picture().pixels, before);
  session.set_view(own);
  session.render();
  EXPECT_EQ(session.picture().pixels, before);
}

TEST(Api, AnEditedSceneIsRenderedAnew) {
  const SharedScene scene = load(box);
  Session session(scene, small("probppm"));
  session.render();
  const std::vector<float> pixels = session.picture().pixels;
  const double before = brightness(session.picture());
  lanthorn::SceneDescription description = lanthorn::description_of(*scene);
  description.area_lights.at(0).scale *= 4;
  session.set_scene(lanthorn::build_scene(std::move(description), scene));
  EXPECT_EQ(session.pass_count(), 0u);
  session.render();
  const double bright = brightness(session.picture());
  EXPECT_NEAR(bright / before, 4, 0.01);  // the same paths
  session.set_scene(scene);
  session.render();
  EXPECT_EQ(session.picture().pixels, pixels);
}

// A scene built by a program, without any file.
TEST(Api, SceneDescriptionsArePlainData) {
  lanthorn::SceneDescription scene;
  scene.materials.emplace_back();  // diffuse, grey
  lanthorn::description::Shape& shape = scene.shapes.emplace_back();
  shape.geometry = lanthorn::description::TriangleMesh{{{-1, -1, 3}, {1, -1, 3}, {0, 1, 3}}, {}, {}, {}, {{0, 1, 2}}};
  scene.lights.push_back({lanthorn::description::PointLight{}, {}, {}, {}});
  Session session(lanthorn::build_scene(scene), small());
  session.render();
  const lanthorn::Image image = session.picture();
  EXPECT_GT(image.at(12, 8, 0), 0.0f);
  EXPECT_EQ(image.at(0, 0, 0), 0.0f);
}

TEST(Api, AViewHasTheShutterOfTheScenesMotion) {
  const lanthorn::test::TemporaryDir dir;
  const SharedScene scene = load(dir.write("a.pbrt", R"(WorldBegin
ActiveTransform EndTime
Translate 1 0 0
ActiveTransform All
Shape "sphere"
)"));
  lanthorn::ViewDescription view = lanthorn::description_of(*scene).view;
  EXPECT_NO_THROW(Session(scene, view, small()));
  view.camera.shutter_close = 0.5f;
  EXPECT_THROW(Session(scene, view, small()), lanthorn::Error);
}

TEST(Api, StatesAreSavedResumedAndMerged) {
  const lanthorn::test::TemporaryDir dir;
  const SharedScene scene = load(box);
  const std::filesystem::path file = dir.path() / "a.state";
  Session first(scene, small("probppm"));
  first.render({.passes = {0, 2}});
  lanthorn::save_state(first.state(), file);

  Session resumed(scene, small("probppm"));
  resumed.resume(lanthorn::open_state(file), "a.state");
  EXPECT_EQ(resumed.pass_count(), 2u);
  resumed.render();
  Session rest(scene, small("probppm"));
  rest.render({.passes = {2, 3}});
  const auto merged = lanthorn::merge(rest.state(), *lanthorn::open_state(file));
  const std::vector<float> whole = pixels_of(scene, small("probppm"), 3);
  EXPECT_EQ(resumed.picture().pixels, whole);
  EXPECT_EQ(lanthorn::picture_of(*merged).pixels, whole);
  EXPECT_EQ(lanthorn::summarize(*merged).pass_count, 3u);
  EXPECT_EQ(lanthorn::summarize(*merged).integrator, "probppm");

  Session other(scene, small("vcm"));
  EXPECT_THROW(other.resume(lanthorn::open_state(file), "a.state"), lanthorn::Error);
}

TEST(Api, PhotonsAreArrays) {
  const SharedScene scene = load(box);
  RenderOptions options = small("probppm");
  options.photons = 2000;
  const lanthorn::Photons photons =
      lanthorn::trace_photons(*scene, lanthorn::description_of(*scene).view, options, 0, /*direct=*/true);
  EXPECT_EQ(photons.light_paths, 2000u);
  ASSERT_GT(photons.size(), 1000u);
  EXPECT_EQ(photons.powers.size(), photons.size());
  ASSERT_EQ(photons.depths.size(), photons.size());
  ASSERT_EQ(photons.classes.size(), photons.size());
  for (std::size_t i = 0; i < photons.size(); ++i)
    ASSERT_EQ(photons.depths[i] == 1, photons.classes[i] == lanthorn::PhotonClass::direct);
  EXPECT_GT(*std::max_element(photons.depths.begin(), photons.depths.end()), 2);
  for (const lanthorn::Direction& d : photons.directions) ASSERT_NEAR(glm::dot(d, d), 1, 1e-2f);
}

// Beams into a box, as the user sends them: the same for any number of threads.
TEST(Api, PhotonsStartWhereTheUserSays) {
  const SharedScene scene = load(box);
  const std::vector<lanthorn::PhotonStart> starts(5000, {{{0, 1, 0}, {0.1f, -1, 0.2f}}, {1, 2, 3}});
  const auto trace = [&](unsigned threads) {
    const lanthorn::ThreadLimit limit(threads);
    return lanthorn::trace_photons(*scene, lanthorn::description_of(*scene).view, small("probppm"), starts, 0,
                                   /*direct=*/true);
  };
  const lanthorn::Photons one = trace(1), many = trace(4);
  EXPECT_EQ(one.light_paths, 5000u);
  ASSERT_GT(one.size(), 5000u);
  EXPECT_EQ(one.positions, many.positions);
  EXPECT_EQ(one.powers, many.powers);
  EXPECT_EQ(one.starts, many.starts);
  ASSERT_TRUE(std::is_sorted(one.starts.begin(), one.starts.end()));
  EXPECT_EQ(one.starts.back(), 4999u);
  const lanthorn::Rgb& first = one.powers.front();
  EXPECT_NEAR(first.g, 2 * first.r, 1e-5f);
}

// A sphere that emits inwards and has one reflectance: what rays meet, how it scatters, and L = E / (1 - rho).
TEST(Api, RaysInAFurnace) {
  const lanthorn::test::TemporaryDir dir;
  const SharedScene scene = load(dir.write("a.pbrt",
                                           R"(WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [.5 .5 .5]
Material "diffuse" "rgb reflectance" [.5 .5 .5]
ReverseOrientation
Shape "sphere" "float radius" 2
AttributeEnd
)"));
  const std::vector<lanthorn::SceneRay> rays(64, {{0, 0, 0.5f}, {0, 0, 3}});
  const std::vector<lanthorn::RayHit> hits = lanthorn::intersect(*scene, rays);
  EXPECT_NEAR(hits.front().distance, 1.5f, 1e-5f);
  EXPECT_NEAR(hits.front().position.z, 2, 1e-5f);
  EXPECT_TRUE(hits.front().emits);
  double sum = 0;
  for (const lanthorn::Rgb& light : lanthorn::radiance_along(*scene, rays)) sum += static_cast<double>(light.g);
  EXPECT_NEAR(sum / 64, 1, 0.03);  // 4096 paths; their standard deviation is about .3
  const auto bsdf = lanthorn::bsdf_at(scene, rays.front());
  ASSERT_TRUE(bsdf);
  EXPECT_NEAR(bsdf->eval({0, 0, 1}, {0, 0.6f, 0.8f}).r, 0.5f / std::numbers::pi_v<float>, 1e-4f);
  EXPECT_NEAR(bsdf->pdf({0, 0, 1}, {0, 0.6f, 0.8f}), 0.8f / std::numbers::pi_v<float>, 1e-4f);
  const std::vector<lanthorn::SceneRay> nowhere{{{0, 0, 0}, {0, 0, 0}}};
  EXPECT_THROW(lanthorn::intersect(*scene, nowhere), lanthorn::Error);
  EXPECT_THROW(lanthorn::radiance_along(*scene, rays, {.samples = 0}), lanthorn::Error);
}

// A small view of a large plane: the method's guide sends more photons there.
TEST(Api, PhotonsFollowTheGuideOfTheMethod) {
  const lanthorn::test::TemporaryDir dir;
  const SharedScene scene = load(dir.write("a.pbrt",
                                           R"(LookAt 0 1 1  0 0 0  0 1 0
Camera "perspective"
Film "rgb" "integer xresolution" [16] "integer yresolution" [16]
WorldBegin
LightSource "point" "point3 from" [0 3 0]
Shape "sphere" "float radius" [0.2]
Shape "bilinearmesh" "point3 P" [-50 0 50  50 0 50  -50 0 -50  50 0 -50]
)"));
  const auto in_view = [&](const char* emission) {
    RenderOptions options = small("probppm");
    options.photons = 5000;
    options.set["emission"] = emission;
    const lanthorn::Photons photons =
        lanthorn::trace_photons(*scene, lanthorn::description_of(*scene).view, options, 0, /*direct=*/true);
    return std::count_if(photons.positions.begin(), photons.positions.end(),
                         [](const lanthorn::Point& p) { return glm::dot(p, p) < 1; });
  };
  EXPECT_GT(in_view("learned"), 4 * in_view("power"));
}

TEST(Api, WarningsReachTheProgram) {
  const lanthorn::test::TemporaryDir dir;
  EXPECT_TRUE(Session(load(box), small()).warnings().empty());
  const std::string file = dir.write("a.pbrt",
                                     R"(Camera "perspective"
Film "rgb"
  "string sensor" "canon_eos_5d"
WorldBegin
LightSource "point"
Shape "sphere"
)");
  const auto warnings = Session(load(file), small()).warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].location.file, file);
  EXPECT_EQ(warnings[0].location.line, 3);
  EXPECT_EQ(warnings[0].location.column, 3);
  EXPECT_EQ(warnings[0].message, R"(the measured sensor "canon_eos_5d" is not supported: replaced by "cie1931")");
}

TEST(Api, WrongOptionsThrow) {
  const SharedScene scene = load(box);
  EXPECT_THROW(Session(scene, small("nosuch")), lanthorn::Error);
  RenderOptions options = small();
  options.resolution = {0, 16};
  EXPECT_THROW(Session(scene, options), lanthorn::Error);
  options = small("probppm");
  options.set["nosuch"] = "1";
  EXPECT_THROW(Session(scene, options), lanthorn::Error);
  const auto refuse = [&](auto member, auto value) {
    RenderOptions wrong = small();
    wrong.*member = value;
    EXPECT_THROW(Session(scene, wrong), lanthorn::Error);
  };
  refuse(&RenderOptions::passes, std::uint64_t{0});
  refuse(&RenderOptions::photons, std::uint64_t{0});
  refuse(&RenderOptions::max_depth, 0);
  refuse(&RenderOptions::pass_range, lanthorn::PassRange{2, 2});
  for (const double no_time : {0.0, -1.0}) refuse(&RenderOptions::seconds, no_time);
  for (const double no_share : {0.0, -0.1, 2.0, std::numeric_limits<double>::quiet_NaN()}) {
    refuse(&RenderOptions::noise, no_share);
    EXPECT_THROW(Session(scene, small()).render({.passes = {0, 1}, .noise = no_share}), lanthorn::Error) << no_share;
  }
}

}  // namespace
