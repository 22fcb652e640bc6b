// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/rays.h"

#include <utility>

#include "base/parallel.h"
#include "camera/view.h"
#include "lanthorn/error.h"
#include "lanthorn/scene.h"
#include "path/path_draw.h"
#include "path/radiance_along.h"
#include "scene/medium_around.h"
#include "scene/scene.h"
#include "surface/bsdf.h"

namespace lanthorn {

namespace {

// An arbitrary wavelength: without dispersion, it does not affect RGB.
const Wavelengths middle_wavelength = Wavelengths::rgb(0.5f);

std::vector<Ray> rays_in_scene(const Scene& scene, std::span<const SceneRay> rays) {
  std::vector<Ray> all;
  all.reserve(rays.size());
  for (const SceneRay& ray : rays) all.push_back(ray_in_scene(scene, ray, all.size()));
  return all;
}

// The nearest actual surface, skipping interfaces between media.
std::optional<SurfacePoint> nearest_surface(const Scene& scene, Ray ray) {
  for (;;) {
    std::optional<SurfacePoint> at = scene.intersect(ray, middle_wavelength);
    if (!at || !at->is_interface) return at;
    leave_surface(*at, ray.direction, ray);
  }
}

RayHit hit_of(const Scene& scene, const Ray& ray) {
  const std::optional<SurfacePoint> at = nearest_surface(scene, ray);
  if (!at) return {};
  return {.distance = glm::distance(at->position, ray.origin),
          .position = Point(DVec3(at->position) + scene.description().origin),
          .normal = at->normal,
          .shading_normal = at->shading.n,
          .uv = at->uv,
          .emits = at->light.has_value()};
}

// Mean over the paths of a ray.
class LightOfRays {
 public:
  LightOfRays(const Scene& scene, const RayLightSettings& settings)
      : scene_(scene), settings_(settings), media_(scene) {}

  Rgb along(const Ray& ray, std::uint32_t index) const {
    const MediumId medium = media_.around(ray.origin, ray.time).value_or(MediumId::vacuum);
    Rgb sum;
    for (std::uint32_t n = 0; n < settings_.samples; ++n) {
      stop_point();
      Sampler sampler = Sampler::for_pixel(settings_.seed, stream_of("rays"), index, n);
      sampler.seek(1);
      const Wavelengths w = Wavelengths::rgb(sampler.next());
      RayCounts counts;
      LightLayers layers(w);
      radiance_along(PathContext{scene_, w, sampler, counts, {settings_.max_depth}}, {ray}, medium, layers);
      const PixelSample sample = layers.sample(FilterPart::positive, {});
      for (std::size_t c = 0; c < path_class_count; ++c) sum += sample.light[c];
    }
    return 1 / static_cast<float>(settings_.samples) * sum;
  }

 private:
  const Scene& scene_;
  const RayLightSettings& settings_;
  MediumFinder media_;
};

}  // namespace

std::vector<RayHit> intersect(const Scene& scene, std::span<const SceneRay> rays) {
  const std::vector<Ray> all = rays_in_scene(scene, rays);
  std::vector<RayHit> hits(all.size());
  parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) { hits[i] = hit_of(scene, all[i]); });
  return hits;
}

std::vector<Rgb> radiance_along(const Scene& scene, std::span<const SceneRay> rays, const RayLightSettings& settings) {
  if (settings.samples < 1) throw Error("radiance along rays: expected at least 1 sample");
  if (settings.max_depth < 1) throw Error("radiance along rays: expected a maximum depth of at least 1");
  const std::vector<Ray> all = rays_in_scene(scene, rays);
  const LightOfRays light(scene, settings);
  std::vector<Rgb> radiance(all.size());
  parallel_for(std::size_t{0}, all.size(),
               [&](std::size_t i) { radiance[i] = light.along(all[i], static_cast<std::uint32_t>(i)); });
  return radiance;
}

struct SurfaceBsdf::At {
  SharedScene scene;  ///< keeps the BSDF's scene alive
  SurfacePoint point;
};

SurfaceBsdf::SurfaceBsdf(std::shared_ptr<const At> at) : at_(std::move(at)) {}

Rgb SurfaceBsdf::eval(const Direction& wi, const Direction& wo) const {
  return middle_wavelength.to_rgb(lanthorn::evaluate(at_->point.bsdf, wi, wo, Transport::radiance, {.f = true}).f);
}
float SurfaceBsdf::pdf(const Direction& wi, const Direction& wo) const {
  return lanthorn::evaluate(at_->point.bsdf, wi, wo, Transport::radiance, {.pdf = true}).pdf;
}
SurfaceBsdf::Sample SurfaceBsdf::sample(const Direction& wi, const Vec3& u) const {
  const std::optional<BsdfSample> sample =
      lanthorn::sample(at_->point.bsdf, wi, u.x, Vec2(u.y, u.z), Transport::radiance);
  if (!sample) return {};
  return {sample->wo, middle_wavelength.to_rgb(sample->weight), sample->pdf, sample->delta, sample->transmission};
}

std::optional<SurfaceBsdf> bsdf_at(SharedScene scene, const SceneRay& ray) {
  std::optional<SurfacePoint> point = nearest_surface(*scene, ray_in_scene(*scene, ray, 0));
  if (!point) return std::nullopt;
  return SurfaceBsdf(std::make_shared<const SurfaceBsdf::At>(SurfaceBsdf::At{std::move(scene), *point}));
}

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
