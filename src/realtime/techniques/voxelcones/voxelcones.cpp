// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Voxel cone tracing (Crassin et al. 2011): indirect light of voxels, which the lights' views illuminate. It has a bias
// that no number of frames removes.
#include <fmt/format.h>

#include <algorithm>

#include "lanthorn/error.h"
#include "realtime/scene/materials.h"
#include "realtime/techniques/frame_context.h"
#include "realtime/techniques/voxelcones/voxel_light.h"

namespace lanthorn {

namespace {

/// With a single scattering event, all light is direct.
bool has_indirect(const FrameSettings& settings) { return settings.max_depth > 1; }

VoxelSettings voxel_settings(const FrameSettings& s) {
  const TechniqueChoice& choice = s.technique;
  return {choice.whole("voxels"), std::min(choice.whole("bounces"), s.max_depth - 1),
          choice.is_auto("grids") ? 0 : choice.whole("grids"), turn_of_frame(s.views.frame),
          s.shadows != ShadowKind::none};
}

class VoxelCones final : public Technique {
 public:
  explicit VoxelCones(const gl::ShaderFiles& files) : light_(files) {}

  void draw(const FrameContext& frame) override {
    if (!has_indirect(frame.settings)) return;
    const VoxelSettings settings = voxel_settings(frame.settings);
    const auto begin = std::chrono::steady_clock::now();
    if (light_.prepare(frame.scene, frame.gpu_scene, frame.view, settings))
      frame.report.stages.push_back({"voxelisation (CPU)", milliseconds_since(begin)});
    frame.timer.begin("light of the voxels");
    light_.light(frame.light_maps, static_cast<int>(frame.light_views.size()), settings);
    frame.timer.begin("cones");
    frame.seen.bind();
    frame.targets.indirect.bind();
    light_.use(frame.rays, settings, frame.eye_paths);
    frame.screen.draw();
  }

 private:
  VoxelLight light_;
};

void check(const TechniqueChoice& choice) {
  const int limit = voxel_grid_limit(choice.whole("voxels"));
  if (!choice.is_auto("grids") && choice.whole("grids") > limit)
    throw Error(fmt::format(
        "--set grids={}: expected auto or a number from 1 to {}, since there are {} voxels along an edge of each",
        choice.text("grids"), limit, choice.text("voxels")));
}

std::vector<std::string> limitations(const Scene& scene, const GpuScene* /*gpu_scene*/) {
  std::vector<std::string> list{"voxelcones is coarse: light leaks and blurs at the width of its voxels"};
  if (scene.may_be_specular())
    list.emplace_back("voxelcones shows direct light alone in glass, and what mirrors reflect in voxels");
  return list;
}

std::vector<TechniqueParameter> parameters() {
  return {
      {.info = {"voxels", "64", "along an edge of each grid: a power of two"},
       .viewer_default = "32",
       .numbers = NumberRange{least_voxels, most_voxels, NumberRange::Kind::power_of_two},
       .control = PanelControl{.label = "Voxels"}},
      {.info = {"grids", "auto", "nested around the eye, each half as wide as the one before: auto, or their number"},
       .words = {"auto"},
       .numbers = NumberRange{1, gpu::most_voxel_grids, NumberRange::Kind::whole},
       .control = PanelControl{.label = "Grids",
                               .tip = "Nested around the eye, each half as wide as the one before",
                               .words = {"Automatic"}}},
      {.info = {"bounces", "4", "of indirect light, at most"},
       .numbers = NumberRange{1, most_voxel_bounces, NumberRange::Kind::whole},
       .control = PanelControl{.label = "Bounces", .low = 1, .high = 6}}};
}

}  // namespace

TechniqueInfo voxelcones_technique() {
  return {.description = {.name = "voxelcones",
                          .title = "Voxel cones",
                          .summary =
                              "voxel cone tracing by OpenGL, as the viewer draws it: coarse and quick, without noise",
                          .paper = "Crassin et al. 2011",
                          .parameters = parameters()},
          .make = [](const TechniqueShaders& shaders) -> std::unique_ptr<Technique> {
            return std::make_unique<VoxelCones>(shaders.files);
          },
          // Cones show mirrors and narrow lobes themselves.
          .plan =
              [](const FrameSettings& settings) {
                if (!has_indirect(settings)) return FramePlan{};
                return FramePlan{.eye_paths = glass_eye_paths,
                                 .eye_paths_in_motion = glass_eye_paths,
                                 .least_sky_alpha = least_alpha_under_sky};
              },
          .check = check,
          .limitations = limitations};
}

}  // namespace lanthorn
