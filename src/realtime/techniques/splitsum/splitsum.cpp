// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The light of the environment alone, by its prefiltered maps (Karis 2013), without shadows.
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "gl/context.h"
#include "gl/program.h"
#include "integrators/environment_image.h"
#include "realtime/scene/gpu_scene.h"
#include "realtime/techniques/frame_context.h"
#include "realtime/techniques/splitsum/environment_maps.h"

namespace lanthorn {

namespace {

/// Split-sum shading of visible surfaces, by the maps of the scene's environment.
class EnvironmentLight {
 public:
  explicit EnvironmentLight(const gl::ShaderFiles& files)
      : files_(files), shade_(files, "screen.vert.glsl", "split_sum.frag.glsl") {}

  /// Bakes the maps if the environment has changed; returns whether it has. A GPU bakes them itself; with software
  /// OpenGL the CPU does.
  bool prepare(const Scene& scene) {
    std::vector<Vec3> fingerprint = environment_fingerprint(scene);
    if (fingerprint == fingerprint_) return false;
    const Image image = environment_image(scene);
    maps_ = gl::current_driver("").software ? EnvironmentMaps(SplitSum(image))
                                            : EnvironmentBaker(files_).bake(image, split_sum_settings(image));
    fingerprint_ = std::move(fingerprint);
    return true;
  }
  /// Uses the program split_sum.frag.glsl with its maps. G-buffer and scene must be bound.
  void use(const WindowRays& rays) const {
    shade_.use();
    shade_.set("eye", rays.eye);
    shade_.set("axis", glm::vec4(rays.axis, rays.parallel ? 1 : 0));
    maps_.bind(shade_);
  }

 private:
  gl::ShaderFiles files_;
  gl::Program shade_;
  EnvironmentMaps maps_;
  std::vector<Vec3> fingerprint_;
};

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
