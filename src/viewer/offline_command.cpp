// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/offline_command.h"

#include <fmt/format.h>

#include <algorithm>

#include "lanthorn/shell.h"

namespace lanthorn {

namespace {

std::string look_at_text(const CameraPose& camera) {
  const Point eye = eye_of(camera), target = pivot_of(camera);
  const Vec3 up = camera_up_of(camera);
  return fmt::format(" --look-at {:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g}", eye.x, eye.y, eye.z,
                     target.x, target.y, target.z, up.x, up.y, up.z);
}

// A value as `render` takes it. Digits that nobody sees are left out.
std::string text_of(const TechniqueParameter& parameter, const std::string& value) {
  using Kind = NumberRange::Kind;
  const bool is_word = std::find(parameter.words.begin(), parameter.words.end(), value) != parameter.words.end();
  if (is_word || !parameter.numbers) return value;
  const bool is_real = parameter.numbers->kind == Kind::real || parameter.numbers->kind == Kind::above_least;
  return is_real ? fmt::format("{:.4g}", std::stod(value)) : value;
}

// The technique by frames of `render`, with what differs from its defaults there.
std::string technique_text(const TechniqueDescription& technique, const RealtimeSettings& settings) {
  std::string text = " -i " + technique.name;
  if (technique.has_photons) text += fmt::format(" -n {}", settings.photons);
  for (const TechniqueParameter& p : all_parameters(technique)) {
    const auto found = settings.values.find(p.info.name);
    const std::string value = text_of(p, found == settings.values.end() ? p.default_in_viewer() : found->second);
    if (value != p.info.default_value) text += " --set " + shell_word(p.info.name + "=" + value);
  }
  return text;
}

std::string method_text(const ShownPicture& shown, const ViewerOptions& options) {
  if (const TechniqueInfo* technique = find_technique(shown.method)) {
    const std::string& offline = technique->description.offline_method;
    return offline.empty() ? technique_text(technique->description, shown.settings) : " -i " + offline;
  }
  std::string text = " -i " + shown.method;
  if (options.render.photons) text += fmt::format(" -n {}", *options.render.photons);
  if (shown.method == options.method)
    for (const auto& [name, value] : options.render.set) text += " --set " + shell_word(name + "=" + value);
  return text;
}

std::string depth_text(const ShownPicture& shown, const ViewerOptions& options) {
  const TechniqueInfo* technique = find_technique(shown.method);
  const std::optional<int> depth = technique != nullptr && technique->description.offline_depth
                                       ? technique->description.offline_depth
                                       : options.render.max_depth;
  return depth ? fmt::format(" -d {}", *depth) : "";
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

std::string offline_command(const ShownPicture& shown, const ViewerOptions& options) {
  std::string command = "lanthorn render " + shell_word(shown.scene.string());
  if (shown.camera) command += look_at_text(*shown.camera);
  command += method_text(shown, options);
  command += fmt::format(" -r {}x{}", shown.width, shown.height);
  if (options.render.seed) command += fmt::format(" --seed {}", *options.render.seed);
  command += depth_text(shown, options);
  command += options.command_options;
  for (const auto& [light, strength] : shown.strengths) command += fmt::format(" --light {}={:.6g}", light, strength);
  if (shown.display.exposure != 0) command += fmt::format(" --exposure {:.2f}", shown.display.exposure);
  if (shown.display.curve == ToneCurve::filmic) command += " --filmic";
  return command + " -o " + shell_word(stem_of(shown.scene) + ".png");
}

}  // namespace lanthorn
