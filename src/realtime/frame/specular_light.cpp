// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/frame/specular_light.h"

#include <algorithm>
#include <array>

#include "path/direct_light.h"
#include "path/eye_pass.h"
#include "path/light_layers.h"
#include "path/path_visitor.h"
#include "path/walk.h"
#include "photon/gather/photon_gather.h"
#include "realtime/scene/frame_heroes.h"

namespace lanthorn {

namespace {

/// Follows delta lobes and the narrow parts of other lobes, like GatherVisitor in integrators/progressive.h. The GPU
/// draws the non-delta lobes of vertices before `first_depth`.
struct SpecularVisitor {
  const PathContext& path;
  const VertexLight& light;
  int first_depth;
  bool finds_indirect;
  LightLayers& layers;

  Continuation operator()(const MediumVertex&) const { return Continuation::stop(); }
  void operator()(const EscapeVertex& v) {
    if (!is_drawn_by_gpu(v.state, v.state.depth)) layers.add_hit(v, hit_lights(path, v));
  }
  NarrowContinuation operator()(const SurfaceVertex& v) {
    const WalkState& state = v.state;
    if (is_drawn_by_gpu(state, state.depth - 1)) return {Continuation::stop()};
    if (state.depth > 1) layers.add_hit(v, hit_lights(path, v));
    if (!v.may_scatter || (state.non_delta > 0 && !finds_indirect)) return {Continuation::stop()};
    if (!has_non_delta(v.at.bsdf)) return {Continuation::go_on()};
    const LobeSplit split = split_lobes(v);
    const NarrowContinuation answer = NarrowContinuation::with_sky_branch(split);
    if (state.depth >= first_depth) scatter(v, answer);
    return answer;
  }

 private:
  // `scatterings`: the number so far in the walk.
  bool is_drawn_by_gpu(const WalkState& state, int scatterings) const {
    return !state.last_delta && scatterings < first_depth;
  }
  void scatter(const SurfaceVertex& v, const NarrowContinuation& answer) {
    path.sampler.seek(visitor_dimensions(v.state.depth));
    const DirectLight direct = next_event(path, v, answer);
    layers.add(class_of_next_event(v.state), direct.radiance, direct.dispersed);
    if (answer.branches_to_sky()) add_sky(path, v, layers);
    if (light && !answer.split.is_all_narrow()) light(v, answer.split, path.limits.max_depth, layers);
  }
};

struct SpecularPixel {
  int x, y;
  std::size_t path;  ///< whose light it shows
};

/// The path of a pixel.
struct SpecularPath {
  int x, y;
  std::uint32_t material;
  int first_depth;  ///< of vertices whose light the GPU does not draw
};

struct SpecularPlan {
  std::vector<SpecularPixel> pixels;
  std::vector<SpecularPath> paths;
};

/// Plans paths block by block, each of `spacing` pixels squared. All pixels of a material in a block share the path of
/// the first of them.
SpecularPlan plan_paths(const GBuffer& seen, const std::vector<GpuMaterial>& materials, const EyePaths& eye_paths,
                        int spacing) {
  const auto positions = seen.position().read<glm::vec4>({GL_RGBA, GL_FLOAT}, 1);
  const auto surfaces = seen.surface().read<glm::uvec4>({GL_RGBA_INTEGER, GL_UNSIGNED_INT}, 1);
  SpecularPlan plan;
  const auto add = [&](int x, int y, std::size_t first_of_block) {
    const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(seen.width()) + static_cast<std::size_t>(x);
    if (positions[i].w == 0) return;
    const std::uint32_t material = surfaces[i].z;
    const bool is_whole = is_drawn_by_paths(materials[material], eye_paths);
    const bool has_mirror = eye_paths.has_mirrors && (materials[material].flags & gpu::flag_smooth) != 0;
    if (!is_whole && !has_mirror) return;
    std::size_t path = first_of_block;
    while (path < plan.paths.size() && plan.paths[path].material != material) ++path;
    if (path == plan.paths.size()) plan.paths.push_back({x, y, material, is_whole ? 1 : 2});
    plan.pixels.push_back({x, y, path});
  };
  for (int top = 0; top < seen.height(); top += spacing)
    for (int left = 0; left < seen.width(); left += spacing) {
      const std::size_t first = plan.paths.size();
      for (int y = top; y < std::min(top + spacing, seen.height()); ++y)
        for (int x = left; x < std::min(left + spacing, seen.width()); ++x) add(x, y, first);
    }
  return plan;
}

using ClassLight = std::array<Spectrum, path_class_count>;  // by PathClass

ClassLight light_of(const SpecularPath& eye_path, const Scene& scene, const View& view, const SpecularPaths& paths,
                    const FrameHeroes& heroes, const VertexLight& vertex_light, RayCounts& counts) {
  const int x = view.window.x0 + eye_path.x, y = view.window.y0 + eye_path.y;
  const Wavelengths w = heroes.of_pixel(x, y);
  const Vec2 raster = Vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f + paths.offset;
  Sampler sampler =
      Sampler::for_pixel(paths.seed, stream_of("specular paths of a frame"), view.pixel_key(x, y), paths.frame);
  const PathContext path{scene, w, sampler, counts, {paths.max_depth, 1}};
  CameraRay ray = view.camera.sample_ray(raster, paths.lens, paths.time);
  ray.weight = 1;
  LightLayers layers(w);
  walk_from_camera(path, ray, view.medium,
                   SpecularVisitor{path, vertex_light, eye_path.first_depth, paths.finds_indirect, layers});
  ClassLight light;
  for (std::size_t c = 0; c < path_class_count; ++c) light[c] = layers.light(static_cast<PathClass>(c));
  return light;
}

/// A pixel and its light, in the layout of add.vert.glsl.
struct PixelLight {
  std::array<glm::vec4, path_class_count> light;  // by PathClass; a of the first two: the pixel
};

PixelLight light_in(const SpecularPixel& pixel, const ClassLight& light) {
  const std::array<int, path_class_count> place{pixel.x, pixel.y};
  PixelLight result;
  for (std::size_t c = 0; c < path_class_count; ++c)
    result.light[c] = {light[c][0], light[c][1], light[c][2], static_cast<float>(place[c])};
  return result;
}

}  // namespace

SpecularLight::SpecularLight(const gl::ShaderFiles& files)
    : add_(files, "add.vert.glsl", "add.frag.glsl"), texels_(GL_RGBA32F), no_vertices_(gl::make_vertex_array()) {}

std::uint64_t SpecularLight::trace(const Scene& scene, const View& view, const GBuffer& seen,
                                   const std::vector<GpuMaterial>& materials, const SpecularPaths& paths) {
  const SpecularPlan plan = plan_paths(seen, materials, paths.eye_paths, paths.spacing);
  pixels_ = plan.pixels.size();
  if (plan.pixels.empty()) return 0;
  constexpr std::size_t texels_of_pixel = sizeof(PixelLight) / sizeof(glm::vec4);
  gl::require_buffer_texels(texels_of_pixel * plan.pixels.size(), "mirrors, glass and gloss in view",
                            "a smaller picture (-r)");
  const VertexLight light = paths.light();
  const FrameHeroes heroes(scene.has_dispersion() && paths.disperses, paths.seed, paths.frame);
  std::vector<ClassLight> found(plan.paths.size());
  SharedRayCounts rays;
  constexpr std::size_t chunk = 256;
  parallel_chunks(plan.paths.size(), chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    RayCounts counts;
    for (std::size_t i = begin; i < end; ++i)
      found[i] = light_of(plan.paths[i], scene, view, paths, heroes, light, counts);
    rays.add(counts);
  });
  std::vector<PixelLight> lights;
  lights.reserve(plan.pixels.size());
  for (const SpecularPixel& pixel : plan.pixels) lights.push_back(light_in(pixel, found[pixel.path]));
  light_.write(lights);
  return rays.sum().walk + rays.sum().shadow;
}

void SpecularLight::add_to(const gl::Framebuffer& layers) const {
  layers.bind();
  texels_.bind(gpu::unit_eye_paths, light_.current());
  add_.use();
  add_.set("size", Vec2(static_cast<float>(layers.width()), static_cast<float>(layers.height())));
  glBindVertexArray(no_vertices_.name());
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(pixels_));
  glDisable(GL_BLEND);
}

}  // namespace lanthorn
