// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Voxel cone tracing (Crassin et al. 2011) as a method of `render`: every pass is a frame with views of lights and
// turns of the cones of its own, and the image is the mean of the frames. It has a bias that no number of passes
// removes.
#include "realtime/frame/voxelcones.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <vector>

#include "gl/context.h"
#include "realtime/frame/frame_pass.h"
#include "realtime/frame/renderer.h"

namespace lanthorn {

namespace {

class VoxelConeTracer final : public Integrator {
 public:
  explicit VoxelConeTracer(const Parameters& parameters) {
    frame_.shadows = shadow_kind(parameters);
    frame_.views = light_view_settings(parameters);
    const int size = static_cast<int>(parameters.number("voxels", least_voxels, most_voxels));
    if (!std::has_single_bit(static_cast<unsigned>(size)))
      throw Error(
          fmt::format("--set voxels={}: expected a power of two from {} to {}", size, least_voxels, most_voxels));
    frame_.voxels.size = size;
    frame_.voxels.bounces = static_cast<int>(parameters.number("bounces", 1, most_voxel_bounces));
    if (parameters.text("grids") != "auto")
      frame_.voxels.grids = static_cast<int>(parameters.number("grids", 1, voxel_grid_limit(size)));
  }

  void prepare(const RenderJob& job) override {
    context_.emplace(gl::Context::headless());
    renderer_.emplace(job.scene);
    frame_.views.seed = job.settings.seed;
    frame_.indirect = job.settings.max_depth > 1 ? IndirectLight::voxels : IndirectLight::none;
    frame_.voxels.bounces = std::min(frame_.voxels.bounces, job.settings.max_depth - 1);
  }
  std::string limitation(const Scene& scene) const override {
    std::vector<std::string> missing{"voxelcones is coarse: light leaks and blurs at the width of its voxels"};
    if (scene.may_be_specular())
      missing.emplace_back("it shows direct light alone in glass, and what mirrors reflect in voxels");
    if (const std::string lights = unsupported_lights(scene); !lights.empty()) missing.push_back(lights);
    if (scene.has_media()) missing.emplace_back("it leaves out media");
    return fmt::format("{}", fmt::join(missing, "; "));
  }
  std::string remark() const override { return driver_remark("voxelcones", context_->driver()); }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, Film& film, const PhaseObserver& begin) override {
    const gl::CurrentScope current(*context_);
    begin(Phase::eye);
    const float weight = place_frame(job, pass, frame_);
    frame_.voxels.turn = turn_of_frame(pass);
    renderer_->draw(job.view, frame_);
    PassReport report = report_of(renderer_->report());
    add_frame(*renderer_, job, frame_, weight, film);
    return report;
  }

 private:
  FrameSettings frame_;
  std::optional<gl::Context> context_;
  std::optional<Renderer> renderer_;  // its objects are those of the context, which must outlive it
};

}  // namespace

IntegratorInfo voxelcones_info() {
  return {"voxelcones",
          "voxel cone tracing by OpenGL, as the viewer draws it: coarse and quick, without noise",
          "Crassin et al. 2011",
          {{"voxels", "64", "along an edge of each grid: a power of two"},
           {"grids", "auto", "nested around the eye, each half as wide as the one before: auto, or their number"},
           {"bounces", "4", "of indirect light, at most"},
           shadow_info(),
           map_info(),
           sky_info()},
          [](const Parameters& p) -> std::unique_ptr<Integrator> { return std::make_unique<VoxelConeTracer>(p); }};
}

}  // namespace lanthorn
