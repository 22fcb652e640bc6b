// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/offline_command.h"

#include <fmt/format.h>

#include <algorithm>

namespace lanthorn {

namespace {

LookAt look_of(const CameraPose& camera, const DVec3& origin) {
  return {origin + DVec3(eye_of(camera)), origin + DVec3(pivot_of(camera)), camera_up_of(camera)};
}

using ParameterTexts = std::map<std::string, std::string>;

// A value in the form that `render` takes, without insignificant digits.
std::string text_of(const TechniqueParameter& parameter, const std::string& value) {
  using Kind = NumberRange::Kind;
  const bool is_word = std::find(parameter.words.begin(), parameter.words.end(), value) != parameter.words.end();
  if (is_word || !parameter.numbers) return value;
  const bool is_real = parameter.numbers->kind == Kind::real || parameter.numbers->kind == Kind::above_least;
  return is_real ? fmt::format("{:.4g}", std::stod(value)) : value;
}

// The parameters that differ from the technique's defaults in `render`.
ParameterTexts technique_parameters(const TechniqueDescription& technique, const RealtimeSettings& settings) {
  ParameterTexts set;
  for (const TechniqueParameter& p : all_parameters(technique)) {
    const auto found = settings.values.find(p.info.name);
    const std::string value = text_of(p, found == settings.values.end() ? p.default_in_viewer() : found->second);
    if (value != p.info.default_value) set[p.info.name] = value;
  }
  return set;
}

// The frames of a technique, or the method of `render` that shows the same.
void set_technique(RenderOptions& render, const TechniqueDescription& technique, const RealtimeSettings& settings) {
  render.photons.reset();
  render.set.clear();
  if (technique.offline_depth) render.max_depth = technique.offline_depth;
  if (!technique.offline_method.empty()) {
    render.integrator = technique.offline_method;
    return;
  }
  render.integrator = technique.name;
  if (technique.has_photons) render.photons = settings.photons;
  render.set = technique_parameters(technique, settings);
}

// The offline method that shows the same, with its settings.
void set_method(RenderOptions& render, const ShownPicture& shown, const std::string& first_method) {
  if (const TechniqueInfo* technique = find_technique(shown.method))
    return set_technique(render, technique->description, shown.settings);
  render.integrator = shown.method;
  if (shown.method != first_method) render.set.clear();  // parameters of another method
}

}  // namespace

std::string stem_of(const std::filesystem::path& scene) {
  std::filesystem::path name = scene.filename();
  if (name.extension() == ".gz") name.replace_extension();
  return name.stem().string();
}

std::map<std::string, float> strengths_of(const std::vector<LightRow>& lights) {
  std::map<std::string, float> strengths;
  for (const LightRow& light : lights)
    if (const float strength = light.on ? light.strength : 0; strength != 1) strengths[light.id] = strength;
  return strengths;
}

ShownRender offline_render(const ShownPicture& shown, const ViewerOptions& options) {
  ShownRender render{shown.scene,
                     options.render,
                     {},
                     shown.strengths,
                     shown.display,
                     shown.measures_exposure,
                     shown.denoises,
                     stem_of(shown.scene) + ".png"};
  if (shown.camera) render.look = look_of(*shown.camera, shown.origin);
  render.options.resolution = {shown.width, shown.height};
  set_method(render.options, shown, options.method);
  return render;
}

}  // namespace lanthorn
