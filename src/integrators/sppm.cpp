// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Stochastic progressive photon mapping (Hachisuka & Jensen 2009) and its predecessor, progressive photon mapping
// (Hachisuka, Ogaki & Jensen 2008). The radius of each pixel, or of each hit point, shrinks as photons arrive. `ppm`
// has fixed hit points. They are not stored: each pass traces them again with the same random numbers.
#include <algorithm>
#include <cstring>

#include "base/parameters.h"
#include "integrators/progressive.h"
#include "lanthorn/error.h"
#include "path/eye_pass.h"
#include "photon/gather/adaptive_radius.h"

namespace lanthorn {

namespace {

// The hit points of a pixel.
struct HitPoints {
  bool fixed = false;  // the same in every pass
  std::uint32_t count = 1;

  // Number of the eye path among all eye paths of its pixel.
  std::uint32_t path(std::uint32_t pass, std::uint32_t hit) const { return fixed ? hit : pass; }
  // Fixed hit points never reach the later samples of the filter's sequences, so the last ones have its negative lobes.
  FilterPlace fixed_place(const Filter& filter, std::uint32_t hit) const {
    const float share = filter.negative_share();
    if (share == 0 || count == 1) return {FilterPart::positive, hit};
    const auto wanted = static_cast<std::uint32_t>(static_cast<float>(count) * share / (1 + 2 * share) + 0.5f);
    const std::uint32_t positive = count - std::clamp(wanted, 1u, count - 1);
    return hit < positive ? FilterPlace{FilterPart::positive, hit} : FilterPlace{FilterPart::negative, hit - positive};
  }
};

// From the first gathering vertex on, each pass draws new random numbers, also for fixed hit points: for shadow rays
// and for the walk.
template <class Visitor>
struct FreshAfterHit {
  Visitor visitor;
  Sampler& walk_sampler;
  const Sampler& fresh;

  auto operator()(const SurfaceVertex& vertex) {
    const auto answer = visitor(vertex);
    if (has_non_delta(vertex.at.bsdf)) walk_sampler = fresh;
    return answer;
  }
  template <class Event>
  requires requires(Visitor& v, const Event& e) { v(e); }
  auto operator()(const Event& event) { return visitor(event); }
};
template <class Visitor>
FreshAfterHit(Visitor, Sampler&, const Sampler&) -> FreshAfterHit<Visitor>;

// Maps a photon of a higher class to the photon of class 0 that has the same part in the estimate: scales its offset
// and its light.
MetPhoton in_disc_of_first_class(const MetPhoton& photon, float radius_factor) {
  const float inverse = 1 / radius_factor;
  return {photon.offset * inverse, photon.dist2 * sqr(inverse), photon.light * sqr(inverse)};
}

template <AdaptiveRadius Radius>
class StochasticProgressivePhotonMapper final : public Integrator {
 public:
  StochasticProgressivePhotonMapper(const Parameters& parameters, HitPoints hits)
      : hits_(hits),
        schedule_{static_cast<float>(parameters.number("alpha", 1e-3, 1)), kernel_parameter(parameters)},
        radius_choice_(RadiusChoice::from(parameters)),
        photon_source_(parameters) {}

  void prepare(const RenderJob& job) override {
    photon_source_.prepare(job);
    // Many photons, because their statistics determine how fast the radius shrinks.
    constexpr double photons_of_first_gather = 50;
    first_radius_ =
        choose_first_radius(job, radius_choice_, photons_of_first_gather, photon_source_.emission().get(), true);
    radii_.clear();
    const auto pixels = static_cast<std::uint32_t>(job.view.window.width() * job.view.window.height());
    for (std::uint32_t pixel = 0; pixel < pixels; ++pixel)
      radii_.insert(radii_.end(), hits_.count, Radius(first_radius_.at(pixel)));
  }
  FilmContents film_contents(const Scene& scene) const override { return progressive_layers(scene); }
  std::string limitation(const Scene& scene) const override {
    return photon_limitation(scene, photon_source_.volume());
  }
  std::string remark() const override { return photon_source_.emission().remark; }
  MemoryUse memory_use(const RenderSettings&) const override {
    return {.per_photon = bytes_per_photon,
            .per_light_path = bytes_per_light_path,
            .per_pixel = static_cast<double>(hits_.count) * sizeof(Radius) + 2 * sizeof(float),
            .media = records_for(photon_source_.volume())};
  }
  // Fixed hit points see the same points of a pixel in every pass: the halves of the passes share that error.
  bool knows_bias() const override { return !hits_.fixed; }
  bool passes_are_independent() const override { return false; }
  bool crops_are_exact() const override { return false; }
  std::vector<std::byte> save() const override {
    const auto bytes = std::as_bytes(std::span(radii_));
    return {bytes.begin(), bytes.end()};
  }
  void load(std::span<const std::byte> state) override {
    if (state.size() != radii_.size() * sizeof(Radius))
      throw Error("damaged: its radii do not match the picture's pixels");
    std::memcpy(radii_.data(), state.data(), state.size());
    // Radii only shrink. On another machine the first ones may have differed a little.
    const float largest = 2 * first_radius_.largest();
    if (!std::all_of(radii_.begin(), radii_.end(), [&](const Radius& r) { return r.is_possible(largest); }))
      throw Error("damaged: its radii are not those of this render");
  }
  bool passes_share_wavelengths() const override { return true; }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, const FilmPass& film,
                         const PhaseObserver& begin) override;

 private:
  HitPoints hits_;
  AdaptiveRadiusSettings schedule_;
  RadiusChoice radius_choice_;
  std::vector<Radius> radii_;  // by pixel and hit point
  FirstRadius first_radius_;
  PassPhotonSource photon_source_;
};

template <AdaptiveRadius Radius>
PassReport StochasticProgressivePhotonMapper<Radius>::render_pass(const RenderJob& job, std::uint32_t pass,
                                                                  const FilmPass& film, const PhaseObserver& begin) {
  float reach = 0;
  double radius_sum = 0;
  for (const Radius& r : radii_) {
    reach = std::max(reach, r.reach(schedule_));
    radius_sum += static_cast<double>(r.radius());
  }
  const PassPhotons photons = photon_source_.trace(job, pass, first_radius_.classes(), reach, begin);
  const PassDraw& draw = photons.draw;

  const auto trace = [&](const PixelPlace& place, std::uint32_t hit, RayCounts& counts) {
    Radius& radius = radii_[std::size_t{place.index} * hits_.count + hit];
    Sampler walk_sampler = eye_sampler(job, place, hits_.path(pass, hit));
    Sampler fresh = eye_sampler(job, place, pass * hits_.count + hit);
    const PathDraw own = draw.of_eye_path(fresh, place.x, place.y);
    const EyeStart start = hits_.fixed ? start_eye_path(job, place, FilmHalf::first,
                                                        hits_.fixed_place(job.view.filter, hit), own.time, walk_sampler)
                                       : start_eye_path(job, place, pass, own.time, walk_sampler);
    const auto gather = [&](const SurfaceVertex& vertex, const LobeSplit& split) {
      typename Radius::Tally tally(radius, schedule_);
      const GatheredLight light = photons.gather([&](const PhotonMap<HashGrid>& map, int flux_class) {
        const float factor = first_radius_.class_factor(flux_class, place.index, radius.radius());
        const GatherSettings how{schedule_.kernel, radius.radius() * factor, split};
        return gather_photons(map, vertex, how, own.w, radius.reach(schedule_) * factor, [&](const MetPhoton& photon) {
          tally.see(in_disc_of_first_class(photon, factor), vertex.at.shading);
        });
      });
      radius.update(tally, schedule_);
      return light;
    };
    LightLayers layers(own.w);
    const PathContext path{job.scene, own.w, walk_sampler, counts, {job.settings.max_depth, 3}};
    const PathContext at_hits = path.with(fresh);
    with_gather_visitor(photons, PathVisitor{at_hits, layers}, gather, [&](const auto& visitor) {
      walk_from_camera(path, start.camera, job.view.medium, FreshAfterHit{visitor, walk_sampler, fresh});
    });
    film.add(place.index, layers.sample(start.filter_part, job.view.sensor));
  };
  PassReport report = photons.report;
  report.radius = static_cast<float>(radius_sum / static_cast<double>(radii_.size()));
  report.rays += for_each_pixel(job.view.window, [&](const PixelPlace& place, RayCounts& counts) {
    for (std::uint32_t hit = 0; hit < hits_.count; ++hit) trace(place, hit, counts);
  });
  return report;
}

template <class Radius>
std::unique_ptr<Integrator> make_with(const Parameters& parameters, HitPoints hits) {
  return std::make_unique<StochasticProgressivePhotonMapper<Radius>>(parameters, hits);
}

std::unique_ptr<Integrator> make(const Parameters& parameters, HitPoints hits) {
  using Make = std::unique_ptr<Integrator> (*)(const Parameters&, HitPoints);
  return choice<Make, 3>(parameters, "schedule",
                         {{{"hachisuka", make_with<HachisukaRadius>},
                           {"least-error", make_with<LeastErrorRadius>},
                           {"chi-squared", make_with<ChiSquaredRadius>}}})(parameters, hits);
}

ParameterInfo schedule_info(const char* default_schedule) {
  return {"schedule", default_schedule,
          "rule that shrinks radii: hachisuka (keeps the share alpha of new photons), least-error (of bias and "
          "variance; Kaplanyan & Dachsbacher 2013), chi-squared (test for a uniform density; Lin et al. 2020)"};
}
ParameterInfo alpha_info() {
  return {"alpha", "0.6667", "share of new photons that hachisuka keeps, in (0,1]; small: sharper, noisier"};
}

}  // namespace

IntegratorInfo sppm_info() {
  return {"sppm", "stochastic progressive photon mapping: each pixel's radius shrinks as photons arrive",
          "Hachisuka & Jensen 2009",
          with_volume_parameters(
              {alpha_info(), kernel_info(), first_radius_info(), schedule_info("chi-squared"), emission_info("auto")}),
          [](const Parameters& p) { return make(p, {}); }};
}

IntegratorInfo ppm_info() {
  return {"ppm", "progressive photon mapping: fixed hit points, whose radii shrink as photons arrive",
          "Hachisuka, Ogaki & Jensen 2008",
          with_volume_parameters({alpha_info(),
                                  {"hits", "4", "hit points of each pixel, from 1"},
                                  kernel_info(),
                                  first_radius_info(),
                                  schedule_info("hachisuka"),
                                  emission_info("auto")}),
          [](const Parameters& p) {
            return make(p, {true, static_cast<std::uint32_t>(p.number("hits", 1, 1024))});
          }};
}

}  // namespace lanthorn
