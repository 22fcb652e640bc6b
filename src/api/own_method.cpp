// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/own_method.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "integrators/integrator.h"
#include "lanthorn/error.h"
#include "math/hash.h"
#include "path/eye_pass.h"
#include "scene/scene.h"

namespace lanthorn {

namespace {

constexpr int rows_of_tile = 32;

struct EyeSample {
  FilterPart filter_part{};
  float camera_weight = 1;
};

class OwnMethod final : public Integrator {
 public:
  explicit OwnMethod(OwnRadiance radiance) : radiance_(std::move(radiance)) {}

  void prepare(const RenderJob& job) override {
    if (job.settings.color != ColorMode::rgb) throw Error("user-defined methods render in RGB only (--color rgb)");
    scene_ = std::make_shared<const Scene>(job.scene.data());
  }
  FilmContents film_contents(const Scene&) const override { return {}; }
  bool crops_are_exact() const override { return false; }
  // Computes the whole pass before adding any of it to the film, so that an exception leaves no partial pass.
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, const FilmPass& film,
                         const PhaseObserver& begin) override {
    begin(Phase::eye);
    const PixelWindow& window = job.view.window;
    const auto count = static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
    std::vector<SceneRay> rays(count);
    std::vector<EyeSample> samples(count);
    std::vector<Rgb> radiance(count);
    PassReport report;
    report.rays = for_each_pixel(window, [&](const PixelPlace& place, RayCounts& counts) {
      start(job, place, pass, rays[place.index], samples[place.index]);
      ++counts.walk;
    });
    const std::size_t tile = static_cast<std::size_t>(window.width()) * rows_of_tile;
    for (std::size_t first = 0; first < count; first += tile) {
      stop_point();
      const std::size_t size = std::min(tile, count - first);
      const std::uint64_t key = hash_words({job.settings.seed, pass, first});
      radiance_(scene_, {std::span(rays).subspan(first, size), key}, std::span(radiance).subspan(first, size));
    }
    for (std::size_t i = 0; i < count; ++i) {
      PixelSample sample;
      sample.light[0] = samples[i].camera_weight * radiance[i];
      sample.filter_part = samples[i].filter_part;
      film.add(static_cast<std::uint32_t>(i), sample);
    }
    return report;
  }

 private:
  static void start(const RenderJob& job, const PixelPlace& place, std::uint32_t pass, SceneRay& ray,
                    EyeSample& sample) {
    Sampler sampler = eye_sampler(job, place, pass);
    const EyeStart eye = start_eye_path(job, place, pass, job.view.camera.time(0), sampler);
    ray = {Point(DVec3(eye.camera.ray.origin) + job.scene.description().origin), eye.camera.ray.direction};
    sample = {eye.filter_part, eye.camera.weight};
  }

  OwnRadiance radiance_;
  SharedScene scene_;
};

}  // namespace

void add_method(const std::string& name, const std::string& summary, OwnRadiance radiance) {
  add_integrator({name, summary, "", {}, [radiance = std::move(radiance)](const Parameters&) {
                    return std::unique_ptr<Integrator>(std::make_unique<OwnMethod>(radiance));
                  }});
}

}  // namespace lanthorn
