// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/realtime_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include "math/sampler.h"
#include "photon/radius_schedule.h"
#include "realtime/scene/materials.h"

namespace lanthorn {

namespace {

constexpr std::uint64_t most_photons = std::uint64_t{1} << 24;

// The number of a setting. Throws Error for anything else.
float number(const std::string& name, const std::string& text, float low, float high) {
  float value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high))
    throw Error(fmt::format("--set {}={}: expected a number from {} to {}", name, text, low, high));
  return value;
}

template <class Value>
Value choice(const std::string& name, const std::string& text, const std::map<std::string, Value>& values) {
  const auto found = values.find(text);
  if (found != values.end()) return found->second;
  std::string known;
  for (const auto& [word, value] : values) known += (known.empty() ? "" : " or ") + word;
  throw Error(fmt::format("--set {}={}: expected {}", name, text, known));
}

int voxels(const std::string& text) {
  const auto size = static_cast<int>(number("voxels", text, least_voxels, most_voxels));
  if (!std::has_single_bit(static_cast<unsigned>(size)))
    throw Error(fmt::format("--set voxels={}: expected a power of two from {} to {}", text, least_voxels, most_voxels));
  return size;
}

void apply(RealtimeSettings& s, const std::string& name, const std::string& text) {
  constexpr float largest = 1e6f;
  if (name == "radius" && text == "auto") return;
  if (name == "radius")
    s.radius = number(name, text, 1e-6f, largest);
  else if (name == "ambient")
    s.ambient = number(name, text, 0, largest);
  else if (name == "map")
    s.map_size = static_cast<int>(number(name, text, 16, 4096));
  else if (name == "shadows")
    s.shadows = choice<ShadowKind>(
        name, text, {{"maps", ShadowKind::maps}, {"traced", ShadowKind::traced}, {"none", ShadowKind::none}});
  else if (name == "gather")
    s.gather = choice<PhotonGather>(
        name, text,
        {{"auto", PhotonGather::automatic}, {"splat", PhotonGather::splat}, {"tiles", PhotonGather::tiles}});
  else if (name == "voxels")
    s.voxels = voxels(text);
  else if (name == "grids")
    s.grids = text == "auto" ? 0 : static_cast<int>(number(name, text, 1, most_voxel_grids));
  else if (name == "bounces")
    s.bounces = static_cast<int>(number(name, text, 1, most_voxel_bounces));
  else
    throw Error(fmt::format(
        "--set {}: the viewer knows ambient, bounces, gather, grids, map, radius, shadows and voxels", name));
}

}  // namespace

std::vector<std::string> realtime_methods() { return {"direct", "ambient", "ispm", "splitsum", "voxelcones"}; }

std::optional<IndirectLight> realtime_method(const std::string& name) {
  if (name == "direct") return IndirectLight::none;
  if (name == "ambient") return IndirectLight::ambient;
  if (name == "ispm") return IndirectLight::photons;
  if (name == "splitsum") return IndirectLight::environment;
  if (name == "voxelcones") return IndirectLight::voxels;
  return std::nullopt;
}

RealtimeSettings realtime_settings(const Scene& scene, const View& view, const ViewerOptions& options) {
  RealtimeSettings s{.ambient = 0};
  const auto method = realtime_method(options.method);
  s.indirect = method.value_or(IndirectLight::ambient);
  // A kernel that holds some dozen of 20,000 photons on the surfaces of a room.
  constexpr float radius_share = 0.05f;
  // Of a small thing in a large place, what is seen counts.
  constexpr float most_distances = 4;
  const float scene_radius = scene.bounding_sphere().radius;
  const float seen_radius = std::min(scene_radius, most_distances * focus_of(scene, view).distance);
  s.radius = radius_share * seen_radius;
  // As if a third of the light were spread evenly over a room of this size. Light from afar fills the scene.
  for (const Light& light : scene.lights())
    s.ambient += power(light) / (3 * 4 * pi * sqr(is_far(light) ? scene_radius : seen_radius));
  s.seed = options.render.seed.value_or(0);
  s.max_depth = options.render.max_depth.value_or(s.max_depth);
  s.photons = static_cast<std::uint32_t>(std::min(options.render.photons.value_or(s.photons), most_photons));
  if (method)
    for (const auto& [name, text] : options.render.set) apply(s, name, text);
  return s;
}

FrameSettings frame_settings(const RealtimeSettings& s, const View& view, std::uint32_t frame) {
  FrameSettings f;
  f.indirect = s.indirect;
  f.shadows = s.shadows;
  f.ambient = Vec3(s.ambient);
  Sampler sampler = Sampler::for_pass(s.seed, frame);
  sampler.seek(2);
  f.offset = view.filter.sample(sampler.next2()).offset;
  f.lens = sampler.next2();
  f.time = view.camera.time(sampler.next());
  f.views.seed = s.seed;
  f.views.frame = frame;
  f.views.map_size = s.map_size;
  f.has_light_focus = true;
  f.voxels = {s.voxels, std::min(s.bounces, s.max_depth - 1), s.grids, turn_of_frame(frame),
              s.shadows != ShadowKind::none};
  if (s.max_depth < 2 && s.indirect == IndirectLight::voxels) f.indirect = IndirectLight::none;
  f.photons = {s.photons, s.radius * RadiusSchedule{}.shrink(frame, 2), s.max_depth, s.gather, false};
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

std::vector<std::string> limitations_of(const Renderer& renderer, const Scene& scene, IndirectLight method) {
  std::vector<std::string> list = renderer.gpu_scene().limitations();
  const std::vector<GpuMaterial>& materials = renderer.gpu_scene().materials();
  const auto has = [&](const auto& property) { return std::any_of(materials.begin(), materials.end(), property); };
  if (scene.has_media()) list.emplace_back("media are left out");
  if (scene.lights().empty()) list.emplace_back("the scene has no lights: all of it is black");
  if (method == IndirectLight::environment) {
    const std::size_t others = scene.lights().size() - scene.infinite_lights().size();
    if (others > 0)
      list.push_back(fmt::format("splitsum lights by the environment alone: {} other light{} ignored", others,
                                 others == 1 ? " is" : "s are"));
    if (has([](const GpuMaterial& m) { return m.kind == GpuMaterial::none && m.through != glm::vec4(0); }))
      list.emplace_back("splitsum leaves out light through glass");
    return list;
  }
  if (method == IndirectLight::voxels)
    list.emplace_back(
        "light of voxels is coarse: it leaks and blurs at the width of a voxel; glass shows direct light alone");
  if (std::string lights = unsupported_lights(scene); !lights.empty()) list.push_back(std::move(lights));
  // Narrow lobes mirror the sky in every frame: by cones, or by eye paths, which draw other materials, too.
  const auto mirrors_sky = [&](const GpuMaterial& m) {
    if ((m.flags & GpuMaterial::is_smooth) != 0) return true;
    return method == IndirectLight::voxels ? m.colour.w < least_alpha_under_sky
                                           : (m.flags & GpuMaterial::is_traced) != 0;
  };
  const bool reflects = has([&](const GpuMaterial& m) {
    return (m.kind == GpuMaterial::metal || m.kind == GpuMaterial::plastic) && !mirrors_sky(m);
  });
  if (!scene.infinite_lights().empty() && reflects)
    list.emplace_back(
        "what metals and coats reflect of the surroundings appears slowly, by four directions a frame; splitsum shows "
        "it "
        "at once");
  return list;
}

void EyePathSpacing::learn(const FrameReport& report, int spacing) {
  double milliseconds = 0;
  for (const gl::StageTime& stage : report.stages)
    if (stage.stage == eye_path_stage) milliseconds += stage.milliseconds;
  const double wanted = std::ceil(spacing * std::sqrt(milliseconds / budget));
  pixels_ = static_cast<int>(std::clamp(wanted, 1.0, double{most}));
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

void StageSums::clear() {
  sums_.clear();
  frames_ = 0;
}

}  // namespace lanthorn
