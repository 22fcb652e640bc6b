// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "camera/view.h"
#include "lanthorn/scene.h"
#include "scene/scene.h"

namespace lanthorn {

std::optional<float> depth_at(const Scene& scene, const ViewDescription& description, const ViewOptions& options,
                              const std::optional<Vec2>& pixel) {
  const View view = make_view(description, options);
  const Camera& camera = view.camera;
  const Vec2 middle = 0.5f * Vec2(static_cast<float>(camera.width()), static_cast<float>(camera.height()));
  Ray ray = camera.sample_ray(pixel.value_or(middle), Vec2(0.5f), camera.time(0)).ray;
  const Transform to_camera = framing(description.camera, camera.width(), camera.height()).start.inverted();
  const Wavelengths w = Wavelengths::rgb(0.5f);
  constexpr int most_interfaces = 1000;
  for (int i = 0; i < most_interfaces; ++i) {
    const std::optional<SurfacePoint> hit = scene.intersect(ray, w);
    if (!hit) return std::nullopt;
    if (!hit->is_interface) return to_camera.point(hit->position).z;
    ray.origin = offset_origin(*hit, ray.direction);
  }
  return std::nullopt;
}

}  // namespace lanthorn
