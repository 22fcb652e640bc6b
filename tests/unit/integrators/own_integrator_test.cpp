// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A user-defined rendering method: one class with its IntegratorInfo. Layers, states, parameters and merging work
// without further code.
#include <gtest/gtest.h>

#include <memory>
#include <new>
#include <string>

#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/image_file.h"
#include "path/eye_pass.h"
#include "support/error_text.h"
#include "support/render_scene.h"
#include "support/temporary_dir.h"

namespace lanthorn::own_integrator_test {
namespace {

// Ambient occlusion: the unoccluded fraction of a cosine-weighted hemisphere up to a distance, for pixels that see a
// surface, and 1 for all other pixels, which go into a separate layer.
class AmbientOcclusion final : public Integrator {
 public:
  explicit AmbientOcclusion(const Parameters& parameters)
      : reach_(static_cast<float>(parameters.number("reach", 1e-6, 1e6))) {}

  FilmContents film_contents(const Scene&) const override { return {.light = {"occlusion", "background"}}; }

  PassReport render_pass(const RenderJob& job, std::uint32_t pass, const FilmPass& film,
                         const PhaseObserver& begin) override {
    begin(Phase::eye);
    PassReport report;
    report.rays = for_each_pixel(job.view.window, [&](const PixelPlace& place, RayCounts& counts) {
      Sampler sampler = Sampler::for_pixel(job.settings.seed, stream, job.view.pixel_key(place.x, place.y), pass);
      const Wavelengths w = Wavelengths::rgb(0.5f);
      const EyeStart start = start_eye_path(job, place, pass, 0, sampler);
      PixelSample sample;
      sample.filter_part = start.filter_part;
      ++counts.walk;
      if (const auto at = job.scene.intersect(start.camera.ray, w))
        sample.light[0] = free_share(job.scene, *at, start.camera.ray.direction, sampler.next2()) * Rgb{1, 1, 1};
      else
        sample.light[1] = {1, 1, 1};
      film.add(place.index, sample);
    });
    return report;
  }

 private:
  static constexpr Stream stream = stream_of("ambient occlusion");

  float free_share(const Scene& scene, const SurfacePoint& at, const Direction& seen_along, const Vec2& u) const {
    Vec3 local = sample_cosine_hemisphere(u);
    if (dot(seen_along, at.normal) > 0) local.z = -local.z;
    Ray ray = spawn_ray(at, at.shading.to_world(local));
    ray.t_max = reach_;
    return scene.visible(ray) ? 1.0f : 0.0f;
  }

  float reach_;
};

// From the third on, its passes need more memory than is available.
class Insatiable final : public Integrator {
 public:
  PassReport render_pass(const RenderJob& /*any*/, std::uint32_t pass, const FilmPass& film,
                         const PhaseObserver& begin) override {
    begin(Phase::eye);
    PixelSample sample;
    sample.light[0] = {1, 1, 1};
    for (std::uint32_t pixel = 0; pixel < 10; ++pixel) film.add(pixel, sample);
    if (pass >= 2) throw std::bad_alloc();
    return {};
  }
};

// Registered once per process, whichever tests run.
const bool added = [] {
  add_integrator({"toy", "ambient occlusion", "a test", {{"reach", "10", "metres"}}, [](const Parameters& p) {
                    return std::unique_ptr<Integrator>(std::make_unique<AmbientOcclusion>(p));
                  }});
  add_integrator({"insatiable", "needs more memory than there is", "a test", {}, [](const Parameters&) {
                    return std::unique_ptr<Integrator>(std::make_unique<Insatiable>());
                  }});
  return true;
}();

// A floor with a wall on it, seen from above; half of the picture is sky.
const std::string corner = R"(
LookAt 0 3 6  0 0.5 0  0 1 0
Camera "perspective" "float fov" [60]
Film "rgb" "integer xresolution" [16] "integer yresolution" [12]
WorldBegin
LightSource "infinite"
Shape "bilinearmesh" "point3 P" [-2 0 2  2 0 2  -2 0 -2  2 0 -2]
Shape "bilinearmesh" "point3 P" [-2 0 -2  2 0 -2  -2 2 -2  2 2 -2]
)";

TEST(OwnIntegrator, HasItsLayersAndTheyAddUpToColor) {
  ASSERT_TRUE(added);
  const Scene scene = test::scene_from_text(corner);
  const Image image = test::render_image(scene, test::options_for("toy", 8));
  const std::vector<std::string> names = layer_names(image);
  EXPECT_EQ(std::vector(names.begin(), names.begin() + 3),
            (std::vector<std::string>{"color", "occlusion", "background"}));
  const Image color = *select_layer(image, "color"), occlusion = *select_layer(image, "occlusion"),
              background = *select_layer(image, "background");
  double free = 0, sky = 0;
  for (std::size_t i = 0; i < color.pixels.size(); ++i) {
    EXPECT_FLOAT_EQ(color.pixels[i], occlusion.pixels[i] + background.pixels[i]);
    free += static_cast<double>(occlusion.pixels[i]);
    sky += static_cast<double>(background.pixels[i]);
  }
  EXPECT_GT(free, 0);
  EXPECT_GT(sky, 0);
  // Rays of length 0 are never occluded.
  const Image open = *select_layer(test::render_image(scene, test::options_for("toy:reach=1e-6", 8)), "color");
  for (const float value : open.pixels) EXPECT_FLOAT_EQ(value, 1);
}

TEST(OwnIntegrator, GoesOnFromItsStateAndItsShardsMerge) {
  const Scene scene = test::scene_from_text(corner);
  const RenderState whole = test::render_state(scene, test::options_for("toy", 4));
  const RenderState first = decode_state(encode_state(test::render_state(scene, test::options_for("toy", 2))), "s");
  EXPECT_EQ(encode_state(test::render_state(scene, test::options_for("toy", 4), first)), encode_state(whole));
  RenderOptions rest = test::options_for("toy", 4);
  rest.passes.reset();
  rest.pass_range = PassRange{2, 4};
  EXPECT_EQ(encode_state(merge_states(test::render_state(scene, rest), first)), encode_state(whole));
  RenderState other = test::render_state(scene, test::options_for("path", 2));
  other.passes = {{4, 6}};
  other.record = whole.record;
  EXPECT_THROW(merge_states(whole, other), Error);
}

TEST(OwnIntegrator, LayersAreWrittenToFiles) {
  const test::TemporaryDir dir;
  const Scene scene = test::scene_from_text(corner);
  const Image image = test::render_image(scene, test::options_for("toy", 1));
  write_image(dir.path() / "a.exr", image);
  const Image read = read_image(dir.path() / "a.exr");
  for (const char* layer : {"color", "occlusion", "background"})
    EXPECT_EQ(select_layer(read, layer)->pixels, select_layer(image, layer)->pixels) << layer;
}

TEST(OwnIntegrator, ErrorsKnowItsParametersAndNames) {
  const Scene scene = test::scene_from_text(corner);
  const auto error_of = [&](const std::string& integrator) {
    return test::error_text([&] { test::plan_render(scene, test::options_for(integrator, 1)); });
  };
  EXPECT_EQ(error_of("toy:reach=0"), "--set reach=0: expected a number from 1e-06 to 1000000");
  EXPECT_NE(error_of("toy:raech=1").find("integrator 'toy' has no such parameter"), std::string::npos);
  EXPECT_NE(error_of("tay").find("toy"), std::string::npos);
  EXPECT_EQ(test::error_text([] { add_integrator(find_integrator("toy")); }),
            "an integrator named 'toy' exists already");
}

TEST(OwnIntegrator, APassWithoutMemoryLeavesThePassesBeforeIt) {
  const Scene scene = test::scene_from_text(corner);
  RenderOptions options;
  options.integrator = "insatiable";
  options.passes = 2;
  const Image before = test::render_image(scene, options);
  options.passes = 5;
  RenderPlan plan = test::plan_render(scene, options);
  plan.stop.undo = Undo::always;
  const RenderStatistics statistics = render(scene, plan, plan.stop);
  EXPECT_TRUE(statistics.out_of_memory);
  EXPECT_EQ(plan.state.pass_count(), 2u);
  EXPECT_EQ(picture_of(plan.state).pixels, before.pixels);
}

}  // namespace
}  // namespace lanthorn::own_integrator_test
