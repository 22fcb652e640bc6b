// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/gather/pilot_radius.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "index/bucket_kdtree.h"
#include "lanthorn/error.h"
#include "photon/gather/disc_tests.h"
#include "photon/gather/photon_gather.h"
#include "photon/photon_map.h"
#include "photon/photon_pass.h"
#include "photon/pilot_paths.h"

namespace lanthorn {

namespace {

// Photons of the pilot pass: enough to measure the density at visible surfaces, and cheaper than a pass.
constexpr std::uint64_t pilot_photons = 50'000;
// Photons of the pilot's nearest-neighbour query. The distance to only a few photons would be noisy.
constexpr std::size_t pilot_neighbours = 24;
// Largest first radius, as a share of the scene's radius.
constexpr float widest_of_scene = 0.05f;
// Largest first radius where the surface is not flat and clear around the gather point, in radii of a pixel's
// footprint. Where few photons reach the visible surfaces, a larger radius would darken whole rooms.
constexpr float widest_in_pixels = 10;
// Longest side of the grid of pilot pixels when one radius serves all.
constexpr int pilot_grid = 64;

// Where an eye path would gather photons.
struct GatherPoint {
  float distance2 = infinity;  // m², to the pilot's photons; infinite if it has too few
  float flux = 0;              // W times light paths, of such photons, their mean without the greatest one
  float footprint2 = 0;  // m², squared radius of the disc that a pixel sees, across the ray; 0 if there is no surface
  float widest = infinity;  // m, largest radius that fits the place
};

// The photons of the pilot pass in a tree.
class PilotPhotons {
 public:
  PilotPhotons() = default;
  PilotPhotons(std::span<const std::vector<Photon>> chunks, float paths, const Wavelengths& w) {
    std::vector<Point> positions;
    std::vector<float> flux;
    for (const std::vector<Photon>& chunk : chunks)
      for (const Photon& photon : chunk) {
        positions.push_back(photon.position);
        flux.push_back(flux_of(photon.power, photon.flags.dispersed, w) * paths);
      }
    IndexBuild<BucketKdTree> built = BucketKdTree::build(positions);
    index_ = std::move(built.index);
    for (const std::uint32_t i : built.order) flux_.push_back(flux[i]);
  }
  FluxClasses classes{};

  // Sets distance and flux of the photons around the point.
  void measure(const Point& at, GatherPoint& point) const {
    std::array<Neighbour, pilot_neighbours> heap;
    const std::span<const Neighbour> found = index_.nearest(at, infinity, heap);
    if (found.size() < heap.size()) return;
    float sum = 0, greatest = 0;
    for (const Neighbour& neighbour : found) {
      sum += flux_[neighbour.slot];
      greatest = std::fmax(greatest, flux_[neighbour.slot]);
    }
    // One strong photon among 24 may be chance, two are not: the strongest is left out of the mean.
    point.flux = (sum - greatest) / static_cast<float>(found.size() - 1);
    point.distance2 = found.front().dist2 * classes.area_factor(point.flux);
  }

  // True if photons with much more than the typical flux carry enough of the light to appear as bright spots.
  bool are_uneven(float typical) const {
    constexpr float much = 8;
    constexpr double part = 0.01;
    double all = 0, bright = 0;
    for (const float flux : flux_) {
      all += static_cast<double>(flux);
      if (flux > much * typical) bright += static_cast<double>(flux);
    }
    return bright > part * all;
  }

 private:
  BucketKdTree index_;
  std::vector<float> flux_;  // by slot, W times light paths
};

// Follows an eye path to its gather point. The footprint is taken from a straight path of the same length: curved
// mirrors and lenses are not accounted for.
struct GatherPointVisitor {
  const PathContext& path;
  const PilotPhotons& photons;
  const Camera& camera;
  Ray camera_ray;
  float scale2;   ///< squared radius that is wanted over `distance2`
  float largest;  ///< factor of the largest disc's radius
  GatherPoint& point;
  float length = 0;

  Continuation operator()(const SurfaceVertex& vertex) {
    length += distance(vertex.state.previous, vertex.at.position);
    if (!has_non_delta(vertex.at.bsdf)) return Continuation::go_on();
    const float p = wide_share(vertex);
    if (p < 0.5f) return Continuation::go_on();
    photons.measure(vertex.at.position, point);
    const float density = camera.density_at(camera_ray, length);
    point.footprint2 = density > 0 ? inv_pi / density : 0.0f;
    point.widest = widest_at(vertex);
    return Continuation::stop();
  }
  float widest_at(const SurfaceVertex& vertex) const {
    if (!(scale2 > 0) || !(point.footprint2 > 0)) return infinity;
    const float few_pixels = widest_in_pixels * std::sqrt(point.footprint2);
    float radius =
        largest * std::fmin(widest_of_scene * path.scene.bounding_sphere().radius, std::sqrt(scale2 * point.distance2));
    if (!(radius > few_pixels)) return infinity;
    while (radius > few_pixels && !is_flat_and_clear(path, vertex, radius)) radius /= 2;
    return std::fmax(radius, few_pixels);
  }
  Continuation operator()(const MediumVertex& vertex) {
    length += distance(vertex.state.previous, vertex.position);
    return Continuation::go_on();
  }
  void operator()(const EscapeVertex&) const {}
};

// A low quantile of the radii that were found, not the median; infinite if none was. Caustics have the densest photons
// and the finest detail; elsewhere there is little light, so that a small radius adds little noise.
float typical_of_found(std::vector<float> values) {
  std::erase(values, 0.0f);
  if (values.empty()) return infinity;
  constexpr std::size_t part = 5;
  const auto quantile = values.begin() + static_cast<std::ptrdiff_t>(values.size() / part);
  std::nth_element(values.begin(), quantile, values.end());
  return *quantile;
}

// The photons of a pilot pass, and the gather points of eye paths among them.
class Pilot {
 public:
  // `by_flux`: measures the radii of the first flux class.
  Pilot(const RenderJob& job, const LightGuide* guide, bool by_flux = false)
      : job_(job), draw_(draw_for_pass(job, 0)), photons_(std::min(pilot_photons, job.settings.photons)) {
    PhotonTracer tracer;
    tracer.trace(job.scene, {job.settings.seed, Stream::pilot_light, 0, photons_},
                 {.max_depth = job.settings.max_depth}, draw_, guide);
    map_ = PilotPhotons(tracer.chunks(), static_cast<float>(photons_), draw_.w);
    if (!by_flux) return;
    std::vector<float> flux;
    for (const GatherPoint& point : of_film(0)) flux.push_back(point.flux);
    const float typical = typical_of_found(std::move(flux));
    if (std::isfinite(typical) && map_.are_uneven(typical)) map_.classes.reference = typical;
  }
  const FluxClasses& classes() const { return map_.classes; }

  double photons() const { return static_cast<double>(photons_); }
  /// On a grid over the whole film, so that crops have the same radii. `wanted_photons`: of a gather.
  std::vector<GatherPoint> of_film(double wanted_photons) const {
    const PixelWindow film = job_.view.film();
    return gather_points(film, std::min(pilot_grid, film.width()), std::min(pilot_grid, film.height()), wanted_photons);
  }
  /// The gather point of each pixel of the window.
  std::vector<GatherPoint> of_pixels(double wanted_photons) const {
    const PixelWindow& window = job_.view.window;
    return gather_points(window, window.width(), window.height(), wanted_photons);
  }
  /// The radius in which a pass finds `wanted_photons`: infinite where the pilot has too few photons, 0 without a
  /// surface.
  float radius_at(const GatherPoint& point, double wanted_photons) const {
    return point.footprint2 > 0 ? std::sqrt(scale2(wanted_photons) * point.distance2) : 0.0f;
  }

 private:
  // Factor for squared distances, which are proportional to 1 / density: converts from the pilot's numbers of photons
  // and neighbours to the numbers of a pass.
  float scale2(double wanted_photons) const {
    return static_cast<float>(wanted_photons / static_cast<double>(pilot_neighbours) * photons() /
                              static_cast<double>(std::max<std::uint64_t>(1, job_.settings.photons)));
  }
  std::vector<GatherPoint> gather_points(const PixelWindow& area, int columns, int rows, double wanted_photons) const {
    const float largest_factor = FluxClasses::radius_factor(classes().count() - 1);
    std::vector<GatherPoint> points(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for_each_pilot_path(
        job_, draw_, area, columns, rows, [&](const PathContext& path, const Ray& camera_ray, std::uint32_t index) {
          return GatherPointVisitor{path,           map_,         job_.view.camera, camera_ray, scale2(wanted_photons),
                                    largest_factor, points[index]};
        });
    return points;
  }

  const RenderJob& job_;
  PassDraw draw_;
  std::uint64_t photons_;
  PilotPhotons map_;
};

float widest_radius(const Scene& scene) { return widest_of_scene * scene.bounding_sphere().radius; }

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
                                const LightGuide* guide, bool by_flux) {
  if (choice.kind == RadiusChoice::Kind::given) return FirstRadius(choice.given);
  const Pilot pilot(job, guide, by_flux && choice.kind == RadiusChoice::Kind::pixel);
  std::vector<float> of_film;
  for (const GatherPoint& point : pilot.of_film(wanted_photons))
    of_film.push_back(std::fmin(pilot.radius_at(point, wanted_photons), point.widest));
  const float typical = std::fmin(typical_of_found(of_film), widest_radius(job.scene));
  if (choice.kind == RadiusChoice::Kind::scene) return FirstRadius(typical);
  // A hash grid is efficient for radii within a small ratio. Outliers are pixels with almost no photons.
  constexpr float widest = 4;
  const float found = of_film.empty() ? infinity : *std::max_element(of_film.begin(), of_film.end());
  const float most = std::min({widest_radius(job.scene), typical * widest, std::fmax(typical, found)});
  FirstRadius result(most, typical, pilot.classes());
  for (const GatherPoint& point : pilot.of_pixels(wanted_photons)) {
    const float radius = std::clamp(pilot.radius_at(point, wanted_photons), typical / widest, most);
    result.add_pixel(point.footprint2 > 0 ? std::fmin(radius, point.widest) : typical, point.widest);
  }
  return result;
}

float radius_of_photons(const RenderJob& job, double wanted_photons, const LightGuide* guide) {
  const Pilot pilot(job, guide);
  std::vector<float> radii;
  for (const GatherPoint& point : pilot.of_film(0)) radii.push_back(pilot.radius_at(point, wanted_photons));
  return std::fmin(typical_of_found(std::move(radii)), widest_radius(job.scene));
}

double photons_in_view(const RenderJob& job) {
  const Pilot pilot(job, nullptr);
  const Camera& camera = job.view.camera;
  const double pixels = static_cast<double>(camera.width()) * static_cast<double>(camera.height());
  std::vector<double> found;
  for (const GatherPoint& point : pilot.of_film(0)) {
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
