// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/volume_radius.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "photon/photon_pass.h"
#include "photon/pilot_paths.h"

namespace lanthorn {

namespace {

// Light paths of each of the pilot's two sets of photons.
constexpr std::uint64_t pilot_paths = 8'000;
// Longest side of the grid of eye paths that look for the largest radius.
constexpr int coarse_side = 16;
// The largest radius that is tried, as a share of the scene's, and the photons of a set that an eye path may find in it
// in the mean: each is looked at.
constexpr double widest_part = 0.1;
constexpr double most_found = 300;
constexpr int most_halvings = 10;
// Radii that are tried, each the one before over √2.
constexpr std::size_t rungs = 20;
// Passes whose noise stands against the blur. If radii shrink with α = 2/3, the best first radius is that of 3 passes
// for blur that falls as their square, and of all passes for blur that does not fall.
constexpr double noisy_passes = 8;
// Variance of a pass besides, over squared light: where it is much, time for more passes is worth more than a wider
// radius. It is .1 to .6 in bench/media.
constexpr double noise_of_rest = 0.2;
// Photons that are met in the time of an eye path or a light path.
constexpr double as_long_as_a_path = 50;
// A smaller radius must be better by so many standard errors.
constexpr double confidence = 2;

// Longest side of the grid of eye paths. Beams meet many of them, each of which tells nearly the same.
constexpr int side_for(VolumeEstimator estimator) { return records_for(estimator) == MediumRecords::points ? 128 : 64; }

// An eye path's light by the kernel of each radius, from two independent sets of photons.
struct Estimates {
  std::array<std::array<float, rungs>, 2> of_sets{};
  std::size_t found = 0;  // photons of both within the largest radius

  double mean(std::size_t rung) const { return (at(0, rung) + at(1, rung)) / 2; }
  // Squared error by blur, but for a sum that is the same for all rungs.
  double blur(std::size_t rung) const { return square(rung) - 2 * square(rung + 1); }
  // Unbiased, of the widest estimate from one set.
  double variance() const { return std::pow(at(0, 0) - at(1, 0), 2) / 2; }

 private:
  // Unbiased, the square of what is expected.
  double square(std::size_t rung) const { return at(0, rung) * at(1, rung); }
  double at(std::size_t set, std::size_t rung) const { return static_cast<double>(of_sets[set][rung]); }
};

// Estimates the light that media scatter towards the eye until the eye path first scatters.
struct EstimateVisitor {
  const PathContext& path;
  std::span<const VolumeGather, 2> sets;
  std::span<const KernelIn> kernels;
  Estimates& estimates;

  void operator()(const FlownSegment& flight) const {
    if (flight.state.medium == MediumId::vacuum) return;
    for (std::size_t i = 0; i < 2; ++i)
      estimates.found += sets[i].compare_along(path, flight, kernels, estimates.of_sets[i]);
  }
  Continuation operator()(const MediumVertex& vertex) const {
    for (std::size_t i = 0; i < 2; ++i)
      estimates.found += sets[i].compare_at(path, vertex, kernels, estimates.of_sets[i]);
    return Continuation::stop();
  }
  Continuation operator()(const SurfaceVertex& vertex) const {
    return has_non_delta(vertex.at.bsdf) ? Continuation::stop() : Continuation::go_on();
  }
  void operator()(const EscapeVertex&) const {}
};

class VolumePilot {
 public:
  VolumePilot(const RenderJob& job, VolumeEstimator estimator, const Kernel& kernel, const LightGuide* guide,
              int first_depth)
      : job_(job),
        estimator_(estimator),
        kernel_(kernel),
        draw_(draw_for_pass(job, 0)),
        paths_(std::min(pilot_paths, job.settings.photons)) {
    for (std::uint32_t i = 0; i < 2; ++i)
      tracers_[i].trace(
          job.scene, {job.settings.seed, Stream::pilot_light, i, paths_},
          {.max_depth = job.settings.max_depth, .media = records_for(estimator), .first_medium_depth = first_depth},
          draw_, guide);
  }

  double radius() const {
    double widest = widest_part * static_cast<double>(job_.scene.bounding_sphere().radius);
    // Where eye and light are in one place, any radius finds all beams.
    for (int i = 0; i < most_halvings && found_by(estimates(widest, coarse_side)) > most_found; ++i) widest /= 2;
    return radius_of(widest, least_error(estimates(widest, side_for(estimator_))));
  }

 private:
  static double radius_of(double widest, std::size_t rung) {
    return widest * std::pow(std::numbers::sqrt2, -static_cast<double>(rung));
  }
  // The mean number of photons of a set that an eye path finds.
  static double found_by(const std::vector<Estimates>& paths) {
    double sum = 0;
    for (const Estimates& path : paths) sum += static_cast<double>(path.found) / 2;
    return sum / static_cast<double>(paths.size());
  }

  std::vector<Estimates> estimates(double widest, int side) const {
    std::vector<KernelIn> kernels;
    for (std::size_t k = 0; k < rungs; ++k)
      kernels.emplace_back(kernel_dimensions(estimator_), kernel_, static_cast<float>(radius_of(widest, k)));
    const auto gather = [&](std::size_t i) {
      return VolumeGather(estimator_, kernel_, static_cast<float>(widest), tracers_[i].medium_chunks(),
                          job_.settings.color);
    };
    const std::array<VolumeGather, 2> sets{gather(0), gather(1)};
    const PixelWindow film = job_.view.film();
    const int columns = std::min(side, film.width()), rows = std::min(side, film.height());
    std::vector<Estimates> result(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for_each_pilot_path(job_, draw_, film, columns, rows, [&](const PathContext& path, const Ray&, std::uint32_t i) {
      return EstimateVisitor{path, sets, kernels, result[i]};
    });
    return result;
  }

  // Photons of the pilot's set over those of a pass.
  double share() const {
    const std::uint64_t photons = std::max<std::uint64_t>(1, job_.settings.photons);
    const double light_paths = static_cast<double>(paths_) / static_cast<double>(photons);
    if (records_for(estimator_) == MediumRecords::points) return light_paths;
    return light_paths * static_cast<double>(share_of_beams(paths_)) / static_cast<double>(share_of_beams(photons));
  }

  // Photons that an eye path meets in the time of all else that a pass does for it.
  double most_work() const {
    const PixelWindow film = job_.view.film();
    const double eye_paths = static_cast<double>(film.width()) * film.height();
    return as_long_as_a_path * (1 + static_cast<double>(job_.settings.photons) / eye_paths);
  }

  // The rung whose estimate L_r of the light L has the least squared error after n passes, relative to the light,
  //   (E L_r - L)² + V(L_r) / n = (E L_r)² - 2 L E L_r + V(L_r) / n + L².
  // L is not known; but to blur it by r is to blur it twice by r/√2, which can be done to one factor or to both, so
  // that the sum of L E L_r over the paths is that of (E L_{r/√2})². That of V(L_r) is inverse to the kernel's size.
  // Smaller radii than that of the least noise have to be significantly better: they find few photons.
  std::size_t least_error(const std::vector<Estimates>& paths) const {
    const auto count = static_cast<double>(paths.size());
    double sum = 0;
    for (const Estimates& path : paths) sum += path.mean(0);
    if (!(sum > 0)) return 0;
    std::vector<double> light2;
    double variance = 0;
    for (const Estimates& path : paths) {
      light2.push_back(std::pow(path.mean(0), 2) + std::pow(sum / count, 2));
      variance += share() * path.variance() / light2.back();
    }
    const double found = found_by(paths) / share();
    const auto noise = [&](std::size_t rung) {
      const double size = std::pow(std::numbers::sqrt2, -static_cast<double>(rung) * kernel_dimensions(estimator_));
      return (variance / count / size + noise_of_rest) * (1 + found * size / most_work()) / noisy_passes;
    };
    std::size_t best = 0;
    for (std::size_t rung = 1; rung + 1 < rungs; ++rung)
      if (noise(rung) < noise(best)) best = rung;
    for (std::size_t rung = best + 1; rung + 1 < rungs; ++rung) {
      double gain = 0, squares = 0;
      for (std::size_t i = 0; i < paths.size(); ++i) {
        const double of_path = (paths[i].blur(best) - paths[i].blur(rung)) / light2[i];
        gain += of_path;
        squares += of_path * of_path;
      }
      const double deviation = std::sqrt(std::max(0.0, squares - gain * gain / count));
      if (gain - confidence * deviation > count * (noise(rung) - noise(best))) best = rung;
    }
    return best;
  }

  const RenderJob& job_;
  VolumeEstimator estimator_;
  Kernel kernel_;
  PassDraw draw_;
  std::uint64_t paths_;
  std::array<PhotonTracer, 2> tracers_;
};

}  // namespace

std::optional<float> volume_radius_parameter(const Parameters& parameters) {
  if (parameters.text("volume-radius") == "auto") return {};
  return static_cast<float>(parameters.number("volume-radius", 1e-30, 1e30));
}

float first_volume_radius(const RenderJob& job, VolumeEstimator estimator, std::optional<float> given,
                          const Kernel& kernel, const LightGuide* guide, int first_depth) {
  if (estimator == VolumeEstimator::path || !job.scene.has_scattering_media()) return 0;
  return given ? *given : static_cast<float>(VolumePilot(job, estimator, kernel, guide, first_depth).radius());
}

}  // namespace lanthorn
