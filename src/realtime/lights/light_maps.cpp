// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/lights/light_maps.h"

#include <algorithm>

#include "realtime/scene/layouts.h"

namespace lanthorn {

namespace gpu {
#include "realtime/lights/light_layout.glsl"
static_assert(offsetof(LightView, clip) == 80 && sizeof(LightView) % 16 == 0);  // as std430 has it
}  // namespace gpu

namespace {

// A point does not light surfaces that are nearer to it than this share of the scene's radius.
constexpr float near_share = 1e-6f;

Mat4 clip_of(const WindowRays& rays, const BoundingSphere& sphere) {
  return clip_matrix(rays, rays.parallel ? 0 : near_share * sphere.radius, 2.001f * sphere.radius);
}

gpu::LightView packed(const LightView& view, const BoundingSphere& sphere) {
  gpu::LightView v{};
  v.origin = glm::vec4(view.origin, static_cast<float>(view.kind));
  v.axis = glm::vec4(view.axis, view.two_sided ? 1 : 0);
  v.colour = glm::vec4(view.colour, 0);
  v.cone = {view.cone_start, view.cone_end, view.square_falloff ? 1 : 0, view.is_all_around ? 1 : 0};
  v.maps.y = static_cast<std::uint32_t>(view.windows.size());
  for (std::size_t i = 0; i < view.windows.size(); ++i) {
    const WindowRays& rays = view.windows[i];
    v.clip[i] = clip_of(rays, sphere);
    v.corner[i] = glm::vec4(rays.corner, 0);
    v.right[i] = glm::vec4(rays.right, 0);
    v.down[i] = glm::vec4(rays.down, 0);
  }
  return v;
}

}  // namespace

void LightMaps::allocate(int layers, int size) {
  layers_ = layers;
  if (size == position_.width() && layers <= position_.layers()) return;
  position_ = gl::Texture::array(GL_RGBA32F, size, size, layers);
  surface_ = gl::Texture::array(GL_RGBA32UI, size, size, layers);
  colour_ = gl::Texture::array(GL_RGBA16F, size, size, layers);
  depth_ = gl::Texture::array(GL_DEPTH_COMPONENT32F, size, size, layers);
  framebuffers_.clear();
  for (int i = 0; i < layers; ++i)
    framebuffers_.push_back(gl::Framebuffer({&position_, &surface_, &colour_}, &depth_, i));
}

void LightMaps::upload(const std::vector<LightView>& views, const std::vector<std::uint32_t>& photons,
                       const BoundingSphere& sphere) {
  std::vector<gpu::LightView> packed_views;
  std::uint32_t layer = 0, first = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    gpu::LightView v = packed(views[i], sphere);
    v.maps.x = layer;
    v.maps.z = first;
    v.maps.w = photons.empty() ? 0 : photons[i];
    layer += v.maps.y;
    first += v.maps.w;
    packed_views.push_back(v);
  }
  views_.write(packed_views);
}

void LightMaps::draw(const GpuScene& scene, const std::vector<LightView>& views,
                     const std::vector<std::uint32_t>& photons, const gl::Program& program, int size) {
  std::size_t layers = 0;
  for (const LightView& view : views) layers += view.windows.size();
  allocate(std::max(1, static_cast<int>(layers)), size);
  upload(views, photons, scene.sphere());
  program.use();
  glEnable(GL_DEPTH_TEST);
  constexpr std::array<GLfloat, 4> nothing{};
  constexpr std::array<GLuint, 4> no_surface{};
  constexpr GLfloat far = 0;
  std::size_t layer = 0;
  for (const LightView& view : views)
    for (const WindowRays& rays : view.windows) {
      const gl::Framebuffer& framebuffer = framebuffers_[layer++];
      framebuffer.bind();
      glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 0, nothing.data());
      glClearNamedFramebufferuiv(framebuffer.name(), GL_COLOR, 1, no_surface.data());
      glClearNamedFramebufferfv(framebuffer.name(), GL_DEPTH, 0, &far);
      program.set("to_clip", clip_of(rays, scene.sphere()));
      program.set("eye", rays.eye);
      program.set("axis", glm::vec4(rays.axis, rays.parallel ? 1 : 0));
      scene.draw();
    }
}

void LightMaps::bind() const {
  views_.current().bind_storage(gpu::storage_light_views);
  position_.bind(gpu::unit_map_position);
  surface_.bind(gpu::unit_map_surface);
  colour_.bind(gpu::unit_map_colour);
}

}  // namespace lanthorn
