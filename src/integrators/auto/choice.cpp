// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/auto/auto.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "lanthorn/text.h"
#include "photon/guides/rare_light.h"

namespace lanthorn {

namespace {

// The unit of work is one ray of a walk with its scattering, in a scene of a few triangles. The weights were fitted to
// measured times of passes with different efforts (docs/lab/auto.md). They are constants, so that the choice is the
// same on every machine.
namespace work {
constexpr double shadow = 0.5;      // a shadow ray
constexpr double eye_path = 0.25;   // overhead of an eye path if there are light paths
constexpr double densities = 0.35;  // densities for MIS weights, per ray of an eye path
constexpr double connection = 0.75, lookup = 0.4, merge = 0.4;
constexpr double media_lookup = 1.5;  // per flight and per scattering
constexpr double light_path = 1.9;
constexpr double light_ray = 0.8;      // a ray of a light path
constexpr double light_vertex = 0.35;  // storing and sorting a light vertex
constexpr double lens = 1.6;           // connecting a light vertex to the lens
}  // namespace work

// A ray takes longer if the bounding volume hierarchy is deep.
double work_of_ray(const Scene& scene) {
  const SceneStatistics& s = scene.statistics();
  const auto primitives = static_cast<double>(s.triangles + s.patches + s.quadrics + s.curves);
  return 1 + 0.03 * std::max(0.0, std::log2(primitives + 1) - 5);
}

// Eye paths are stratified over passes, so the variance of their mean falls faster than 1 / passes. These divisors were
// measured over 48 passes in five scenes (docs/lab/auto.md). Light paths are stratified, too, but shrinking radii add
// about as much variance as that saves.
namespace stratification {
constexpr double long_eye_paths = 3;
constexpr double short_eye_paths = 4;  // they have few dimensions; not used in scenes with media
}  // namespace stratification
// Factor on path tracing's product of variance and work: light paths must be better than this. Path tracing alone is
// stratified best, and merges add bias.
constexpr double margin = 0.8;

// One line for the user: findings and choice.
std::string describe(const EffortReport& r) {
  const auto percent = [](double share) { return fmt::format("{:.{}f} %", 100 * share, share < 0.1 ? 1 : 0); };
  const bool has_caustics = r.caustic_light >= 0.001;
  const std::string found = has_caustics ? fmt::format("caustics make {} of the light, in {} of the picture",
                                                       percent(r.caustic_light), percent(r.caustic_part))
                                         : "hardly any light is in caustics";
  if (r.light_paths_per_pixel == 0) return found + ": path tracing";
  const std::string shorter =
      r.short_part > 0 ? fmt::format("; in {}, eye paths end at their first merge", percent(r.short_part)) : "";
  return fmt::format("{}: {} light paths a pixel, merged in {} and connected in {} of the picture{}", found,
                     short_number(r.light_paths_per_pixel), percent(r.merged_part), percent(r.connected_part), shorter);
}

PlaceEffort place_of(const EffortCandidate& c) {
  return {static_cast<std::uint8_t>(c.connections), c.merges, c.merges_in_media, c.sees, c.goes_on};
}

class Chooser {
 public:
  Chooser(const RenderJob& job, const EffortMeasurement& measured)
      : job_(job), m_(measured), has_specular_(has_specular_surfaces(job.scene)), ray_work_(work_of_ray(job.scene)) {
    find_variances();
  }

  EffortChoice best() const;

 private:
  // Variance and work of a choice for each block.
  struct Plan {
    std::vector<std::size_t> candidates;
    double variance = 0, work = 0;
  };

  void find_variances();
  double variance_at(std::size_t block, std::size_t candidate) const {
    return variances_[block * m_.candidates.size() + candidate];
  }
  double variance_around(std::size_t block, std::size_t candidate) const;
  // Work per eye path in a block.
  double work_of(const EffortBlock& block, const EffortCandidate& c) const;
  // Work of a pass's light paths per pixel, without their connections to the lens. `light_paths`: relative to the
  // settings' number.
  double work_of_light(float light_paths) const;
  // Per pixel of a pass: scales a count that the pilot has taken over all its light paths.
  double count_per_pixel(float light_paths, double of_pilot) const;
  double per_pixel(float light_paths) const;
  void count_work(EffortReport& report) const;
  std::vector<UniformEffort> uniform_efforts() const;
  EffortReport report_on(const Plan& plan, float light_paths) const;
  bool finds_all_light(const EffortCandidate& c) const;
  Plan plan_with(float light_paths) const;

  const RenderJob& job_;
  const EffortMeasurement& m_;
  bool has_specular_;
  double ray_work_;
  std::vector<double> variances_;  // by block and candidate: relative, of the mean of many passes, times their number
};

double Chooser::work_of(const EffortBlock& block, const EffortCandidate& c) const {
  const EyeWork& of = c.goes_on ? block.work : block.short_work;
  double sum = ray_work_ * (of.rays + work::shadow * of.next_events);
  if (c.light_paths > 0) sum += work::eye_path * block.paths + work::densities * of.rays;
  sum += work::connection * of.connections * static_cast<double>(c.connections);
  const auto light_paths = static_cast<double>(c.light_paths);
  if (c.merges) sum += work::lookup * of.lookups + work::merge * of.merges * light_paths;
  if (c.merges_in_media) sum += work::media_lookup * of.media_lookups + work::merge * of.media_merges * light_paths;
  sum /= block.paths;
  if (c.sees) sum += work::lens * count_per_pixel(c.light_paths / m_.scale, m_.light_vertices);
  return sum;
}

void Chooser::find_variances() {
  double light = 0, paths = 0;
  for (const EffortBlock& block : m_.blocks) {
    light += block.light;
    paths += block.paths;
  }
  const double floor = 0.01 * sqr(light / paths) + std::numeric_limits<double>::min();
  const bool has_media = job_.scene.has_scattering_media();
  constexpr double least_part = 0.02;  // of a second moment that is variance
  for (const EffortBlock& block : m_.blocks)
    for (std::size_t k = 0; k < m_.candidates.size(); ++k) {
      const EffortBlock::Moments& m = block.moments[k];
      const EffortCandidate& c = m_.candidates[k];
      const double of_eye_paths = std::max(0.0, m.of_eye_path - m.square), of_light_paths = m.second - m.of_eye_path;
      const double shared_out =
          c.goes_on || has_media ? stratification::long_eye_paths : stratification::short_eye_paths;
      const double variance = std::max(of_eye_paths / shared_out + of_light_paths + m.rare(), least_part * m.second);
      variances_.push_back(variance / block.paths / (sqr(block.light / block.paths) + floor));
    }
}

// The mean with the blocks around.
double Chooser::variance_around(std::size_t b, std::size_t candidate) const {
  const int x0 = static_cast<int>(b) % m_.grid.columns(), y0 = static_cast<int>(b) / m_.grid.columns();
  double sum = 0;
  int count = 0;
  for (int y = std::max(0, y0 - 1); y <= std::min(m_.grid.rows() - 1, y0 + 1); ++y)
    for (int x = std::max(0, x0 - 1); x <= std::min(m_.grid.columns() - 1, x0 + 1); ++x, ++count) {
      const int near = y * m_.grid.columns() + x;
      sum += variance_at(static_cast<std::size_t>(near), candidate);
    }
  return sum / count;
}

double Chooser::work_of_light(float light_paths) const {
  return count_per_pixel(light_paths, work::light_path * m_.light_paths + work::light_ray * ray_work_ * m_.light_rays +
                                          work::light_vertex * m_.light_vertices);
}

double Chooser::count_per_pixel(float light_paths, double of_pilot) const {
  const PixelWindow& window = job_.view.crop;
  const double pixels = static_cast<double>(window.width()) * static_cast<double>(window.height());
  return static_cast<double>(light_paths) * static_cast<double>(job_.settings.photons) / pixels * of_pilot /
         std::max(1.0, m_.light_paths);
}

void Chooser::count_work(EffortReport& report) const {
  double paths = 0;
  EyeWork all;
  for (const EffortBlock& block : m_.blocks) {
    paths += block.paths;
    all.add(block.work);
  }
  report.work_of_eye_path.add(all, 1 / paths);
  report.work_of_eye_path.merges /= per_pixel(1 / m_.scale);
  report.work_of_eye_path.media_merges /= per_pixel(1 / m_.scale);
  const double light_paths = std::max(1.0, m_.light_paths);
  report.work_of_light_path = {m_.light_rays / light_paths, m_.light_vertices / light_paths};
}

double Chooser::per_pixel(float light_paths) const {
  const PixelWindow& window = job_.view.crop;
  const auto paths = static_cast<double>(light_paths) * static_cast<double>(job_.settings.photons);
  return paths * job_.settings.parts / (static_cast<double>(window.width()) * static_cast<double>(window.height()));
}

std::vector<UniformEffort> Chooser::uniform_efforts() const {
  std::vector<UniformEffort> result;
  for (std::size_t k = 0; k < m_.candidates.size(); ++k) {
    const float light_paths = m_.candidates[k].light_paths / m_.scale;
    UniformEffort& u = result.emplace_back(
        UniformEffort{per_pixel(light_paths), place_of(m_.candidates[k]), 0, work_of_light(light_paths)});
    for (std::size_t b = 0; b < m_.blocks.size(); ++b) {
      u.variance += variance_at(b, k) / static_cast<double>(m_.blocks.size());
      u.work += work_of(m_.blocks[b], m_.candidates[k]) / static_cast<double>(m_.blocks.size());
    }
  }
  return result;
}

// The pilot may miss light that arrives by way of mirrors and clear glass, and eye paths may be unable to find it.
// Photons find it.
bool Chooser::finds_all_light(const EffortCandidate& c) const {
  const bool in_media = m_.candidates.back().merges_in_media;
  return !has_specular_ || (c.merges && c.merges_in_media == in_media);
}

// Minimises the product of variance and work for this number of light paths. In each round, every block takes the
// candidate whose shares of the total variance and of the total work have the smallest sum.
Chooser::Plan Chooser::plan_with(float light_paths) const {
  std::vector<std::size_t> able;
  for (std::size_t k = 0; k < m_.candidates.size(); ++k)
    if (m_.candidates[k].light_paths == m_.scale * light_paths && finds_all_light(m_.candidates[k])) able.push_back(k);
  std::vector<std::vector<double>> variance(m_.blocks.size()), work(m_.blocks.size());
  for (std::size_t b = 0; b < m_.blocks.size(); ++b)
    for (const std::size_t k : able) {
      variance[b].push_back(variance_around(b, k));
      work[b].push_back(work_of(m_.blocks[b], m_.candidates[k]));
    }
  Plan plan{std::vector<std::size_t>(m_.blocks.size(), able.back())};
  std::vector<std::size_t> chosen(m_.blocks.size(), able.size() - 1);
  constexpr int rounds = 8;
  for (int round = 0; round < rounds; ++round) {
    plan.variance = plan.work = 0;
    for (std::size_t b = 0; b < m_.blocks.size(); ++b) {
      plan.variance += variance[b][chosen[b]] / static_cast<double>(m_.blocks.size());
      plan.work += work[b][chosen[b]] / static_cast<double>(m_.blocks.size());
    }
    plan.work += work_of_light(light_paths);
    if (round + 1 == rounds) break;
    for (std::size_t b = 0; b < m_.blocks.size(); ++b)
      for (std::size_t i = 0; i < able.size(); ++i) {
        const auto cost = [&](std::size_t j) { return variance[b][j] / plan.variance + work[b][j] / plan.work; };
        if (cost(i) < cost(chosen[b])) chosen[b] = i;
      }
  }
  for (std::size_t b = 0; b < m_.blocks.size(); ++b) plan.candidates[b] = able[chosen[b]];
  return plan;
}

EffortReport Chooser::report_on(const Plan& plan, float light_paths) const {
  constexpr double visible = 0.05;  // share of a block's light
  EffortReport report{.variance = plan.variance, .work = plan.work, .uniform = uniform_efforts()};
  double light = 0, by_light_paths = 0, caustic = 0;
  const auto share = 1 / static_cast<double>(m_.blocks.size());
  for (std::size_t b = 0; b < m_.blocks.size(); ++b) {
    const EffortBlock& block = m_.blocks[b];
    const EffortCandidate& c = m_.candidates[plan.candidates[b]];
    report.merged_part += c.merges || c.merges_in_media ? share : 0;
    report.connected_part += c.connections > 0 ? share : 0;
    report.short_part += c.goes_on ? 0 : share;
    report.caustic_part += block.caustic > visible * block.light ? share : 0;
    light += block.light;
    by_light_paths += block.from_light_paths;
    caustic += block.caustic;
  }
  report.light_by_light_paths = light > 0 ? by_light_paths / light : 0;
  report.caustic_light = light > 0 ? caustic / light : 0;
  report.light_paths_per_pixel = per_pixel(light_paths);
  count_work(report);
  report.summary = describe(report);
  // Variances of extreme scenes may exceed all numbers, which JSON does not know.
  const auto finite = [](double x) { return std::isfinite(x) ? x : std::numeric_limits<double>::max(); };
  report.variance = finite(report.variance);
  for (UniformEffort& choice : report.uniform) choice.variance = finite(choice.variance);
  return report;
}

EffortChoice Chooser::best() const {
  float best_paths = 0;
  Plan best{};
  double least = infinity;
  const auto consider = [&](float light_paths, double share) {
    Plan plan = plan_with(light_paths);
    const double product = share * plan.variance * plan.work;
    if (!(product < least) && !best.candidates.empty()) return;
    best = std::move(plan);
    best_paths = light_paths;
    least = product;
  };
  if (!has_specular_) consider(0, margin);
  constexpr double most_numbers = std::numeric_limits<std::uint32_t>::max();  // of random sequences
  for (const float light_paths : light_path_choices)
    if (static_cast<double>(light_paths) * static_cast<double>(job_.settings.photons) <= most_numbers)
      consider(light_paths, 1);
  std::vector<PlaceEffort> places;
  for (const std::size_t k : best.candidates) places.push_back(place_of(m_.candidates[k]));
  const auto paths = static_cast<double>(best_paths) * static_cast<double>(job_.settings.photons);
  return {Effort(static_cast<std::uint64_t>(std::ceil(paths)), job_.view.crop, m_.grid.columns(), std::move(places)),
          report_on(best, best_paths)};
}

}  // namespace

EffortChoice choose_effort(const RenderJob& job, const EffortMeasurement& measured) {
  return Chooser(job, measured).best();
}

}  // namespace lanthorn
