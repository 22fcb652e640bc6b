// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "gl/texture.h"
#include "gl/timer.h"
#include "lanthorn/error.h"
#include "lanthorn/metrics.h"
#include "path/walk.h"
#include "realtime/frame/renderer.h"
#include "realtime/scene/shader_files.h"
#include "realtime/techniques/ispm/photon_walk.h"
#include "support/chi2.h"
#include "support/edited.h"
#include "support/opengl.h"
#include "support/render_scene.h"
#include "support/runs.h"

namespace lanthorn::photons_test {
namespace {

class Photons : public test::OpenGl {};

// A box that is open towards the eye, with a block and a light of the given kind.
std::string box(const std::string& light,
                const std::string& wall = R"(Material "diffuse" "rgb reflectance" [.7 .6 .5])") {
  return R"(
LookAt 0 1 -3.4  0 1 0  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [48] "integer yresolution" [40]
PixelFilter "box"
WorldBegin
)" + light +
         wall +
         R"(
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 1  1 0 1  1 0 -1  -1 0 -1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 1  1 0 1  1 2 1  -1 2 1]
Material "diffuse" "rgb reflectance" [.2 .6 .3]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 -1  -1 0 1  -1 2 1  -1 2 -1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [1 0 -1  1 0 1  1 2 1  1 2 -1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 0 1 4 1 2 4 2 3 4 3 0 4] "point3 P" [-.4 0 0  .3 0 0  .3 0 .6  -.4 0 .6  0 .8 .3]
)";
}

constexpr const char* mirror = R"(Material "conductor" "float roughness" [0]
)";
constexpr const char* point_light = R"(LightSource "point" "rgb I" [3 2 1] "point3 from" [.3 1.5 -.2]
)";
constexpr const char* spot_light =
    R"(LightSource "spot" "rgb I" [9 9 9] "point3 from" [.5 1.8 -.8] "point3 to" [-.3 0 .4] "float coneangle" [35] "float conedeltaangle" [12]
)";
constexpr const char* sun =
    R"(LightSource "distant" "rgb L" [2 2 2] "point3 from" [.4 1 -.8] "point3 to" [0 0 0]
)";
/// A square lamp facing down.
std::string lamp_of(const std::string& radiance, double half, double height) {
  return fmt::format(R"(
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [{0}]
  Material "diffuse" "rgb reflectance" [0 0 0]
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-{1} {2} -{1}  {1} {2} -{1}  {1} {2} {1}  -{1} {2} {1}]
AttributeEnd
)",
                     radiance, half, height);
}
TechniqueChoice technique_of(const std::string& radius, const std::string& gather) {
  return TechniqueChoice("ispm", {{"radius", radius}, {"gather", gather}});
}
FrameSettings photon_settings(std::uint32_t count) {
  FrameSettings settings;
  settings.technique = technique_of("0.15", "auto");
  settings.photons = count;
  settings.views.map_size = 64;
  return settings;
}

Image frame_of(const Scene& scene, const FrameSettings& settings) {
  Renderer renderer(scene);
  renderer.draw(make_view(scene.description().view), settings);
  EXPECT_TRUE(renderer.log().messages().empty());
  return renderer.read_layers();
}

// In the second room, photons are also behind the eye and around it.
TEST_F(Photons, SplatsAndTilesGiveTheSameLight) {
  std::string inside = box(point_light);
  inside.replace(inside.find("0 1 -3.4"), 8, ".9 1 -.5");
  for (const std::string& text : {box(point_light), inside}) {
    const Scene scene = test::scene_from_text(text);
    FrameSettings settings = photon_settings(3000);
    settings.technique = technique_of("0.15", "splat");
    const Image splats = *select_layer(frame_of(scene, settings), "indirect");
    settings.technique = technique_of("0.15", "tiles");
    const Image tiles = *select_layer(frame_of(scene, settings), "indirect");
    const ImageErrors errors = image_errors(splats, tiles);
    EXPECT_GT(errors.mean_image, 0.01);
    EXPECT_LT(errors.max_difference, 2e-5 * errors.mean_image);
  }
}

bool has_stage(Renderer& renderer, const std::string& stage) {
  const std::vector<gl::StageTime> stages = renderer.report().stages;
  return std::any_of(stages.begin(), stages.end(), [&](const gl::StageTime& s) { return s.stage == stage; });
}

// Software drivers silently end long loops in shaders.
TEST_F(Photons, TilesLoseNoneOfVeryManyPhotons) {
  const Scene scene = test::scene_from_text(box(point_light));
  ViewOptions options;
  options.resolution = {8, 8};  // one tile
  const View view = make_view(scene.description().view, options);
  Renderer renderer(scene);
  FrameSettings settings = photon_settings(150000);
  const auto indirect = [&](const char* gather) {
    settings.technique = technique_of("0.02", gather);
    renderer.draw(view, settings);
    return *select_layer(renderer.read_layers(), "indirect");
  };
  const ImageErrors errors = image_errors(indirect("tiles"), indirect("splat"));
  EXPECT_GT(renderer.report().photons_per_bounce[0], 70000u);
  EXPECT_LT(errors.max_difference, 1e-4 * errors.mean_image);
}

// Software drivers compute immediately and draw later: without waiting, a stage would be charged for the stage before.
TEST_F(Photons, StagesBeginWhenAllBeforeIsDone) {
  gl::Texture large(GL_RGBA32F, 2048, 2048, 12);
  large.clear();
  large.generate_mipmaps();
  const GLsync drawn = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  gl::StageTimer timer(true);
  timer.begin("next");
  GLint state = 0;
  glGetSynciv(drawn, GL_SYNC_STATUS, 1, nullptr, &state);
  glDeleteSync(drawn);
  EXPECT_EQ(state, GL_SIGNALED);
}

TEST_F(Photons, BuffersThatShadersCannotSeeAreErrors) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  const auto texels = static_cast<std::size_t>(most);
  EXPECT_NO_THROW(gl::require_buffer_texels(texels, "a", "b"));
  try {
    gl::require_buffer_texels(texels + 1, "mirrors in view", "a smaller picture");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()), fmt::format("mirrors in view take {} texels, and this OpenGL driver has {} at "
                                                 "most; expected a smaller picture",
                                                 texels + 1, most));
  }
}

// Light maps are drawn only once while only the eye moves, and the picture equals that of a renderer that redraws
// everything. Mirrors, whose light the CPU gathers, show the same photons.
TEST_F(Photons, AreKeptWhileOnlyTheEyeMoves) {
  const Scene scene = test::scene_from_text(box(point_light, mirror));
  const View view = make_view(scene.description().view);
  FrameSettings settings = photon_settings(1000);
  Renderer renderer(scene);
  renderer.draw(view, settings);
  EXPECT_TRUE(has_stage(renderer, "light maps") && has_stage(renderer, "photon walk (CPU)"));
  settings.offset = {3, 2};
  renderer.draw(view, settings);
  EXPECT_FALSE(has_stage(renderer, "light maps") || has_stage(renderer, "photon walk (CPU)"));
  EXPECT_TRUE(has_stage(renderer, "eye paths (CPU)"));
  EXPECT_EQ(renderer.read_layers().pixels, frame_of(scene, settings).pixels);
  settings.technique = technique_of("0.2", "auto");
  renderer.draw(view, settings);
  EXPECT_FALSE(has_stage(renderer, "photon walk (CPU)"));
  EXPECT_EQ(renderer.read_layers().pixels, frame_of(scene, settings).pixels);
  settings.views.frame = 1;
  renderer.draw(view, settings);
  EXPECT_TRUE(has_stage(renderer, "light maps") && has_stage(renderer, "photon walk (CPU)"));
  EXPECT_EQ(renderer.read_layers().pixels, frame_of(scene, settings).pixels);
}

TEST_F(Photons, FollowALightThatMoves) {
  const Scene scene = test::scene_from_text(box(point_light));
  const View view = make_view(scene.description().view);
  const FrameSettings settings = photon_settings(1000);
  Renderer renderer(scene);
  renderer.draw(view, settings);
  const Image before = renderer.read_layers();
  const SharedScene moved = test::edited(scene, [](SceneDescription& description) {
    Transform& place = description.lights[0].light_to_world;
    place = translate({-0.6f, 0, 0}) * place;
  });
  renderer.update(*moved);
  renderer.draw(view, settings);
  EXPECT_EQ(renderer.read_layers().pixels, frame_of(*moved, settings).pixels);
  EXPECT_GT(image_errors(renderer.read_layers(), before).rel_mse, 0.01);
}

// Counts, by 6 x 6 x 6 cells of the room, of photons' first hits.
constexpr int cells_along = 6;
std::size_t cell_of(const Point& p) {
  const auto along = [](float x, float low) {
    return std::clamp(static_cast<int>((x - low) / 2.002f * cells_along), 0, cells_along - 1);
  };
  return static_cast<std::size_t>((along(p.x, -1.001f) * cells_along + along(p.y, -0.001f)) * cells_along +
                                  along(p.z, -1.001f));
}
using Histogram = std::array<double, cells_along * cells_along * cells_along>;

// Luminance times albedo, in proportion to which texels are sampled.
float importance_of(const Spectrum& flux, const Spectrum& albedo) {
  const Spectrum s = flux * albedo;
  return 0.2126f * s[0] + 0.7152f * s[1] + 0.0722f * s[2];
}

struct FirstHit {
  float importance = 0;
  Point position{0};
  Continuation operator()(const MediumVertex&) { return Continuation::stop(); }
  void operator()(const EscapeVertex&) {}
  Continuation operator()(const SurfaceVertex& v) {
    importance = importance_of(v.state.beta, albedo(v.at.bsdf, v.wi_local));
    position = v.at.position;
    return Continuation::stop();
  }
};

// Positions of traced photons, each with the fraction of them that maps should sample there.
Histogram traced_positions(const Scene& scene, int photons) {
  Histogram shares{};
  double total = 0;
  const Wavelengths w = Wavelengths::rgb(0.5f);
  RayCounts counts;
  const Light& light = scene.lights()[0];
  for (int i = 0; i < photons; ++i) {
    Sampler sampler = Sampler::for_light_path(test::seed(5), Stream::light, 0, 0, static_cast<std::uint32_t>(i));
    FirstHit hit;
    walk_from_light(PathContext{scene, w, sampler, counts, {1, 2}}, LightPath{light}, 0, hit);
    shares[cell_of(hit.position)] += static_cast<double>(hit.importance);
    total += static_cast<double>(hit.importance);
  }
  for (double& share : shares) share /= total;
  return shares;
}

Histogram map_positions(const Scene& scene, std::uint32_t frames, std::uint32_t photons) {
  Histogram counts{};
  Renderer renderer(scene);
  BounceMap bounces(shader_files());
  FrameSettings settings = photon_settings(photons);
  settings.views.map_size = 256;
  settings.views.seed = test::seed(6);
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    settings.views.frame = frame;
    renderer.draw(make_view(scene.description().view), settings);
    const auto views = static_cast<int>(renderer.light_views().size());
    bounces.start(renderer.light_maps(), views, photons, settings.views.seed, frame);
    for (const PhotonStart& start : bounces.read())
      if (start.state != gpu::start_none) counts[cell_of(start.position)] += 1;
  }
  return counts;
}

// Pearson's test. Cells of few photons are pooled. Photons of a frame are stratified, which only makes the statistic
// smaller. The expected fractions are themselves estimated from `share_samples` photons, so the variances add up.
double chi2_p(const Histogram& counts, const Histogram& shares, double share_samples) {
  double total = 0, statistic = 0, few_count = 0, few_share = 0;
  for (const double c : counts) total += c;
  int cells = 0;
  const auto add = [&](double count, double share) {
    const double expected = total * share;
    statistic += (count - expected) * (count - expected) / (expected * (1 + 2 * total / share_samples));
    ++cells;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (total * shares[i] >= 20) {
      add(counts[i], shares[i]);
    } else {
      few_count += counts[i];
      few_share += shares[i];
    }
  }
  if (total * few_share >= 20) add(few_count, few_share);
  return test::chi2_upper_tail(statistic, cells - 1);
}

TEST_F(Photons, OfMapsLieWhereTracedOnesDo) {
  // The lamp is so small that all photons of a frame may start at one point.
  for (const std::string& light :
       {std::string(point_light), std::string(spot_light), std::string(sun), lamp_of("9000 8000 5000", 0.002, 1.9)}) {
    const Scene scene = test::scene_from_text(box(light));
    constexpr int traced = 200000;
    constexpr std::uint32_t frames = 40, photons = 500;
    const double p = chi2_p(map_positions(scene, frames, photons), traced_positions(scene, traced), traced);
    EXPECT_GT(p, test::false_alarm_rate / 4) << light;
  }
}

// Watts scattered at the first surface, by luminance, in 3 x 3 x 3 cells of the room.
constexpr std::size_t block_count = 27;
using Blocks = std::array<double, block_count>;
std::size_t block_of(const Point& p) {
  const auto along = [](float x, float low) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>((x - low) / 2.002f * 3), 0, 2));
  };
  return (along(p.x, -1.001f) * 3 + along(p.y, -0.001f)) * 3 + along(p.z, -1.001f);
}

// All photons of a frame start at one point of the lamp, so each frame is one sample.
std::vector<Blocks> watts_of_maps(const Scene& scene, std::uint32_t frames, std::uint32_t photons) {
  std::vector<Blocks> samples;
  Renderer renderer(scene);
  BounceMap bounces(shader_files());
  ViewOptions options;
  options.resolution = {2, 2};  // the view does not matter
  const View view = make_view(scene.description().view, options);
  FrameSettings settings = photon_settings(photons);
  settings.views.seed = test::seed(8);
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    settings.views.frame = frame;
    renderer.draw(view, settings);
    bounces.start(renderer.light_maps(), 1, photons, settings.views.seed, frame);
    Blocks watts{};
    for (const PhotonStart& s : bounces.read())
      if (s.state != gpu::start_none)
        watts[block_of(s.position)] +=
            static_cast<double>(importance_of(Spectrum(s.power.x, s.power.y, s.power.z, 0), Spectrum(1)));
    samples.push_back(watts);
  }
  return samples;
}

std::vector<Blocks> watts_of_traced(const Scene& scene, int runs, int photons) {
  std::vector<Blocks> samples;
  const Wavelengths w = Wavelengths::rgb(0.5f);
  RayCounts counts;
  for (int run = 0; run < runs; ++run) {
    Blocks watts{};
    for (int i = 0; i < photons; ++i) {
      Sampler sampler =
          Sampler::for_light_path(test::seed(9), Stream::light, 0, 0, static_cast<std::uint32_t>(run * photons + i));
      FirstHit hit;
      walk_from_light(PathContext{scene, w, sampler, counts, {1, 2}}, LightPath{scene.lights()[0]}, 0, hit);
      watts[block_of(hit.position)] += static_cast<double>(hit.importance) / photons;
    }
    samples.push_back(watts);
  }
  return samples;
}

// Means of groups of blocks, and the covariances of these means.
struct GroupMeans {
  std::vector<double> mean;
  std::vector<std::vector<double>> covariance;
};
GroupMeans group_means(const std::vector<Blocks>& samples, const std::vector<std::size_t>& group_of,
                       std::size_t groups) {
  std::vector<std::vector<double>> sums(samples.size(), std::vector<double>(groups));
  GroupMeans result{std::vector<double>(groups), {groups, std::vector<double>(groups)}};
  const auto n = static_cast<double>(samples.size());
  for (std::size_t s = 0; s < samples.size(); ++s) {
    for (std::size_t b = 0; b < block_count; ++b) sums[s][group_of[b]] += samples[s][b];
    for (std::size_t g = 0; g < groups; ++g) result.mean[g] += sums[s][g] / n;
  }
  for (const std::vector<double>& x : sums)
    for (std::size_t g = 0; g < groups; ++g)
      for (std::size_t h = 0; h < groups; ++h)
        result.covariance[g][h] += (x[g] - result.mean[g]) * (x[h] - result.mean[h]) / (n * (n - 1));
  return result;
}

// d^T C^-1 d, by Cholesky's factors.
double squared_length(std::vector<std::vector<double>> c, std::vector<double> d) {
  double sum = 0;
  for (std::size_t k = 0; k < d.size(); ++k) {
    d[k] /= std::sqrt(c[k][k]);
    sum += d[k] * d[k];
    for (std::size_t i = k + 1; i < d.size(); ++i) {
      const double factor = c[i][k] / std::sqrt(c[k][k]);
      d[i] -= factor * d[k];
      for (std::size_t j = k + 1; j <= i; ++j) c[i][j] -= factor * c[j][k] / std::sqrt(c[k][k]);
    }
  }
  return sum;
}

// Hotelling's test, i.e. Pearson's for cells that are correlated: T² would be chi-squared, but the covariances are
// estimated from `frames` samples. The F distribution accounts for that, here by Paulson's approximation (1942). Blocks
// of less than 2 % of the light are pooled. Frames are stratified, which only makes T² smaller.
double hotelling_p(const std::vector<Blocks>& frames, const std::vector<Blocks>& traced) {
  Blocks share{};
  double total = 0;
  for (const Blocks& b : traced)
    for (std::size_t i = 0; i < block_count; ++i) {
      share[i] += b[i];
      total += b[i];
    }
  std::vector<std::size_t> group_of(block_count, 0);
  std::size_t groups = 1;  // the first: all dim blocks
  for (std::size_t i = 0; i < block_count; ++i)
    if (share[i] > 0.02 * total) group_of[i] = groups++;
  const GroupMeans found = group_means(frames, group_of, groups), expected = group_means(traced, group_of, groups);
  std::vector<double> difference(groups);
  std::vector<std::vector<double>> covariance = found.covariance;
  for (std::size_t g = 0; g < groups; ++g) {
    difference[g] = found.mean[g] - expected.mean[g];
    for (std::size_t h = 0; h < groups; ++h) covariance[g][h] += expected.covariance[g][h];
  }
  const auto k = static_cast<double>(groups), n = static_cast<double>(frames.size());
  const double f = squared_length(covariance, difference) * (n - k) / (k * (n - 1)), a = 2 / (9 * k),
               b = 2 / (9 * (n - k));
  const double root = std::cbrt(f);
  return 0.5 * std::erfc(((1 - b) * root - (1 - a)) / std::sqrt(2 * (b * root * root + a)));
}

// A lamp of nine tenths the width gives T² = 119. The limit is 80, and 5 is usual.
TEST_F(Photons, OfExtendedLampsLieWhereTracedOnesDo) {
  const Scene scene = test::scene_from_text(box(lamp_of("9 8 5", 0.6, 1.7)));
  EXPECT_TRUE(test::not_below(hotelling_p(watts_of_maps(scene, 600, 500), watts_of_traced(scene, 1000, 200)),
                              test::false_alarm_rate));
}

// The sun's finer map takes over its part of the light from the other map, and half of the photons.
TEST_F(Photons, OfNestedMapsCarryTheSameLight) {
  const Scene scene = test::scene_from_text(box(sun));
  Renderer renderer(scene);
  FrameSettings settings = photon_settings(20000);
  settings.views.map_size = 256;
  const LightFocus focus{Point(0.5f, 0, -0.4f), 0.3f};
  const auto starts = [&] {
    renderer.draw(make_view(scene.description().view), settings);
    BounceMap bounces(shader_files());
    bounces.start(renderer.light_maps(), 1, 20000, 0, 0);
    return bounces.read();
  };
  const auto watts = [](const std::vector<PhotonStart>& photons) {
    double sum = 0;
    for (const PhotonStart& start : photons) sum += static_cast<double>(start.power.y);
    return sum;
  };
  const auto near_focus = [&](const std::vector<PhotonStart>& photons) {
    return std::count_if(photons.begin(), photons.end(), [&](const PhotonStart& start) {
      return distance_squared(start.position, focus.centre) < 4 * focus.radius * focus.radius;
    });
  };
  const std::vector<PhotonStart> whole = starts();
  settings.views.focus = focus;
  const std::vector<PhotonStart> nested = starts();
  ASSERT_EQ(renderer.light_views().front().windows.size(), 2u);
  // Stratified photons of one light, in texels of 1 and .2 cm.
  EXPECT_NEAR(watts(nested) / watts(whole), 1, 0.01);
  EXPECT_GT(near_focus(nested), 10000);
  EXPECT_LT(near_focus(whole), 9000);
}

// Watts scattered at the first surfaces, by photons of the GPU and of the CPU.
TEST_F(Photons, OfMapsCarryTheLightThatIsScattered) {
  const Scene scene = test::scene_from_text(box(point_light));
  Renderer renderer(scene);
  FrameSettings settings = photon_settings(20000);
  settings.views.map_size = 256;
  renderer.draw(make_view(scene.description().view), settings);
  BounceMap bounces(shader_files());
  bounces.start(renderer.light_maps(), 1, 20000, 0, 0);
  double scattered = 0;
  for (const PhotonStart& start : bounces.read()) scattered += static_cast<double>(start.power.y);
  double expected = 0;
  constexpr int paths = 100000;
  RayCounts counts;
  const Wavelengths w = Wavelengths::rgb(0.5f);
  for (int i = 0; i < paths; ++i) {
    Sampler sampler = Sampler::for_light_path(test::seed(7), Stream::light, 0, 0, static_cast<std::uint32_t>(i));
    struct Visitor : FirstHit {
      double green = 0;
      using FirstHit::operator();
      Continuation operator()(const SurfaceVertex& v) {
        green = static_cast<double>((v.state.beta * albedo(v.at.bsdf, v.wi_local))[1]);
        return Continuation::stop();
      }
    } visitor;
    walk_from_light(PathContext{scene, w, sampler, counts, {1, 2}}, LightPath{scene.lights()[0]}, 0, visitor);
    expected += visitor.green / paths;
  }
  // Stratified photons of one light: 1 % is about twenty standard deviations of either sum.
  EXPECT_NEAR(scattered / expected, 1, 0.01);
}

}  // namespace
}  // namespace lanthorn::photons_test
