// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/media/volume_radius.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "photon/photon_pass.h"
#include "photon/pilot_paths.h"

namespace lanthorn {

namespace {

// Independent sets of photons.
constexpr std::size_t set_count = 8;
// Longest side of the grid of eye paths that look for the largest radius.
constexpr int coarse_side = 16;
// The largest radius that is tried, as a fraction of the scene's and of the mean free path, and the largest mean number
// of photons that an eye path may find in it, each of which costs time. Within a mean free path of its surface, the
// light of a dense medium falls off. A wider kernel loses what lies outside, and the mean squared error of single eye
// paths does not show it, because each is too noisy.
constexpr double widest_part = 0.1;
constexpr double part_of_free_path(VolumeEstimator estimator) { return kernel_dimensions(estimator) == 3 ? 0.25 : 0.5; }
constexpr double most_found = 600;
constexpr int most_halvings = 10;
// Radii that are tried; each is the one before divided by √2.
constexpr std::size_t rungs = 20;
// Light closer to the eye than this many of the widest radii counts less.
constexpr float near_in_radii = 4;
// Number of passes whose noise is weighed against the blur. If radii shrink with α = 2/3 and blur falls with the square
// of the radius, the best first radius is the one that suits 3 passes; if blur does not fall, it is the one that suits
// all passes.
constexpr double noisy_passes = 8;
// Assumed variance of a pass from other causes, over squared light: if it is large, more passes gain more than a wider
// radius. It is .1 to .6 in bench/media.
constexpr double noise_of_rest = 0.2;
// Number of photons that can be met in the time of one eye path or light path.
constexpr double as_long_as_a_path = 50;
// A smaller radius must be better by this many standard errors.
constexpr double confidence = 2;

// Light paths of all sets together. Beams need fewer, because a beam is found all along its length; sets this small
// keep every beam.
constexpr std::uint64_t paths_for(VolumeEstimator estimator) {
  return records_for(estimator) == MediumRecords::points ? 16'000 : 2'048;
}
// Longest side of the grid of eye paths. A beam meets many eye paths, which give nearly the same information.
constexpr int side_for(VolumeEstimator estimator) { return records_for(estimator) == MediumRecords::points ? 128 : 64; }

// Estimates of an eye path's light, by set of photons and by kernel radius.
struct Estimates {
  std::array<std::array<float, rungs>, set_count> of_sets{};
  std::size_t found = 0;  // photons of all sets within the largest radius
  double extinction = 0;  // per metre, where the path scatters in a medium; 0 if it does not

  double at(std::size_t set, std::size_t rung) const { return static_cast<double>(of_sets[set][rung]); }
  double sum(std::size_t rung) const {
    double result = 0;
    for (std::size_t i = 0; i < set_count; ++i) result += at(i, rung);
    return result;
  }
  double sum_of_squares(std::size_t rung) const {
    double result = 0;
    for (std::size_t i = 0; i < set_count; ++i) result += at(i, rung) * at(i, rung);
    return result;
  }
  // Unbiased variance of the widest estimate from one set.
  double variance() const { return (sum_of_squares(0) - std::pow(sum(0), 2) / set_count) / (set_count - 1); }
};

// Sums over the eye paths of (E L_r)², by rung: the mean over all pairs of sets of the product of their estimates,
// which are independent.
class SquaresOfMeans {
 public:
  void add(const Estimates& path, double weight) {
    constexpr double m = set_count;
    for (std::size_t rung = 0; rung < rungs; ++rung) {
      const double sum = path.sum(rung), squares = path.sum_of_squares(rung);
      all_[rung] += weight * (sum * sum - squares) / (m * (m - 1));
      for (std::size_t i = 0; i < set_count; ++i) {
        const double a = path.at(i, rung);
        without_[i][rung] += weight * ((sum - a) * (sum - a) - (squares - a * a)) / ((m - 1) * (m - 2));
      }
    }
  }
  // How much smaller the squared error by blur is for `rung` than for `other`.
  double gain(std::size_t rung, std::size_t other) const { return blur(all_, other) - blur(all_, rung); }
  // Standard error of `gain` by the jackknife over sets. The spread over eye paths would not show it, because they
  // share photons.
  double gain_error(std::size_t rung, std::size_t other) const {
    std::array<double, set_count> gains{};
    double mean = 0, squares = 0;
    for (std::size_t i = 0; i < set_count; ++i) {
      gains[i] = blur(without_[i], other) - blur(without_[i], rung);
      mean += gains[i] / set_count;
    }
    for (const double of_set : gains) squares += (of_set - mean) * (of_set - mean);
    return std::sqrt(squares * (set_count - 1) / set_count);
  }

 private:
  using ByRung = std::array<double, rungs>;
  // Squared error by blur, up to a term that is the same for all rungs.
  static double blur(const ByRung& squares, std::size_t rung) { return squares[rung] - 2 * squares[rung + 1]; }

  ByRung all_{};
  std::array<ByRung, set_count> without_{};  // by the set that is left out
};

// Estimates the light that media scatter towards the eye until the eye path first scatters.
struct EstimateVisitor {
  const PathContext& path;
  std::span<const VolumeGather, set_count> sets;
  const KernelLadder& ladder;
  Estimates& estimates;
  float flown = 0;  // m

  void operator()(const FlownSegment& flight) {
    if (flight.state.medium != MediumId::vacuum)
      for (std::size_t i = 0; i < set_count; ++i)
        estimates.found += sets[i].compare_along(path, flight, flown, ladder, estimates.of_sets[i]);
    flown += flight.segment.length;
  }
  Continuation operator()(const MediumVertex& vertex) const {
    for (std::size_t i = 0; i < set_count; ++i)
      estimates.found += sets[i].compare_at(path, vertex, flown, ladder, estimates.of_sets[i]);
    const Medium& medium = path.scene.medium(vertex.state.medium);
    estimates.extinction = static_cast<double>(collision_density(medium, vertex.position, path.w));
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
        paths_(std::max<std::uint64_t>(1, std::min(paths_for(estimator), job.settings.photons) / set_count)) {
    for (std::uint32_t i = 0; i < set_count; ++i)
      tracers_[i].trace(
          job.scene, {job.settings.seed, Stream::pilot_light, i, paths_},
          {.max_depth = job.settings.max_depth, .media = records_for(estimator), .first_medium_depth = first_depth},
          draw_, guide);
  }

  double radius() const {
    double widest = widest_part * static_cast<double>(job_.scene.bounding_sphere().radius);
    widest = std::min(widest, part_of_free_path(estimator_) * free_path(estimates(widest, coarse_side)));
    // If eye and light are in one place, any radius finds all beams; hence the limit on halvings.
    for (int i = 0; i < most_halvings && found_by(estimates(widest, coarse_side)) > most_found; ++i) widest /= 2;
    return radius_of(widest, least_error(estimates(widest, side_for(estimator_))));
  }

 private:
  static double radius_of(double widest, std::size_t rung) {
    return widest * std::pow(std::numbers::sqrt2, -static_cast<double>(rung));
  }
  // The mean free path where the eye paths scatter, m.
  static double free_path(const std::vector<Estimates>& paths) {
    double sum = 0;
    std::size_t scattered = 0;
    for (const Estimates& path : paths) {
      sum += path.extinction;
      if (path.extinction > 0) ++scattered;
    }
    return scattered == 0 ? std::numeric_limits<double>::infinity() : static_cast<double>(scattered) / sum;
  }
  // The mean number of photons that an eye path finds.
  static double found_by(const std::vector<Estimates>& paths) {
    double sum = 0;
    for (const Estimates& path : paths) sum += static_cast<double>(path.found);
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
    const auto sets = [&]<std::size_t... i>(std::index_sequence<i...>) { return std::array{gather(i)...}; }
    (std::make_index_sequence<set_count>());
    const KernelLadder ladder{kernels, near_in_radii * static_cast<float>(widest)};
    const PixelWindow film = job_.view.film();
    const int columns = std::min(side, film.width()), rows = std::min(side, film.height());
    std::vector<Estimates> result(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for_each_pilot_path(job_, draw_, film, columns, rows, [&](const PathContext& path, const Ray&, std::uint32_t i) {
      return EstimateVisitor{path, sets, ladder, result[i]};
    });
    return result;
  }

  // Number of photons of one of the pilot's sets, divided by the number of a pass.
  double share() const {
    const std::uint64_t photons = std::max<std::uint64_t>(1, job_.settings.photons);
    const double light_paths = static_cast<double>(paths_) / static_cast<double>(photons);
    if (records_for(estimator_) == MediumRecords::points) return light_paths;
    return light_paths * static_cast<double>(share_of_beams(paths_)) / static_cast<double>(share_of_beams(photons));
  }

  // Number of photons that an eye path can meet in the time that a pass needs for all other work per eye path.
  double most_work() const {
    const PixelWindow film = job_.view.film();
    const double eye_paths = static_cast<double>(film.width()) * film.height();
    return as_long_as_a_path * (1 + static_cast<double>(job_.settings.photons) / eye_paths);
  }

  // The rung whose estimate L_r of the light L has the least squared error after n passes, relative to the light,
  //   (E L_r - L)² + V(L_r) / n = (E L_r)² - 2 L E L_r + V(L_r) / n + L².
  // L is not known. But blurring by r equals blurring twice by r/√2, and each blur can be applied to either factor, so
  // the sum of L E L_r over the paths equals the sum of (E L_{r/√2})². V(L_r) is inversely proportional to the kernel's
  // size. Radii smaller than the one with the least noise have to be significantly better, because they find few
  // photons.
  std::size_t least_error(const std::vector<Estimates>& paths) const {
    const auto count = static_cast<double>(paths.size());
    double light = 0;
    for (const Estimates& path : paths) light += path.sum(0) / (set_count * count);
    if (!(light > 0)) return 0;
    SquaresOfMeans squares;
    double variance = 0;
    for (const Estimates& path : paths) {
      const double weight = 1 / (count * (std::pow(path.sum(0) / set_count, 2) + light * light));
      squares.add(path, weight);
      variance += share() * weight * path.variance();
    }
    const double found = found_by(paths) / (share() * set_count);
    const auto noise = [&](std::size_t rung) {
      const double size = std::pow(std::numbers::sqrt2, -static_cast<double>(rung) * kernel_dimensions(estimator_));
      return (variance / size + noise_of_rest) * (1 + found * size / most_work()) / noisy_passes;
    };
    std::size_t best = 0;
    for (std::size_t rung = 1; rung + 1 < rungs; ++rung)
      if (noise(rung) < noise(best)) best = rung;
    for (std::size_t rung = best + 1; rung + 1 < rungs; ++rung)
      if (squares.gain(rung, best) - confidence * squares.gain_error(rung, best) > noise(rung) - noise(best))
        best = rung;
    return best;
  }

  const RenderJob& job_;
  VolumeEstimator estimator_;
  Kernel kernel_;
  PassDraw draw_;
  std::uint64_t paths_;
  std::array<PhotonTracer, set_count> tracers_;
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
