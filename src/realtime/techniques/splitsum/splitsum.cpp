// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The light of the environment alone, by its prefiltered maps (Karis 2013), without shadows.
#include <fmt/format.h>

#include <algorithm>

#include "realtime/techniques/frame_context.h"
#include "realtime/techniques/splitsum/environment_light.h"

namespace lanthorn {

namespace {

class EnvironmentAlone final : public Technique {
 public:
  explicit EnvironmentAlone(const gl::ShaderFiles& files) : light_(files) {}

  void prepare(const FrameContext& frame) override {
    const auto begin = std::chrono::steady_clock::now();
    if (light_.prepare(frame.scene)) frame.report.stages.push_back({"environment maps", milliseconds_since(begin)});
  }
  void draw(const FrameContext& frame) override {
    frame.timer.begin("split sum");
    frame.targets.direct.bind();
    light_.use(frame.rays);
    frame.screen.draw();
  }

 private:
  EnvironmentLight light_;
};

std::vector<std::string> limitations(const Scene& scene, const GpuScene* gpu_scene) {
  std::vector<std::string> list;
  const std::size_t others = scene.lights().size() - scene.infinite_lights().size();
  if (others > 0)
    list.push_back(fmt::format("splitsum lights by the environment alone: {} other light{} ignored", others,
                               others == 1 ? " is" : "s are"));
  const auto is_clear = [](const GpuMaterial& m) { return m.kind == gpu::kind_none && m.through != glm::vec4(0); };
  if (gpu_scene != nullptr && std::any_of(gpu_scene->materials().begin(), gpu_scene->materials().end(), is_clear))
    list.emplace_back("splitsum leaves out light through glass");
  return list;
}

}  // namespace

TechniqueInfo splitsum_technique() {
  return {.description = {.name = "splitsum",
                          .title = "Environment alone (split sum)",
                          .summary = "the environment alone, without shadows, by its prefiltered maps",
                          .paper = "Karis 2013",
                          .has_light_views = false,
                          .offline_method = "splitsum"},
          .make = [](const TechniqueShaders& shaders) -> std::unique_ptr<Technique> {
            return std::make_unique<EnvironmentAlone>(shaders.files);
          },
          // The split sum leaves glass black.
          .plan =
              [](const FrameSettings&) {
                return FramePlan{.eye_paths = no_eye_paths, .eye_paths_in_motion = no_eye_paths};
              },
          .limitations = limitations};
}

}  // namespace lanthorn
