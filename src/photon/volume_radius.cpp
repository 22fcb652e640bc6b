// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/volume_radius.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "photon/photon_pass.h"
#include "photon/pilot_paths.h"

namespace lanthorn {

namespace {

// Light paths of the pilot pass, and sides of its grid of eye paths: their products are computed one by one.
constexpr std::uint64_t pilot_paths = 8'000;
constexpr int pilot_side = 16;
// The estimate whose distance is measured: more photons than a gather wants, so that one distance tells.
constexpr std::size_t pilot_found = 24;
// Largest first radius, as a share of the scene's radius.
constexpr double widest_part = 0.05;

// Squared distance (m²) at which an estimator at the flight or at its end begins to find the photon; none if it does
// not at any. Only the part of the ray that the flight has reached counts: light from behind is dim.
std::optional<double> distance_to(const MediumPhoton& photon, const Segment& way, VolumeEstimator estimator) {
  const Point end = way.origin + way.length * way.direction;
  const Beam beam = photon.beam(infinity);
  switch (estimator) {
    case VolumeEstimator::path:
      break;
    case VolumeEstimator::point:
      return distance_squared(end, photon.photon.position);
    case VolumeEstimator::beam: {
      const FootPoint foot = foot_on_line(photon.photon.position, way.origin, way.direction);
      if (foot.t >= 0 && foot.t <= static_cast<double>(way.length)) return foot.dist2;
      break;
    }
    case VolumeEstimator::photon_beam:
    case VolumeEstimator::short_photon_beam: {
      const FootPoint foot = foot_on_line(end, beam.origin, beam.direction);
      if (foot.t >= 0 && foot.t <= static_cast<double>(beam.length)) return foot.dist2;
      break;
    }
    case VolumeEstimator::beams:
    case VolumeEstimator::short_beams:
      if (const auto crossing = crossing_of({way.origin, way.direction, 0, way.length}, beam)) return crossing->dist2;
      break;
  }
  return {};
}

// Measures the distance of the flights that the eye sees directly or through mirrors and clear glass, the nearest one
// of each path.
struct FlightVisitor {
  std::span<const std::vector<MediumPhoton>> photons;
  VolumeEstimator estimator;
  std::optional<double>& distance2;

  void operator()(const FlownSegment& flight) const {
    if (flight.state.medium == MediumId::vacuum || (is_at_point(estimator) && !flight.scattered)) return;
    std::vector<double> found;
    for (const std::vector<MediumPhoton>& chunk : photons)
      for (const MediumPhoton& photon : chunk)
        if (photon.medium == flight.state.medium)
          if (const auto d2 = distance_to(photon, flight.segment, estimator)) found.push_back(*d2);
    const double here = found.size() < pilot_found ? static_cast<double>(infinity) : nth(found);
    distance2 = std::min(here, distance2.value_or(here));
  }
  Continuation operator()(const SurfaceVertex& vertex) const {
    return has_non_delta(vertex.at.bsdf) ? Continuation::stop() : Continuation::go_on();
  }
  Continuation operator()(const MediumVertex&) const { return Continuation::stop(); }
  void operator()(const EscapeVertex&) const {}

  static double nth(std::vector<double>& values) {
    const auto last = values.begin() + (pilot_found - 1);
    std::nth_element(values.begin(), last, values.end());
    return *last;
  }
};

}  // namespace

std::optional<float> volume_radius_parameter(const Parameters& parameters) {
  if (parameters.text("volume-radius") == "auto") return {};
  return static_cast<float>(parameters.number("volume-radius", 1e-30, 1e30));
}

float first_volume_radius(const RenderJob& job, VolumeEstimator estimator, std::optional<float> given,
                          double wanted_photons, const LightGuide* guide, int first_depth) {
  if (estimator == VolumeEstimator::path || !job.scene.has_scattering_media()) return 0;
  if (given) return *given;
  const PassDraw draw = draw_for_pass(job, 0);
  const std::uint64_t paths = std::min(pilot_paths, job.settings.photons);
  PhotonTracer tracer;
  tracer.trace(
      job.scene, {job.settings.seed, Stream::pilot_light, 0, paths},
      {.max_depth = job.settings.max_depth, .media = records_for(estimator), .first_medium_depth = first_depth}, draw,
      guide);
  const PixelWindow film = job.view.film();
  const int columns = std::min(pilot_side, film.width()), rows = std::min(pilot_side, film.height());
  std::vector<std::optional<double>> of_paths(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for_each_pilot_path(job, draw, film, columns, rows, [&](const PathContext&, const Ray&, std::uint32_t index) {
    return FlightVisitor{tracer.medium_chunks(), estimator, of_paths[index]};
  });
  std::vector<double> found;
  for (const std::optional<double>& distance2 : of_paths)
    if (distance2) found.push_back(*distance2);
  const double widest = widest_part * static_cast<double>(job.scene.bounding_sphere().radius);
  if (found.empty()) return static_cast<float>(widest);
  // Light is densest, and its detail finest, where distances are short.
  const auto fifth = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 5);
  std::nth_element(found.begin(), fifth, found.end());
  const std::uint64_t photons = std::max<std::uint64_t>(1, job.settings.photons);
  const float kept = records_for(estimator) == MediumRecords::points ? 1.0f : share_of_beams(photons);
  const double share = wanted_photons / static_cast<double>(pilot_found) * static_cast<double>(paths) /
                       (static_cast<double>(photons) * static_cast<double>(kept));
  return static_cast<float>(std::min(widest, std::sqrt(*fifth) * std::pow(share, 1.0 / kernel_dimensions(estimator))));
}

}  // namespace lanthorn
