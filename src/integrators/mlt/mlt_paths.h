// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The paths of Metropolis light transport as functions of their random numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "math/distribution.h"
#include "math/primary_samples.h"
#include "path/emission_densities.h"
#include "path/path_class.h"
#include "path/path_draw.h"
#include "path/render_job.h"
#include "path/walk.h"
#include "scene/scene.h"

namespace lanthorn {

/// The random numbers of a path's two subpaths (path_samples.cpp).
struct PathSamples {
  PrimarySamples eye, light;

  explicit PathSamples(float sigma) : eye(sigma), light(sigma) {}
  void start(std::uint64_t key);
  void set_key(std::uint64_t key);
  void propose(Mutation mutation);
  void accept();
  void reject();
};

/// Distribution of the number of scatterings, at least 1, of independently drawn paths of fixed length. In most scenes,
/// most light scatters a few times only. The probabilities affect noise alone (path_samples.cpp).
class PathLengths {
 public:
  PathLengths() = default;
  explicit PathLengths(int most);
  float probability(int scatterings) const { return probability_[static_cast<std::size_t>(scatterings) - 1]; }
  /// `u` in [0,1).
  int at(float u) const;

 private:
  std::vector<float> probability_, sums_;  // by scatterings less 1
};

/// Contribution of a path to the film, divided by the density of its random numbers. Emission seen directly or by way
/// of delta scatterings alone is left out, because plain eye paths find it.
struct FilmLight {
  Vec2 raster{0};                                  ///< film position, pixels
  std::array<Spectrum, path_class_count> light{};  ///< by class, times the factor of dispersion, as `splat` takes it
  bool from_medium = false;                        ///< see media_layer

  Spectrum& of(PathClass c) { return light[static_cast<std::size_t>(c)]; }
};

/// The part of the film plane whose samples contribute to the window through the pixel filter.
struct FilmRegion {
  Vec2 corner{0}, size{1};

  explicit FilmRegion(const View& view);
  float area() const { return size.x * size.y; }
  bool contains(const Vec2& raster) const {
    const Vec2 p = raster - corner;
    return p.x >= 0 && p.y >= 0 && p.x < size.x && p.y < size.y;
  }
};

/// State shared by the paths of a pass. Wavelengths are drawn once per pass: if each path drew its own, each would have
/// its own tint. Only the hero is a path's own.
struct PathPass {
  const RenderJob& job;
  PassDraw draw;
  FilmRegion region;
  WalkLimits limits;
};

/// The choice of a light for light paths.
struct LightChoice {
  EmissionDensities emission;
  AliasTable table;

  explicit LightChoice(const Scene& scene);
};

/// Path tracing's estimate of all light but emission (Kelemen et al. 2002).
FilmLight trace_path(const PathPass& pass, PathSamples& samples, RayCounts& counts);

/// The light of a path with `scatterings` >= 1 by one technique of bidirectional path tracing, which the samples choose
/// uniformly. Includes the technique's MIS weight, divided by its probability (Hachisuka, Kaplanyan & Dachsbacher
/// 2014).
FilmLight connect_path(const PathPass& pass, const LightChoice& lights, int scatterings, PathSamples& samples,
                       RayCounts& counts);

}  // namespace lanthorn
