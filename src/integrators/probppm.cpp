// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Progressive photon mapping, the probabilistic approach (Knaus & Zwicker 2011): every pass is an independent photon
// map whose radius depends on the pass number only, and the image is the mean of the passes. Direct light comes from
// next-event estimation, all other light from photons or, where lobes are narrow, from continuing the eye path.
#include "integrators/progressive.h"
#include "path/eye_pass.h"
#include "photon/gather/radius_schedule.h"

namespace lanthorn {

namespace {

class ProbabilisticProgressivePhotonMapper final : public Integrator {
 public:
  explicit ProbabilisticProgressivePhotonMapper(const Parameters& parameters)
      : alpha_(parameters.number("alpha", 1e-3, 1)),
        kernel_(kernel_parameter(parameters)),
        radius_choice_(RadiusChoice::from(parameters)),
        photon_source_(parameters) {}

  void prepare(const RenderJob& job) override {
    photon_source_.prepare(job);
    // Few photons: edges and caustics are sharp from the first passes on, and the mean of the passes removes the noise.
    constexpr double photons_of_first_gather = 10;
    first_radius_ =
        choose_first_radius(job, radius_choice_, photons_of_first_gather, photon_source_.emission().get(), true);
  }

  FilmContents film_contents(const Scene& scene) const override { return progressive_layers(scene); }
  std::string limitation(const Scene& scene) const override {
    return photon_limitation(scene, photon_source_.volume());
  }
  std::string remark() const override { return photon_source_.emission().remark; }
  MemoryUse memory_use(const RenderSettings& settings) const override {
    return {.per_photon = bytes_per_photon,
            .per_light_path = bytes_per_light_path,
            .per_pixel = 2 * sizeof(float),
            .media = records_for(photon_source_.volume()),
            .photon_block = settings.photon_block,
            .per_pixel_of_blocks = PartialLight::bytes_per_pixel};
  }
  bool passes_share_wavelengths() const override { return true; }
  bool passes_may_overlap() const override { return true; }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, const FilmPass& film,
                         const PhaseObserver& begin) override;

 private:
  double alpha_;
  Kernel kernel_;
  RadiusChoice radius_choice_;
  FirstRadius first_radius_;
  PassPhotonSource photon_source_;
};

PassReport ProbabilisticProgressivePhotonMapper::render_pass(const RenderJob& job, std::uint32_t pass,
                                                             const FilmPass& film, const PhaseObserver& begin) {
  const PassRadii radii(first_radius_, RadiusSchedule{1, alpha_}.radius(pass));
  const PassDraw draw = draw_for_pass(job, pass);
  const LightPathBlocks blocks(job.settings.photons, job.settings.photon_block);
  PartialLight partial(job.view.window, draw.w, blocks.count());
  PassReport report;
  for (std::uint32_t block = 0; block < blocks.count(); ++block) {
    const PassPhotons photons =
        photon_source_.trace(job, pass, radii.classes(), kernel_.support(radii.largest()), begin, blocks[block]);
    report += photons.report;
    report.rays += trace_eye_paths(
        job, {pass, {job.settings.max_depth, 3}, &partial}, film,
        [&](Sampler& sampler, const PixelPlace& place) { return draw.of_eye_path(sampler, place.x, place.y); },
        [&](const PathContext& path, const EyeStart& start, const PixelPlace& place, LightLayers& layers) {
          const auto gather = [&](const SurfaceVertex& vertex, const LobeSplit& split) {
            return photons.gather([&](const PhotonMap<HashGrid>& map, int flux_class) {
              return gather_photons(map, vertex, {kernel_, radii.at(place.index, flux_class), split}, path.w);
            });
          };
          with_gather_visitor(photons, PathVisitor{path, layers}, gather, [&](auto visitor) {
            walk_from_camera(path, start.camera, job.view.medium, std::move(visitor));
          });
        });
  }
  report.radius = radii.typical();
  return report;
}

}  // namespace

IntegratorInfo probppm_info() {
  return {"probppm", "progressive photon mapping, one independent photon map per pass: caustics of every kind",
          "Knaus & Zwicker 2011",
          with_volume_parameters(
              {radius_reduction_info("0.6667"), kernel_info(), first_radius_info(), emission_info("auto")}),
          [](const Parameters& p) -> std::unique_ptr<Integrator> {
            return std::make_unique<ProbabilisticProgressivePhotonMapper>(p);
          }};
}

}  // namespace lanthorn
