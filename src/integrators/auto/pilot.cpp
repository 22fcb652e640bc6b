// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/auto/pilot.h"

#include <algorithm>
#include <array>
#include <concepts>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "integrators/vcm/eye_visitor.h"
#include "integrators/vcm/light_visitor.h"
#include "path/eye_pass.h"

namespace lanthorn {

namespace {

constexpr std::uint32_t pilot_passes = 4;
// Merge radii shrink from pass to pass. Those of this pass are typical of a render of about 64 passes.
constexpr std::uint32_t typical_pass = 24;
constexpr std::uint64_t most_pilot_paths = 1u << 16;

// `scale`: converts the numbers of `light_path_choices` into multiples of the pilot's number. `merges_everywhere`:
// merging finds all light that connections to the lens find.
std::vector<EffortCandidate> all_candidates(float scale, bool one_time, bool in_media, bool merges_everywhere) {
  const auto is_possible = [&](const EffortCandidate& c) {
    const bool merges_all = merges_everywhere && c.merges && c.merges_in_media == in_media;
    return (one_time || c.connections <= 1) && (in_media || !c.merges_in_media) && (c.sees || merges_all) &&
           (c.goes_on || merges_all);
  };
  std::vector<EffortCandidate> all{{0, 0, false, false, false}};
  for (const float light_paths : light_path_choices)
    for (const float connections : {0.0f, 1.0f, 4.0f})
      for (unsigned used = 0; used < 16; ++used) {
        const EffortCandidate c{scale * light_paths, connections,     (used & 4) != 0,
                                (used & 2) != 0,     (used & 1) != 0, (used & 8) == 0};
        if (is_possible(c)) all.push_back(c);
      }
  return all;
}

// Finds the light of one eye path with two sets of light paths.
struct TwoSets {
  PathMoments& moments;
  EyePathLog& log;
  EyeVisitor first, second;

  template <class Event>
  requires std::invocable<EyeVisitor&, const Event&>
  auto operator()(const Event& v) {
    {
      const Taken of_second{*this, 1};
      second(v);
    }
    const Taken of_first{*this, 0};
    return first(v);
  }

 private:
  // Moves what a visitor finds from the log to the moments.
  struct Taken {
    TwoSets& sets;
    std::size_t set;
    ~Taken() {
      sets.moments.set = set;
      for (const EyePathLog::Contribution& c : sets.log.found) sets.moments.add(c);
      sets.log.found.clear();
    }
  };
};

// A light vertex that was connected to the lens.
struct SeenLight {
  std::uint32_t block;
  float light;
  bool is_caustic;
  double spread;  // the sum over pixels of the squares of the filter
  TechniqueSum densities;
};

double spread_of(const View& view, const Vec2& raster) {
  double sum = 0;
  const PixelWindow& window = view.crop;
  view.filter.for_each_pixel(raster - window.corner(), window.width(), window.height(),
                             [&](int, int, float filter) { sum += static_cast<double>(sqr(filter)); });
  return sum;
}

class Pilot {
 public:
  Pilot(const RenderJob& job, const VcmSettings& settings)
      : job_(job), settings_(settings), measured_(job.view.crop), blocks_(places_of(job.view.crop, measured_.grid)) {
    measured_.scale = static_cast<float>(job.settings.photons) / static_cast<float>(pilot_light_paths(job));
    measured_.candidates =
        all_candidates(measured_.scale, draw_for_pass(job, 0).is_of_one_time(),
                       settings.merges_in_media() && job.scene.has_scattering_media(), !job.scene.has_fibres());
    const auto radius = [&](float light_paths) {
      return merge_radius_shrink(settings.alpha, typical_pass, static_cast<double>(light_paths));
    };
    for (EffortCandidate& c : measured_.candidates)
      c.merge_area = sqr(radius(c.light_paths / measured_.scale) / radius(1 / measured_.scale));
    candidates_ = CandidateArrays(measured_.candidates);
    cells_.resize(pixel_count(measured_.grid.cells()) * measured_.candidates.size());
    for (EffortBlock& block : measured_.blocks) {
      block.moments.resize(measured_.candidates.size());
      block.pixels = static_cast<double>(pixel_count(job.view.crop)) / static_cast<double>(measured_.blocks.size());
    }
  }

  EffortMeasurement measure(const VcmPreparation& prepared) {
    for (std::uint32_t i = 0; i < pilot_passes; ++i) run(i, prepared);
    const std::size_t count = measured_.candidates.size();
    for_each_cell_by_blocks([&](EffortBlock& block, std::size_t cell) {
      for (std::size_t k = 0; k < count; ++k) {
        const Cell& sums = cells_[cell * count + k];
        block.moments[k].square += (sqr(sums.sum) - sums.squares) / (pilot_passes - 1);
      }
    });
    return std::move(measured_);
  }

 private:
  // A candidate's estimates of a cell's light, summed over passes.
  struct Cell {
    double sum = 0, squares = 0;
  };

  // Each cell has one eye path per pass, but both sets of light paths reach all pixels of its block: the part of their
  // light that counts.
  static double share_of(const EffortBlock& block) {
    return static_cast<double>(sqr(PilotGrid::cells_per_block)) / (2 * block.pixels);
  }
  static std::size_t pixel_count(const PixelWindow& window) {
    return static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
  }
  // An effort that serves only to find the block of a place on the film (`block_of`).
  static Effort places_of(const PixelWindow& window, const PilotGrid& grid) {
    return {0, window, grid.columns(), std::vector<PlaceEffort>(grid.block_count())};
  }
  // Calls `body(block, cell)` for each cell, row by row within a block. One thread does a whole block.
  template <class Body>
  void for_each_cell_by_blocks(Body&& body) {
    constexpr std::size_t side = PilotGrid::cells_per_block;
    const auto width = static_cast<std::size_t>(measured_.grid.cells().width());
    parallel_for(std::size_t{0}, measured_.blocks.size(), [&](std::size_t b) {
      const std::size_t first = b / (width / side) * side * width + b % (width / side) * side;
      for (std::size_t y = 0; y < side; ++y)
        for (std::size_t x = 0; x < side; ++x) body(measured_.blocks[b], first + y * width + x);
    });
  }

  void run(std::uint32_t pass, const VcmPreparation& prepared);
  void trace_light(const VcmPass& pass);
  void add(std::span<const SeenLight> seen);
  void trace_eye(const VcmPass& pass, const VcmPass& other);
  // Returns the light of caustics.
  float trace_eye_path(const VcmPass& pass, const VcmPass& other, std::size_t cell, PathMoments& moments,
                       EyePathLog& log) const;
  void add(EffortBlock& block, std::size_t cell, const PathMoments& moments, const EyePathLog& log, float caustic);

  RenderJob job_;
  const VcmSettings& settings_;
  EffortMeasurement measured_;
  Effort blocks_;
  CandidateArrays candidates_;
  std::vector<Cell> cells_;
  std::vector<std::vector<SeenLight>> seen_;  // by chunk of light paths
  LightVertices vertices_, other_vertices_;
};

// Each pass has its own seed: passes of one seed would be stratified, not independent.
void Pilot::run(std::uint32_t number, const VcmPreparation& prepared) {
  constexpr std::uint64_t own_seed = 0x9e3779b97f4a7c15u;
  RenderSettings of_pilot = job_.settings, of_other = job_.settings;
  of_pilot.seed ^= own_seed * (2 * number + 1);
  of_other.seed ^= own_seed * (2 * number + 2);
  of_pilot.photon_block = of_other.photon_block = std::numeric_limits<std::uint64_t>::max();
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
  seen_.resize(pass.light_paths.chunk_count());
  for (std::vector<SeenLight>& chunk : seen_) chunk.clear();
  const RayCounts rays = trace_light_paths(
      pass, nullptr,
      [&](const LightArrival& light, const LensLight& seen, const PlaceEffort& effort, std::size_t chunk) {
        const Bidirectional there = pass.bidirectional_at(seen.raster, effort);
        const TechniqueSum densities = light.densities(there, seen);
        const float found = densities.weight(there.techniques) * flux_of(seen.light, seen.dispersed, light.w);
        if (!(found > 0)) return;
        seen_[chunk].push_back({static_cast<std::uint32_t>(blocks_.block_of(seen.raster)), found,
                                light.layers.path_class == PathClass::caustic, spread_of(job_.view, seen.raster),
                                densities});
      });
  measured_.light_rays += static_cast<double>(rays.walk);
  measured_.light_paths += static_cast<double>(pass.light_paths.total());
  for (std::size_t c = 0; c < seen_.size(); ++c) {
    measured_.light_vertices += static_cast<double>(pass.vertices.chunk(c).vertices.size());
    add(seen_[c]);
  }
}

void Pilot::add(std::span<const SeenLight> seen) {
  for (const SeenLight& s : seen) {
    EffortBlock& block = measured_.blocks[s.block];
    const double light = share_of(block) * static_cast<double>(s.light);
    block.light += light;
    block.from_light_paths += light;
    if (s.is_caustic) block.caustic += light;
  }
  constexpr std::size_t at_a_time = 16;  // candidates
  parallel_chunks(candidates_.size(), at_a_time, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::array<float, at_a_time> ratios;
    std::array<double, at_a_time> all, own;
    const std::span<const float> samples = candidates_.samples(&TechniqueDensities::lens).subspan(begin, end - begin);
    for (const SeenLight& s : seen) {
      candidates_.ratios(s.densities, begin, std::span(ratios).first(samples.size()));
      EffortBlock& block = measured_.blocks[s.block];
      const double square = share_of(block) * s.spread * sqr(static_cast<double>(s.light));
      for (std::size_t i = 0; i < samples.size(); ++i) {
        all[i] = square / static_cast<double>(ratios[i]);
        own[i] = all[i] * static_cast<double>(samples[i]) / static_cast<double>(ratios[i]);
      }
      for (std::size_t i = 0; i < samples.size(); ++i) {
        EffortBlock::Moments& m = block.moments[begin + i];
        m.second += own[i];
        m.squares += own[i];
        m.all_squares += all[i];
      }
    }
  });
}

// The sums of all candidates take some kilobytes. Processing one cell at a time keeps its sums in the core's own cache.
void Pilot::trace_eye(const VcmPass& pass, const VcmPass& other) {
  for_each_cell_by_blocks([&](EffortBlock& block, std::size_t cell) {
    stop_point();
    PathMoments moments(candidates_);
    EyePathLog log;
    const float caustic = trace_eye_path(pass, other, cell, moments, log);
    add(block, cell, moments, log, caustic);
  });
}

float Pilot::trace_eye_path(const VcmPass& pass, const VcmPass& other, std::size_t cell, PathMoments& moments,
                            EyePathLog& log) const {
  const auto index = static_cast<std::uint32_t>(cell);
  const int width = measured_.grid.cells().width(), x = static_cast<int>(cell) % width,
            y = static_cast<int>(cell) / width;
  Sampler sampler = Sampler::for_pixel(pass.job.settings.seed, Stream::pilot_camera, index, pass.number);
  const PixelPlace place = measured_.grid.pixel_of({x, y, index});
  const PathDraw draw = pass.draw_of_eye_path(sampler, place);
  const EyeStart start = start_eye_path(pass.job, place, pass.number, draw.time, sampler);
  LightLayers layers(draw.w), other_layers(draw.w);
  RayCounts counts;
  const PathContext path{pass.job.scene, draw.w, sampler, counts, {pass.max_depth(), settings_.roulette_depth}};
  walk_from_camera(path, start.camera, pass.job.view.medium,
                   TwoSets{moments, log, EyeVisitor(path, pass, start.raster, layers, &log),
                           EyeVisitor(path, other, start.raster, other_layers, &log)});
  log.work.rays = 2 * static_cast<double>(counts.walk);
  return flux_of(layers.light(PathClass::caustic), false, draw.w);
}

void Pilot::add(EffortBlock& block, std::size_t cell, const PathMoments& moments, const EyePathLog& log,
                float caustic) {
  for (std::size_t k = 0; k < measured_.candidates.size(); ++k) {
    const PathMoments::Estimate e = moments.estimate(k);
    EffortBlock::Moments& m = block.moments[k];
    m.second += e.second_moment;
    m.of_eye_path += e.of_eye_path;
    m.squares += e.squares;
    m.all_squares += e.all_squares;
    Cell& sums = cells_[cell * measured_.candidates.size() + k];
    sums.sum += e.light;
    sums.squares += sqr(e.light);
  }
  block.light += static_cast<double>(moments.light);
  block.from_light_paths += static_cast<double>(moments.light - moments.by_walk);
  block.caustic += static_cast<double>(caustic);
  block.paths += 1;
  constexpr double of_one_set = 0.5;
  block.work.add(log.work, of_one_set);
  block.short_work.add(log.short_work, of_one_set);
}

}  // namespace

std::uint64_t pilot_light_paths(const RenderJob& job) { return std::min(job.settings.photons, most_pilot_paths); }

EffortMeasurement measure_candidates(const RenderJob& job, const VcmSettings& settings,
                                     const VcmPreparation& prepared) {
  return Pilot(job, settings).measure(prepared);
}

}  // namespace lanthorn
