// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lanthorn/scene_description.h"
#include "light/light.h"
#include "light/light_sampler.h"
#include "light/ray_lights.h"
#include "material/material_table.h"
#include "math/ray.h"
#include "math/vec.h"
#include "medium/medium.h"
#include "scene/surface_point.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Counts and measurements from building the scene.
struct SceneStatistics {
  std::uint64_t triangles = 0, patches = 0, quadrics = 0, curves = 0;  ///< each stored once, however often instanced
  std::uint64_t instances = 0;
  std::uint64_t materials = 0, textures = 0, lights = 0;
  std::uint64_t geometry_bytes = 0, bvh_bytes = 0, texture_bytes = 0;
  std::uint64_t texture_disk_bytes = 0;  ///< of tiles of textures that do not fit into memory
  double build_seconds = 0;
};

/// A world-space box around some of the scene's surfaces, covering the whole shutter interval.
struct Obstacle {
  Bounds box;
  bool is_specular = false;  ///< includes mirrors or clear glass
};

struct SceneData;
struct SceneRay;

/// An immutable scene: geometry in Embree, materials, textures, media, lights. Safe to share between threads. The
/// camera is in a View.
class Scene {
 public:
  /// Builds from a description (moved from: takes over its meshes). Throws Error at the location of an error in the
  /// scene. Appends to `warnings()`.
  explicit Scene(SceneDescription description);
  explicit Scene(std::shared_ptr<const SceneData> data) : data_(std::move(data)) {}

  /// Nearest surface along the ray, with its closure evaluated at `w`, or nearest interface of a medium. Returns
  /// nullopt if the ray leaves the scene. Passes through alpha cut-outs.
  std::optional<SurfacePoint> intersect(const Ray& ray, const Wavelengths& w) const;
  /// True if nothing lies between the ray's origin and t_max, not even an interface of a medium.
  bool visible(const Ray& ray) const;

  const std::vector<Light>& lights() const;
  const LightBvh& light_bvh() const;
  /// Indices of the lights that are visible to rays leaving the scene.
  const std::vector<std::uint32_t>& infinite_lights() const;
  /// Lights that are sampled along rays through media; none if no medium scatters.
  const RayLights& ray_lights() const;
  const Bounds& bounds() const;
  BoundingSphere bounding_sphere() const;
  /// Largest radiance of any light, in any channel; for a light without extent, the radiance of surfaces that it
  /// illuminates. Scales the film's exact sums.
  float largest_radiance() const;
  /// True if some material has a wavelength-dependent index of refraction or a tabulated (measured) spectrum. Spectra
  /// of metals do not count, because RGB mode reproduces their reflectance. The default colour mode is then spectral.
  bool has_measured_spectra() const;
  bool has_dispersion() const;
  /// True if anything moves while the shutter is open.
  bool has_motion() const;
  /// True if some material may have delta lobes: mirrors and clear glass.
  bool may_be_specular() const;
  /// True if the scene describes any medium. If not, all rays are in vacuum.
  bool has_media() const;
  /// True if some material scatters as hair does.
  bool has_fibres() const;
  /// True if some shape is only an interface between media. If not, a ray that passes no surface stays in one medium.
  bool has_interfaces() const;
  /// True if rays from the camera pass through some shape that other rays meet.
  bool has_hidden_shapes() const;
  /// True if any medium scatters.
  bool has_scattering_media() const;
  /// The largest albedo of a medium that is not under a surface (`largest_albedo`); 0 if none of these scatters.
  float largest_medium_albedo() const;
  /// True if any medium has volumetric emission.
  bool has_emissive_media() const;
  /// Boxes that contain all scattering media; empty if one of them is unbounded.
  std::optional<std::vector<Bounds>> scattering_boxes() const;
  /// The light that stands for a medium with volumetric emission; nullopt if the medium is not a light, for example
  /// because it is unbounded.
  std::optional<std::uint32_t> volume_light(MediumId medium) const;
  /// True if some emissive medium is not a light: only eye paths find its emission.
  bool has_unlit_emission() const;
  /// True if the medium is around the ray's origin; asks the surfaces along the ray.
  bool lies_in(MediumId medium, const Ray& ray) const;
  /// `id` must not be vacuum.
  const Medium& medium(MediumId id) const;
  /// Media in front of (outside) and behind the surface of a light; equal for lights without surface.
  MediumInterface light_media(std::uint32_t light) const;
  /// Boxes that together contain all surfaces except matte emitting ones: at most a few thousand, and small where
  /// surfaces are small.
  std::vector<Obstacle> obstacles() const;
  const SceneStatistics& statistics() const;
  /// Throws Error if a texture on disk could not be read since the scene was built: then pictures are wrong.
  void require_textures() const;
  /// Statistics of reading textures on disk since the scene was built.
  TileCacheCounts texture_reads() const;
  /// Location in the scene file of the nearest surface along the ray; nullopt if there is none.
  std::optional<SourceLocation> locate(const Ray& ray) const;
  /// Location in the scene file of the light with this index.
  const SourceLocation& light_location(std::uint32_t light) const;
  const std::vector<description::Warning>& warnings() const;
  /// The description without its meshes (names, and the file's view and hints).
  const SceneDescription& description() const;
  const std::shared_ptr<const SceneData>& data() const { return data_; }

 private:
  std::shared_ptr<const SceneData> data_;
};

/// The ray in the coordinates of the scene, with a unit direction, when the shutter opens. Throws Error, naming
/// `index`, unless all its numbers are finite and its direction is not 0.
Ray ray_in_scene(const Scene& scene, const SceneRay& ray, std::size_t index);

/// True if the medium is the interior of a material, such as skin or wax (subsurface scattering).
bool is_under_surface(const Scene& scene, MediumId medium);

/// Largest number of vertices under surfaces that a walk may have; 0 if no medium is under a surface.
int most_under_surface(const Scene& scene);

/// Number of scatterings after which a thousandth of the light is left in a medium of this albedo. At least 64; at most
/// 4096, for media that absorb nothing.
int scatterings_until_dark(float albedo);

/// Version of the loaded Embree, such as "3.13.5" (geometry.cpp). Throws Error if it cannot be started.
std::string version_of_embree();

}  // namespace lanthorn
