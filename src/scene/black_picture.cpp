// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include "camera/view.h"
#include "lanthorn/scene.h"
#include "math/sampling.h"
#include "scene/scene.h"

namespace lanthorn {

namespace {

constexpr int rays_across = 16;  // of the picture

bool meets_surface(const Scene& scene, const Ray& ray) {
  return scene.intersect(ray, Wavelengths::rgb(0.5f)).has_value();
}

// Rays through the picture, as from the middle of the lens.
std::vector<Ray> view_rays(const View& view) {
  const Vec2 cell = Vec2(view.camera.width(), view.camera.height()) / static_cast<float>(rays_across);
  std::vector<Ray> rays;
  for (int y = 0; y < rays_across; ++y)
    for (int x = 0; x < rays_across; ++x)
      rays.push_back(view.camera.sample_ray((Vec2(x, y) + 0.5f) * cell, {0.5f, 0.5f}, 0.5f).ray);
  return rays;
}

// True if one of the lights (of many, some) is in sight of this point, on the side that faces the eye.
bool is_lit(const Scene& scene, const SurfacePoint& at, const Direction& to_eye) {
  constexpr std::size_t most = 64;
  const std::vector<Light>& lights = scene.lights();
  for (std::size_t i = 0; i < lights.size(); i += lights.size() / most + 1) {
    const auto l = sample_direct(lights[i], at.position, Vec2(0.5f), Wavelengths::rgb(0.5f));
    if (!l || l->radiance.is_black() || dot(l->wi, at.normal) * dot(to_eye, at.normal) <= 0) continue;
    const bool is_distant = is_far(lights[i]);
    if (scene.visible(is_distant ? spawn_ray(at, l->wi)
                                 : spawn_ray_to(at, l->wi, {l->position, l->normal, l->position_error})))
      return true;
  }
  return false;
}

// True if a light is in sight of a part of the visible surfaces.
bool shows_lit_surfaces(const Scene& scene, const std::vector<Ray>& rays) {
  constexpr double least = 0.05;
  double seen = 0, lit = 0;
  for (const Ray& ray : rays)
    if (const auto at = scene.intersect(ray, Wavelengths::rgb(0.5f))) {
      ++seen;
      if (is_lit(scene, *at, -ray.direction)) ++lit;
    }
  return lit > least * seen;
}

// True if surfaces are all around the point.
bool is_enclosed(const Scene& scene, const Point& from) {
  for (int i = 0; i < rays_across; ++i)
    for (int k = 0; k < rays_across; ++k) {
      const Vec2 u((static_cast<float>(i) + 0.5f) / rays_across, (static_cast<float>(k) + 0.5f) / rays_across);
      if (!meets_surface(scene, {from, sample_uniform_sphere(u)})) return false;
    }
  return true;
}

std::string what_is_seen(const Scene& scene, const View& view, bool is_black) {
  const std::vector<Ray> rays = view_rays(view);
  const auto seen = std::count_if(rays.begin(), rays.end(), [&](const Ray& ray) { return meets_surface(scene, ray); });
  if (seen == 0) return "no surface is in the camera's view; --look-at places the camera";
  if (!is_black && shows_lit_surfaces(scene, rays))
    return "the lights are faint, or far from what the camera sees; --light and the scene file set their strength";
  const Ray& middle = rays[rays.size() / 2 + rays_across / 2];
  const auto place = scene.locate(middle);
  if (is_enclosed(scene, middle.origin))
    return "the camera is inside of closed surfaces that keep the light out" +
           (place ? " (" + std::string(Error(*place, "the one in the middle of the picture").what()) + ")" : "") +
           "; --look-at places the camera";
  return is_black ? "no light reaches what the camera sees"
                  : "no light is in sight of what the camera sees; only little of it arrives by detours";
}

}  // namespace

std::string reason_for_black(const Scene& scene, const ViewDescription& view) {
  const std::vector<Light>& lights = scene.lights();
  if (lights.empty() && !scene.has_emissive_media()) return "the scene has no light";
  const auto shines = [](const Light& light) { return power(light) > 0; };
  if (!scene.has_emissive_media() && std::none_of(lights.begin(), lights.end(), shines))
    return lights.size() == 1 ? "the scene's light has no power" : "none of the scene's lights has any power";
  const View placed = make_view(view);
  if (!(placed.imaging_ratio > 0)) return "the film's exposure is 0";
  return what_is_seen(scene, placed, true);
}

std::string reason_for_faint(const Scene& scene, const ViewDescription& view) {
  return what_is_seen(scene, make_view(view), false);
}

}  // namespace lanthorn
