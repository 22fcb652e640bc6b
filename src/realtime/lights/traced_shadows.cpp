// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/lights/traced_shadows.h"

#include <algorithm>
#include <atomic>

#include "base/parallel.h"
#include "photon/photon.h"
#include "scene/surface_point.h"

namespace lanthorn {

namespace {

// Error of positions that the GPU has interpolated, relative to their largest coordinate.
constexpr float interpolation_error = 0x1p-17f;

SurfacePoint surface_of(const glm::vec4& position, const glm::uvec4& surface) {
  SurfacePoint at;
  at.position = Point(position);
  at.position_error = Vec3(interpolation_error * max_component(abs(at.position)));
  at.normal = decode_octahedral<16>(surface.y);
  return at;
}

bool sees(const Scene& scene, const LightView& view, const SurfacePoint& at) {
  if (view.kind == LightView::Kind::parallel) return scene.visible(spawn_ray(at, view.axis));
  const Vec3 way = view.origin - at.position;
  const float distance = std::sqrt(length_squared(way));
  if (view.kind == LightView::Kind::area && !view.two_sided && dot(way, view.axis) >= 0) return false;
  const Normal normal = view.kind == LightView::Kind::area ? view.axis : Normal(0);
  return scene.visible(spawn_ray_to(at, way / distance, {view.origin, normal, view.position_error}));
}

}  // namespace

std::uint64_t TracedShadows::trace(const Scene& scene, const GBuffer& seen, const std::vector<LightView>& views,
                                   const std::vector<GpuMaterial>& materials, const EyePaths& eye_paths) {
  const int width = seen.width(), height = seen.height();
  if (visibility_.width() != width || visibility_.height() != height)
    visibility_ = gl::Texture(GL_R32UI, width, height);
  const auto positions = seen.position().read<glm::vec4>({GL_RGBA, GL_FLOAT}, 1);
  const auto surfaces = seen.surface().read<glm::uvec4>({GL_RGBA_INTEGER, GL_UNSIGNED_INT}, 1);
  std::vector<std::uint32_t> bits(positions.size(), 0);
  std::atomic<std::uint64_t> rays{0};
  const std::size_t count = std::min<std::size_t>(views.size(), 32);
  parallel_for(0, height, [&](int y) {
    std::uint64_t of_row = 0;
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      if (positions[i].w == 0) continue;
      if (is_drawn_by_paths(materials[surfaces[i].z], eye_paths)) continue;
      const SurfacePoint at = surface_of(positions[i], surfaces[i]);
      for (std::size_t v = 0; v < count; ++v)
        if (sees(scene, views[v], at)) bits[i] |= 1u << v;
      of_row += count;
    }
    rays += of_row;
  });
  visibility_.write({GL_RED_INTEGER, GL_UNSIGNED_INT}, bits.data());
  return rays;
}

}  // namespace lanthorn
