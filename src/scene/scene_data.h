// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The parts of a scene, for the code that builds and edits scenes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "lanthorn/scene_description.h"
#include "light/light.h"
#include "light/light_sampler.h"
#include "light/ray_lights.h"
#include "material/material_table.h"
#include "medium/medium.h"
#include "scene/area_lights.h"
#include "scene/geometry.h"
#include "scene/lights.h"
#include "scene/scene.h"
#include "texture/spectrum_store.h"
#include "texture/textures.h"

namespace lanthorn {

/// A placement of a group, and the instance that it belongs to, if any.
struct PlacedInstance {
  PlacedGroup placed;
  std::optional<description::Index> instance;
  bool emits = false;
  SourceLocation location;
};

/// The parts of a scene. An edited scene shares those that take long to make with the scene it comes from, and keeps
/// them alive.
struct SceneData {
  /// Compiles the materials. `loaded`: a scene to share images and measured materials with; may be null.
  SceneData(SceneDescription&& source, const SceneData* loaded, Geometry own_geometry);
  SceneData(const SceneData&) = delete;
  SceneData& operator=(const SceneData&) = delete;

  /// The index of the first of the description's lights.
  std::size_t first_described_light() const { return lights.size() - volume_lights.size() - description.lights.size(); }
  /// Where the light, an index of `lights`, is described.
  const SourceLocation& light_location(std::uint32_t light) const;

  std::vector<std::shared_ptr<const void>> kept;  ///< parts of other scenes that parts of this one point to

  SceneDescription description;
  std::shared_ptr<SpectrumStore> spectra = std::make_shared<SpectrumStore>();
  TextureGraph textures;
  MaterialTable materials;
  Geometry geometry;
  std::vector<PlacedInstance> placed;
  std::shared_ptr<const std::vector<Medium>> media;
  std::shared_ptr<LightStore> light_store = std::make_shared<LightStore>();
  std::vector<std::unique_ptr<ShapeStore>> posed_emitters;  ///< placed shapes that emit, in world space
  std::vector<EmittingShape> emitters;
  std::vector<Light> lights;  ///< of the emitters, then the description's, then those of media
  std::vector<MediumInterface> light_media;
  std::map<MediumId, std::uint32_t> volume_lights;          ///< the lights of media: the last ones of `lights`
  std::map<std::uint32_t, SourceLocation> light_locations;  ///< by the index of the first light described there
  std::vector<std::uint32_t> infinite_lights;
  LightBvh light_bvh;
  RayLights ray_lights;
  BoundingSphere sphere;
  float largest_radiance = 0;
  bool has_measured_spectra = false, has_dispersion = false, has_interfaces = false, has_emissive = false;
  bool has_hidden_shapes = false;
  bool has_unlit_emission = false;     ///< some emissive medium is not a light
  std::vector<bool> is_under_surface;  ///< by medium; empty if none is (scene/subsurface.h)
  int most_under_surface = 0;
  std::vector<MediumId> endless_media;  ///< around the whole scene
  bool is_edited = false;
  bool has_edited_lights = false;  ///< `lights` point to `spectra`, `light_store` and `textures`
  SceneStatistics statistics;
};

/// Makes all parts. `like`: may be null; another scene from the same files, whose images are not read again. Throws
/// Error.
std::shared_ptr<const SceneData> build(SceneDescription&& description, const SceneData* like = nullptr);

/// Middle of the shutter interval of the scene's own camera.
float shutter_middle(const SceneDescription& description);
/// Appends the warning unless one says the same.
void warn_once(SceneDescription& description, const SourceLocation& location, const std::string& message);
/// Throws Error at `location` if the light's power is so large that numbers computed from it might overflow.
void check_power(const Light& light, const SourceLocation& location);
/// The same for a radiance, in any channel or at any wavelength.
void check_radiance(float radiance, const SourceLocation& location);
/// A sphere around all surfaces; the unit sphere if there are none.
BoundingSphere bounding_sphere(const Bounds& box);
/// Largest radiance of any light, in any channel. For lights without extent, the radiance of a white surface at the
/// nearest place that they illuminate. Depends on lights and geometry. Throws Error as `check_radiance` does.
float find_largest_radiance(const SceneData& data);
/// Like `make_light`, for an environment that differs from one of `scene` in its transformation and scale only: shares
/// the image, which takes long to make. Nullopt for all other lights.
std::optional<Light> make_from(const SceneData& scene, const description::Light& light, const BoundingSphere& bounds);
/// Sets the data that depend on the lights: their sampler, the infinite ones, the largest radiance.
void index_lights(SceneData& data);

}  // namespace lanthorn
