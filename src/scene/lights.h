// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Turns described lights into Light values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "lanthorn/scene_description.h"
#include "light/light.h"
#include "scene/geometry.h"
#include "texture/spectrum_store.h"

namespace lanthorn {

struct MaterialPart;

/// Data that lights point to; a deque keeps addresses stable.
struct LightStore {
  std::shared_ptr<const MaterialPart> materials;  ///< whose textures the lights read
  SpectrumStore spectra;
  std::deque<SphericalImage> spherical_images;
  std::deque<ProjectionImage> projection_images;
  std::deque<Portal> portals;
  std::deque<EmissionPattern> patterns;
  std::deque<PiecewiseConstant2d> brightnesses;
  std::vector<description::Warning> warnings;
};

/// Makes a light without surface. Throws Error for unreadable or unsuitable images.
Light make_light(const description::Light& light, const FileAccess& access, const BoundingSphere& scene,
                 ColorSpace space, LightStore& store);

/// A light that was made from a description.
struct MadeLight {
  const description::Light& source;
  const Light& light;
};
/// Like `make_light`, for an environment that differs from `before` in its transformation and scale only: shares the
/// image, which takes long to make. Nullopt for all other lights.
std::optional<Light> make_from(const MadeLight& before, const description::Light& light, const BoundingSphere& scene);

/// A shape that emits.
struct EmittingShape {
  const ShapeStore* shape = nullptr;           ///< in world space
  const description::Shape* source = nullptr;  ///< without its mesh
  Transform to_world;
  bool is_placed = false;         ///< rays are mapped to the shape's own space, where they meet it
  std::uint32_t first_light = 0;  ///< its lights have consecutive indices
};

/// The number of the shape's lights (area_lights.cpp).
std::size_t light_count(const ShapeStore& shape);

/// The lights of the shape: one per triangle, patch or quadric, in the order of its primitives (the two halves of a
/// patch share one). `radiance`: the light's radiance, compiled in `textures`, with its images loaded. All of them
/// together emit the power `light.power`, if given, whatever the number of primitives; textures and alpha are taken
/// into account as sampled at some points. An alpha of 0 everywhere makes lights that no ray can hit. If textures are
/// involved (`varies`), `emitter.shape` must outlive the lights (area_lights.cpp).
std::vector<Light> make_area_lights(const EmittingShape& emitter, const description::AreaLight& light,
                                    const TextureGraph& textures, const SpectrumInput& radiance, LightStore& store);

}  // namespace lanthorn
