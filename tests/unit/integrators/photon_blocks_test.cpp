// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Passes that trace photons in blocks find the same light as with a single block.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "lanthorn/threads.h"
#include "path/light_pass.h"
#include "support/render_scene.h"
#include "support/varied_room.h"

namespace lanthorn::photon_blocks_test {
namespace {

constexpr std::uint64_t at_once = std::numeric_limits<std::uint64_t>::max();

Scene room(bool moves) {
  std::string text = test::varied_room;
  const std::string end = "Translate -0.4 0.6 -0.35";
  if (!moves) text.replace(text.find(end), end.size(), "Translate -0.4 0.4 -0.35");
  return test::scene_from_text(text);
}
const Scene& still_room() {
  static const Scene scene = room(false);
  return scene;
}

struct Outcome {
  RenderState state;
  RenderStatistics statistics;
};
Outcome run(const Scene& scene, const std::string& method, std::uint64_t block, PassRange passes = {0, 2},
            unsigned threads = 2, ColorMode color = ColorMode::rgb) {
  const ThreadLimit limit(threads);
  RenderOptions options = test::options_for(method, 0, 7);
  options.passes.reset();
  options.pass_range = passes;
  options.color = color;
  options.photons = 6000;
  options.max_depth = 6;
  RenderPlan plan = test::plan_render(scene, options);
  plan.settings.photon_block = block;
  Outcome result;
  result.statistics = render(scene, plan, plan.stop);
  plan.state.seconds = 0;
  result.state = std::move(plan.state);
  return result;
}

// The largest difference of the pictures, relative to the largest value of its channel; and the mean difference.
struct Difference {
  double largest = 0, mean = 0;
};
Difference difference(const RenderState& a, const RenderState& b) {
  const Image x = picture_of(a), y = picture_of(b);
  EXPECT_EQ(x.channels, y.channels);
  const std::size_t channels = x.channel_count();
  std::vector<double> largest(channels, 1e-30);
  for (std::size_t i = 0; i < x.pixels.size(); ++i)
    largest[i % channels] = std::max(largest[i % channels], std::fabs(static_cast<double>(x.pixels[i])));
  Difference d;
  for (std::size_t i = 0; i < x.pixels.size(); ++i) {
    if (!std::isfinite(x.pixels[i]) || is_noise_channel(x.channels[i % channels])) continue;
    const double own = std::fabs(static_cast<double>(x.pixels[i]) - static_cast<double>(y.pixels[i]));
    d.largest = std::max(d.largest, own / largest[i % channels]);
    d.mean += own / largest[i % channels] / static_cast<double>(x.pixels.size());
  }
  return d;
}

class PhotonBlocks : public testing::TestWithParam<const char*> {};

// Photon maps quantise the lengths of flights by the longest one; otherwise only sums are rounded differently.
TEST_P(PhotonBlocks, FindTheLightThatOneBlockFinds) {
  for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral}) {
    const Outcome whole = run(still_room(), GetParam(), at_once, {0, 2}, 2, color);
    for (const std::uint64_t block : {400, 111}) {
      const Outcome parts = run(still_room(), GetParam(), block, {0, 2}, 2, color);
      const Difference d = difference(whole.state, parts.state);
      EXPECT_LT(d.mean, 1e-5) << block;
      EXPECT_LT(d.largest, 1e-2) << block;
      EXPECT_EQ(whole.statistics.light_paths, parts.statistics.light_paths);
      EXPECT_EQ(whole.statistics.photons_stored, parts.statistics.photons_stored);
      EXPECT_EQ(whole.statistics.radius, parts.statistics.radius);
      if (whole.statistics.photon_map_bytes > 0) {
        EXPECT_LT(parts.statistics.photon_map_bytes, whole.statistics.photon_map_bytes);
      }
    }
  }
}

TEST_P(PhotonBlocks, BytesDoNotDependOnThreadsOrShards) {
  const Scene moving = room(true);
  for (const Scene* scene : {&still_room(), &moving}) {
    const std::vector<std::byte> expected = encode_state(run(*scene, GetParam(), 400).state);
    for (const unsigned threads : {1u, 3u})
      EXPECT_EQ(expected, encode_state(run(*scene, GetParam(), 400, {0, 2}, threads).state)) << threads;
    EXPECT_EQ(expected, encode_state(merge_states(run(*scene, GetParam(), 400, {1, 2}).state,
                                                  run(*scene, GetParam(), 400, {0, 1}).state)));
  }
}

// Eye paths use the time of the light path that they connect to, even if its block is not in memory.
TEST_P(PhotonBlocks, MeetWhatMovesAtTheSameTimes) {
  const Scene moving = room(true);
  const RenderState whole = run(moving, GetParam(), at_once, {0, 16}).state;
  const RenderState parts = run(moving, GetParam(), 400, {0, 16}).state;
  EXPECT_LT(difference(whole, parts).mean, 1e-2);
}

INSTANTIATE_TEST_SUITE_P(Methods, PhotonBlocks,
                         testing::Values("probppm", "probppm:volume=beams", "probppm:volume=point",
                                         "probppm:volume=path", "light", "bdpt", "bpm", "vcm",
                                         "vcm:volume=point+photon-beam", "auto"),
                         [](const auto& of) { return test::identifier(of.param); });

// In a large scene, the tree of light paths is sorted block by block.
TEST(LightPathBlocks, DivideAPassWithoutGaps) {
  for (const std::uint64_t paths : {0u, 1u, 999u, 1000u, 1001u, 5000u}) {
    const LightPathBlocks blocks(paths, 1000);
    std::uint64_t next = 0;
    for (std::uint32_t b = 0; b < blocks.count(); ++b) {
      EXPECT_EQ(blocks[b].begin, next);
      next = std::min(blocks[b].end, paths);
      EXPECT_LE(next - blocks[b].begin, 1000u);
    }
    EXPECT_EQ(next, paths);
    EXPECT_EQ(blocks[blocks.count() - 1].end, at_once) << "lights may emit a path more than planned";
  }
}

TEST(LightPathBlocks, HaveThePathsOfThePassEachOnce) {
  const Scene& scene = still_room();
  const auto numbers = [&](const LightPathBlock& block) {
    const LightPaths paths(scene, {3, Stream::light, 5, 5000, nullptr, block});
    std::vector<std::vector<float>> chunks(paths.chunk_count());
    paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts&, std::size_t chunk) {
      sampler.seek(0);
      chunks[chunk].push_back(static_cast<float>(start.index) + sampler.next());
    });
    std::vector<float> all;
    for (const auto& chunk : chunks) all.insert(all.end(), chunk.begin(), chunk.end());
    return all;
  };
  std::vector<float> joined;
  const LightPathBlocks blocks(5000, 1700);
  for (std::uint32_t b = 0; b < blocks.count(); ++b) {
    const std::vector<float> of_block = numbers(blocks[b]);
    joined.insert(joined.end(), of_block.begin(), of_block.end());
  }
  EXPECT_EQ(joined, numbers({}));
}

}  // namespace
}  // namespace lanthorn::photon_blocks_test
