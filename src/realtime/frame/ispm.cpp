// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Image-space photon mapping (McGuire & Luebke 2009) as a method of `render`: every pass is a frame with photons and
// views of lights of its own, whose radius depends on the pass number only (Knaus & Zwicker 2011), and the image is the
// mean of the frames.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string>
#include <vector>

#include "gl/context.h"
#include "integrators/integrator.h"
#include "lanthorn/realtime.h"
#include "photon/pilot_radius.h"
#include "photon/radius_schedule.h"
#include "realtime/frame/frame_pass.h"
#include "realtime/frame/renderer.h"
#include "realtime/frame/voxelcones.h"

namespace lanthorn {

namespace {

class ImageSpacePhotonMapper final : public Integrator {
 public:
  explicit ImageSpacePhotonMapper(const Parameters& parameters)
      : alpha_(parameters.number("alpha", 1e-3, 1)), radius_choice_(RadiusChoice::from(parameters)) {
    frame_.indirect = IndirectLight::photons;
    frame_.shadows = shadow_kind(parameters);
    frame_.views = light_view_settings(parameters);
    frame_.photons.gather = choice<PhotonGather, 3>(
        parameters, "gather",
        {{{"auto", PhotonGather::automatic}, {"splat", PhotonGather::splat}, {"tiles", PhotonGather::tiles}}});
    if (radius_choice_.kind == RadiusChoice::Kind::pixel)
      throw Error("--set radius=pixel: expected auto, or a length in metres above 0; photons have one radius here");
  }

  void prepare(const RenderJob& job) override {
    context_.emplace(gl::Context::headless());
    renderer_.emplace(job.scene);
    constexpr double photons_of_first_gather = 10;
    first_radius_ = choose_first_radius(job, radius_choice_, photons_of_first_gather).typical();
    frame_.photons.count = static_cast<std::uint32_t>(std::min<std::uint64_t>(job.settings.photons, most_photons));
    frame_.photons.max_depth = job.settings.max_depth;
    frame_.views.seed = job.settings.seed;
  }
  std::string limitation(const Scene& scene) const override {
    std::vector<std::string> missing;
    if (const std::string lights = unsupported_lights(scene); !lights.empty()) missing.push_back(lights);
    if (scene.has_media()) missing.emplace_back("ispm leaves out media");
    return fmt::format("{}", fmt::join(missing, "; "));
  }
  std::string remark() const override { return driver_remark("ispm", context_->driver()); }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, Film& film, const PhaseObserver& begin) override;

 private:
  static constexpr std::uint64_t most_photons = std::uint64_t{1} << 24;

  double alpha_;
  RadiusChoice radius_choice_;
  float first_radius_ = 0;
  FrameSettings frame_;
  std::optional<gl::Context> context_;
  std::optional<Renderer> renderer_;  // its objects are those of the context, which must outlive it
};

PassReport ImageSpacePhotonMapper::render_pass(const RenderJob& job, std::uint32_t pass, Film& film,
                                               const PhaseObserver& begin) {
  const gl::CurrentScope current(*context_);
  begin(Phase::photons);
  const float weight = place_frame(job, pass, frame_);
  frame_.photons.radius = first_radius_ * RadiusSchedule{1, alpha_}.radius(pass);
  renderer_->draw(job.view, frame_);
  begin(Phase::eye);
  PassReport report = report_of(renderer_->report());
  add_frame(*renderer_, job, frame_, weight, film);
  report.light_paths = frame_.photons.count;
  report.radius = frame_.photons.radius;
  return report;
}

IntegratorInfo ispm_info() {
  return {
      "ispm",
      "image-space photon mapping by OpenGL, as the viewer draws it: for diffuse and rough surfaces",
      "McGuire & Luebke 2009",
      {radius_reduction_info("0.6667"),
       {"radius", "auto", "first radius: auto (one for the scene), or a length in metres"},
       {"gather", "auto",
        "splat (photon volumes are drawn), tiles (tiles of pixels find their photons), or auto: tiles in software, "
        "else splat"},
       shadow_info(),
       map_info(),
       sky_info()},
      [](const Parameters& p) -> std::unique_ptr<Integrator> { return std::make_unique<ImageSpacePhotonMapper>(p); }};
}

}  // namespace

void add_realtime_methods() {
  add_integrator(ispm_info());
  add_integrator(voxelcones_info());
}

}  // namespace lanthorn
