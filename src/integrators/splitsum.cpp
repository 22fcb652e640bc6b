// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Split-sum shading (Karis 2013), as in real-time engines: shades the first surface with the prefiltered maps of the
// environment. Comparing it with `path` shows the error of the approximation. Only the
// environment lights the surface: there are no shadows, no other lights and no second scattering.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <set>
#include <string>

#include "ibl/split_sum.h"
#include "integrators/environment_image.h"
#include "integrators/integrator.h"
#include "path/direct_light.h"
#include "path/eye_pass.h"
#include "path/walk.h"
#include "spectrum/curve.h"

namespace lanthorn {

namespace {

/// Reflected radiance. Multiple scattering: Fdez-Agüera 2019, "A Multiple-Scattering Microfacet Model for Real-Time
/// Image-based Lighting", eqs. 9 to 16, for the lobe.
Spectrum shade(const SplitSum& maps, const SurfaceVertex& v, bool multiple_scattering, const Wavelengths& w) {
  const SplitTerms terms = split_terms(v.at.bsdf, v.wi_local);
  const float cos = abs_cos_theta(v.wi_local);
  const Normal n = v.wi_local.z >= 0 ? v.at.shading.n : -v.at.shading.n;
  const auto light = [&](const Spectrum& rgb) { return evaluate_illuminant({rgb[0], rgb[1], rgb[2]}, w); };
  const Spectrum irradiance = light(maps.irradiance(n));
  Spectrum sum = (terms.diffuse + terms.sheen) * irradiance;
  if (!terms.diffuse_behind.is_black()) sum += terms.diffuse_behind * light(maps.irradiance(-n));
  if (terms.f0.is_black() && terms.f90.is_black()) return sum;
  const SplitSum::Brdf brdf = maps.brdf(cos, terms.alpha);
  const Spectrum single = terms.f0 * brdf.scale + terms.f90 * brdf.bias;
  sum += single * light(maps.reflection(2 * cos * n - v.wi, terms.alpha));
  if (!multiple_scattering) return sum;
  const float lost = 1 - (brdf.scale + brdf.bias);
  const Spectrum mean_fresnel = terms.f0 + (terms.f90 - terms.f0) / 21.0f;
  return sum + single * mean_fresnel * lost / (Spectrum(1) - mean_fresnel * lost) * irradiance;
}

struct SplitSumVisitor {
  const PathContext& path;
  const SplitSum* maps;  ///< null if there is no environment
  bool multiple_scattering;
  LightLayers& layers;

  Continuation operator()(const MediumVertex&) { return Continuation::stop(); }
  void operator()(const EmissionVertex& vertex) { layers.add_hit(vertex, hit_lights(path, vertex)); }
  Continuation operator()(const SurfaceVertex& vertex) {
    layers.see(vertex);
    layers.add_hit(vertex, hit_lights(path, vertex));
    if (maps && vertex.may_scatter)
      layers.add(PathClass::direct, vertex.state.beta * shade(*maps, vertex, multiple_scattering, path.w),
                 vertex.state.dispersed);
    return Continuation::stop();
  }
  void operator()(const EscapeVertex& vertex) { layers.add_hit(vertex, hit_lights(path, vertex)); }
};

/// Collects the parts of the first surfaces' closures that the split terms leave out.
struct MissingVisitor {
  std::set<std::string>& missing;

  Continuation operator()(const MediumVertex&) { return Continuation::stop(); }
  void operator()(const EmissionVertex&) {}
  void operator()(const EscapeVertex&) {}
  Continuation operator()(const SurfaceVertex& vertex) {
    if (const char* name = split_terms(vertex.at.bsdf, vertex.wi_local).missing) missing.insert(name);
    return Continuation::stop();
  }
};

class SplitSumShader final : public Integrator {
 public:
  explicit SplitSumShader(const Parameters& parameters)
      : multiple_scattering_(choice<bool, 2>(parameters, "scattering", {{{"single", false}, {"multiple", true}}})) {}

  std::string limitation(const Scene& scene) const override {
    const std::size_t others = scene.lights().size() - scene.infinite_lights().size();
    if (others == 0) return {};
    return fmt::format("splitsum lights by the environment alone: {} other light{} ignored", others,
                       others == 1 ? " is" : "s are");
  }
  bool knows_bias() const override { return false; }
  void prepare(const RenderJob& job) override {
    if (!job.scene.infinite_lights().empty()) maps_.emplace(environment_image(job.scene));
    missing_ = missing_of(job);
  }
  std::string remark() const override {
    return missing_.empty() ? "" : fmt::format("splitsum leaves out {}", fmt::join(missing_, ", "));
  }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, const FilmPass& film,
                         const PhaseObserver& begin) override {
    begin(Phase::eye);
    PassReport report;
    report.rays = trace_eye_paths(
        job, {pass, {job.settings.max_depth, 1}}, film,
        [&](const PathContext& path, const EyeStart& start, const PixelPlace&, LightLayers& layers) {
          walk_from_camera(path, start.camera, job.view.medium,
                           SplitSumVisitor{path, maps_ ? &*maps_ : nullptr, multiple_scattering_, layers});
        });
    return report;
  }

 private:
  static std::set<std::string> missing_of(const RenderJob& job);

  bool multiple_scattering_;
  std::optional<SplitSum> maps_;
  std::set<std::string> missing_;
};

// Follows one eye path for each point of a grid in the window, and collects the features along it that split-sum
// shading leaves out.
std::set<std::string> SplitSumShader::missing_of(const RenderJob& job) {
  constexpr int grid = 64;
  const PixelWindow& window = job.view.window;
  std::set<std::string> missing;
  RayCounts counts;
  for (int i = 0; i < grid * grid; ++i) {
    const int x = i % grid * window.width() / grid, y = i / grid * window.height() / grid;
    const PixelPlace place{window.x0 + x, window.y0 + y, static_cast<std::uint32_t>(y * window.width() + x)};
    Sampler sampler = eye_sampler(job, place, 0);
    const PathDraw draw = draw_time_and_wavelengths(job.view.camera, job.settings.color, sampler);
    const EyeStart start = start_eye_path(job, place, 0, draw.time, sampler);
    walk_from_camera(PathContext{job.scene, draw.w, sampler, counts, {1, 1}}, start.camera, job.view.medium,
                     MissingVisitor{missing});
  }
  return missing;
}

}  // namespace

IntegratorInfo splitsum_info() {
  return {"splitsum",
          "split-sum shading of the first surface by the environment's maps, as in real time (no shadows)",
          "Karis 2013",
          {{"scattering", "single",
            "on the microsurface: single (as in the lecture), or multiple (Fdez-Aguera 2019: rough metal keeps its "
            "light)"}},
          [](const Parameters& p) -> std::unique_ptr<Integrator> { return std::make_unique<SplitSumShader>(p); }};
}

}  // namespace lanthorn
