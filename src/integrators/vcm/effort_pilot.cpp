// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/vcm/effort_pilot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <vector>

#include "integrators/vcm/vcm_visitors.h"
#include "path/eye_pass.h"
#include "photon/guides/rare_light.h"

namespace lanthorn {

namespace {

constexpr std::uint32_t pilot_passes = 4;
// The radii of merging shrink. Those of this pass are typical of a render of about 64 passes.
constexpr std::uint32_t typical_pass = 24;
constexpr int most_cells = 96;      // pilot pixels along a side of the film
constexpr int cells_per_block = 4;  // along a side of a block
constexpr std::uint64_t most_pilot_paths = 1u << 16;

// Work in units of a ray of a walk with its scattering, in a scene of a few triangles. The numbers were fitted to times
// of path, bdpt and vcm with 1/4, 1 and 4 light paths a pixel in nine scenes; they are fixed, so that choices are the
// same on every machine.
namespace work {
constexpr double shadow = 0.5;      // of a ray
constexpr double densities = 0.65;  // of eye and light paths for each other, at each ray of an eye path
constexpr double connection = 0.46, lookup = 0.36, merge = 0.1;
constexpr double light_ray = 0.8;      // of a ray
constexpr double light_vertex = 1.95;  // with its connection to the lens, and sorting
}  // namespace work

// A ray takes longer in a deep hierarchy.
double work_of_ray(const Scene& scene) {
  const SceneStatistics& s = scene.statistics();
  const auto primitives = static_cast<double>(s.triangles + s.patches + s.quadrics + s.curves);
  return 1 + 0.1 * std::max(0.0, std::log2(primitives + 1) - 5);
}

// Passes share the samples of eye paths out among them, so that their means vary less than if they were independent:
// measured with path, 1.2 to 3.2 times after 32 passes, most under environments, and 2.3 after 256 in a diffuse room.
constexpr double stratification = 2.3;
// Of path tracing's product of variance and work: what light paths must do better, since merges have a bias, too.
constexpr double margin = 0.85;

// Numbers of light paths of a pass, over that of all pixels.
constexpr std::array light_path_choices{0.25f, 0.5f, 1.0f, 2.0f, 4.0f};

// `scale`: from those to multiples of the pilot's number.
std::vector<EffortCandidate> all_candidates(float scale, bool one_time, bool in_media) {
  std::vector<EffortCandidate> all{{0, 0, false, false}};
  for (const float light_paths : light_path_choices)
    for (const float connections : {0.0f, 1.0f, 4.0f})
      for (const bool merges : {false, true})
        for (const bool media : {false, true})
          if ((one_time || connections <= 1) && (in_media || !media))
            all.push_back({scale * light_paths, connections, merges, media});
  return all;
}

PlaceEffort place_of(const EffortCandidate& c) {
  return {static_cast<std::uint8_t>(c.connections), c.merges, c.merges_in_media};
}

// Sums over the eye paths of a block of pixels.
struct Block {
  struct Moments {
    double second = 0;                    // E[X^2]
    double of_eye_path = 0;               // E[E[X | eye path]^2]
    double square = 0;                    // E[X]^2 of the pixels: products of two passes
    double squares = 0, all_squares = 0;  // PathMoments::Estimate
    double relative_variance = 0;         // of the mean of many passes, times their number

    // Of paths that the candidate finds too rarely to be seen here. Merges count with the densities of paths that are
    // displaced within the radius, which makes `all_squares` larger than `squares` where nothing is rare, too.
    double rare() const { return std::max(0.0, all_squares - 3 * squares); }
    double variance() const { return second + rare() - square; }
  };
  std::vector<Moments> moments;  // by candidate; sums over paths
  double light = 0, from_light_paths = 0, caustic = 0;
  double paths = 0, pixels = 0;
  double rays = 0, next_events = 0, connections = 0, lookups = 0, merges = 0;
};

// Finds the light of one eye path with two sets of light paths.
struct TwoSets {
  PathMoments& moments;
  EyeVisitor first, second;

  template <class Event>
  requires std::invocable<EyeVisitor&, const Event&>
  auto operator()(const Event& v) {
    moments.set = 1;
    second(v);
    moments.set = 0;
    return first(v);
  }
};

// One light vertex that the lens sees.
struct SeenLight {
  std::uint32_t block;
  float light;
  bool is_caustic;
  double spread;  // the sum over pixels of the squares of the filter
  TechniqueSum weighed;
};

double spread_of(const View& view, const Vec2& raster) {
  double sum = 0;
  const PixelWindow& window = view.window;
  view.filter.for_each_pixel(raster - window.corner(), window.width(), window.height(),
                             [&](int, int, float filter) { sum += static_cast<double>(sqr(filter)); });
  return sum;
}

// The pilot's pixels and blocks.
class Grid {
 public:
  explicit Grid(const PixelWindow& window) : window_(window) {
    const auto along = [](int pixels) { return std::max(1, std::min(most_cells, pixels) / cells_per_block); };
    columns_ = along(window.width());
    rows_ = along(window.height());
  }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  PixelWindow cells() const { return {0, 0, columns_ * cells_per_block, rows_ * cells_per_block}; }
  // The pixel in the middle of a cell.
  PixelPlace pixel_of(const PixelPlace& cell) const {
    const auto middle = [](int i, int pixels, int cells) { return (2 * i + 1) * pixels / (2 * cells); };
    const int x = middle(cell.x, window_.width(), columns_ * cells_per_block);
    const int y = middle(cell.y, window_.height(), rows_ * cells_per_block);
    return {window_.x0 + x, window_.y0 + y, static_cast<std::uint32_t>(y * window_.width() + x)};
  }
  std::size_t block_of(int x, int y) const {
    const int block = y / cells_per_block * columns_ + x / cells_per_block;
    return static_cast<std::size_t>(block);
  }

 private:
  const PixelWindow& window_;
  int columns_, rows_;
};

class Pilot {
 public:
  Pilot(const RenderJob& job, const VcmSettings& settings, const VcmPreparation& prepared)
      : job_(job),
        settings_(settings),
        grid_(job.view.window),
        scale_(static_cast<float>(job.settings.photons) / static_cast<float>(pilot_light_paths(job))),
        has_specular_(has_specular_surfaces(job.scene)),
        ray_work_(work_of_ray(job.scene)),
        candidates_(all_candidates(scale_, draw_for_pass(job, 0).is_of_one_time(),
                                   settings.merges_in_media() && job.scene.has_scattering_media())),
        blocks_(static_cast<std::size_t>(grid_.columns() * grid_.rows())),
        cells_(static_cast<std::size_t>(grid_.cells().width() * grid_.cells().height()) * candidates_.size()),
        found_(0, job.view.window, grid_.columns(), std::vector<PlaceEffort>(blocks_.size()), {}) {
    for (Block& block : blocks_) {
      block.moments.resize(candidates_.size());
      block.pixels = static_cast<double>(job.view.window.width()) * static_cast<double>(job.view.window.height()) /
                     static_cast<double>(blocks_.size());
    }
    for (std::uint32_t i = 0; i < pilot_passes; ++i) run(i, prepared);
    const auto width = static_cast<std::size_t>(grid_.cells().width());
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const std::size_t cell = i / candidates_.size();
      Block& block = blocks_[grid_.block_of(static_cast<int>(cell % width), static_cast<int>(cell / width))];
      block.moments[i % candidates_.size()].square += (sqr(cells_[i].sum) - cells_[i].squares) / (pilot_passes - 1);
    }
    find_variances();
  }

  Effort best() const;
  std::vector<CandidateEstimate> estimates() const;

 private:
  // Light of a cell by a candidate, over the passes.
  struct Cell {
    double sum = 0, squares = 0;
  };
  // Variance and work of a choice for each block.
  struct Plan {
    std::vector<std::size_t> candidates;
    double variance = 0, work = 0;
  };

  void run(std::uint32_t pass, const VcmPreparation& prepared);
  void trace_light(const VcmPass& pass);
  void trace_eye(const VcmPass& pass, const VcmPass& other);
  void find_variances();
  double work_of(const Block& block, const EffortCandidate& c) const;
  double variance_of(std::size_t block, std::size_t candidate) const;
  double work_of_light(float light_paths) const;
  double per_pixel(float light_paths) const;
  void count_work(EffortReport& report) const;
  std::vector<UniformEffort> uniform_efforts() const;
  bool finds_all_light(const EffortCandidate& c) const;
  Plan plan_with(float light_paths) const;

  RenderJob job_;
  const VcmSettings& settings_;
  Grid grid_;
  float scale_;
  bool has_specular_;
  double ray_work_;
  std::vector<EffortCandidate> candidates_;
  std::vector<Block> blocks_;
  std::vector<Cell> cells_;
  Effort found_;  // for places
  LightVertices vertices_, other_vertices_;
  double light_rays_ = 0, light_vertices_ = 0, light_paths_ = 0;
};

// With a seed for each pass: later passes of one seed avoid the samples of those before.
void Pilot::run(std::uint32_t number, const VcmPreparation& prepared) {
  constexpr std::uint64_t own_seed = 0x9e3779b97f4a7c15u;
  RenderSettings of_pilot = job_.settings, of_other = job_.settings;
  of_pilot.seed ^= own_seed * (2 * number + 1);
  of_other.seed ^= own_seed * (2 * number + 2);
  const RenderJob job{job_.scene, job_.view, of_pilot}, other_job{job_.scene, job_.view, of_other};
  VcmPass pass(job, typical_pass, settings_, prepared, vertices_);
  VcmPass other(other_job, typical_pass, settings_, prepared, other_vertices_);
  PassReport report;
  for (VcmPass* p : {&pass, &other}) {
    trace_light(*p);
    p->build_merges(report);
  }
  trace_eye(pass, other);
}

void Pilot::trace_light(const VcmPass& pass) {
  std::vector<std::vector<SeenLight>> chunks(pass.light_paths.chunk_count());
  const RayCounts rays =
      trace_light_paths(pass, nullptr, [&](const LightArrival& light, const LensLight& seen, std::size_t chunk) {
        TechniqueSum weighed;
        Bidirectional there = pass.bidirectional_at(seen.raster);
        there.weighed = &weighed;
        const float weight = light.weight(there, seen);
        chunks[chunk].push_back({static_cast<std::uint32_t>(found_.block_of(seen.raster)),
                                 weight * flux_of(seen.light, seen.dispersed, pass.draw.w),
                                 light.layers.path_class == PathClass::caustic, spread_of(job_.view, seen.raster),
                                 weighed});
      });
  light_rays_ += static_cast<double>(rays.walk);
  light_paths_ += static_cast<double>(pass.light_paths.total());
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    light_vertices_ += static_cast<double>(pass.vertices.chunk(c).vertices.size());
    for (const SeenLight& seen : chunks[c]) {
      // Of a pixel: as many eye paths as pilot passes see each cell, but all light paths all pixels, twice.
      Block& block = blocks_[seen.block];
      const double share = static_cast<double>(sqr(cells_per_block)) / (2 * block.pixels);
      const auto light = static_cast<double>(seen.light);
      block.light += share * light;
      block.from_light_paths += share * light;
      if (seen.is_caustic) block.caustic += share * light;
      for (std::size_t k = 0; k < candidates_.size(); ++k) {
        const double ratio = static_cast<double>(
            std::max(candidates_[k].all(seen.weighed) / seen.weighed.all(), PathMoments::least_ratio));
        const double all = share * seen.spread * sqr(light) / ratio;
        const double own = all * static_cast<double>(candidates_[k].light_paths) / ratio;
        block.moments[k].second += own;
        block.moments[k].squares += own;
        block.moments[k].all_squares += all;
      }
    }
  }
}

void Pilot::trace_eye(const VcmPass& pass, const VcmPass& other) {
  const PixelWindow cells = grid_.cells();
  const auto width = static_cast<std::size_t>(cells.width()), count = width * static_cast<std::size_t>(cells.height());
  std::vector<PathMoments> of_cells(count, PathMoments(candidates_));
  std::vector<float> caustic(count);
  for_each_pixel(cells, [&](const PixelPlace& cell, RayCounts& counts) {
    Sampler sampler = Sampler::for_pixel(pass.job.settings.seed, Stream::pilot_camera, cell.index, pass.number);
    const PathDraw draw = pass.draw_of_eye_path(sampler);
    const EyeStart start = start_eye_path(pass.job.view, grid_.pixel_of(cell), draw.time, sampler);
    LightLayers layers(draw.w), other_layers(draw.w);
    const PathContext path{pass.job.scene, draw.w, sampler, counts, {pass.max_depth(), settings_.roulette_depth}};
    const RayCounts before = counts;
    PathMoments& moments = of_cells[cell.index];
    const std::size_t partner = pass.partner(sampler);
    walk_from_camera(path, start.camera, pass.job.view.medium,
                     TwoSets{moments, EyeVisitor(path, pass, start.raster, partner, layers, &moments),
                             EyeVisitor(path, other, start.raster, partner, other_layers, &moments)});
    moments.work.rays = static_cast<std::uint32_t>(counts.walk - before.walk);
    caustic[cell.index] = flux_of(layers.light(PathClass::caustic), false, draw.w);
  });
  for (std::size_t i = 0; i < count; ++i) {
    const PathMoments& moments = of_cells[i];
    Block& block = blocks_[grid_.block_of(static_cast<int>(i % width), static_cast<int>(i / width))];
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
      const PathMoments::Estimate e = moments.estimate(k);
      block.moments[k].second += e.second_moment;
      block.moments[k].of_eye_path += e.of_eye_path;
      block.moments[k].squares += e.squares;
      block.moments[k].all_squares += e.all_squares;
      Cell& cell = cells_[i * candidates_.size() + k];
      cell.sum += e.light;
      cell.squares += sqr(e.light);
    }
    block.light += static_cast<double>(moments.light);
    block.from_light_paths += static_cast<double>(moments.light - moments.by_walk);
    block.caustic += static_cast<double>(caustic[i]);
    block.paths += 1;
    block.rays += moments.work.rays;
    block.next_events += moments.work.next_events / 2.0;
    block.connections += moments.work.connections / 2.0;
    block.lookups += moments.work.lookups / 2.0;
    block.merges += moments.work.merges / 2.0;
  }
}

// Of an eye path.
double Pilot::work_of(const Block& block, const EffortCandidate& c) const {
  double sum = ray_work_ * (block.rays + work::shadow * block.next_events);
  if (c.light_paths > 0) sum += work::densities * block.rays;
  sum += work::connection * block.connections * static_cast<double>(c.connections);
  if (c.merges || c.merges_in_media)
    sum += work::lookup * block.lookups + work::merge * block.merges * static_cast<double>(c.light_paths);
  return sum / block.paths;
}

void Pilot::find_variances() {
  double light = 0, paths = 0;
  for (const Block& block : blocks_) {
    light += block.light;
    paths += block.paths;
  }
  const double floor = 0.01 * sqr(light / paths) + std::numeric_limits<double>::min();
  constexpr double least_part = 0.02;  // of a second moment that is variance
  for (Block& block : blocks_)
    for (Block::Moments& m : block.moments) {
      const double of_eye_paths = std::max(0.0, m.of_eye_path - m.square),
                   of_light_paths = m.second + m.rare() - m.of_eye_path;
      const double variance = std::max(of_eye_paths / stratification + of_light_paths, least_part * m.second);
      m.relative_variance = variance / block.paths / (sqr(block.light / block.paths) + floor);
    }
}

// The mean with the blocks around.
double Pilot::variance_of(std::size_t b, std::size_t candidate) const {
  const int x0 = static_cast<int>(b) % grid_.columns(), y0 = static_cast<int>(b) / grid_.columns();
  double sum = 0;
  int count = 0;
  for (int y = std::max(0, y0 - 1); y <= std::min(grid_.rows() - 1, y0 + 1); ++y)
    for (int x = std::max(0, x0 - 1); x <= std::min(grid_.columns() - 1, x0 + 1); ++x, ++count) {
      const int near = y * grid_.columns() + x;
      sum += blocks_[static_cast<std::size_t>(near)].moments[candidate].relative_variance;
    }
  return sum / count;
}

// Of a pass, for each pixel. `light_paths`: over those of the settings.
double Pilot::work_of_light(float light_paths) const {
  const double of_path =
      (work::light_ray * ray_work_ * light_rays_ + work::light_vertex * light_vertices_) / std::max(1.0, light_paths_);
  const PixelWindow& window = job_.view.window;
  const double pixels = static_cast<double>(window.width()) * static_cast<double>(window.height());
  return static_cast<double>(light_paths) * static_cast<double>(job_.settings.photons) / pixels * of_path;
}

std::vector<CandidateEstimate> Pilot::estimates() const {
  std::vector<CandidateEstimate> result;
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    EffortCandidate candidate = candidates_[k];
    candidate.light_paths /= scale_;
    CandidateEstimate& e = result.emplace_back(CandidateEstimate{candidate, 0, work_of_light(candidate.light_paths)});
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const Block& block = blocks_[b];
      e.variance += block.moments[k].variance() / block.paths / static_cast<double>(blocks_.size());
      e.work += work_of(blocks_[b], candidates_[k]) / static_cast<double>(blocks_.size());
    }
  }
  return result;
}

void Pilot::count_work(EffortReport& report) const {
  double paths = 0;
  for (const Block& block : blocks_) {
    paths += block.paths;
    report.rays += block.rays;
    report.next_events += block.next_events;
    report.connections += block.connections;
    report.lookups += block.lookups;
    report.merges += block.merges;
  }
  for (double* sum : {&report.rays, &report.next_events, &report.connections, &report.lookups, &report.merges})
    *sum /= paths;
  report.merges /= per_pixel(1 / scale_);
  report.light_rays = light_rays_ / std::max(1.0, light_paths_);
  report.light_vertices = light_vertices_ / std::max(1.0, light_paths_);
}

double Pilot::per_pixel(float light_paths) const {
  const PixelWindow& window = job_.view.window;
  const auto paths = static_cast<double>(light_paths) * static_cast<double>(job_.settings.photons);
  return paths * job_.settings.parts / (static_cast<double>(window.width()) * static_cast<double>(window.height()));
}

std::vector<UniformEffort> Pilot::uniform_efforts() const {
  std::vector<UniformEffort> result;
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    const float light_paths = candidates_[k].light_paths / scale_;
    UniformEffort& u = result.emplace_back(
        UniformEffort{per_pixel(light_paths), place_of(candidates_[k]), 0, work_of_light(light_paths)});
    for (const Block& block : blocks_) {
      u.variance += block.moments[k].relative_variance / static_cast<double>(blocks_.size());
      u.work += work_of(block, candidates_[k]) / static_cast<double>(blocks_.size());
    }
  }
  return result;
}

// Light by way of mirrors and clear glass may be too rare for the pilot, and out of reach of eye paths. Photons find
// it.
bool Pilot::finds_all_light(const EffortCandidate& c) const {
  const bool in_media = candidates_.back().merges_in_media;
  return !has_specular_ || (c.merges && c.merges_in_media == in_media);
}

// The least product of variance and work with so many light paths: each block takes what reduces the sum of its shares
// of both most, until the shares stay.
Pilot::Plan Pilot::plan_with(float light_paths) const {
  std::vector<std::size_t> able;
  for (std::size_t k = 0; k < candidates_.size(); ++k)
    if (candidates_[k].light_paths == scale_ * light_paths && finds_all_light(candidates_[k])) able.push_back(k);
  std::vector<std::vector<double>> variance(blocks_.size()), work(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (const std::size_t k : able) {
      variance[b].push_back(variance_of(b, k));
      work[b].push_back(work_of(blocks_[b], candidates_[k]));
    }
  Plan plan{std::vector<std::size_t>(blocks_.size(), able.back())};
  std::vector<std::size_t> chosen(blocks_.size(), able.size() - 1);
  constexpr int rounds = 8;
  for (int round = 0; round < rounds; ++round) {
    plan.variance = plan.work = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      plan.variance += variance[b][chosen[b]] / static_cast<double>(blocks_.size());
      plan.work += work[b][chosen[b]] / static_cast<double>(blocks_.size());
    }
    plan.work += work_of_light(light_paths);
    if (round + 1 == rounds) break;
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      for (std::size_t i = 0; i < able.size(); ++i) {
        const auto cost = [&](std::size_t j) { return variance[b][j] / plan.variance + work[b][j] / plan.work; };
        if (cost(i) < cost(chosen[b])) chosen[b] = i;
      }
  }
  for (std::size_t b = 0; b < blocks_.size(); ++b) plan.candidates[b] = able[chosen[b]];
  return plan;
}

Effort Pilot::best() const {
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
  for (const float light_paths : light_path_choices) consider(light_paths, 1);
  std::vector<PlaceEffort> places;
  EffortReport report{.variance = best.variance, .work = best.work, .uniform = uniform_efforts()};
  double light = 0, by_light_paths = 0, caustic = 0;
  constexpr double visible = 0.05;  // share of a block's light
  const auto share = 1 / static_cast<double>(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const EffortCandidate& c = candidates_[best.candidates[b]];
    places.push_back(place_of(c));
    report.merged_part += c.merges || c.merges_in_media ? share : 0;
    report.connected_part += c.connections > 0 ? share : 0;
    light += blocks_[b].light;
    by_light_paths += blocks_[b].from_light_paths;
    caustic += blocks_[b].caustic;
    report.caustic_part += blocks_[b].caustic > visible * blocks_[b].light ? share : 0;
  }
  count_work(report);
  report.light_by_light_paths = light > 0 ? by_light_paths / light : 0;
  report.caustic_light = light > 0 ? caustic / light : 0;
  report.light_paths_per_pixel = per_pixel(best_paths);
  const auto paths = static_cast<double>(best_paths) * static_cast<double>(job_.settings.photons);
  return {static_cast<std::uint64_t>(std::ceil(paths)), job_.view.window, grid_.columns(), std::move(places),
          std::move(report)};
}

}  // namespace

std::uint64_t pilot_light_paths(const RenderJob& job) { return std::min(job.settings.photons, most_pilot_paths); }

std::vector<CandidateEstimate> estimate_candidates(const RenderJob& job, const VcmSettings& settings,
                                                   const VcmPreparation& prepared) {
  return Pilot(job, settings, prepared).estimates();
}

Effort measure_effort(const RenderJob& job, const VcmSettings& settings, const VcmPreparation& prepared) {
  return Pilot(job, settings, prepared).best();
}

}  // namespace lanthorn
