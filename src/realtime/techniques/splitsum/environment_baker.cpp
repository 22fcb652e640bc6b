// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/splitsum/environment_baker.h"

#include <cmath>

#include "gl/buffer.h"
#include "ibl/bake_plan.h"
#include "ibl/prefilter.h"
#include "ibl/split_sum.h"
#include "realtime/techniques/splitsum/splitsum_constants.h"

namespace lanthorn {

namespace {

gl::Buffer upload(const std::vector<PointFlux>& points) {
  std::vector<gpu::PointFlux> packed;
  packed.reserve(points.size());
  for (const PointFlux& p : points)
    packed.push_back({glm::vec4(p.direction, 0), {p.flux[0], p.flux[1], p.flux[2], p.flux[3]}});
  return gl::Buffer(packed);
}

gl::Buffer upload(const std::vector<LobeSample>& samples) {
  std::vector<gpu::LobeSample> packed;
  packed.reserve(samples.size());
  for (const LobeSample& s : samples)
    packed.push_back({glm::vec4(s.local, s.weight), {static_cast<std::uint32_t>(s.level), 0, 0, 0}});
  return gl::Buffer(packed);
}

void dispatch(int invocations) {
  glDispatchCompute(static_cast<GLuint>((invocations + gpu::work_group - 1) / gpu::work_group), 1, 1);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

}  // namespace

EnvironmentBaker::EnvironmentBaker(const gl::ShaderFiles& files)
    : irradiance_(gl::Program::compute(files, "irradiance.comp.glsl")),
      prefilter_(gl::Program::compute(files, "prefilter.comp.glsl")),
      seams_(gl::Program::compute(files, "seams.comp.glsl")),
      brdf_(gl::Program::compute(files, "brdf.comp.glsl")) {}

void EnvironmentBaker::close_seams(CubeAtlas& map, int level) const {
  map.texture().bind_image(gpu::image_of_technique, GL_READ_WRITE, GL_RGBA32F);
  seams_.use();
  seams_.set("first_size", map.size());
  seams_.set("level", level);
  dispatch(cube_faces * 4 * ((map.size() >> level) + 1));
}

void EnvironmentBaker::bake_irradiance(const std::vector<PointFlux>& points, CubeAtlas& map) const {
  const gl::Buffer buffer = upload(points);
  buffer.bind_storage(gpu::storage_points);
  map.texture().bind_image(gpu::image_of_technique, GL_WRITE_ONLY, GL_RGBA32F);
  irradiance_.use();
  irradiance_.set("first_size", map.size());
  irradiance_.set("point_count", static_cast<int>(points.size()));
  dispatch(cube_faces * map.size() * map.size());
  close_seams(map, 0);
}

void EnvironmentBaker::bake_table(gl::Texture& table) const {
  const std::vector<CapSample> samples = cap_samples();
  const gl::Buffer buffer(samples);
  buffer.bind_storage(gpu::storage_samples);
  table.bind_image(gpu::image_of_technique, GL_WRITE_ONLY, GL_RG32F);
  brdf_.use();
  brdf_.set("sample_count", static_cast<int>(samples.size()));
  const auto groups = static_cast<GLuint>((table.width() + 7) / 8);
  glDispatchCompute(groups, groups, 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

EnvironmentMaps EnvironmentBaker::bake(const Image& image, const IblSettings& settings) const {
  const Environment environment(image);
  const CubePyramid source = source_of(environment, settings);
  const std::vector<LevelPlan> levels = specular_levels(settings);
  EnvironmentMaps maps;
  maps.irradiance = CubeAtlas(settings.irradiance_size, 1);
  bake_irradiance(irradiance_points(source, environment), maps.irradiance);
  maps.brdf = gl::Texture(GL_RG32F, split_sum_table_size, split_sum_table_size);
  bake_table(maps.brdf);
  maps.reflections = CubeAtlas(settings.specular_size, static_cast<int>(levels.size()));
  maps.reflections.write(0, mirror_level(source, environment, settings.specular_size));
  const CubeAtlas source_maps(source);
  source_maps.texture().bind(gpu::unit_bake_source);
  for (int l = 1; l < static_cast<int>(levels.size()); ++l) {
    const LevelPlan& plan = levels[static_cast<std::size_t>(l)];
    const std::vector<LobeSample> samples = sample_lobe({plan.alpha, plan.samples, settings.weight}, source);
    const std::vector<PointFlux> suns = environment.sun_points(sun_spacing(plan.alpha));
    const gl::Buffer sample_buffer = upload(samples), sun_buffer = upload(suns);
    sample_buffer.bind_storage(gpu::storage_samples);
    sun_buffer.bind_storage(gpu::storage_points);
    maps.reflections.texture().bind_image(gpu::image_of_technique, GL_WRITE_ONLY, GL_RGBA32F);
    prefilter_.use();
    prefilter_.set("source_size", source_maps.size());
    prefilter_.set("first_size", settings.specular_size);
    prefilter_.set("level", l);
    prefilter_.set("sample_count", static_cast<int>(samples.size()));
    prefilter_.set("point_count", static_cast<int>(suns.size()));
    prefilter_.set("alpha2", plan.alpha * plan.alpha);
    prefilter_.set("kernel_scale", GgxKernel(plan.alpha, settings.weight).scale());
    prefilter_.set("weight", settings.weight == LobeWeight::masking ? 1 : 0);
    dispatch(cube_faces * plan.size * plan.size);
    close_seams(maps.reflections, l);
  }
  return maps;
}

}  // namespace lanthorn
