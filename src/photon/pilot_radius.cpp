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
// Largest first radius, as a share of the scene's radius. Where few photons reach the visible surfaces, a larger radius
// would darken whole rooms.
constexpr float widest_of_scene = 0.05f;
// Longest side of the grid of pilot pixels when one radius serves all.
constexpr int pilot_grid = 64;

// Follows an eye path to its gather point and measures the distance to the nearest pilot photons there.
struct DistanceVisitor {
  const PilotMap& map;
  float& distance2;

  Continuation operator()(const SurfaceVertex& vertex) const {
    if (!has_non_delta(vertex.at.bsdf)) return Continuation::go_on();
    const float p = gather_probability(lobe_weights(vertex.at.bsdf, vertex.wi_local));
    if (p < 0.5f) return Continuation::go_on();
    std::array<Neighbour, pilot_neighbours> heap;
    const std::span<const Neighbour> found = map.nearest(vertex.at.position, infinity, heap);
    if (found.size() == heap.size()) distance2 = found.front().dist2;
    return Continuation::stop();
  }
  Continuation operator()(const MediumVertex&) const { return Continuation::go_on(); }
  void operator()(const EscapeVertex&) const {}
};

PilotMap trace_pilot(const RenderJob& job, const PathDraw& draw, const EmissionGuide* guide) {
  PhotonTracer tracer;
  const std::uint64_t photons = std::min(pilot_photons, job.settings.photons);
  tracer.trace(job.scene, {job.settings.seed, Stream::pilot_light, 0, photons, guide},
               {.max_depth = job.settings.max_depth}, draw);
  return PilotMap::build(tracer.chunks(), job.settings.color);
}

// For columns x rows points of the window, the squared distance from the gather point to its pilot photons; 0 if there
// are none.
std::vector<float> measure_distances(const RenderJob& job, const PilotMap& map, const PathDraw& draw, int columns,
                                     int rows) {
  std::vector<float> distances(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for_each_pilot_path(job, draw, columns, rows, [&](const PathContext&, std::uint32_t index) {
    return DistanceVisitor{map, distances[index]};
  });
  return distances;
}

// A low quantile instead of the median. Caustics have the densest photons and the finest detail; elsewhere there is
// little light, so that a small radius adds little noise.
float typical_of_found(std::vector<float> values) {
  std::erase(values, 0.0f);
  if (values.empty()) return 0;
  constexpr std::size_t part = 5;
  const auto quantile = values.begin() + static_cast<std::ptrdiff_t>(values.size() / part);
  std::nth_element(values.begin(), quantile, values.end());
  return *quantile;
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
  const PathDraw draw = draw_for_pass(job, 0);
  const PilotMap map = trace_pilot(job, draw, guide);

  const bool per_pixel = choice.kind == RadiusChoice::Kind::pixel;
  const PixelWindow& window = job.view.window;
  const int columns = per_pixel ? window.width() : std::min(pilot_grid, window.width());
  const int rows = per_pixel ? window.height() : std::min(pilot_grid, window.height());
  std::vector<float> distances = measure_distances(job, map, draw, columns, rows);

  // Squared distances are proportional to 1 / density. Scale from the pilot's numbers of photons and neighbours to
  // those of a pass.
  const double photons = static_cast<double>(std::min(pilot_photons, job.settings.photons));
  const double scale = wanted_photons / static_cast<double>(pilot_neighbours) * photons /
                       static_cast<double>(std::max<std::uint64_t>(1, job.settings.photons));
  const float found = typical_of_found(distances);
  // Without visible photons, the radius is a share of the scene's size.
  const float size = job.scene.bounding_sphere().radius;
  const float most = widest_of_scene * size;
  const float typical =
      found > 0 ? std::fmin(most, static_cast<float>(std::sqrt(scale * static_cast<double>(found)))) : 1e-3f * size;
  if (!per_pixel) return FirstRadius(typical);
  // A hash grid is efficient for radii within a small ratio. Outliers are pixels with almost no photons.
  constexpr float widest = 4;
  for (float& d : distances)
    d = d > 0 ? std::clamp(static_cast<float>(std::sqrt(scale * static_cast<double>(d))), typical / widest,
                           std::fmin(most, typical * widest))
              : typical;
  const float largest = distances.empty() ? typical : *std::max_element(distances.begin(), distances.end());
  return FirstRadius(std::move(distances), largest, typical);
}

}  // namespace lanthorn
