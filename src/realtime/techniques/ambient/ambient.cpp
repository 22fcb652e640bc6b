// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A constant instead of indirect light.
#include <fmt/format.h>

#include <algorithm>

#include "light/light.h"
#include "realtime/scene/projection.h"
#include "realtime/techniques/frame_context.h"

namespace lanthorn {

namespace {

/// Irradiance, W/m², as if a third of the light were spread evenly over a room as large as the visible part of the
/// scene. Light from afar fills the scene.
float fitting_irradiance(const Scene& scene, const View& view) {
  const float scene_radius = scene.bounding_sphere().radius, seen = seen_radius(scene, view);
  float irradiance = 0;
  for (const Light& light : scene.lights())
    irradiance += power(light) / (3 * 4 * pi * sqr(is_far(light) ? scene_radius : seen));
  return irradiance;
}

class Ambient final : public Technique {
 public:
  explicit Ambient(const gl::ShaderFiles& files) : program_(files, "screen.vert.glsl", "ambient.frag.glsl") {}

  void draw(const FrameContext& frame) override {
    const TechniqueChoice& choice = frame.settings.technique;
    const float irradiance = choice.is_auto("ambient") ? fitting_irradiance(frame.scene, frame.view)
                                                       : static_cast<float>(choice.number("ambient"));
    frame.targets.indirect.bind();
    program_.use();
    program_.set("ambient", Vec3(irradiance));
    frame.screen.draw();
  }

 private:
  gl::Program program_;
};

}  // namespace

TechniqueInfo ambient_technique() {
  return {
      .description = {.name = "ambient",
                      .title = "Direct + ambient",
                      .summary = "and the same light everywhere",
                      .parameters = {{.info = {"ambient", "auto",
                                               "irradiance of all surfaces, W/m2: a third of the lights' power over a "
                                               "sphere around what is seen (auto), or a number"},
                                      .words = {"auto"},
                                      .numbers = NumberRange{0, 1e6},
                                      .control = PanelControl{.label = "Ambient",
                                                              .tip = "The same light on all surfaces, from all sides.",
                                                              .low = 0,
                                                              .high = 20,
                                                              .format = "%.3g W/m²",
                                                              .is_logarithmic = true}}},
                      .offline_method = "path"},
      .make = [](const TechniqueShaders& shaders) -> std::unique_ptr<Technique> {
        return std::make_unique<Ambient>(shaders.files);
      },
      .fit_view = [](const Scene& scene, const View& view) -> ParameterValues {
        return {{"ambient", fmt::format("{}", fitting_irradiance(scene, view))}};
      }};
}

}  // namespace lanthorn
