// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The same bytes for any number of threads, resumed, and merged from shards, for every integrator and colour mode.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "integrators/integrator.h"
#include "path/light_pass.h"
#include "support/render_scene.h"

namespace lanthorn {
namespace {

// Rough and clear glass, a mirror, a textured wall, fog, three kinds of light, motion and a thin lens: everything that
// could draw from a wrong stream; and, with the floor, enough triangles for light paths to be traced in another order.
const char* const scene_text = R"(
TransformTimes 0 1
LookAt 0 1 4.4  0 1 0  0 1 0
Camera "perspective" "float fov" [36] "float lensradius" [0.05] "float focaldistance" [4] "float shutteropen" [0] "float shutterclose" [1]
Film "rgb" "integer xresolution" [40] "integer yresolution" [30]
PixelFilter "mitchell"
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [17 12 4]
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-0.25 1.99 -0.25 0.25 1.99 -0.25 0.25 1.99 0.25 -0.25 1.99 0.25]
AttributeEnd
LightSource "point" "rgb I" [0.6 0.5 0.4] "point3 from" [-0.6 1.6 0.3]
LightSource "infinite" "rgb L" [0.1 0.1 0.2]
Texture "checks" "spectrum" "checkerboard" "rgb tex1" [0.8 0.8 0.8] "rgb tex2" [0.1 0.2 0.5] "float uscale" [6] "float vscale" [6]
Material "diffuse" "texture reflectance" "checks"
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 -1 1 0 -1 1 2 -1 -1 2 -1]
AttributeBegin
  Material "dielectric" "spectrum eta" "glass-F11"
  Translate 0.42 0.4 0.3
  Shape "sphere" "float radius" [0.4]
AttributeEnd
AttributeBegin
  ActiveTransform StartTime
  Translate -0.4 0.4 -0.35
  ActiveTransform EndTime
  Translate -0.4 0.6 -0.35
  ActiveTransform All
  Material "coateddiffuse" "rgb reflectance" [0.2 0.3 0.6] "float roughness" [0.1]
  Shape "sphere" "float radius" [0.4]
AttributeEnd
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.1 0.3 0.2] "rgb sigma_s" [1 2 3] "float g" [0.4]
AttributeBegin
  MediumInterface "fog" ""
  Material "interface"
  Translate 0.5 1.3 0.2
  Shape "sphere" "float radius" [0.3]
AttributeEnd
AttributeBegin
  Material "conductor" "float roughness" [0.1]
  Translate 0 1.4 -0.5
  Shape "sphere" "float radius" [0.3]
AttributeEnd
)";

constexpr int floor_cells = 72;

std::string rippled_floor() {
  std::string positions, uvs, indices;
  constexpr int side = floor_cells + 1;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double u = static_cast<double>(x) / floor_cells, v = static_cast<double>(y) / floor_cells;
      const double height = 0.02 * std::sin(20 * u) * std::cos(17 * v);
      positions += fmt::format("{} {} {} ", 2 * u - 1, height, 1 - 2 * v);
      uvs += fmt::format("{} {} ", u, v);
    }
  for (int y = 0; y < floor_cells; ++y)
    for (int x = 0; x < floor_cells; ++x) {
      const int a = y * side + x, b = a + 1, c = a + side, d = c + 1;
      indices += fmt::format("{} {} {} {} {} {} ", a, b, d, a, d, c);
    }
  return fmt::format(R"(
Material "diffuse" "texture reflectance" "checks"
Shape "trianglemesh" "integer indices" [{}] "point3 P" [{}] "point2 uv" [{}]
)",
                     indices, positions, uvs);
}

const Scene& test_scene() {
  static const Scene s = test::scene_from_text(scene_text + rippled_floor());
  return s;
}

const Scene& scene_with_spectral_film() {
  std::string text = scene_text;
  text.replace(text.find("\"rgb\" \"integer xres"), 5, "\"spectral\"");
  static const Scene s = test::scene_from_text(text + rippled_floor());
  return s;
}

struct Case {
  std::string integrator;
  ColorMode color;
  bool spectral_film = false;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const IntegratorInfo& info : integrator_registry())
    for (const Case& c : {Case{info.name, ColorMode::rgb}, Case{info.name, ColorMode::spectral},
                          Case{info.name, ColorMode::spectral, true}})
      all.push_back(c);
  return all;
}

class Determinism : public testing::TestWithParam<Case> {
 protected:
  static RenderOptions options(PassRange passes) {
    RenderOptions o = test::options_for(GetParam().integrator, 0, 7);
    o.passes.reset();
    o.pass_range = passes;
    o.color = GetParam().color;
    o.photons = 5000;
    o.max_depth = 8;
    return o;
  }
  static RenderState render_with(unsigned threads, PassRange passes, RenderState resumed = {}) {
    const ThreadLimit limit(threads);
    return test::render_state(scene(), options(passes), std::move(resumed));
  }
  static const Scene& scene() { return GetParam().spectral_film ? scene_with_spectral_film() : test_scene(); }
};

TEST_P(Determinism, BytesDoNotDependOnThreads) {
  const std::vector<std::byte> one = encode_state(render_with(1, {0, 4}));
  EXPECT_EQ(one, encode_state(render_with(2, {0, 4})));
  EXPECT_EQ(one, encode_state(render_with(3, {0, 4})));
}

TEST_P(Determinism, BytesDoNotDependOnBeingResumed) {
  const RenderState whole = render_with(2, {0, 4});
  RenderState part = render_with(2, {0, 1});
  RenderState saved = decode_state(encode_state(part), "saved");
  EXPECT_EQ(encode_state(whole), encode_state(render_with(2, {0, 4}, std::move(saved))));
}

TEST_P(Determinism, ShardsMergeExactly) {
  const RenderState whole = render_with(2, {0, 4});
  if (!whole.shardable) return;
  const RenderState a = render_with(2, {0, 1}), b = render_with(1, {1, 3}), c = render_with(2, {3, 4});
  EXPECT_EQ(encode_state(whole), encode_state(merge_states(merge_states(c, a), b)));
}

TEST_P(Determinism, SeedsDiffer) {
  RenderOptions o = options({0, 1});
  const RenderState a = test::render_state(scene(), o);
  o.seed = 8;
  const RenderState b = test::render_state(scene(), o);
  EXPECT_NE(a.film.plane(0), b.film.plane(0));
}

// In whatever order they are traced, the light paths of a pass are those of the allocation, each once.
TEST(LightPaths, OrderIsAPermutation) {
  const LightPass pass{7, Stream::light, 3, 5000};
  const LightPaths paths(test_scene(), pass);
  std::multiset<float> traced;
  const auto note = [&](const LightPath&, Sampler& sampler) {
    sampler.seek(1);
    traced.insert(sampler.next());
  };
  paths.for_each_in(0, 2048, note);
  paths.for_each_in(2048, paths.total(), note);

  Sampler pass_sampler = Sampler::for_pass(pass.seed ^ static_cast<std::uint64_t>(pass.stream), pass.pass);
  pass_sampler.seek(1);
  const PhotonAllocation allocation(test_scene().lights(), pass.paths, pass_sampler.next());
  std::multiset<float> expected;
  for (const PhotonAllocation::Share& share : allocation.shares())
    for (std::uint32_t i = 0; i < share.count; ++i) {
      Sampler sampler = Sampler::for_light_path(pass.seed, pass.stream, share.light, pass.pass, i);
      sampler.seek(1);
      expected.insert(sampler.next());
    }
  EXPECT_EQ(traced, expected);
}

INSTANTIATE_TEST_SUITE_P(Integrators, Determinism, testing::ValuesIn(cases()), [](const auto& c) {
  return c.param.integrator + (c.param.color == ColorMode::rgb ? "_rgb" : "_spectral") +
         (c.param.spectral_film ? "_film" : "");
});

// Of one seed, and each strategy shows some light.
TEST(Bidirectional, StrategiesAddUpToTheImage) {
  const Scene scene = test::scene_from_text(scene_text);
  constexpr int depth = 2;
  const auto render = [&](const std::string& integrator) {
    RenderOptions options = test::options_for(integrator, 2, 1);
    options.max_depth = depth;
    options.photons = 2'000;
    return *select_layer(test::render_image(scene, options), "color");
  };
  const Image all = render("bdpt");
  std::vector<double> sum(all.pixels.size());
  for (int vertices = 2; vertices <= depth + 2; ++vertices)
    for (int s = 0; s < vertices; ++s) {
      const Image one = render(fmt::format("bdpt:strategy={},{}", s, vertices - s));
      double light = 0;
      for (std::size_t i = 0; i < sum.size(); ++i) {
        sum[i] += static_cast<double>(one.pixels[i]);
        light += static_cast<double>(one.pixels[i]);
      }
      if (vertices > 2 || s == 0) {  // no light is joined to the lens itself
        EXPECT_GT(light, 0) << s << ", " << vertices - s;
      }
    }
  for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i], static_cast<double>(all.pixels[i]), 1e-4);
}

}  // namespace
}  // namespace lanthorn
