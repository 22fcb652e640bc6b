// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Metropolis light transport in primary sample space: over path tracing (Kelemen, Szirmay-Kalos, Antal & Csonka 2002)
// and multiplexed over bidirectional path tracing (Hachisuka, Kaplanyan & Dachsbacher 2014). Paths as functions of
// primary samples are in mlt_paths.h, mutations of primary samples in math/primary_samples.h. Every pass is an
// independent estimate. Its bootstrap of independent paths gives the normalisation and, by resampling, the initial
// states of the Markov chains, so that there is no start-up bias (Veach 1997, section 11.3.1).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "base/parameters.h"
#include "integrators/integrator.h"
#include "integrators/mlt/mlt_paths.h"
#include "path/emission_pass.h"
#include "path/lens_connection.h"
#include "path/mis.h"
#include "scene/scene.h"

namespace lanthorn {

namespace {

// User settings.
struct MltSettings {
  bool multiplexed = true;     ///< over bidirectional path tracing, else over path tracing
  int roulette_depth;          ///< of path tracing
  float large_steps;           ///< probability of large mutations
  float sigma;                 ///< standard deviation of small ones
  std::uint64_t chain_length;  ///< mutations
  double bootstrap;            ///< independent paths for each mutation

  explicit MltSettings(const Parameters& parameters)
      : multiplexed(choice<bool, 2>(parameters, "over", {{{"bdpt", true}, {"path", false}}})),
        roulette_depth(static_cast<int>(parameters.number("roulette-depth", 1, 1e6))),
        large_steps(static_cast<float>(parameters.number("large-steps", 1e-3, 1))),
        sigma(static_cast<float>(parameters.number("sigma", 1e-6, 1))),
        chain_length(static_cast<std::uint64_t>(parameters.number("chain-length", 1, 1e9))),
        bootstrap(parameters.number("bootstrap", 1e-3, 1e3)) {}
};

// The scalar contribution function I, to which the density of the chains is proportional. It is the mean magnitude of
// the colour channels, not luminance, which would make saturated blue paths rare and very bright.
float importance(const FilmLight& path, const Wavelengths& w) {
  float sum = 0;
  for (const Spectrum& light : path.light) {
    if (light.is_black()) continue;
    const Rgb rgb = w.to_rgb(light);
    sum += std::fabs(rgb.r) + std::fabs(rgb.g) + std::fabs(rgb.b);
  }
  return std::isfinite(sum) ? sum / 3 : 0;
}

// A state of a Markov chain.
struct State {
  FilmLight path;
  int scatterings = 0;  // of all paths of the chain; 0: any number
  float importance = 0;
  float weight = 0;  // expected number of mutations for which the chain stays in this state
};

class MetropolisLightTransport final : public Integrator {
 public:
  explicit MetropolisLightTransport(const MltSettings& settings) : settings_(settings) {}

  FilmContents film_contents(const Scene& scene) const override {
    FilmContents contents = path_layers(scene);
    contents.splats = true;
    return contents;
  }
  MemoryUse memory_use(const RenderSettings&) const override {
    const double counts_of_mutation = sizeof(RayCounts) / static_cast<double>(settings_.chain_length);
    return {0, settings_.bootstrap * sizeof(double) + counts_of_mutation, 0};
  }
  void prepare(const RenderJob& job) override;
  bool passes_share_wavelengths() const override { return true; }
  bool crops_are_exact() const override { return false; }
  PassReport render_pass(const RenderJob& job, std::uint32_t number, const FilmPass& film,
                         const PhaseObserver& begin) override;

 private:
  // Independent paths: cumulative sums of importance / probability of the path's length.
  struct Bootstrap {
    std::uint64_t key = 0;
    std::vector<double> sums;
    RayCounts rays;
    double mean() const { return sums.back() / static_cast<double>(sums.size()); }
  };

  PathPass begin_pass(const RenderJob& job, std::uint32_t number) const {
    return {job, draw_for_pass(job, number), FilmRegion(job.view), {job.settings.max_depth, settings_.roulette_depth}};
  }
  State evaluate(const PathPass& pass, int scatterings, PathSamples& samples, RayCounts& counts) const {
    const FilmLight path = settings_.multiplexed ? connect_path(pass, *lights_, scatterings, samples, counts)
                                                 : trace_path(pass, samples, counts);
    return {path, scatterings, importance(path, pass.draw.w), 0};
  }
  // Number of scatterings of a bootstrap path, stratified over the paths.
  int scatterings_of(const Bootstrap& bootstrap, std::size_t index) const;
  float length_probability(int scatterings) const { return scatterings > 0 ? lengths_.probability(scatterings) : 1.0f; }
  template <class Visit>
  Bootstrap draw_independent_paths(const PathPass& pass, std::uint64_t key, Visit&& visit) const;
  RayCounts run_chain(const PathPass& pass, const Bootstrap& bootstrap, std::size_t first, std::uint64_t key,
                      const FilmPass& film) const;
  void add(const PathPass& pass, const State& state, float weight, const FilmPass& film) const;

  MltSettings settings_;
  // Derived from scene and settings.
  std::optional<LightChoice> lights_;
  PathLengths lengths_;
  std::uint64_t chains_ = 1, independent_paths_ = 1;
  float expected_ = 1;     // estimate of the mean importance
  float mutated_ = 1;      // density of mutated paths per unit of importance, if the estimate is right
  float independent_ = 0;  // density of the bootstrap's paths, which is constant
};

int MetropolisLightTransport::scatterings_of(const Bootstrap& bootstrap, std::size_t index) const {
  if (!settings_.multiplexed) return 0;
  const float offset = HashRng(hash_words({bootstrap.key, index, 1})).next();
  const float u = (static_cast<float>(index) + offset) / static_cast<float>(independent_paths_);
  return lengths_.at(u);
}

// `visit(state)` is called from many threads.
template <class Visit>
MetropolisLightTransport::Bootstrap MetropolisLightTransport::draw_independent_paths(const PathPass& pass,
                                                                                     std::uint64_t key,
                                                                                     Visit&& visit) const {
  constexpr std::size_t chunk = 1024;
  Bootstrap result{key, std::vector<double>(independent_paths_), {}};
  std::vector<RayCounts> counts((independent_paths_ + chunk - 1) / chunk);
  parallel_chunks(independent_paths_, chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    PathSamples samples(settings_.sigma);
    for (std::size_t i = begin; i < end; ++i) {
      samples.start(hash_words({key, i}));
      const State state = evaluate(pass, scatterings_of(result, i), samples, counts[c]);
      result.sums[i] = static_cast<double>(state.importance / length_probability(state.scatterings));
      visit(state);
    }
  });
  std::partial_sum(result.sums.begin(), result.sums.end(), result.sums.begin());
  for (const RayCounts& c : counts) result.rays += c;
  return result;
}

// MIS weights must not depend on the pass's own bootstrap, because they would correlate with the paths that they weigh.
// They use the density expected from a separate bootstrap, the same for all passes.
void MetropolisLightTransport::prepare(const RenderJob& job) {
  const RenderSettings& settings = job.settings;
  chains_ = std::max<std::uint64_t>(1, (settings.photons + settings_.chain_length / 2) / settings_.chain_length);
  const auto mutations = static_cast<float>(chains_ * settings_.chain_length);
  independent_paths_ = static_cast<std::uint64_t>(std::ceil(settings_.bootstrap * static_cast<double>(mutations)));
  lights_.emplace(job.scene);
  lengths_ = PathLengths(settings.max_depth + most_under_surface(job.scene));
  const std::uint64_t key = hash_words({settings.seed, static_cast<std::uint64_t>(Stream::pilot_bootstrap)});
  const PathPass pass = begin_pass(job, 0);
  const auto found = static_cast<float>(draw_independent_paths(pass, key, [](const State&) {}).mean());
  expected_ = found > 0 ? found : 1;
  mutated_ = mutations / expected_;
  independent_ = found > 0 ? static_cast<float>(independent_paths_) : 0;
}

void MetropolisLightTransport::add(const PathPass& pass, const State& state, float weight, const FilmPass& film) const {
  // Values that are not finite have importance 0. They are added anyway, so that the film counts them.
  if (state.importance > 0 && !(weight > 0)) return;
  const float density = mutated_ * state.importance + independent_ * length_probability(state.scatterings);
  const float factor = over_balanced(weight, density);
  for (std::size_t c = 0; c < path_class_count; ++c)
    if (!state.path.light[c].is_black())
      splat(film, pass.job.view, pass.draw.w, state.path.raster, state.path.light[c] * factor,
            {static_cast<PathClass>(c), state.path.from_medium});
}

RayCounts MetropolisLightTransport::run_chain(const PathPass& pass, const Bootstrap& bootstrap, std::size_t first,
                                              std::uint64_t key, const FilmPass& film) const {
  RayCounts counts;
  const auto scale = static_cast<float>(bootstrap.mean() / static_cast<double>(expected_));
  const int scatterings = scatterings_of(bootstrap, first);
  PathSamples samples(settings_.sigma);
  samples.start(hash_words({bootstrap.key, first}));
  State current = evaluate(pass, scatterings, samples, counts);
  samples.set_key(key);
  HashRng rng(hash_words({key}));
  for (std::uint64_t i = 0; i < settings_.chain_length; ++i) {
    stop_point();
    samples.propose(rng.next() < settings_.large_steps ? Mutation::large : Mutation::small);
    State proposed = evaluate(pass, scatterings, samples, counts);
    // Mutations are symmetric: a = min(1, I(v) / I(u)) (Kelemen et al. 2002).
    const float acceptance = std::fmin(1.0f, proposed.importance / current.importance);
    // Both states are recorded, weighted by their probabilities (Veach 1997, section 11.5.1).
    proposed.weight = acceptance;
    current.weight += 1 - acceptance;
    if (rng.next() < acceptance) {
      add(pass, current, scale * current.weight, film);
      current = proposed;
      samples.accept();
    } else {
      add(pass, proposed, scale * proposed.weight, film);
      samples.reject();
    }
  }
  add(pass, current, scale * current.weight, film);
  return counts;
}

PassReport MetropolisLightTransport::render_pass(const RenderJob& job, std::uint32_t number, const FilmPass& film,
                                                 const PhaseObserver& begin) {
  const RenderSettings& settings = job.settings;
  PassReport report;
  const PathPass pass = begin_pass(job, number);
  begin(Phase::photons);
  const std::uint64_t first_key = hash_words({settings.seed, static_cast<std::uint64_t>(Stream::bootstrap), number});
  const Bootstrap bootstrap = draw_independent_paths(pass, first_key, [&](const State& state) {
    if (independent_ > 0) add(pass, state, 1, film);
  });
  report.rays = bootstrap.rays;
  begin(Phase::eye);
  if (bootstrap.mean() > 0) {
    // Systematic resampling.
    const std::uint64_t key = hash_words({settings.seed, static_cast<std::uint64_t>(Stream::chain), number});
    const double offset = static_cast<double>(HashRng(key).next());
    std::vector<RayCounts> counts(chains_);
    parallel_for(std::uint64_t{0}, chains_, [&](std::uint64_t c) {
      const double place = (static_cast<double>(c) + offset) / static_cast<double>(chains_) * bootstrap.sums.back();
      const auto first = std::upper_bound(bootstrap.sums.begin(), bootstrap.sums.end(), place);
      counts[c] = run_chain(pass, bootstrap, static_cast<std::size_t>(first - bootstrap.sums.begin()),
                            hash_words({key, c}), film);
    });
    for (const RayCounts& c : counts) report.rays += c;
  }
  report.rays += see_emission(job, {.scatterings = settings.max_depth}, number, film);
  report.rays.eye = report.rays.light = {};  // the mutations choose the lengths of paths
  return report;
}

}  // namespace

IntegratorInfo mlt_info() {
  return {"mlt",
          "Metropolis light transport: paths mutated where they carry much light; unbiased",
          "Kelemen et al. 2002; Hachisuka et al. 2014",
          {{"over", "bdpt", "bdpt: each path by one of its techniques (multiplexed); path: paths traced from the eye"},
           {"roulette-depth", "3", "over=path: scattering event from which Russian roulette may end a path, from 1"},
           {"large-steps", "0.3", "probability in (0,1] of a large step, which draws a new path"},
           {"sigma", "0.01", "standard deviation of small steps, in primary samples from [0,1)"},
           {"chain-length", "256", "mutations of each Markov chain in a pass"},
           {"bootstrap", "0.25", "independent paths of a pass / mutations of a pass"}},
          [](const Parameters& p) { return std::make_unique<MetropolisLightTransport>(MltSettings(p)); }};
}

}  // namespace lanthorn
