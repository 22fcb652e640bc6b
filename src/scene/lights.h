// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Turns described lights into Light values.
#pragma once

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

}  // namespace lanthorn
