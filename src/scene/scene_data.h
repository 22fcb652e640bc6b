// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The parts of a scene, for the code that builds scenes. Parts are immutable, and scenes share them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lanthorn/scene_description.h"
#include "light/light.h"
#include "light/light_sampler.h"
#include "light/ray_lights.h"
#include "material/material_table.h"
#include "medium/medium.h"
#include "scene/geometry.h"
#include "scene/lights.h"
#include "scene/scene.h"
#include "texture/spectrum_store.h"
#include "texture/textures.h"

namespace lanthorn {

/// Textures and materials.
struct MaterialPart {
  /// Compiles the materials. `loaded`: images and measured materials to share; may be null.
  MaterialPart(const SceneDescription& scene, const MaterialPart* loaded);
  MaterialPart(const MaterialPart&) = delete;
  MaterialPart& operator=(const MaterialPart&) = delete;

  std::vector<description::Warning> warnings;
  SpectrumStore spectra;
  TextureGraph textures;
  MaterialTable table;
};

struct MediumPart {
  SpectrumStore spectra;
  std::vector<Medium> all;
};

/// A placement of a group, and the instance that it belongs to, if any.
struct PlacedInstance {
  PlacedGroup placed;
  std::optional<description::Index> instance;
  bool emits = false;
  SourceLocation location;
};

/// What was made from the shapes, besides their geometry.
struct ShapePart {
  std::shared_ptr<const MaterialPart> materials;            ///< whose textures the shapes read
  std::vector<std::unique_ptr<ShapeStore>> posed_emitters;  ///< placed shapes that emit, in world space
  std::vector<EmittingShape> emitters;
  std::uint32_t light_count = 0;  ///< of the emitters
  bool has_interfaces = false, has_hidden_shapes = false;
  SceneStatistics statistics;  ///< of the shapes
  std::vector<description::Warning> warnings;
};

struct LightPart {
  std::vector<Light> all;                                 ///< of the emitters, then the description's, then of media
  std::vector<std::shared_ptr<const LightStore>> stores;  ///< of each emitter, then of each of the description's lights
  std::vector<MediumInterface> media;                     ///< in front of and behind each light
  std::map<MediumId, std::uint32_t> volume_lights;        ///< the lights of media
  std::map<std::uint32_t, SourceLocation> locations;      ///< by the index of the first light described there
  std::vector<std::uint32_t> infinite;
  LightBvh bvh;
  RayLights ray_lights;
  float largest_radiance = 0;
  bool has_unlit_emission = false;      ///< some emissive medium is not a light
  std::vector<MediumId> endless_media;  ///< around the whole scene
  std::vector<description::Warning> warnings;
};

/// The parts of a scene, and the description that they were built from, without its meshes.
struct SceneData {
  /// The index of the first of the description's lights.
  std::size_t first_described_light() const { return shapes->light_count; }
  /// Where the light, an index of `lights->all`, is described.
  const SourceLocation& light_location(std::uint32_t light) const;

  SceneDescription description;
  std::uint64_t given_hash = 0;  ///< the description's hash when it was given
  std::shared_ptr<const MaterialPart> materials;
  std::shared_ptr<const MediumPart> media;
  std::shared_ptr<const ShapePart> shapes;
  std::shared_ptr<const std::vector<PlacedInstance>> placed;
  std::shared_ptr<const Geometry> geometry;
  std::shared_ptr<const LightPart> lights;
  BoundingSphere sphere;
  bool has_measured_spectra = false, has_dispersion = false, has_emissive = false;
  std::vector<bool> is_under_surface;  ///< by medium; empty if none is (`find_media_under_surfaces`)
  int most_under_surface = 0;
  SceneStatistics statistics;
};

/// Builds the parts whose descriptions differ from those of `previous`, and shares the others with it. `previous` may
/// be null. Throws Error.
std::shared_ptr<const SceneData> build(SceneDescription&& description, const SceneData* previous = nullptr);

/// Makes the scene's shapes, placements and geometry (shape_builder.cpp). Moves the meshes out of its description.
/// Throws Error at the location of an invalid shape.
void build_shapes(SceneData& scene, const std::shared_ptr<MaterialPart>& materials);
/// Makes all lights of a scene whose other parts are built (light_builder.cpp). Shares those with `previous`, which may
/// be null, that did not change. `materials`: the scene's, if they are new; null if they are those of `previous`.
void build_lights(const std::shared_ptr<SceneData>& scene, MaterialPart* materials, const SceneData* previous);
/// Sets those members of a record that depend on its material and do not change where surfaces and media are.
void note_traits(GeometryRecord& record, const MaterialTraits& traits);
/// Middle of the shutter interval of the scene's own camera.
float shutter_middle(const SceneDescription& description);
/// Appends the warning unless one says the same.
void warn_once(std::vector<description::Warning>& warnings, const SourceLocation& location, const std::string& message);
/// Throws Error at `location` if the light's power is so large that numbers computed from it might overflow.
void check_power(const Light& light, const SourceLocation& location);
/// The same for a radiance, in any channel or at any wavelength.
void check_radiance(float radiance, const SourceLocation& location);
/// All media of the scene, in the description's order (media.cpp). Throws Error if there are more media than ids.
std::vector<Medium> make_media(const SceneDescription& description, SpectrumStore& spectra);
/// Sets the parts of `data` that say which media are under surfaces (media.cpp). Needs its media.
void find_media_under_surfaces(SceneData& data);
/// See `Scene::obstacles` (obstacles.cpp). Interfaces of media are not obstacles, nor are matte shapes that emit: they
/// do not block their own light.
std::vector<Obstacle> find_obstacles(const Geometry& geometry, const MaterialTable& materials);

}  // namespace lanthorn
