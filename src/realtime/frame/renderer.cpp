// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/frame/renderer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "gl/context.h"
#include "path/path_class.h"
#include "photon/kernels.h"
#include "realtime/scene/materials.h"
#include "realtime/scene/shader_files.h"

namespace lanthorn {

namespace {

double milliseconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

void clear(const gl::Framebuffer& target) {
  constexpr std::array<GLfloat, 4> black{};
  glClearNamedFramebufferfv(target.name(), GL_COLOR, 0, black.data());
}

// Cones show mirrors and narrow lobes themselves. The split sum leaves glass black.
EyePaths eye_paths_of(const FrameSettings& settings) {
  if (settings.indirect == IndirectLight::environment) return no_eye_paths;
  if (settings.indirect == IndirectLight::voxels) return glass_eye_paths;
  return settings.has_stand_ins ? needed_eye_paths : all_eye_paths;
}

// It moves by steps, so that maps and photons stay while the eye moves a little.
std::optional<LightFocus> light_focus(const Scene& scene, const View& view) {
  constexpr float radius_by_distance = 1.25f, steps = 4;  // steps: of a radius
  const VoxelFocus focus = focus_of(scene, view);
  if (!(focus.distance > 0 && focus.distance < infinity)) return std::nullopt;
  const float radius = std::exp2(std::ceil(std::log2(radius_by_distance * focus.distance))), step = radius / steps;
  return LightFocus{step * glm::round(focus.centre / step), radius + step};
}

std::string surface_defines(const GpuScene& scene) {
  return closure_defines(scene.materials()) + (scene.has_patterns() ? "#define HAS_PATTERNS\n" : "");
}

}  // namespace

Renderer::Programs::Programs(const gl::ShaderFiles& files, const std::string& surfaces)
    : gbuffer(files, "scene.vert.glsl", "gbuffer.frag.glsl", surfaces + "#define EYE\n"),
      light_map(files, "scene.vert.glsl", "gbuffer.frag.glsl", surfaces),
      background(files, "screen.vert.glsl", "background.frag.glsl"),
      direct(files, "screen.vert.glsl", "direct.frag.glsl", surfaces),
      ambient(files, "screen.vert.glsl", "ambient.frag.glsl"),
      tone(files, "screen.vert.glsl", "tone.frag.glsl"),
      bounces(files, surfaces),
      photons(files, surfaces),
      environment(files),
      voxels(files),
      specular(files) {}

Renderer::Renderer(const Scene& scene)
    : is_software_(gl::current_driver({}).software),
      scene_(&scene),
      gpu_scene_(scene),
      files_(shader_files()),
      surfaces_(surface_defines(gpu_scene_)),
      programs_(files_, surfaces_),
      no_vertices_(gl::make_vertex_array()),
      timer_(is_software_) {
  log_.check();
}

void Renderer::reload(const gl::ShaderFiles& files) {
  programs_ = Programs(files, surfaces_);
  files_ = files;
  lights_of_.reset();
}

void Renderer::update(const Scene& scene) {
  lights_of_.reset();
  gpu_scene_.update(scene);
  scene_ = &scene;
  if (std::string surfaces = surface_defines(gpu_scene_); surfaces != surfaces_) {
    surfaces_ = std::move(surfaces);
    programs_ = Programs(files_, surfaces_);
  }
}

void Renderer::allocate(int width, int height) {
  if (gbuffer_.width() == width && gbuffer_.height() == height) return;
  gbuffer_ = GBuffer(width, height);
  const auto layer = [&] { return gl::Texture(GL_RGBA32F, width, height); };
  layers_ = {layer(), layer(), layer()};
  emission_target_ = gl::Framebuffer({&gbuffer_.emission()});
  direct_target_ = gl::Framebuffer({&layers_.direct});
  indirect_target_ = gl::Framebuffer({&layers_.indirect});
  caustic_target_ = gl::Framebuffer({&layers_.caustic});
  layers_target_ = gl::Framebuffer({&gbuffer_.emission(), &layers_.direct, &layers_.indirect, &layers_.caustic});
}

void Renderer::draw_screen() const {
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

Mat4 Renderer::eye_clip(const WindowRays& rays) const {
  constexpr float least_depth = 1e-6f;  // of the scene's radius; reversed depths are as exact for any
  const BoundingSphere& sphere = gpu_scene_.sphere();
  const float far = std::sqrt(distance_squared(sphere.centre, rays.corner)) + sphere.radius;
  return clip_matrix(rays, rays.parallel ? 0 : least_depth * sphere.radius, far);
}

void Renderer::draw_gbuffer(const FrameSettings& settings, const WindowRays& rays) {
  gbuffer_.begin();
  const gl::Program& p = programs_.gbuffer;
  p.use();
  p.set("to_clip", eye_clip(rays));
  p.set("eye", rays.parallel ? rays.corner : rays.eye);
  p.set("axis", glm::vec4(rays.axis, rays.parallel ? 1 : 0));
  set_eye_paths(p, eye_paths_of(settings));
  p.set("frame", settings.views.frame);
  glEnable(GL_DEPTH_TEST);
  gpu_scene_.draw();
  emission_target_.bind();
  gbuffer_.bind();
  const gl::Program& b = programs_.background;
  b.use();
  b.set("corner", rays.parallel ? rays.axis : rays.corner);
  b.set("right", rays.parallel ? Vec3(0) : rays.right);
  b.set("down", rays.parallel ? Vec3(0) : rays.down);
  b.set("size", Vec2(static_cast<float>(gbuffer_.width()), static_cast<float>(gbuffer_.height())));
  draw_screen();
}

void Renderer::trace_shadows(const FrameSettings& settings) {
  timer_.end();
  const auto begin = std::chrono::steady_clock::now();
  report_.shadow_rays = traced_.trace(*scene_, gbuffer_, views_, gpu_scene_.materials(), eye_paths_of(settings));
  report_.stages.push_back({"traced shadows (CPU)", milliseconds_since(begin)});
}

void Renderer::draw_direct(const FrameSettings& settings, const WindowRays& rays) {
  direct_target_.bind();
  const gl::Program& p = programs_.direct;
  p.use();
  p.set("view_count", static_cast<int>(views_.size()));
  p.set("shadows", static_cast<int>(settings.shadows));
  set_eye_paths(p, eye_paths_of(settings));
  p.set("least_sky_alpha", settings.indirect == IndirectLight::voxels ? least_alpha_under_sky : 0.0f);
  p.set("eye", rays.eye);
  p.set("axis", glm::vec4(rays.axis, rays.parallel ? 1 : 0));
  light_maps_.bind();
  if (settings.shadows == ShadowKind::traced) traced_.visibility().bind(9);
  draw_screen();
}

void Renderer::draw_ambient(const FrameSettings& settings) {
  indirect_target_.bind();
  programs_.ambient.use();
  programs_.ambient.set("ambient", settings.ambient);
  draw_screen();
}

std::vector<PhotonStart> Renderer::draw_light_maps(const LightKey& key) {
  lights_of_.reset();
  views_ = lanthorn::light_views(*scene_, key.views);
  const std::uint32_t count = views_.empty() ? 0 : key.photons;
  timer_.begin("light maps");
  light_maps_.draw(gpu_scene_, views_, share_photons(views_, count), programs_.light_map, key.views.map_size);
  if (count == 0) return {};
  timer_.begin("photons of the maps");
  programs_.bounces.start(light_maps_, static_cast<int>(views_.size()), count, key.views.seed, key.views.frame);
  return programs_.bounces.read();
}

void Renderer::follow_photons(const LightKey& key, const std::vector<PhotonStart>& starts) {
  const auto begin = std::chrono::steady_clock::now();
  FramePhotons found = walk_photons(*scene_, views_, starts, {key.views.seed, key.views.frame, key.max_depth});
  report_.rays = found.rays;
  report_.stages.push_back({"photon walk (CPU)", milliseconds_since(begin)});
  programs_.photons.upload(std::move(found));
}

void Renderer::draw_volumes(const FrameSettings& settings, const WindowRays& rays) {
  timer_.begin("photon volumes");
  shown_photons_ = programs_.photons.photons();
  PhotonGather gather = settings.photons.gather;
  if (gather == PhotonGather::automatic) gather = is_software_ ? PhotonGather::tiles : PhotonGather::splat;
  programs_.photons.draw(gbuffer_, rays, eye_clip(rays), photon_volume(settings), gather, eye_paths_of(settings),
                         layers_.indirect, layers_.caustic);
}

PhotonVolume Renderer::photon_volume(const FrameSettings& settings) const {
  const float radius = settings.photons.radius;
  // Photons lie on round shapes, and what is seen of these on triangles around them.
  const float slack = std::min(1.1f * gpu_scene_.largest_slack(), 0.5f * radius);
  return {radius, search_flatness * radius + slack};
}

void Renderer::draw_specular(const FrameSettings& settings, const View& view) {
  if (!gpu_scene_.has_eye_paths()) return;
  timer_.end();
  const auto begin = std::chrono::steady_clock::now();
  const bool has_photons = settings.indirect == IndirectLight::photons;
  const SpecularPaths paths{settings.views.seed,
                            settings.views.frame,
                            settings.photons.max_depth,
                            settings.offset,
                            settings.lens,
                            settings.time,
                            settings.eye_path_spacing,
                            eye_paths_of(settings),
                            has_photons,
                            has_photons ? shown_photons_ : nullptr,
                            photon_volume(settings)};
  const std::uint64_t rays = programs_.specular.trace(*scene_, view, gbuffer_, gpu_scene_.materials(), paths);
  report_.rays += rays;
  report_.stages.push_back({eye_path_stage, milliseconds_since(begin)});
  if (rays == 0) return;
  timer_.begin("light of eye paths");
  programs_.specular.add_to(layers_target_);
}

void Renderer::draw_environment(const FrameSettings& settings, const WindowRays& rays) {
  const auto begin = std::chrono::steady_clock::now();
  if (programs_.environment.prepare(*scene_)) report_.stages.push_back({"environment maps", milliseconds_since(begin)});
  timer_.begin("G-buffer");
  draw_gbuffer(settings, rays);
  timer_.begin("split sum");
  direct_target_.bind();
  programs_.environment.use(rays);
  draw_screen();
}

void Renderer::draw_voxels(const FrameSettings& settings, const View& view, const WindowRays& rays) {
  VoxelLight& voxels = programs_.voxels;
  const auto begin = std::chrono::steady_clock::now();
  if (voxels.prepare(*scene_, gpu_scene_, view, settings.voxels))
    report_.stages.push_back({"voxelisation (CPU)", milliseconds_since(begin)});
  timer_.begin("light of the voxels");
  voxels.light(light_maps_, static_cast<int>(views_.size()), settings.voxels);
  timer_.begin("cones");
  gbuffer_.bind();
  indirect_target_.bind();
  voxels.use(rays, settings.voxels, eye_paths_of(settings));
  draw_screen();
}

void Renderer::draw_indirect(const FrameSettings& settings, const View& view, const WindowRays& rays) {
  if (settings.indirect == IndirectLight::ambient) draw_ambient(settings);
  if (settings.indirect == IndirectLight::voxels) draw_voxels(settings, view, rays);
}

void Renderer::draw_photons(const FrameSettings& settings, const WindowRays& rays, const LightKey& key,
                            const std::vector<PhotonStart>& starts) {
  const bool are_new = lights_of_ != key;
  if (settings.photons.late) draw_volumes(settings, rays);
  // What was asked of the GPU so far is done while the CPU follows the photons.
  if (are_new) {
    timer_.end();
    glFlush();
    follow_photons(key, starts);
  }
  if (!settings.photons.late) draw_volumes(settings, rays);
  if (const SharedPhotons& last = programs_.photons.photons()) {
    report_.photons_per_bounce = last->per_bounce;
    report_.photons_started = last->started;
  }
}

void Renderer::draw_lights(const FrameSettings& settings, const View& view, const WindowRays& rays) {
  const bool has_photons = settings.indirect == IndirectLight::photons;
  LightKey key{settings.views, has_photons ? settings.photons.count : 0, settings.photons.max_depth};
  if (settings.has_light_focus) key.views.focus = light_focus(*scene_, view);
  // While only the eye moves, lights see the same, and photons lie where they lay.
  const std::vector<PhotonStart> starts = lights_of_ == key ? std::vector<PhotonStart>() : draw_light_maps(key);
  report_.light_views = views_.size();
  timer_.begin("G-buffer");
  draw_gbuffer(settings, rays);
  if (settings.shadows == ShadowKind::traced) trace_shadows(settings);
  timer_.begin("direct light");
  draw_direct(settings, rays);
  if (has_photons)
    draw_photons(settings, rays, key, starts);
  else
    draw_indirect(settings, view, rays);
  if (eye_paths_of(settings) != no_eye_paths) draw_specular(settings, view);
  lights_of_ = key;
}

void Renderer::draw(const View& view, const FrameSettings& settings) {
  const WindowRays rays = window_rays(view, settings.offset, settings.lens, settings.time);
  allocate(view.window.width(), view.window.height());
  report_ = {};
  timer_.begin_frame();
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  gpu_scene_.bind();
  clear(indirect_target_);
  clear(caustic_target_);
  if (settings.indirect == IndirectLight::environment)
    draw_environment(settings, rays);
  else
    draw_lights(settings, view, rays);
  timer_.end();
  log_.check();
}

FrameReport Renderer::report() {
  FrameReport report = report_;
  std::vector<gl::StageTime> stages = timer_.collect();
  report.stages.insert(report.stages.begin(), stages.begin(), stages.end());
  return report;
}

void Renderer::present(unsigned framebuffer, const ToneSettings& tone) const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, gbuffer_.width(), gbuffer_.height());
  glDisable(GL_BLEND);
  gbuffer_.emission().bind(10);
  layers_.direct.bind(11);
  layers_.indirect.bind(12);
  layers_.caustic.bind(13);
  const gl::Program& p = programs_.tone;
  p.use();
  p.set("shown", tone.shown);
  p.set("exposure", tone.exposure);
  p.set("curve", static_cast<int>(tone.curve));
  p.set("height", gbuffer_.height());
  draw_screen();
  log_.check();
}

Image Renderer::read_layers() const {
  const std::array<std::pair<const char*, const gl::Texture*>, 4> layers{{{"emission", &gbuffer_.emission()},
                                                                          {"direct", &layers_.direct},
                                                                          {"indirect", &layers_.indirect},
                                                                          {"caustic", &layers_.caustic}}};
  std::vector<std::string> names;
  for (const auto& [name, texture] : layers)
    for (const char* channel : {".R", ".G", ".B"}) names.push_back(std::string(name) + channel);
  Image image(gbuffer_.width(), gbuffer_.height(), names);
  for (std::size_t l = 0; l < layers.size(); ++l) {
    const auto texels = layers[l].second->read<glm::vec4>({GL_RGBA, GL_FLOAT}, 1);
    for (std::size_t i = 0; i < texels.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        image.at(static_cast<int>(i) % image.width, static_cast<int>(i) / image.width, 3 * l + c) =
            texels[i][static_cast<glm::length_t>(c)];
  }
  log_.check();
  return image;
}

}  // namespace lanthorn
