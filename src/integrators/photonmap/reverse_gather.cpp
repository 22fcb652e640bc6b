// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/two_pass.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "integrators/photonmap/reverse_photons.h"
#include "path/eye_pass.h"

namespace lanthorn {

namespace {

// A pixel whose photon light has not been added yet.
struct OpenPixel {
  LightLayers layers;
  FilterPart filter_part{};
};

// Side of square blocks, pixels. Every gather ray ends in at most one reverse photon.
int side_of_blocks(const RenderSettings& render, const TwoPassSettings& settings) {
  const std::size_t bytes = static_cast<std::size_t>(settings.gather_rays + 1) * reverse_photon_bytes +
                            sizeof(OpenPixel) + sizeof(ReversePhotons);
  const auto pixels = static_cast<double>(render.memory) / static_cast<double>(bytes);
  return static_cast<int>(std::clamp(std::sqrt(pixels), 1.0, static_cast<double>(1 << 16)));
}

// State shared by all blocks of a pass.
struct ReverseGather {
  const RenderJob& job;
  const TwoPassSettings& settings;
  const TwoPassMaps& maps;
  const InfluencePhotons& photons;
  std::uint32_t pass;
  const FilmPass& film;

  RayCounts render_block(const PixelWindow& block) const;
};

RayCounts ReverseGather::render_block(const PixelWindow& block) const {
  const auto count = static_cast<std::size_t>(block.width()) * static_cast<std::size_t>(block.height());
  std::vector<OpenPixel> pixels(count, OpenPixel{LightLayers(maps.draw.w)});
  std::vector<ReversePhotons> reverse(count);
  const RayCounts rays = for_each_pixel(block, [&](const PixelPlace& place, RayCounts& counts) {
    OpenPixel& pixel = pixels[place.index];
    Sampler sampler = eye_sampler(job, place, pass);
    const PathDraw draw = maps.draw.of_eye_path(sampler, place.x, place.y);
    const EyeStart start = start_eye_path(job, place, pass, draw.time, sampler);
    pixel.filter_part = start.filter_part;
    const PathContext path{job.scene, draw.w, sampler, counts, {job.settings.max_depth, 3}};
    const std::uint32_t key = job.view.pixel_key(place.x, place.y);
    const TwoPassContext context{job, settings, maps, key, pass, nullptr, &reverse[place.index]};
    pixel.layers.use(draw.w);
    walk_from_camera(path, start.camera, job.view.medium, TwoPassVisitor({path, pixel.layers}, context));
    pixel.layers.use(maps.draw.w);
  });
  distribute(photons, settings.global.kernel, maps.draw.w, reverse);
  parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    LightLayers& layers = pixels[i].layers;
    reverse[i].for_each([&](Term term, const Spectrum& light) {
      layers.begin_part(static_cast<std::size_t>(term));
      layers.add(PathClass::indirect, light, false);
    });
    const PixelWindow& window = job.view.window;
    const int x = block.x0 + static_cast<int>(i) % block.width(), y = block.y0 + static_cast<int>(i) / block.width();
    film.add(static_cast<std::uint32_t>((y - window.y0) * window.width() + x - window.x0),
             layers.sample(pixels[i].filter_part, job.view.sensor));
  });
  return rays;
}

}  // namespace

PassReport gather_in_reverse(const RenderJob& job, const TwoPassSettings& settings, const TwoPassMaps& maps,
                             RadiusRule radii, std::uint32_t pass, const FilmPass& film, const PhaseObserver& begin) {
  begin(Phase::build);
  const InfluencePhotons photons = InfluencePhotons::of(maps.global, photon_radii(maps.global, settings.global, radii));
  PassReport report = maps.report;
  report.radius = settings.global.radius;
  report.photon_map_bytes += photons.memory_bytes();
  begin(Phase::eye);
  const ReverseGather gather{job, settings, maps, photons, pass, film};
  const PixelWindow& window = job.view.window;
  const int side = side_of_blocks(job.settings, settings);
  for (int y = window.y0; y < window.y1; y += side)
    for (int x = window.x0; x < window.x1; x += side)
      report.rays += gather.render_block({x, y, std::min(x + side, window.x1), std::min(y + side, window.y1)});
  return report;
}

}  // namespace lanthorn
