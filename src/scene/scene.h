// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "description/scene_description.h"
#include "light/light.h"
#include "light/light_sampler.h"
#include "math/ray.h"
#include "math/vec.h"
#include "medium/medium.h"
#include "scene/material.h"
#include "scene/surface_point.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// What was counted and measured while building.
struct SceneStatistics {
  std::uint64_t triangles = 0, patches = 0, quadrics = 0, curves = 0;  ///< stored once, however often instanced
  std::uint64_t instances = 0;
  std::uint64_t materials = 0, textures = 0, lights = 0;
  std::uint64_t geometry_bytes = 0, bvh_bytes = 0, texture_bytes = 0;
  double build_seconds = 0;
};

/// A box around some of the scene's surfaces, in the world, for as long as the shutter is open.
struct Obstacle {
  Bounds box;
  bool is_specular = false;  ///< mirrors or clear glass are among them
};

/// What there is to be seen, immutable: geometry behind Embree, materials, textures, media, lights. Safe to share
/// between threads. Who looks at it is a View.
class Scene {
 public:
  /// Builds from a description (moved from: meshes are taken over). Throws Error at the place of what is wrong.
  /// Warnings are appended to `warnings()`.
  explicit Scene(SceneDescription description);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Nearest surface along the ray, with its closure evaluated at `w`, or border of a medium; empty if the ray leaves
  /// the scene. Alpha cut-outs are passed through.
  std::optional<SurfacePoint> intersect(const Ray& ray, const Wavelengths& w) const;
  /// True if nothing lies between the ray's origin and t_max, not even the border of a medium.
  bool visible(const Ray& ray) const;

  const std::vector<Light>& lights() const;
  const LightBvh& light_bvh() const;
  /// Indices of the lights that rays leaving the scene see.
  const std::vector<std::uint32_t>& infinite_lights() const;
  const Bounds& bounds() const;
  BoundingSphere bounding_sphere() const;
  /// Largest radiance (or equivalent for delta lights) that any light sends, in any channel: scales the film's exact
  /// sums.
  float largest_radiance() const;
  /// True if some material has a wavelength-dependent index of refraction or a tabulated (measured) spectrum: then the
  /// default colour mode is spectral.
  bool has_measured_spectra() const;
  bool has_dispersion() const;
  /// True if anything moves while the shutter is open.
  bool has_motion() const;
  /// True if any medium is described. If not, all rays are in vacuum.
  bool has_media() const;
  /// True if one of the scene's media scatters.
  bool has_scattering_media() const;
  /// True if one of them gives off light.
  bool has_emissive_media() const;
  /// Not for vacuum.
  const Medium& medium(MediumId id) const;
  /// Media in front of (outside) and behind the surface of a light; equal for lights without surface.
  MediumInterface light_media(std::uint32_t light) const;
  /// Boxes that together hold all surfaces, but matte ones that emit, a few thousand of them at most, small ones where
  /// surfaces are small.
  std::vector<Obstacle> obstacles() const;
  const SceneStatistics& statistics() const;
  /// Where the scene file describes the nearest surface along the ray; nothing if there is none.
  std::optional<SourceLocation> locate(const Ray& ray) const;
  /// Where it describes the light with this index.
  const SourceLocation& light_location(std::uint32_t light) const;
  const std::vector<description::Warning>& warnings() const;
  /// The description without its meshes (names, and the view and hints that the file has).
  const SceneDescription& description() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lanthorn
