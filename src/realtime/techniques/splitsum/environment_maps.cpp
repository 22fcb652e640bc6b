// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/techniques/splitsum/environment_maps.h"

#include <algorithm>

#include "gl/buffer.h"
#include "ibl/bake_plan.h"
#include "ibl/prefilter.h"
#include "ibl/split_sum.h"
#include "realtime/scene/layouts.h"

namespace lanthorn {

namespace gpu {
#include "realtime/techniques/splitsum/splitsum_constants.glsl"
}  // namespace gpu

namespace {

int faces_height(int size) { return cube_faces * (size + 2); }

gl::Texture make_atlas(int size, int levels) {
  int beside = 0;
  for (int l = 1; l < levels; ++l) beside += faces_height(size >> l);
  const int width = size + 2 + (levels > 1 ? size / 2 + 2 : 0);
  return {GL_RGBA32F, width, std::max(faces_height(size), beside)};
}

gl::Texture upload_brdf(const Image& table) {
  std::vector<Vec2> texels;
  for (int y = 0; y < table.height; ++y)
    for (int x = 0; x < table.width; ++x) texels.emplace_back(table.at(x, y, 0), table.at(x, y, 1));
  gl::Texture texture(GL_RG32F, table.width, table.height);
  texture.write({GL_RG, GL_FLOAT}, texels.data());
  return texture;
}

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

CubeAtlas::CubeAtlas(int size, int levels) : size_(size), levels_(levels), texture_(make_atlas(size, levels)) {}

CubeAtlas::CubeAtlas(const std::vector<CubeMap>& levels)
    : CubeAtlas(levels.front().size(), static_cast<int>(levels.size())) {
  for (int l = 0; l < levels_; ++l) write(l, levels[static_cast<std::size_t>(l)]);
}

CubeAtlas::Corner CubeAtlas::corner(int level) const {
  if (level == 0) return {};
  int y = 0;
  for (int l = 1; l < level; ++l) y += faces_height(size_ >> l);
  return {size_ + 2, y};
}

void CubeAtlas::write(int level, const CubeMap& map) {
  const Corner at = corner(level);
  texture_.write_part({}, map.data(), at.x, at.y, map.stride(), faces_height(map.size()));
}

CubeMap CubeAtlas::read(int level) const {
  const auto texels = texture_.read<glm::vec4>({GL_RGBA, GL_FLOAT}, 1);
  const Corner from = corner(level);
  CubeMap map(size_ >> level);
  for (int face = 0; face < cube_faces; ++face)
    for (int y = -1; y <= map.size(); ++y)
      for (int x = -1; x <= map.size(); ++x) {
        const int row = from.y + face * map.stride() + y + 1;
        const glm::vec4& t =
            texels[static_cast<std::size_t>(row * texture_.width()) + static_cast<std::size_t>(from.x + x + 1)];
        map.texel(face, x, y) = {t.x, t.y, t.z, t.w};
      }
  return map;
}

EnvironmentMaps::EnvironmentMaps(const SplitSum& maps)
    : reflections(maps.levels()), irradiance({maps.irradiance_map()}), brdf(upload_brdf(maps.table())) {}

void EnvironmentMaps::bind(const gl::Program& program) const {
  reflections.texture().bind(gpu::unit_reflections);
  irradiance.texture().bind(gpu::unit_irradiances);
  brdf.bind(gpu::unit_brdf_terms);
  program.set("level_count", reflections.levels());
  program.set("first_size", reflections.size());
  program.set("irradiance_size", irradiance.size());
}

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
