// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Equal bytes for any number of threads, resumed, and merged from shards, for every integrator and colour mode.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "integrators/integrator.h"
#include "path/light_pass.h"
#include "support/render_scene.h"
#include "support/varied_room.h"

namespace lanthorn::determinism_test {
namespace {

using test::varied_room;

// With the floor, `varied_room` has enough triangles for light paths to be traced in another order.
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

// An emissive medium, which every method finds by light paths and eye paths.
const std::string flame =
    R"(AttributeBegin
Translate 0.5 0.6 0.3
MakeNamedMedium "flame" "string type" "uniformgrid" "point3 p0" [-0.1 -0.2 -0.1] "point3 p1" [0.1 0.2 0.1] "integer nx" 1 "integer ny" 3 "integer nz" 1 "float density" [1 2 0.5] "rgb sigma_a" [1 1 2] "rgb sigma_s" [0.5 0.2 0.1] "rgb Le" [20 10 5]
MediumInterface "flame" ""
Material "interface"
Shape "sphere" "float radius" [0.2]
AttributeEnd
)";

const Scene& test_scene() {
  static const Scene s = test::scene_from_text(varied_room + flame + rippled_floor());
  return s;
}

const Scene& scene_with_spectral_film() {
  std::string text = varied_room;
  text.replace(text.find(R"("rgb" "integer xres)"), 5, R"("spectral")");
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
  for (const char* integrator :
       {"path:guide=photons", "photonmap:guide=photons", "photonmap:final-gather=cached:cache-rays=32"})
    for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral}) all.push_back({integrator, color});
  all.push_back({"photonmap:emission=learned:caustic-photons=5000", ColorMode::rgb});
  all.push_back({"vcm:emission=learned", ColorMode::spectral});
  for (const char* integrator : {"probppm:volume=point", "sppm:volume=short-photon-beam", "probppm:volume=beams",
                                 "vcm:volume=point+beam+photon-beam+beams"})
    for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral}) all.push_back({integrator, color});
  return all;
}

class EveryMethod : public testing::TestWithParam<Case> {
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

// A single test, because all its parts are compared with the same render.
TEST_P(EveryMethod, BytesDoNotDependOnThreadsResumingOrShards) {
  const RenderState whole = render_with(2, {0, 3});
  const std::vector<std::byte> expected = encode_state(whole);
  EXPECT_EQ(expected, encode_state(render_with(1, {0, 3})));
  EXPECT_EQ(expected, encode_state(render_with(3, {0, 3})));

  const RenderState first = render_with(2, {0, 1});
  EXPECT_EQ(expected, encode_state(render_with(2, {0, 3}, decode_state(encode_state(first), "saved"))));
  if (!whole.shardable) return;
  const RenderState second = render_with(1, {1, 2}), third = render_with(2, {2, 3});
  EXPECT_EQ(expected, encode_state(merge_states(merge_states(third, first), second)));
}

// Radii of `auto` depend on the photons of the first 16 passes: these are rendered, retraced by a shard that begins
// later, or known from a saved state.
TEST(Determinism, RadiiOfAutoAreThoseOfItsFirstPasses) {
  const auto render = [](PassRange passes, const RenderState& resumed = {}) {
    RenderOptions options = test::options_for("auto", 0, 7);
    options.passes.reset();
    options.pass_range = passes;
    options.photons = 2000;
    options.max_depth = 6;
    return test::render_state(test_scene(), options, resumed);
  };
  const RenderState whole = render({0, 18}), first = render({0, 16}), last = render({16, 18});
  const std::vector<std::byte> expected = encode_state(whole);
  EXPECT_EQ(whole.integrator_state.size(), first.film.pixel_count()) << "the filter does not reach beyond a pixel";
  EXPECT_EQ(expected, encode_state(render({0, 18}, first)));
  EXPECT_EQ(expected, encode_state(merge_states(first, last)));
  EXPECT_EQ(expected, encode_state(render({0, 18}, last)));
  EXPECT_EQ(expected, encode_state(merge_states(merge_states(render({0, 5}), last), render({5, 16}))));

  RenderState forgotten = first, other = first;
  forgotten.integrator_state.clear();
  EXPECT_EQ(expected, encode_state(render({0, 18}, forgotten)));
  for (std::byte& b : other.integrator_state) b ^= std::byte{31};
  EXPECT_NE(expected, encode_state(render({0, 18}, other))) << "the saved results are used";
}

TEST(Determinism, SeedsDiffer) {
  for (const IntegratorInfo& info : integrator_registry()) {
    RenderOptions options = test::options_for(info.name, 1, 7);
    options.photons = 1000;
    const RenderState a = test::render_state(test_scene(), options);
    options.seed = 8;
    EXPECT_NE(a.film.plane(0), test::render_state(test_scene(), options).film.plane(0)) << info.name;
  }
}

// Whatever the tracing order, a pass traces each light path of the allocation exactly once.
TEST(LightPaths, OrderIsAPermutation) {
  const LightPass pass{7, Stream::light, 3, 5000};
  const LightPaths paths(test_scene(), pass);
  std::multiset<float> traced;
  const ThreadLimit one_thread(1);
  paths.for_each([&](const LightPath&, Sampler& sampler, RayCounts&, std::size_t) {
    sampler.seek(1);
    traced.insert(sampler.next());
  });

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

INSTANTIATE_TEST_SUITE_P(Determinism, EveryMethod, testing::ValuesIn(cases()), [](const auto& c) {
  return test::identifier(c.param.integrator) + (c.param.color == ColorMode::rgb ? "_rgb" : "_spectral") +
         (c.param.spectral_film ? "_film" : "");
});

}  // namespace
}  // namespace lanthorn::determinism_test
