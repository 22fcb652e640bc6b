// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "base/memory.h"
#include "ibl/bake_plan.h"
#include "ibl/brute_force.h"
#include "ibl/point_sums.h"
#include "ibl/prefilter.h"
#include "ibl/spherical_harmonics.h"
#include "lanthorn/error.h"

namespace lanthorn {

namespace {

// The cosine kernel needs no more texels than this across a face.
constexpr int size_for_irradiance = 64;
constexpr int least_source_size = 128;

void check_power_of_two(int size, const char* what) {
  if (size < 1 || !std::has_single_bit(static_cast<unsigned>(size)))
    throw Error(fmt::format("{} is {}; it must be a power of two", what, size));
}

void check_settings(const IblSettings& settings) {
  check_power_of_two(settings.specular_size, "the size of the specular map");
  check_power_of_two(settings.smallest_size, "the size of its last level");
  check_power_of_two(settings.irradiance_size, "the size of the irradiance map");
  if (settings.smallest_size > settings.specular_size)
    throw Error(fmt::format("the last level of the specular map ({}) is larger than the first ({})",
                            settings.smallest_size, settings.specular_size));
}

// The source is as fine as the image, but no finer than twice the requested size.
int source_size(const Environment& environment, const IblSettings& settings) {
  const int asked = settings.specular ? settings.specular_size : size_for_irradiance;
  int size = least_source_size;
  while (size < asked) size *= 2;
  const int finest = settings.specular ? 2 * size : size;
  while (size < finest && static_cast<float>(size) < environment.texels_per_face()) size *= 2;
  return size;
}

const CubeMap& level_of_size(const CubePyramid& pyramid, int size) {
  for (const CubeMap& map : pyramid)
    if (map.size() <= size) return map;
  return pyramid.back();
}

// All light of the environment as points: the texels of a map, each with its solid angle as the fourth component of
// its flux, and the suns, without one. A kernel's sums over them are normalised by dividing by the sum of the fourth
// component: a white environment gives 1.
std::vector<PointFlux> points_of(const CubeMap& map, const Environment& environment) {
  const std::vector<float> solid_angles = cube_solid_angles(map.size());
  constexpr float sun_spacing = 0.02f;
  std::vector<PointFlux> points = environment.sun_points(sun_spacing);
  const int n = map.size();
  for (int face = 0; face < cube_faces; ++face)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const float omega =
            solid_angles[static_cast<std::size_t>(y) * static_cast<std::size_t>(n) + static_cast<std::size_t>(x)];
        Spectrum flux = omega * map.texel(face, x, y);
        flux[3] = omega;
        points.push_back({map.direction(face, x, y), flux});
      }
  return points;
}

// (1/pi) ∫ L cos dω for all normals, by a sum over all points.
CubeMap irradiance_map(const std::vector<PointFlux>& points, int size) {
  CubeMap map(size);
  for_texel_batches(map, [&](const DirectionBatch& at, auto&& store) {
    SpectrumBatch sums;
    for (const PointFlux& point : points) add_point(point, CosineKernel{}, at, sums);
    store([&](std::size_t i) {
      const Spectrum sum = sums[i];
      return Spectrum{sum[0], sum[1], sum[2], 0} / sum[3];
    });
  });
  return map;
}

template <class Integrate>
MapError check_map(const Environment& environment, const CubeMap& map, int checks, const Integrate& integrate) {
  std::vector<Spectrum> values;
  std::vector<Direction> directions;
  for (const CubeTexel& t : checked_texels(environment, map.size(), checks)) {
    values.push_back(map.texel(t.face, t.x, t.y));
    directions.push_back(map.direction(t.face, t.x, t.y));
  }
  return map_error(values, integrate(directions));
}

MapError check_sh(const Environment& environment, const ShMaps& sh, int checks) {
  const CubeMap grid(size_for_irradiance);
  std::vector<Spectrum> values;
  std::vector<Direction> directions;
  for (const CubeTexel& t : checked_texels(environment, grid.size(), checks)) {
    const Direction d = grid.direction(t.face, t.x, t.y);
    const Rgb e = irradiance_at(sh, {d.x, d.y, d.z}, 3);
    values.emplace_back(e.r, e.g, e.b, 0.0f);
    directions.push_back(d);
  }
  return map_error(values, integrate_cosine(environment, directions));
}

void describe_suns(const Environment& environment, Ibl& ibl) {
  Spectrum flux;
  for (const Environment::Sun& sun : environment.suns()) flux += sun.excess * environment.solid_angle(sun.x, sun.y);
  ibl.sun_texels = environment.suns().size();
  ibl.sun_threshold = environment.suns().empty() ? 0 : environment.sun_threshold();
  const auto share = [&](int c, float mean) { return mean > 0 ? flux[c] / (4 * pi * mean) : 0.0f; };
  ibl.sun_share = {share(0, ibl.mean.r), share(1, ibl.mean.g), share(2, ibl.mean.b)};
}

/// Reports the completed fraction of the work, measured in texels times samples.
class Progress {
 public:
  Progress(const std::function<void(double)>& report, double total) : report_(report), total_(total) {}
  void add(double work) { report_((done_ += work) / total_); }

 private:
  const std::function<void(double)>& report_;
  double total_, done_ = 0;
};

double texels_of(int size) { return static_cast<double>(cube_faces) * size * size; }

int samples_of_level(int size, const IblSettings& settings) {
  // Narrow lobes need fewer samples per texel and have more texels.
  int samples = settings.samples;
  for (int s = size; s > settings.smallest_size && samples > settings.samples / 4; s /= 2) samples /= 2;
  return std::max(samples, 1);
}

std::vector<SpecularLevel> bake_specular(const CubePyramid& source, const Environment& environment,
                                         const IblSettings& settings, const std::function<void(double)>& work) {
  std::vector<SpecularLevel> levels;
  for (const LevelPlan& plan : specular_levels(settings)) {
    SpecularLevel level;
    level.roughness = plan.roughness;
    level.alpha = plan.alpha;
    level.samples = plan.samples;
    if (plan.samples == 0) {
      level.faces = strip_of(mirror_level(source, environment, plan.size));
    } else {
      const CubeMap map = prefilter(source, environment, {plan.alpha, plan.samples, settings.weight}, plan.size);
      if (settings.checks > 0)
        level.error = check_map(environment, map, settings.checks, [&](const std::vector<Direction>& directions) {
          return integrate_lobe(environment, directions, plan.alpha, settings.weight);
        });
      level.faces = strip_of(map);
    }
    work(texels_of(plan.size) * std::max(1, plan.samples));
    levels.push_back(std::move(level));
  }
  return levels;
}

void bake_cubes(const Environment& environment, const IblSettings& settings, Ibl& ibl) {
  const int size = source_size(environment, settings);
  double total = texels_of(size);
  if (settings.specular)
    for (const LevelPlan& level : specular_levels(settings))
      total += texels_of(level.size) * std::max(1, level.samples);
  Progress progress(settings.progress, total);
  const CubePyramid source = source_of(environment, settings);
  progress.add(texels_of(size));
  if (settings.irradiance) {
    const CubeMap map = irradiance_map(irradiance_points(source, environment), settings.irradiance_size);
    if (settings.checks > 0)
      ibl.irradiance_error = check_map(
          environment, map, settings.checks,
          [&](const std::vector<Direction>& directions) { return integrate_cosine(environment, directions); });
    ibl.irradiance = strip_of(map);
  }
  if (settings.specular)
    ibl.specular = bake_specular(source, environment, settings, [&](double work) { progress.add(work); });
}

}  // namespace

float level_roughness(float x, RoughnessMapping mapping) {
  switch (mapping) {
    case RoughnessMapping::square:
      return x;
    case RoughnessMapping::linear:
      return std::sqrt(x);
    case RoughnessMapping::filament:
      return 1 - safe_sqrt(1 - x);
  }
  return x;
}

float level_of_roughness(float roughness, RoughnessMapping mapping) {
  switch (mapping) {
    case RoughnessMapping::square:
      return roughness;
    case RoughnessMapping::linear:
      return roughness * roughness;
    case RoughnessMapping::filament:
      return roughness * (2 - roughness);
  }
  return roughness;
}

std::vector<LevelPlan> specular_levels(const IblSettings& settings) {
  std::vector<LevelPlan> levels;
  const int count = std::countr_zero(static_cast<unsigned>(settings.specular_size / settings.smallest_size)) + 1;
  for (int i = 0; i < count; ++i) {
    const float x = count > 1 ? static_cast<float>(i) / static_cast<float>(count - 1) : 0.0f;
    const int size = settings.specular_size >> i;
    const float roughness = level_roughness(x, settings.mapping);
    levels.push_back({size, roughness, roughness * roughness, i == 0 ? 0 : samples_of_level(size, settings)});
  }
  return levels;
}

CubePyramid source_of(const Environment& environment, const IblSettings& settings) {
  const int size = source_size(environment, settings);
  constexpr double pyramid_share = 4.0 / 3;
  require_memory(texels_of(size) * sizeof(Spectrum) * pyramid_share, {}, "the environment as a cube map");
  return cube_pyramid(environment.cube_without_suns(size));
}

std::vector<PointFlux> irradiance_points(const CubePyramid& source, const Environment& environment) {
  return points_of(level_of_size(source, size_for_irradiance), environment);
}

Ibl bake_ibl(const Image& image, const IblSettings& settings) {
  check_settings(settings);
  const Environment environment(image);
  Ibl ibl;
  ibl.layout = environment.layout();
  ibl.width = image.width;
  ibl.height = image.height;
  ibl.unusable_values = environment.unusable_values();
  const ShMaps sh = project_to_sh(environment, settings.windowed);
  ibl.mean = sh_basis({0, 1, 0})[0] * sh.radiance[0];
  describe_suns(environment, ibl);
  if (settings.sh) {
    ibl.sh = sh;
    if (settings.checks > 0) ibl.sh_error = check_sh(environment, sh, settings.checks);
  }
  if (settings.irradiance || settings.specular) bake_cubes(environment, settings, ibl);
  return ibl;
}

}  // namespace lanthorn
