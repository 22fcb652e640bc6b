// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/offline_command.h"

#include <fmt/format.h>

#include <array>

#include "lanthorn/shell.h"

namespace lanthorn {

namespace {

std::string look_at_text(const CameraPose& camera) {
  const Point eye = eye_of(camera), target = pivot_of(camera);
  const Vec3 up = camera_up_of(camera);
  return fmt::format(" --look-at {:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g}", eye.x, eye.y, eye.z,
                     target.x, target.y, target.z, up.x, up.y, up.z);
}

// What `render` knows of the settings of a method that draws by OpenGL.
std::string realtime_text(const std::string& method, const RealtimeSettings& s) {
  std::string text;
  if (method == "ispm") {
    constexpr std::array gathers{"auto", "splat", "tiles"};
    text = fmt::format(" -n {} --set radius={:.4g} --set gather={}", s.photons, s.radius,
                       gathers[static_cast<std::size_t>(s.gather)]);
  }
  if (method == "voxelcones") {
    text = fmt::format(" --set voxels={} --set bounces={}", s.voxels, s.bounces);
    if (s.grids != 0) text += fmt::format(" --set grids={}", s.grids);
  }
  if (!text.empty() && s.map_size != RealtimeSettings{}.map_size) text += fmt::format(" --set map={}", s.map_size);
  return text;
}

std::string method_text(const ShownPicture& shown, const ViewerOptions& options) {
  if (shown.method == "direct" || shown.method == "ambient") return " -i path";
  const std::string text = " -i " + shown.method;
  if (realtime_method(shown.method)) return text + realtime_text(shown.method, shown.settings);
  std::string parameters;
  if (options.render.photons) parameters += fmt::format(" -n {}", *options.render.photons);
  if (shown.method == options.method)
    for (const auto& [name, value] : options.render.set) parameters += " --set " + shell_word(name + "=" + value);
  return text + parameters;
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
  if (shown.method == "direct")
    command += " -d 1";
  else if (options.render.max_depth)
    command += fmt::format(" -d {}", *options.render.max_depth);
  command += options.command_options;
  for (const auto& [light, strength] : shown.strengths) command += fmt::format(" --light {}={:.6g}", light, strength);
  if (shown.display.exposure != 0) command += fmt::format(" --exposure {:.2f}", shown.display.exposure);
  if (shown.display.curve == ToneCurve::filmic) command += " --filmic";
  return command + " -o " + shell_word(stem_of(shown.scene) + ".png");
}

}  // namespace lanthorn
