// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Overhead of Scene::intersect and of tracing photons over the ray queries themselves, relative to raw Embree on the
// same geometry: incoherent rays inside a scene of triangles and patches, and the rays of the photons.
//   bench_intersect tests/conformance/scenes/c02-cornell.pbrt
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "lanthorn/scene.h"
#include "math/hash.h"
#include "math/sampling.h"
#include "photon/photon_pass.h"
#include "scene/geometry.h"
#include "scene/scene.h"

namespace lanthorn {
namespace {

constexpr std::size_t ray_count = 1 << 18;
constexpr int rounds = 7;

// Rays that leave surfaces in all directions, as after a diffuse bounce.
std::vector<Ray> bounced_rays(const Scene& scene) {
  const Camera camera = make_view(scene.description().view).camera;
  const Wavelengths w = Wavelengths::rgb(0.5f);
  HashRng rng(1);
  std::vector<Ray> rays;
  while (rays.size() < ray_count) {
    const Vec2 raster(rng.next() * static_cast<float>(camera.width()),
                      rng.next() * static_cast<float>(camera.height()));
    Ray ray = camera.sample_ray(raster, rng.next2(), 0).ray;
    for (int bounce = 0; bounce < 6 && rays.size() < ray_count; ++bounce) {
      const auto at = scene.intersect(ray, w);
      if (!at) break;
      Vec3 local = sample_cosine_hemisphere(rng.next2());
      if (dot(ray.direction, at->normal) > 0) local.z = -local.z;
      ray = spawn_ray(*at, at->shading.to_world(local));
      rays.push_back(ray);
    }
  }
  return rays;
}

constexpr LightPass photon_pass{1, Stream::light, 0, 200'000};
constexpr PhotonRule photon_rule{.first_depth = 2, .max_depth = 10};

// The rays that the photon pass below traces, in its order.
std::vector<Ray> photon_rays(const Scene& scene, const PathDraw& draw) {
  struct Recorder {
    std::vector<Ray>& rays;
    Continuation operator()(const SurfaceVertex& vertex) const {
      add(vertex.state.previous, -vertex.wi);
      return Continuation::go_on();
    }
    Continuation operator()(const MediumVertex& vertex) const {
      add(vertex.state.previous, -vertex.wi);
      return Continuation::go_on();
    }
    void operator()(const EscapeVertex& vertex) const { add(vertex.state.previous, vertex.direction); }
    void add(const Point& from, const Direction& direction) const {
      rays.push_back({from + 1e-4f * direction, direction, infinity, 0});
    }
  };
  const LightPaths paths(scene, photon_pass);
  std::vector<Ray> rays;
  const ThreadLimit one_thread(1);
  const WalkLimits limits{photon_rule.max_depth - 1, photon_rule.roulette_depth};
  paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts& counts, std::size_t) {
    walk_from_light(PathContext{scene, draw.w, sampler, counts, limits}, start, draw.time, Recorder{rays});
  });
  return rays;
}

template <class Body>
double best_seconds(Body&& body) {
  double best = 1e30;
  for (int round = 0; round < rounds; ++round) {
    const std::clock_t start = std::clock();  // processor time: less affected by other programs
    body();
    best = std::min(best, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return best;
}

// Only the file's static meshes, in an Embree scene with the flags that Geometry sets.
struct RawScene {
  std::vector<std::unique_ptr<ShapeStore>> shapes;
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = rtcNewScene(device);

  explicit RawScene(SceneDescription description) {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    for (description::Shape& shape : description.shapes) {
      auto store = make_shape_store(shape, shape.object_to_world.start);
      if (store->record.kind != GeometryRecord::Kind::triangles) continue;
      const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
      rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
      share_triangles(geometry, *store);
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene, geometry);
      rtcReleaseGeometry(geometry);
      shapes.push_back(std::move(store));
    }
    rtcCommitScene(scene);
  }
  ~RawScene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

double seconds_of(const RawScene& raw, const std::vector<Ray>& rays) {
  float sum = 0;
  const double seconds = best_seconds([&] {
    for (const Ray& ray : rays) {
      RTCRayHit hit;
      hit.ray = embree::make_ray(ray.origin, ray.direction, ray.t_max, 0);
      hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      embree::intersect(raw.scene, hit);
      sum += hit.ray.tfar < 1e30f ? hit.ray.tfar : 0;
    }
  });
  if (sum == 0) std::printf("nothing was hit\n");
  return seconds;
}

void report(const char* what, double seconds, double raw_seconds, std::size_t rays = ray_count) {
  std::printf("%-34s %7.2f M rays/s  %6.1f ns  %5.2f of raw\n", what, 1e-6 * static_cast<double>(rays) / seconds,
              1e9 * seconds / static_cast<double>(rays), raw_seconds / seconds);
}

void measure_photons(const Scene& scene, const RawScene& raw) {
  const PathDraw draw{0, Wavelengths::rgb(0.5f)};
  const std::vector<Ray> rays = photon_rays(scene, draw);
  const double raw_seconds = seconds_of(raw, rays);
  report("photons: rtcIntersect1", raw_seconds, raw_seconds, rays.size());
  PhotonTracer tracer;
  const ThreadLimit one_thread(1);
  report("photons: traced and stored, RGB", best_seconds([&] {
           tracer.trace(scene, photon_pass, photon_rule, {0, 0, draw.w});
         }),
         raw_seconds, rays.size());
}

void measure(const std::string& file) {
  const Scene scene(read_scene(file));
  const RawScene raw(read_scene(file));
  const std::vector<Ray> rays = bounced_rays(scene);
  const Wavelengths rgb = Wavelengths::rgb(0.5f);
  const Wavelengths spectral = Wavelengths::spectral(0.5f);
  float sum = 0;
  const double raw_seconds = seconds_of(raw, rays);
  report("rtcIntersect1", raw_seconds, raw_seconds);
  const auto shade = [&](const Wavelengths& w) {
    return best_seconds([&] {
      for (const Ray& ray : rays)
        if (const auto at = scene.intersect(ray, w)) sum += at->position.x + at->shading.s.x;
    });
  };
  report("Scene::intersect, RGB", shade(rgb), raw_seconds);
  report("Scene::intersect, spectral", shade(spectral), raw_seconds);
  const double visible = best_seconds([&] {
    for (const Ray& ray : rays) sum += scene.visible(ray) ? 1.0f : 0.0f;
  });
  report("Scene::visible", visible, raw_seconds);
  if (sum == 0) std::printf("nothing was hit\n");
  measure_photons(scene, raw);
}

}  // namespace
}  // namespace lanthorn

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_intersect SCENE...\n");
    return EXIT_FAILURE;
  }
  for (int i = 1; i < argc; ++i) {
    std::printf("%s\n", argv[i]);
    lanthorn::measure(argv[i]);
  }
  return EXIT_SUCCESS;
}
