// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/frame/frame_pass.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "math/sampler.h"
#include "photon/photon.h"
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

}  // namespace

float place_frame(const RenderJob& job, std::uint32_t pass, FrameSettings& settings) {
  Sampler sampler = Sampler::for_pass(job.settings.seed, pass);
  sampler.seek(2);
  const FilterSample place = job.view.filter.sample(sampler.next2());
  settings.offset = place.offset;
  settings.lens = sampler.next2();
  settings.time = job.view.camera.time(sampler.next());
  settings.views.frame = pass;
  return place.weight;
}

void add_frame(const Renderer& renderer, const RenderJob& job, const FrameSettings& settings, float weight,
               Film& film) {
  const FrameOnCpu seen = read_frame(renderer);
  const Point eye = window_rays(job.view, settings.offset, settings.lens, settings.time).eye;
  const int width = seen.light.width;
  parallel_for(0, seen.light.height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const auto pixel = static_cast<std::uint32_t>(y * width + x);
      film.add(pixel, sample_of(seen, pixel, weight, job.view.imaging_ratio, eye));
    }
  });
}

PassReport report_of(const FrameReport& frame) {
  PassReport report;
  report.rays.walk = frame.rays;
  report.rays.shadow = frame.shadow_rays;
  for (const std::uint64_t count : frame.photons_per_bounce) report.photons_stored += count;
  constexpr double milliseconds_of_second = 1000;
  for (const gl::StageTime& stage : frame.stages)
    report.stages.push_back({stage.stage, stage.milliseconds / milliseconds_of_second});
  report.photons_per_bounce = frame.photons_per_bounce;
  return report;
}

std::string driver_remark(const std::string& method, const gl::Driver& driver) {
  return fmt::format("{} draws by {}{}", method, driver.renderer, driver.software ? ", in software" : "");
}

ShadowKind shadow_kind(const Parameters& parameters) {
  return choice<ShadowKind, 2>(parameters, "shadows", {{{"traced", ShadowKind::traced}, {"maps", ShadowKind::maps}}});
}

ParameterInfo shadow_info() {
  return {"shadows", "traced", "of direct light: traced (rays of the CPU) or maps (shadow maps)"};
}
ParameterInfo map_info() { return {"map", "256", "texels along the side of a light's map"}; }
ParameterInfo sky_info() { return {"sky", "4", "directions of each light all around that light a pass"}; }

LightViewSettings light_view_settings(const Parameters& parameters) {
  constexpr double least_map = 16, most_map = 4096, most_sky = 16;
  LightViewSettings settings;
  settings.map_size = static_cast<int>(parameters.number("map", least_map, most_map));
  settings.sky_views = static_cast<int>(parameters.number("sky", 1, most_sky));
  return settings;
}

}  // namespace lanthorn
