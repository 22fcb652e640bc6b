// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Techniques as methods of `render`: every pass is a frame with its own photons, views of lights and turns, and the
// image is the mean of the frames.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "film/film_pass.h"
#include "gl/context.h"
#include "integrators/integrator.h"
#include "lanthorn/methods.h"
#include "math/sampler.h"
#include "path/path_draw.h"
#include "photon/photon.h"
#include "realtime/frame/renderer.h"
#include "realtime/techniques/technique.h"
#include "scene/scene_data.h"

namespace lanthorn {

namespace {

/// The layers of a frame and the surfaces that they show, on the CPU.
struct FrameOnCpu {
  Image light;
  std::vector<glm::vec4> positions, colours;
  std::vector<glm::uvec4> surfaces;
};

FrameOnCpu read_frame(const Renderer& renderer) {
  const GBuffer& g = renderer.gbuffer();
  return {renderer.read_layers(), g.position().read<glm::vec4>({GL_RGBA, GL_FLOAT}, 1),
          g.colour().read<glm::vec4>({GL_RGBA, GL_FLOAT}, 1),
          g.surface().read<glm::uvec4>({GL_RGBA_INTEGER, GL_UNSIGNED_INT}, 1)};
}

PixelSample sample_of(const FrameOnCpu& frame, std::size_t pixel, FilterPart part, float imaging_ratio,
                      const Point& eye) {
  PixelSample sample;
  const float* light = frame.light.pixels.data() + pixel * frame.light.channel_count();
  for (std::size_t layer = 0; layer < path_class_count; ++layer)
    sample.light[layer] = imaging_ratio * Rgb{light[3 * layer], light[3 * layer + 1], light[3 * layer + 2]};
  sample.filter_part = part;
  if (frame.positions[pixel].w == 0) return sample;
  const glm::vec4& colour = frame.colours[pixel];
  sample.features.albedo = {colour.x, colour.y, colour.z};
  sample.features.normal = decode_octahedral<16>(frame.surfaces[pixel].x);
  sample.features.position = {Point(frame.positions[pixel])};
  sample.features.depth = std::sqrt(distance_squared(sample.features.position.at, eye));
  return sample;
}

/// Sets the points on film, lens and lights that all pixels of a pass share. Returns the part of the filter to which
/// its samples belong.
FilterPart place_frame(const RenderJob& job, std::uint32_t pass, FrameSettings& settings) {
  Sampler sampler = Sampler::for_pass(job.settings.seed, pass);
  sampler.seek(2);
  const FilterPart part = job.view.filter.place_of_sample(place_in_half(pass, job.settings.parts).number).part;
  settings.offset = job.view.filter.sample(sampler.next2(), part);
  settings.lens = sampler.next2();
  settings.time = job.view.camera.time(sampler.next());
  settings.views.frame = pass;
  return part;
}

/// Adds the last frame to the film: light and features.
void add_frame(const Renderer& renderer, const RenderJob& job, const FrameSettings& settings, FilterPart part,
               const FilmPass& film) {
  const FrameOnCpu seen = read_frame(renderer);
  const Point eye = window_rays(job.view, settings.offset, settings.lens, settings.time).eye;
  const int width = seen.light.width;
  parallel_for(0, seen.light.height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const auto pixel = static_cast<std::uint32_t>(y * width + x);
      film.add(pixel, sample_of(seen, pixel, part, job.view.imaging_ratio, eye));
    }
  });
}

/// The frame's counts of rays and photons, and its times.
PassReport report_of(const FrameReport& frame) {
  PassReport report;
  report.rays.walk = frame.rays;
  report.rays.shadow = frame.shadow_rays;
  for (const std::uint64_t count : frame.photons_per_bounce) report.photons_stored += count;
  constexpr double milliseconds_of_second = 1000;
  for (const gl::StageTime& stage : frame.stages)
    report.stages.push_back({stage.stage, stage.milliseconds / milliseconds_of_second});
  report.photons_per_bounce = frame.photons_per_bounce;
  report.radius = frame.radius;
  return report;
}

class FrameIntegrator final : public Integrator {
 public:
  FrameIntegrator(const TechniqueInfo& technique, const Parameters& parameters)
      : technique_(technique), values_(parameters.all()), frame_(TechniqueChoice(name(), values_)) {
    if (technique_.check != nullptr) technique_.check(frame_.technique);
  }

  void prepare(const RenderJob& job) override {
    context_.emplace(gl::Context::headless());
    renderer_.emplace(job.scene);
    if (technique_.fit_render != nullptr && has_auto()) {
      ParameterValues values = values_;
      for (const auto& [parameter, value] : technique_.fit_render(job))
        if (values.at(parameter) == "auto") values[parameter] = value;
      frame_ = FrameSettings(TechniqueChoice(name(), values));
    }
    frame_.photons = static_cast<std::uint32_t>(std::min<std::uint64_t>(job.settings.photons, most_frame_photons));
    frame_.max_depth = job.settings.max_depth;
    frame_.views.seed = job.settings.seed;
  }
  bool knows_bias() const override { return false; }
  bool crops_are_exact() const override { return false; }
  std::string limitation(const Scene& scene) const override {
    std::vector<std::string> missing;
    if (technique_.limitations != nullptr) missing = technique_.limitations(scene, nullptr);
    for (std::string& lights : light_limitations(scene)) missing.push_back(std::move(lights));
    if (scene.has_media()) missing.push_back(fmt::format("{} leaves out media", name()));
    return fmt::format("{}", fmt::join(missing, "; "));
  }
  std::string remark() const override {
    const gl::Driver& driver = context_->driver();
    return fmt::format("{} draws by {}{}", name(), driver.renderer, driver.software ? ", in software" : "");
  }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, const FilmPass& film,
                         const PhaseObserver& begin) override;

 private:
  const std::string& name() const { return technique_.description.name; }
  bool has_auto() const {
    return std::any_of(values_.begin(), values_.end(), [](const auto& value) { return value.second == "auto"; });
  }

  const TechniqueInfo& technique_;
  ParameterValues values_;
  FrameSettings frame_;
  std::optional<gl::Context> context_;
  std::optional<Renderer> renderer_;  // its objects are those of the context, which must outlive it
};

PassReport FrameIntegrator::render_pass(const RenderJob& job, std::uint32_t pass, const FilmPass& film,
                                        const PhaseObserver& begin) {
  const bool has_photons = technique_.description.has_photons;
  const gl::CurrentScope current(*context_);
  begin(has_photons ? Phase::photons : Phase::eye);
  const FilterPart part = place_frame(job, pass, frame_);
  renderer_->draw(job.view, frame_);
  begin(Phase::eye);
  PassReport report = report_of(renderer_->report());
  add_frame(*renderer_, job, frame_, part, film);
  if (has_photons) report.light_paths = frame_.photons;
  return report;
}

/// The method that renders by frames of this technique.
IntegratorInfo frame_method(const TechniqueInfo& technique) {
  const TechniqueDescription& description = technique.description;
  std::vector<ParameterInfo> parameters;
  for (const TechniqueParameter& p : all_parameters(description)) parameters.push_back(p.info);
  return {description.name, description.summary, description.paper, std::move(parameters),
          [&technique](const Parameters& p) -> std::unique_ptr<Integrator> {
            return std::make_unique<FrameIntegrator>(technique, p);
          }};
}

}  // namespace

void add_realtime_methods() {
  for (const TechniqueInfo* technique : technique_registry())
    if (technique->description.offline_method.empty()) add_integrator(frame_method(*technique));
}

}  // namespace lanthorn
