// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/realtime_view.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lanthorn/text.h"
#include "math/sampler.h"

namespace lanthorn {

namespace {

// The technique with its own parameters, taken from `values`, which may have parameters of other techniques, too.
TechniqueChoice choice_of(const std::string& technique, const ParameterValues& values) {
  ParameterValues own;
  for (const TechniqueParameter& p : all_parameters(find_technique(technique)->description))
    own[p.info.name] = values.at(p.info.name);
  return TechniqueChoice(technique, own);
}

ParameterValues default_values() {
  ParameterValues values;
  for (const TechniqueInfo* technique : technique_registry())
    for (const TechniqueParameter& p : all_parameters(technique->description))
      values.try_emplace(p.info.name, p.default_in_viewer());
  return values;
}

void set_values(const std::string& method, const std::map<std::string, std::string>& set, ParameterValues& values) {
  for (const auto& [name, text] : set) {
    const auto value = values.find(name);
    if (value != values.end()) {
      value->second = text;
      continue;
    }
    std::vector<std::string> known;
    for (const auto& [known_name, known_value] : values) known.push_back(known_name);
    throw Error(fmt::format("--set {}={}: the viewer knows {}{}", name, text, fmt::join(known, ", "),
                            did_you_mean(name, known)));
  }
  for (const TechniqueInfo* technique : technique_registry()) {
    const TechniqueChoice choice = choice_of(technique->description.name, values);
    if (technique->check != nullptr && technique->description.name == method) technique->check(choice);
  }
}

void fit_values(const Scene& scene, const View& view, ParameterValues& values) {
  for (const TechniqueInfo* technique : technique_registry()) {
    if (technique->fit_view == nullptr) continue;
    for (const auto& [name, value] : technique->fit_view(scene, view))
      if (values.at(name) == "auto") values[name] = value;
  }
}

}  // namespace

std::vector<MethodInfo> realtime_methods() {
  std::vector<MethodInfo> methods;
  for (const TechniqueInfo* technique : technique_registry()) {
    const TechniqueDescription& d = technique->description;
    MethodInfo method{d.name, d.summary, d.paper, {}};
    for (const TechniqueParameter& p : all_parameters(d))
      method.parameters.push_back({p.info.name, p.default_in_viewer(), p.info.help});
    methods.push_back(std::move(method));
  }
  return methods;
}

RealtimeSettings realtime_settings(const Scene& scene, const View& view, const ViewerOptions& options) {
  RealtimeSettings s;
  const bool is_technique = find_technique(options.method) != nullptr;
  s.technique = is_technique ? options.method : stand_in_technique;
  s.values = default_values();
  if (is_technique) set_values(options.method, options.render.set, s.values);
  fit_values(scene, view, s.values);
  s.seed = options.render.seed.value_or(0);
  s.max_depth = options.render.max_depth.value_or(s.max_depth);
  s.photons = static_cast<std::uint32_t>(
      std::min(options.render.photons.value_or(s.photons), std::uint64_t{most_frame_photons}));
  return s;
}

FrameSettings frame_settings(const RealtimeSettings& s, const View& view, std::uint32_t frame) {
  FrameSettings f(choice_of(s.technique, s.values));
  Sampler sampler = Sampler::for_pass(s.seed, frame);
  sampler.seek(2);
  f.offset = view.filter.sample(sampler.next2(), FilterPart::positive);
  f.lens = sampler.next2();
  f.time = view.camera.time(sampler.next());
  f.views.seed = s.seed;
  f.views.frame = frame;
  f.has_light_focus = true;
  f.photons = s.photons;
  f.max_depth = s.max_depth;
  // The first frames are without dispersion, so that the coloured noise of later ones is a small part of the mean.
  constexpr std::uint32_t frames_without_dispersion = 8;
  f.disperses = frame >= frames_without_dispersion;
  return f;
}

bool is_drawable(const ViewDescription& view) {
  return std::holds_alternative<description::PerspectiveCamera>(view.camera.node) ||
         std::holds_alternative<description::OrthographicCamera>(view.camera.node);
}

ViewDescription drawable(ViewDescription view) {
  if (is_drawable(view)) return view;
  constexpr float fov = 60;
  view.camera.node = description::PerspectiveCamera{fov};
  view.camera.screen_window.reset();
  view.camera.frame_aspect_ratio.reset();
  return view;
}

std::vector<std::string> limitations_of(const Renderer& renderer, const Scene& scene,
                                        const RealtimeSettings& settings) {
  std::vector<std::string> list = renderer.gpu_scene().limitations();
  if (scene.has_media()) list.emplace_back("media are left out");
  if (scene.lights().empty()) list.emplace_back("the scene has no lights: all of it is black");
  FrameSettings frame(choice_of(settings.technique, settings.values));
  frame.max_depth = settings.max_depth;
  const TechniqueInfo& technique = frame.technique.info();
  if (technique.limitations != nullptr)
    for (std::string& limitation : technique.limitations(scene, &renderer.gpu_scene()))
      list.push_back(std::move(limitation));
  if (!technique.description.has_light_views) return list;
  for (std::string& limitation : light_limitations(scene)) list.push_back(std::move(limitation));
  // Narrow lobes mirror the sky in every frame: by the technique, or by eye paths, which draw other materials, too.
  const float least_alpha = technique.plan(frame).least_sky_alpha;
  const auto mirrors_sky = [&](const GpuMaterial& m) {
    if ((m.flags & gpu::flag_smooth) != 0) return true;
    return least_alpha > 0 ? m.colour.w < least_alpha : (m.flags & gpu::flag_traced) != 0;
  };
  const std::vector<GpuMaterial>& materials = renderer.gpu_scene().materials();
  const bool reflects = std::any_of(materials.begin(), materials.end(), [&](const GpuMaterial& m) {
    return (m.kind == gpu::kind_metal || m.kind == gpu::kind_plastic) && !mirrors_sky(m);
  });
  if (!scene.infinite_lights().empty() && reflects)
    list.emplace_back(
        "reflections of the surroundings in metals and coats appear slowly, by four directions a frame; splitsum shows "
        "them at once");
  return list;
}

void EyePathSpacing::learn(const FrameReport& report, int spacing) {
  double milliseconds = 0;
  for (const gl::StageTime& stage : report.stages)
    if (stage.stage == eye_path_stage) milliseconds += stage.milliseconds;
  const double wanted = std::ceil(spacing * std::sqrt(milliseconds / budget));
  pixels_ = static_cast<int>(std::clamp(wanted, 1.0, double{most}));
}

void MovingResolution::learn(double seconds, double share) {
  // Steps, so that textures are seldom made anew. A frame may take somewhat more or less time than it should.
  constexpr double wanted = 0.075, slack = 1.3, step = 0.8;
  constexpr int coarsest = 6;  // steps: a quarter of the width
  if (seconds > slack * wanted || seconds < wanted / slack) {
    const double fitting = share * std::sqrt(wanted / std::max(seconds, 1e-4));
    const double steps = std::ceil(std::log(fitting) / std::log(step));
    share_ = std::pow(step, std::clamp(steps, 0.0, double{coarsest}));
  }
}

void StageSums::add(const FrameReport& report) {
  ++frames_;
  for (const gl::StageTime& stage : report.stages) {
    auto sum = std::find_if(sums_.begin(), sums_.end(), [&](const FrameStage& s) { return s.name == stage.stage; });
    if (sum == sums_.end()) sum = sums_.insert(sums_.end(), {stage.stage, 0});
    sum->milliseconds += stage.milliseconds;
  }
}

std::vector<FrameStage> StageSums::means() const {
  std::vector<FrameStage> means = sums_;
  for (FrameStage& stage : means) stage.milliseconds /= static_cast<double>(frames_);
  return means;
}

}  // namespace lanthorn
