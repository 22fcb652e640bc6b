// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Image-space photon mapping (McGuire & Luebke 2009) as a method of `render`: every pass is a frame with photons and
// views of lights of its own, whose radius depends on the pass number only (Knaus & Zwicker 2011), and the image is the
// mean of the frames.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "gl/context.h"
#include "integrators/integrator.h"
#include "lanthorn/realtime.h"
#include "math/sampler.h"
#include "photon/photon.h"
#include "photon/pilot_radius.h"
#include "photon/radius_schedule.h"
#include "realtime/renderer.h"
#include "scene/scene_data.h"

namespace lanthorn {

namespace {

/// The layers of a frame and what they belong to, on the CPU.
struct FrameOnCpu {
  Image light;
  std::vector<glm::vec4> positions, colours;
  std::vector<glm::uvec4> surfaces;
};

FrameOnCpu read_frame(const Renderer& renderer) {
  const GBuffer& g = renderer.gbuffer();
  return {renderer.read_layers(), g.position().read<glm::vec4>({GL_RGBA, GL_FLOAT}, 1),
          g.colour().read<glm::vec4>({GL_RGBA, GL_FLOAT}, 1),
          g.surface().read<glm::uvec4>({GL_RGBA_INTEGER, GL_UNSIGNED_INT}, 1)};
}

PixelSample sample_of(const FrameOnCpu& frame, std::size_t pixel, float weight, float imaging_ratio, const Point& eye) {
  PixelSample sample;
  const float* light = frame.light.pixels.data() + pixel * frame.light.channel_count();
  for (std::size_t layer = 0; layer < path_class_count; ++layer)
    sample.light[layer] = imaging_ratio * Rgb{light[3 * layer], light[3 * layer + 1], light[3 * layer + 2]};
  sample.weight = weight;
  if (frame.positions[pixel].w == 0) return sample;
  const glm::vec4& colour = frame.colours[pixel];
  sample.albedo = {colour.x, colour.y, colour.z};
  sample.normal = decode_octahedral<16>(frame.surfaces[pixel].x);
  sample.depth = std::sqrt(distance_squared(Point(frame.positions[pixel]), eye));
  return sample;
}

bool may_be_specular(const Scene& scene) {
  const MaterialTable& materials = scene.data()->materials;
  for (std::uint32_t i = 0; i < materials.size(); ++i)
    if (materials.traits(i).may_be_specular) return true;
  return false;
}

class ImageSpacePhotonMapper final : public Integrator {
 public:
  explicit ImageSpacePhotonMapper(const Parameters& parameters)
      : alpha_(parameters.number("alpha", 1e-3, 1)),
        radius_choice_(RadiusChoice::from(parameters)),
        map_size_(static_cast<int>(parameters.number("map", 16, 4096))),
        sky_views_(static_cast<int>(parameters.number("sky", 1, 16))) {
    frame_.indirect = IndirectLight::photons;
    frame_.shadows =
        choice<ShadowKind, 2>(parameters, "shadows", {{{"traced", ShadowKind::traced}, {"maps", ShadowKind::maps}}});
    frame_.photons.gather = choice<PhotonGather, 2>(parameters, "gather",
                                                    {{{"splat", PhotonGather::splat}, {"tiles", PhotonGather::tiles}}});
    if (radius_choice_.kind == RadiusChoice::Kind::pixel)
      throw Error("--set radius=pixel: expected auto, or a length in metres above 0; photons have one radius here");
  }

  void prepare(const RenderJob& job) override {
    context_.emplace(gl::Context::headless());
    renderer_.emplace(job.scene);
    constexpr double photons_of_first_gather = 10;
    first_radius_ = choose_first_radius(job, radius_choice_, photons_of_first_gather).typical();
    frame_.photons.count = static_cast<std::uint32_t>(std::min<std::uint64_t>(job.settings.photons, most_photons));
    frame_.photons.max_depth = job.settings.max_depth;
    frame_.views.seed = job.settings.seed;
    frame_.views.map_size = map_size_;
    frame_.views.sky_views = sky_views_;
  }
  std::string limitation(const Scene& scene) const override {
    std::vector<std::string> missing;
    if (may_be_specular(scene)) missing.emplace_back("ispm shows mirrors and clear glass black");
    if (const std::string lights = unsupported_lights(scene); !lights.empty()) missing.push_back(lights);
    if (scene.has_media()) missing.emplace_back("ispm leaves out media");
    return fmt::format("{}", fmt::join(missing, "; "));
  }
  std::string remark() const override {
    return fmt::format("ispm draws by {}{}", context_->driver().renderer,
                       context_->driver().software ? ", in software" : "");
  }
  PassReport render_pass(const RenderJob& job, std::uint32_t pass, Film& film, const PhaseObserver& begin) override;

 private:
  static constexpr std::uint64_t most_photons = std::uint64_t{1} << 24;

  double alpha_;
  RadiusChoice radius_choice_;
  int map_size_, sky_views_;
  float first_radius_ = 0;
  FrameSettings frame_;
  std::optional<gl::Context> context_;
  std::optional<Renderer> renderer_;  // its objects are those of the context, which must outlive it
};

PassReport ImageSpacePhotonMapper::render_pass(const RenderJob& job, std::uint32_t pass, Film& film,
                                               const PhaseObserver& begin) {
  const gl::CurrentScope current(*context_);
  begin(Phase::photons);
  Sampler sampler = Sampler::for_pass(job.settings.seed, pass);
  sampler.seek(2);
  const FilterSample place = job.view.filter.sample(sampler.next2());
  frame_.offset = place.offset;
  frame_.lens = sampler.next2();
  frame_.time = job.view.camera.time(sampler.next());
  frame_.views.frame = pass;
  frame_.photons.radius = first_radius_ * RadiusSchedule{1, alpha_}.radius(pass);
  renderer_->draw(job.view, frame_);
  begin(Phase::eye);
  const FrameReport frame = renderer_->report();
  const FrameOnCpu seen = read_frame(*renderer_);
  const Point eye = window_rays(job.view, frame_.offset, frame_.lens, frame_.time).eye;
  const int width = seen.light.width;
  parallel_for(0, seen.light.height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const auto pixel = static_cast<std::uint32_t>(y * width + x);
      film.add(pixel, sample_of(seen, pixel, place.weight, job.view.imaging_ratio, eye));
    }
  });
  PassReport report;
  report.rays.walk = frame.rays;
  report.rays.shadow = frame.shadow_rays;
  report.light_paths = frame_.photons.count;
  for (const std::uint64_t count : frame.photons_per_bounce) report.photons_stored += count;
  report.radius = frame_.photons.radius;
  return report;
}

IntegratorInfo ispm_info() {
  return {
      "ispm",
      "image-space photon mapping by OpenGL, as the viewer draws it: for diffuse and rough surfaces",
      "McGuire & Luebke 2009",
      {radius_reduction_info("0.6667"),
       {"radius", "auto", "first radius: auto (one for the scene), or a length in metres"},
       {"gather", "splat", "splat (photon volumes are drawn) or tiles (tiles of pixels find their photons)"},
       {"shadows", "traced", "of direct light: traced (rays of the CPU) or maps (shadow maps)"},
       {"map", "256", "texels along the side of a light's map"},
       {"sky", "4", "directions of each light all around that light a pass"}},
      [](const Parameters& p) -> std::unique_ptr<Integrator> { return std::make_unique<ImageSpacePhotonMapper>(p); }};
}

}  // namespace

void add_realtime_methods() { add_integrator(ispm_info()); }

}  // namespace lanthorn
