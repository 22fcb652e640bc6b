// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photon mapping in two passes (Jensen 1996; 2001, chapter 9). Light at a surface is the sum of four terms: A, direct
// light by next-event estimation; B, what mirrors, glass and narrow lobes bring, by going on with the eye path; C,
// caustics, from a map of their own; D, all other indirect light, by final gathering: rays whose ends read the global
// map.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cache/bucket_kdtree.h"
#include "cache/irradiance_photons.h"
#include "cache/photon_gather.h"
#include "cache/photon_map.h"
#include "cache/photon_pass.h"
#include "cache/radiance_estimate.h"
#include "integrators/integrator.h"
#include "integrators/pilot_radius.h"
#include "integrators/progressive.h"
#include "lanthorn/error.h"
#include "path/eye_pass.h"
#include "path/path_draw.h"
#include "path/path_visitor.h"

namespace lanthorn {

namespace {

using Map = PhotonMap<BucketKdTree>;

/// The photons of a pass.
struct Maps {
  PathDraw draw;
  Map global;  ///< all photons
  Map caustic;
  std::optional<IrradiancePhotons> irradiance;  ///< of the global map
  PassReport report;
};

/// Instead of the picture, what the maps hold where it is looked up.
enum class Show : std::uint8_t { image, global, caustic, radius, density };

struct Settings {
  EstimateSettings global, caustic;
  int gather_rays = 1;
  float shortest = 0;  ///< gather rays below this, m, do not read the map where they end
  Show show = Show::image;
};

/// What all vertices of a pixel's eye path and of its gather rays need.
struct EyeContext {
  const Scene& scene;
  const RenderSettings& render;
  const Settings& settings;
  const Maps& maps;
  std::uint32_t pixel_key, pass;
  RayCounts& counts;
  LightLayers& layers;
};

/// Follows the eye path, and the rays of final gathers.
class TwoPassVisitor : PathVisitor {
 public:
  TwoPassVisitor(const EyeContext& context, Sampler& numbers)
      : PathVisitor{context.scene, context.maps.draw.w, numbers, context.counts, context.layers}, context_(context) {}
  /// A gather ray: it leaves a vertex whose direct light and caustics are known.
  static TwoPassVisitor of_gather_ray(const EyeContext& context, Sampler& numbers, int non_delta) {
    TwoPassVisitor visitor(context, numbers);
    visitor.is_gather_ray_ = true;
    visitor.known_ = non_delta;
    return visitor;
  }

  Continuation operator()(const SurfaceVertex& vertex);
  Continuation operator()(const MediumVertex& vertex) {
    begin(vertex.state.depth == 1 ? Term::direct : Term::specular);
    return PathVisitor::operator()(vertex);
  }
  void operator()(const GlowVertex& vertex) {
    begin(term_of_hit(vertex.state, vertex.state.depth));
    PathVisitor::operator()(vertex);
  }
  void operator()(const EscapeVertex& vertex) {
    begin(term_of_hit(vertex.state, vertex.state.depth));
    if (!is_known(vertex.state)) PathVisitor::operator()(vertex);
  }

 private:
  // Light that the walk would find here has been estimated where it last scattered by more than a delta lobe.
  bool is_known(const WalkState& state) const { return known_ > 0 && state.non_delta == known_; }
  static Term term_of_hit(const WalkState& state, int scatterings) {
    return scatterings == 1 && !state.last_delta ? Term::direct : Term::specular;
  }
  void begin(Term term) {
    if (!is_gather_ray_) layers.begin(term);
  }

  void next_events(const SurfaceVertex& vertex, float walk_probability, int count);
  void show(const SurfaceVertex& vertex);
  Continuation estimate_by_terms(const SurfaceVertex& vertex);
  Continuation read_map(const SurfaceVertex& vertex);
  std::optional<Spectrum> precomputed(const SurfaceVertex& vertex) const;
  Continuation continue_short_ray(const SurfaceVertex& vertex);
  void add_caustics(const SurfaceVertex& vertex, float share);
  void gather(const SurfaceVertex& vertex, float share);
  Sampler branch(const SurfaceVertex& vertex, int number) const;

  const EyeContext& context_;
  bool is_gather_ray_ = false;
  int known_ = 0;  // non-delta scatterings of a walk that may not find light by itself
};

// One of the rays and shadow rays that start at a vertex: stratified over these and over the passes.
Sampler TwoPassVisitor::branch(const SurfaceVertex& vertex, int number) const {
  const std::uint64_t key = hash_words({context_.pixel_key, static_cast<std::uint64_t>(vertex.state.depth)});
  const auto rays = static_cast<std::uint32_t>(context_.settings.gather_rays);
  return Sampler::for_pixel(context_.render.seed, Stream::gather, static_cast<std::uint32_t>(key),
                            context_.pass * rays + static_cast<std::uint32_t>(number));
}

Continuation TwoPassVisitor::operator()(const SurfaceVertex& vertex) {
  const WalkState& state = vertex.state;
  if (!is_gather_ray_) layers.see(vertex);
  begin(term_of_hit(state, state.depth - 1));
  if (!is_known(state)) layers.add(class_of_hit(state), hit_emitter(scene, vertex, w), state.dispersed);
  if (!vertex.may_scatter) return Continuation::stop();
  if (!has_non_delta(vertex.at.bsdf)) return Continuation::go_on();
  if (context_.settings.show != Show::image) {
    show(vertex);
    return Continuation::stop();
  }
  return state.non_delta == 0 ? estimate_by_terms(vertex) : read_map(vertex);
}

// Where the picture shows it, directly or through mirrors and clear glass, light is estimated with care.
Continuation TwoPassVisitor::estimate_by_terms(const SurfaceVertex& vertex) {
  const bool is_first = vertex.state.depth == 1;
  const float share = gather_probability(lobe_weights(vertex.at.bsdf, vertex.wi_local));
  // The rest is narrow lobes' and goes on, but is not followed every time if it is little.
  const float goes_on = std::fmin(1.0f, 4 * (1 - share));
  begin(is_first ? Term::direct : Term::specular);
  next_events(vertex, goes_on, (context_.settings.gather_rays + 3) / 4);
  if (share > 0) {
    begin(is_first ? Term::caustic : Term::specular);
    add_caustics(vertex, share);
    begin(is_first ? Term::diffuse : Term::specular);
    gather(vertex, share);
  }
  return {goes_on, 1 - share};
}

// After a scattering that is not a mirror's the map is good enough, where lobes are wide.
Continuation TwoPassVisitor::read_map(const SurfaceVertex& vertex) {
  begin(Term::specular);
  const float distance2 = distance_squared(vertex.state.previous, vertex.at.position);
  const float p = gather_probability(lobe_weights(vertex.at.bsdf, vertex.wi_local));
  if (p == 1 && is_known(vertex.state) && distance2 < sqr(context_.settings.shortest))
    return continue_short_ray(vertex);
  sampler.seek(visitor_dimensions(vertex.state.depth));
  if (p < 1) {
    const DirectLight direct = next_event(scene, vertex, 1 - p, w, sampler, counts);
    layers.add(PathClass::indirect, direct.radiance, direct.dispersed);
  }
  if (sampler.next() >= p) return {1 - p, 1 - p};
  if (const std::optional<Spectrum> light = precomputed(vertex)) {
    layers.add(PathClass::indirect, vertex.state.beta * *light, false);
    return Continuation::stop();
  }
  const DensityEstimate estimate =
      estimate_radiance(context_.maps.global, vertex, context_.settings.global, w, [p](const PhotonFlags& flags) {
        if (flags.direct) return p < 1 ? 0.0f : 1.0f;
        return flags.caustic && flags.from_delta_light ? 1 / p : 1.0f;
      });
  layers.add(PathClass::indirect, vertex.state.beta * estimate.light, false);
  return Continuation::stop();
}

// Radiance from irradiance that is known nearby: of what only scatters diffusely. Records are for eye paths of one
// scattering before, and have the factor of dispersion of their photons alone.
std::optional<Spectrum> TwoPassVisitor::precomputed(const SurfaceVertex& vertex) const {
  const auto* diffuse = std::get_if<Diffuse>(&vertex.at.bsdf);
  if (!context_.maps.irradiance || diffuse == nullptr || vertex.state.depth != 2 || vertex.state.dispersed) return {};
  const Normal& normal = vertex.at.normal;
  const auto irradiance = context_.maps.irradiance->find(
      vertex.at.position, dot(vertex.wi, normal) < 0 ? -normal : normal, context_.settings.global.radius);
  if (!irradiance) return {};
  return diffuse->reflectance * *irradiance * inv_pi;
}

// In corners, where the map's blur would show (secondary gathering): one more ray takes its place.
Continuation TwoPassVisitor::continue_short_ray(const SurfaceVertex& vertex) {
  next_events(vertex, 0, 1);
  add_caustics(vertex, 1);
  ++known_;
  return Continuation::go_on();
}

void TwoPassVisitor::next_events(const SurfaceVertex& vertex, float walk_probability, int count) {
  for (int i = 0; i < count; ++i) {
    Sampler own = branch(vertex, i);
    Sampler& numbers = is_gather_ray_ ? sampler : own;
    numbers.seek(visitor_dimensions(vertex.state.depth));
    const DirectLight direct = next_event(scene, vertex, walk_probability, w, numbers, counts);
    layers.add(class_of_next_event(vertex.state), direct.radiance * (1 / static_cast<float>(count)), direct.dispersed);
  }
}

void TwoPassVisitor::add_caustics(const SurfaceVertex& vertex, float share) {
  const DensityEstimate estimate =
      estimate_radiance(context_.maps.caustic, vertex, context_.settings.caustic, w,
                        [share](const PhotonFlags& flags) { return flags.from_delta_light ? 1.0f : share; });
  layers.add(vertex.state.non_delta == 0 ? PathClass::caustic : PathClass::indirect, vertex.state.beta * estimate.light,
             false);
}

void TwoPassVisitor::gather(const SurfaceVertex& vertex, float share) {
  const int rays = context_.settings.gather_rays;
  for (int i = 0; i < rays; ++i) {
    Sampler own = branch(vertex, i);
    branch_walk<Transport::radiance>(scene, vertex, share / static_cast<float>(rays), {context_.render.max_depth, 3}, w,
                                     own, counts, of_gather_ray(context_, own, vertex.state.non_delta + 1));
  }
}

void TwoPassVisitor::show(const SurfaceVertex& vertex) {
  const Show what = context_.settings.show;
  const bool caustics = what == Show::caustic;
  const DensityEstimate estimate = estimate_radiance(caustics ? context_.maps.caustic : context_.maps.global, vertex,
                                                     caustics ? context_.settings.caustic : context_.settings.global, w,
                                                     [](const PhotonFlags&) { return 1.0f; });
  Spectrum value = vertex.state.beta * estimate.light;
  if (what == Show::radius) value = Spectrum(estimate.radius);
  if (what == Show::density)
    value = Spectrum(estimate.radius > 0 ? static_cast<float>(estimate.photons) * inv_pi / sqr(estimate.radius) : 0.0f);
  layers.add(caustics ? PathClass::caustic : PathClass::indirect, value, false);
}

class PhotonMapper final : public Integrator {
 public:
  explicit PhotonMapper(const Parameters& parameters);

  void prepare(const Scene& scene, const RenderSettings& settings) override;
  std::string limitation(const Scene& scene) const override { return photon_limitation(scene); }
  Parting parting() const override { return Parting::terms; }
  PassReport render_pass(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, Film& film,
                         const PhaseObserver& begin) override;

 private:
  Maps trace(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, const PhaseObserver& begin);

  Settings settings_;
  std::optional<float> radius_;
  std::uint64_t caustic_photons_ = 0;
  bool keeps_ = false, precomputes_ = false;
  std::optional<Maps> kept_;
  PhotonTracer tracer_, caustic_tracer_;
};

template <class Value, std::size_t n>
Value choice(const Parameters& parameters, const char* name,
             const std::array<std::pair<const char*, Value>, n>& known) {
  const std::string& text = parameters.text(name);
  std::string names;
  for (const auto& [known_name, value] : known) {
    if (text == known_name) return value;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", known_name);
  }
  throw Error(fmt::format("--set {}={}: expected one of {}", name, text, names));
}

PhotonMapper::PhotonMapper(const Parameters& parameters) {
  const Kernel kernel = kernel_parameter(parameters);
  const auto most = static_cast<double>(EstimateSettings::most_nearest);
  settings_.global = {kernel, static_cast<std::size_t>(parameters.number("nearest", 0, most)), 0};
  settings_.caustic = {kernel, static_cast<std::size_t>(parameters.number("caustic-nearest", 0, most)), 0};
  settings_.gather_rays = static_cast<int>(parameters.number("gather", 1, 65536));
  settings_.show = choice<Show, 5>(parameters, "show",
                                   {{{"image", Show::image},
                                     {"global", Show::global},
                                     {"caustic", Show::caustic},
                                     {"radius", Show::radius},
                                     {"density", Show::density}}});
  precomputes_ = choice<bool, 2>(parameters, "irradiance", {{{"estimated", false}, {"precomputed", true}}});
  keeps_ = choice<bool, 2>(parameters, "maps", {{{"fresh", false}, {"kept", true}}});
  caustic_photons_ = static_cast<std::uint64_t>(parameters.number("caustic-photons", 0, 1e9));
  if (parameters.text("max-radius") != "auto")
    radius_ = static_cast<float>(parameters.number("max-radius", 1e-30, 1e30));
}

void PhotonMapper::prepare(const Scene& scene, const RenderSettings& settings) {
  if (keeps_ && (settings.color != ColorMode::rgb || scene.has_motion() || scene.has_dispersion()))
    throw Error(
        "--set maps=kept: the passes of spectral colour, motion and dispersion each have wavelengths and a time of "
        "their own, which one map cannot have; use --color rgb and a still scene, or maps=fresh");
  // As far as twice the photons that are asked for lie apart where most of the picture is: beyond, few would be enough.
  const float radius =
      radius_ ? *radius_
              : 2 * choose_first_radius(scene, settings, {},
                                        static_cast<double>(std::max<std::size_t>(settings_.global.nearest, 50)))
                        .typical();
  settings_.global.radius = settings_.caustic.radius = radius;
  settings_.shortest = radius / 2;
  if (!keeps_) return;
  kept_ = trace(scene, settings, 0, [](Phase) {});
  kept_->report.rays = {};  // no pass's
  kept_->report.light_paths = 0;
}

Maps PhotonMapper::trace(const Scene& scene, const RenderSettings& settings, std::uint32_t pass,
                         const PhaseObserver& begin) {
  Sampler pass_sampler = Sampler::for_pass(settings.seed, pass);
  Maps maps{draw_time_and_wavelengths(scene, settings.color, pass_sampler), {}, {}, {}, {}};
  begin(Phase::photons);
  tracer_.trace(scene, {settings.seed, Stream::light, pass, settings.photons},
                {.first_depth = 1, .max_depth = settings.max_depth}, maps.draw);
  if (caustic_photons_ > 0)
    caustic_tracer_.trace(scene, {settings.seed, Stream::caustic, pass, caustic_photons_},
                          {.max_depth = settings.max_depth, .caustics_alone = true}, maps.draw);
  begin(Phase::build);
  maps.global = Map::build(tracer_.chunks(), settings.color);
  std::vector<Photon> caustics;
  for (const std::vector<Photon>& chunk : (caustic_photons_ > 0 ? caustic_tracer_ : tracer_).chunks())
    std::copy_if(chunk.begin(), chunk.end(), std::back_inserter(caustics),
                 [](const Photon& photon) { return photon.flags.caustic; });
  maps.caustic = Map::build(caustics, settings.color);
  if (precomputes_)
    maps.irradiance = IrradiancePhotons::build(maps.global, tracer_.chunks(), settings_.global, maps.draw.w);
  maps.report.rays = tracer_.rays();
  maps.report.rays += caustic_tracer_.rays();
  maps.report.light_paths = tracer_.emitted() + caustic_tracer_.emitted();
  maps.report.photons_stored = maps.global.size() + maps.caustic.size();
  maps.report.photon_map_bytes = maps.global.memory_bytes() + maps.caustic.memory_bytes() +
                                 (maps.irradiance ? maps.irradiance->memory_bytes() : 0);
  return maps;
}

PassReport PhotonMapper::render_pass(const Scene& scene, const RenderSettings& settings, std::uint32_t pass, Film& film,
                                     const PhaseObserver& begin) {
  std::optional<Maps> fresh;
  if (!kept_) fresh = trace(scene, settings, pass, begin);
  const Maps& maps = kept_ ? *kept_ : *fresh;
  begin(Phase::eye);
  const PixelWindow& window = settings.window;
  PassReport report = maps.report;
  report.radius = settings_.global.radius;
  report.rays += for_each_pixel(
      window.x0, window.y0, window.width(), window.height(), [&](const PixelPlace& place, RayCounts& counts) {
        const std::uint32_t key = pixel_key(scene, place);
        Sampler sampler = Sampler::for_pixel(settings.seed, Stream::camera, key, pass);
        const EyeStart start = start_eye_path(scene, settings.filter, place, maps.draw.time, sampler);
        LightLayers layers(maps.draw.w);
        const EyeContext context{scene, settings, settings_, maps, key, pass, counts, layers};
        walk_from_camera(scene, start.camera, {settings.max_depth, 3}, maps.draw.w, sampler, counts,
                         TwoPassVisitor(context, sampler));
        film.add(place.index, layers.sample(start.filter_weight));
      });
  return report;
}

}  // namespace

IntegratorInfo photonmap_info() {
  return {"photonmap",
          "photon mapping in two passes: global and caustic map, final gathering",
          "Jensen 1996",
          {{"nearest", "50", "photons of an estimate from the global map, up to 256; 0: all within the radius"},
           {"caustic-nearest", "50", "the same for the caustic map"},
           {"max-radius", "auto", "largest radius of an estimate: auto, or a length in metres"},
           {"gather", "16", "rays of a final gather"},
           {"irradiance", "precomputed",
            "where gather rays end on diffuse surfaces: precomputed (at one photon in four), or estimated each time"},
           {"caustic-photons", "0", "further light paths per pass, for caustics alone; 0: the caustics of --photons"},
           {"maps", "fresh", "fresh: new photons in each pass; kept: those of the first (RGB colour, still scenes)"},
           {"show", "image", "image, or what a map holds: global, caustic, radius (m) or density (photons/m^2)"},
           kernel_info},
          [](const Parameters& p) -> std::unique_ptr<Integrator> { return std::make_unique<PhotonMapper>(p); }};
}

}  // namespace lanthorn
