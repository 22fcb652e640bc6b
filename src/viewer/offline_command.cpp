// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/offline_command.h"

#include <fmt/format.h>

#include <array>

namespace lanthorn {

namespace {

LookAt look_of(const CameraPose& camera) { return {eye_of(camera), pivot_of(camera), camera_up_of(camera)}; }

using Parameters = std::map<std::string, std::string>;

// What `render` knows of the settings of a method that draws by OpenGL.
Parameters realtime_parameters(const std::string& method, const RealtimeSettings& s) {
  Parameters set;
  if (method == "ispm") {
    constexpr std::array gathers{"auto", "splat", "tiles"};
    set = {{"radius", fmt::format("{:.4g}", s.radius)}, {"gather", gathers[static_cast<std::size_t>(s.gather)]}};
  }
  if (method == "voxelcones") {
    set = {{"voxels", std::to_string(s.voxels)}, {"bounces", std::to_string(s.bounces)}};
    if (s.grids != 0) set["grids"] = std::to_string(s.grids);
  }
  if (!set.empty() && s.map_size != RealtimeSettings{}.map_size) set["map"] = std::to_string(s.map_size);
  return set;
}

// The method that shows the same offline, and what goes with it.
void set_method(RenderOptions& render, const ShownPicture& shown, const std::string& first_method) {
  if (shown.method == "direct" || shown.method == "ambient") {
    render.integrator = "path";
    render.photons.reset();
    render.set.clear();
    if (shown.method == "direct") render.max_depth = 1;
    return;
  }
  render.integrator = shown.method;
  if (realtime_method(shown.method)) {
    render.photons.reset();
    if (shown.method == "ispm") render.photons = shown.settings.photons;
    render.set = realtime_parameters(shown.method, shown.settings);
  } else if (shown.method != first_method) {
    render.set.clear();  // parameters of another method
  }
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
  ShownRender render{shown.scene, options.render, {}, shown.strengths, shown.display, stem_of(shown.scene) + ".png"};
  if (shown.camera) render.look = look_of(*shown.camera);
  render.options.resolution = {shown.width, shown.height};
  set_method(render.options, shown, options.method);
  return render;
}

}  // namespace lanthorn
