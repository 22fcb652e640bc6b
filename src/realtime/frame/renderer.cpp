// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/frame/renderer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "realtime/scene/materials.h"
#include "realtime/scene/projection.h"
#include "realtime/scene/shader_files.h"

namespace lanthorn {

namespace {

void clear(const gl::Framebuffer& target) {
  constexpr std::array<GLfloat, 4> black{};
  glClearNamedFramebufferfv(target.name(), GL_COLOR, 0, black.data());
}

// The focus moves in steps, so that maps and photons stay valid while the eye moves a little.
std::optional<LightFocus> light_focus(const Scene& scene, const View& view) {
  constexpr float radius_by_distance = 1.25f, steps = 4;  // steps: of a radius
  const ViewFocus focus = focus_of(scene, view);
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
      specular(files) {}

Renderer::Renderer(const Scene& scene)
    : is_software_(gl::current_driver({}).software),
      scene_(&scene),
      gpu_scene_(scene),
      surfaces_(surface_defines(gpu_scene_)),
      programs_(shader_files(), surfaces_),
      timer_(is_software_) {
  log_.check();
}

void Renderer::update(const Scene& scene) {
  lights_of_.reset();
  gpu_scene_.update(scene);
  scene_ = &scene;
  if (std::string surfaces = surface_defines(gpu_scene_); surfaces != surfaces_) {
    surfaces_ = std::move(surfaces);
    programs_ = Programs(shader_files(), surfaces_);
    techniques_.clear();
  }
}

void Renderer::allocate(int width, int height) {
  if (gbuffer_.width() == width && gbuffer_.height() == height) return;
  gbuffer_ = GBuffer(width, height);
  const auto layer = [&] { return gl::Texture(GL_RGBA32F, width, height); };
  layers_ = {layer(), layer(), layer()};
  emission_target_ = gl::Framebuffer({&gbuffer_.emission()});
  targets_ = {gl::Framebuffer({&layers_.direct}), gl::Framebuffer({&layers_.indirect}),
              gl::Framebuffer({&layers_.caustic})};
  layers_target_ = gl::Framebuffer({&gbuffer_.emission(), &layers_.direct, &layers_.indirect, &layers_.caustic});
}

Mat4 Renderer::eye_clip(const WindowRays& rays) const {
  constexpr float least_depth = 1e-6f;  // of the scene's radius; reversed depths are as exact for any
  const BoundingSphere& sphere = gpu_scene_.sphere();
  const float far = std::sqrt(distance_squared(sphere.centre, rays.corner)) + sphere.radius;
  return clip_matrix(rays, rays.parallel ? 0 : least_depth * sphere.radius, far);
}

Technique& Renderer::technique(const TechniqueInfo& info) {
  std::unique_ptr<Technique>& technique = techniques_[&info];
  if (!technique) technique = info.make({shader_files(), surfaces_});
  return *technique;
}

void Renderer::draw_light_maps(const LightKey& key) {
  if (lights_of_ == key) return;
  lights_of_.reset();
  ++light_maps_version_;
  views_ = lanthorn::light_views(*scene_, key.views);
  timer_.begin("light maps");
  light_maps_.draw(gpu_scene_, views_, share_photons(views_, key.photons), programs_.light_map, key.views.map_size);
  lights_of_ = key;
}

void Renderer::draw_gbuffer(const FrameContext& frame) {
  const WindowRays& rays = frame.rays;
  gbuffer_.begin();
  const gl::Program& p = programs_.gbuffer;
  p.use();
  p.set("to_clip", frame.to_clip);
  p.set("eye", rays.parallel ? rays.corner : rays.eye);
  p.set("axis", glm::vec4(rays.axis, rays.parallel ? 1 : 0));
  set_eye_paths(p, frame.eye_paths);
  p.set("frame", frame.settings.views.frame);
  glEnable(GL_DEPTH_TEST);
  gpu_scene_.draw_for_camera();
  emission_target_.bind();
  gbuffer_.bind();
  const gl::Program& b = programs_.background;
  b.use();
  b.set("corner", rays.parallel ? rays.axis : rays.corner);
  b.set("right", rays.parallel ? Vec3(0) : rays.right);
  b.set("down", rays.parallel ? Vec3(0) : rays.down);
  b.set("size", Vec2(static_cast<float>(gbuffer_.width()), static_cast<float>(gbuffer_.height())));
  screen_.draw();
}

void Renderer::trace_shadows(const FrameContext& frame) {
  timer_.end();
  const auto begin = std::chrono::steady_clock::now();
  report_.shadow_rays = traced_.trace(*scene_, gbuffer_, views_, gpu_scene_.materials(), frame.eye_paths);
  report_.stages.push_back({"traced shadows (CPU)", milliseconds_since(begin)});
}

void Renderer::draw_direct(const FrameContext& frame, float least_sky_alpha) {
  timer_.begin("direct light");
  targets_.direct.bind();
  const gl::Program& p = programs_.direct;
  p.use();
  p.set("view_count", static_cast<int>(views_.size()));
  p.set("shadows", static_cast<int>(frame.settings.shadows));
  set_eye_paths(p, frame.eye_paths);
  p.set("least_sky_alpha", least_sky_alpha);
  p.set("soft_edges", frame.settings.has_soft_edges ? 1 : 0);
  p.set("eye", frame.rays.eye);
  p.set("axis", glm::vec4(frame.rays.axis, frame.rays.parallel ? 1 : 0));
  light_maps_.bind();
  if (frame.settings.shadows == ShadowKind::traced) traced_.visibility().bind(gpu::unit_visibility);
  screen_.draw();
}

void Renderer::draw_specular(const FrameContext& frame, Technique& technique, bool find_indirect) {
  if (frame.eye_paths == no_eye_paths || !gpu_scene_.has_eye_paths()) return;
  timer_.end();
  const auto begin = std::chrono::steady_clock::now();
  const FrameSettings& s = frame.settings;
  const SpecularPaths paths{s.views.seed,
                            s.views.frame,
                            s.max_depth,
                            s.offset,
                            s.lens,
                            s.time,
                            s.eye_path_spacing,
                            frame.eye_paths,
                            s.disperses,
                            find_indirect,
                            [&] { return technique.light_at_vertices(frame); }};
  const std::uint64_t rays = programs_.specular.trace(*scene_, frame.view, gbuffer_, gpu_scene_.materials(), paths);
  report_.rays += rays;
  report_.stages.push_back({eye_path_stage, milliseconds_since(begin)});
  if (rays == 0) return;
  timer_.begin("light of eye paths");
  programs_.specular.add_to(layers_target_);
}

void Renderer::draw_stages(const FrameContext& frame, const FramePlan& plan) {
  const TechniqueInfo& info = frame.settings.technique.info();
  Technique& chosen = technique(info);
  chosen.prepare(frame);
  timer_.begin("G-buffer");
  draw_gbuffer(frame);
  if (info.description.has_light_views) {
    if (frame.settings.shadows == ShadowKind::traced) trace_shadows(frame);
    draw_direct(frame, plan.least_sky_alpha);
  }
  chosen.draw(frame);
  draw_specular(frame, chosen, plan.eye_paths_find_indirect);
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
  for (const gl::Framebuffer* target : {&targets_.direct, &targets_.indirect, &targets_.caustic}) clear(*target);
  const TechniqueInfo& info = settings.technique.info();
  const FramePlan plan = info.plan(settings);
  if (info.description.has_light_views) {
    LightKey key{settings.views, plan.photons};
    if (settings.has_light_focus) key.views.focus = light_focus(*scene_, view);
    draw_light_maps(key);  // while only the eye moves, lights see the same
    report_.light_views = views_.size();
  }
  const Mat4 to_clip = eye_clip(rays);
  const EyePaths eye_paths = settings.has_stand_ins ? plan.eye_paths_in_motion : plan.eye_paths;
  draw_stages({settings, *scene_, view, rays, to_clip, eye_paths, gpu_scene_, gbuffer_, light_maps_, views_,
               light_maps_version_, layers_, targets_, screen_, is_software_, timer_, report_},
              plan);
  timer_.end();
  log_.check();
}

FrameReport Renderer::report() {
  FrameReport report = report_;
  std::vector<gl::StageTime> stages = timer_.collect();
  report.stages.insert(report.stages.begin(), stages.begin(), stages.end());
  return report;
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
