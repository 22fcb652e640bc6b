// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/pilot_radius.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "index/bucket_kdtree.h"
#include "lanthorn/error.h"
#include "photon/photon_gather.h"
#include "photon/photon_map.h"
#include "photon/photon_pass.h"
#include "photon/pilot_paths.h"

namespace lanthorn {

namespace {

using PilotMap = PhotonMap<BucketKdTree>;

// Photons of the pilot pass: enough to measure the density at visible surfaces, and cheaper than a pass.
constexpr std::uint64_t pilot_photons = 50'000;
// Photons of the pilot's nearest-neighbour query. The distance to only a few photons would be noisy.
constexpr std::size_t pilot_neighbours = 24;
// Largest first radius, as a share of the scene's radius, for pictures of few pixels ...
constexpr float widest_of_scene = 0.05f;
// ... and in radii of a pixel's footprint, for small views of large scenes. Where few photons reach the visible
// surfaces, a larger radius would darken whole rooms.
constexpr float widest_in_pixels = 10;
// Longest side of the grid of pilot pixels when one radius serves all.
constexpr int pilot_grid = 64;

// Where an eye path would gather photons.
struct GatherPoint {
  float distance2 = infinity;  // m², to the pilot's photons; infinite if it has too few
  float footprint2 = 0;  // m², squared radius of the disc that a pixel sees, across the ray; 0 if there is no surface
};

// Follows an eye path to its gather point. The footprint is that of a straight path of the same length: curved mirrors
// and lenses are not accounted for.
struct GatherPointVisitor {
  const PilotMap& map;
  const Camera& camera;
  Ray camera_ray;
  GatherPoint& point;
  float length = 0;

  Continuation operator()(const SurfaceVertex& vertex) {
    length += distance(vertex.state.previous, vertex.at.position);
    if (!has_non_delta(vertex.at.bsdf)) return Continuation::go_on();
    const float p = gather_probability(lobe_weights(vertex.at.bsdf, vertex.wi_local));
    if (p < 0.5f) return Continuation::go_on();
    std::array<Neighbour, pilot_neighbours> heap;
    const std::span<const Neighbour> found = map.nearest(vertex.at.position, infinity, heap);
    if (found.size() == heap.size()) point.distance2 = found.front().dist2;
    const float density = camera.density_at(camera_ray, length);
    point.footprint2 = density > 0 ? inv_pi / density : 0.0f;
    return Continuation::stop();
  }
  Continuation operator()(const MediumVertex& vertex) {
    length += distance(vertex.state.previous, vertex.position);
    return Continuation::go_on();
  }
  void operator()(const EscapeVertex&) const {}
};

// The photons of a pilot pass, and the gather points of eye paths among them.
class Pilot {
 public:
  Pilot(const RenderJob& job, const EmissionGuide* guide)
      : job_(job), draw_(draw_for_pass(job, 0)), photons_(std::min(pilot_photons, job.settings.photons)) {
    PhotonTracer tracer;
    tracer.trace(job.scene, {job.settings.seed, Stream::pilot_light, 0, photons_, guide},
                 {.max_depth = job.settings.max_depth}, draw_);
    map_ = PilotMap::build(tracer.chunks(), job.settings.color);
  }

  double photons() const { return static_cast<double>(photons_); }
  /// On a grid over the whole film, so that crops have the same radii.
  std::vector<GatherPoint> of_film() const {
    const Camera& camera = job_.view.camera;
    return gather_points({0, 0, camera.width(), camera.height()}, std::min(pilot_grid, camera.width()),
                         std::min(pilot_grid, camera.height()));
  }
  /// Of each pixel of the window.
  std::vector<GatherPoint> of_pixels() const {
    const PixelWindow& window = job_.view.window;
    return gather_points(window, window.width(), window.height());
  }
  /// The radius in which a pass finds `wanted_photons`: infinite where the pilot has too few photons, 0 without a
  /// surface.
  float radius_at(const GatherPoint& point, double wanted_photons) const {
    // Squared distances are proportional to 1 / density. Scale from the pilot's numbers of photons and neighbours to
    // those of a pass.
    const double scale = wanted_photons / static_cast<double>(pilot_neighbours) * photons() /
                         static_cast<double>(std::max<std::uint64_t>(1, job_.settings.photons));
    return point.footprint2 > 0 ? static_cast<float>(std::sqrt(scale * static_cast<double>(point.distance2))) : 0.0f;
  }

 private:
  std::vector<GatherPoint> gather_points(const PixelWindow& area, int columns, int rows) const {
    std::vector<GatherPoint> points(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for_each_pilot_path(job_, draw_, area, columns, rows,
                        [&](const PathContext&, const Ray& camera_ray, std::uint32_t index) {
                          return GatherPointVisitor{map_, job_.view.camera, camera_ray, points[index]};
                        });
    return points;
  }

  const RenderJob& job_;
  PathDraw draw_;
  std::uint64_t photons_;
  PilotMap map_;
};

// Infinite if there is none. A low quantile instead of the median. Caustics have the densest photons and the finest
// detail; elsewhere there is little light, so that a small radius adds little noise.
float typical_of_found(std::vector<float> values) {
  std::erase(values, 0.0f);
  if (values.empty()) return infinity;
  constexpr std::size_t part = 5;
  const auto quantile = values.begin() + static_cast<std::ptrdiff_t>(values.size() / part);
  std::nth_element(values.begin(), quantile, values.end());
  return *quantile;
}

float widest_radius(const Scene& scene) { return widest_of_scene * scene.bounding_sphere().radius; }

float widest_radius(const GatherPoint& point) {
  return point.footprint2 > 0 ? widest_in_pixels * std::sqrt(point.footprint2) : infinity;
}

}  // namespace

RadiusChoice RadiusChoice::from(const Parameters& parameters) {
  const std::string& text = parameters.text("radius");
  if (text == "auto") return {};
  if (text == "pixel") return {Kind::pixel, 0};
  float value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value > 0) || !std::isfinite(value))
    throw Error(fmt::format("--set radius={}: expected auto, pixel, or a length in metres above 0", text));
  return {Kind::given, value};
}

FirstRadius choose_first_radius(const RenderJob& job, const RadiusChoice& choice, double wanted_photons,
                                const EmissionGuide* guide) {
  if (choice.kind == RadiusChoice::Kind::given) return FirstRadius(choice.given);
  const Pilot pilot(job, guide);
  std::vector<float> of_film;
  for (const GatherPoint& point : pilot.of_film())
    of_film.push_back(std::fmin(pilot.radius_at(point, wanted_photons), widest_radius(point)));
  const float typical = std::fmin(typical_of_found(of_film), widest_radius(job.scene));
  if (choice.kind == RadiusChoice::Kind::scene) return FirstRadius(typical);
  // A hash grid is efficient for radii within a small ratio. Outliers are pixels with almost no photons.
  constexpr float widest = 4;
  const float found = of_film.empty() ? infinity : *std::max_element(of_film.begin(), of_film.end());
  const float most = std::min({widest_radius(job.scene), typical * widest, std::fmax(typical, found)});
  std::vector<float> of_pixels;
  for (const GatherPoint& point : pilot.of_pixels()) {
    const float radius = std::clamp(pilot.radius_at(point, wanted_photons), typical / widest, most);
    of_pixels.push_back(point.footprint2 > 0 ? std::fmin(radius, widest_radius(point)) : typical);
  }
  return FirstRadius(std::move(of_pixels), most, typical);
}

float radius_of_photons(const RenderJob& job, double wanted_photons, const EmissionGuide* guide) {
  const Pilot pilot(job, guide);
  std::vector<float> radii;
  for (const GatherPoint& point : pilot.of_film()) radii.push_back(pilot.radius_at(point, wanted_photons));
  return std::fmin(typical_of_found(std::move(radii)), widest_radius(job.scene));
}

double photons_in_view(const RenderJob& job) {
  const Pilot pilot(job, nullptr);
  const Camera& camera = job.view.camera;
  const double pixels = static_cast<double>(camera.width()) * static_cast<double>(camera.height());
  std::vector<double> found;
  for (const GatherPoint& point : pilot.of_film()) {
    if (!(point.footprint2 > 0)) continue;
    const double per_pixel = static_cast<double>(pilot_neighbours) * static_cast<double>(point.footprint2) /
                             static_cast<double>(point.distance2);
    found.push_back(pixels * per_pixel / pilot.photons());
  }
  if (found.empty()) return 1;
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
  std::nth_element(found.begin(), middle, found.end());
  return *middle;
}

}  // namespace lanthorn
