// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// From described lights to Light values.
#pragma once

#include <deque>
#include <vector>

#include "description/scene_description.h"
#include "light/light.h"
#include "scene/geometry.h"
#include "texture/spectrum_store.h"

namespace lanthorn {

/// What lights point to; its parts stay where they are.
struct LightStore {
  std::deque<SphericalImage> spherical_images;
  std::deque<ProjectionImage> projection_images;
  std::deque<Portal> portals;
  std::deque<EmissionPattern> patterns;
  std::deque<PiecewiseConstant2d> brightnesses;
};

/// A light without surface. Throws Error for unreadable and unsuitable images, appends to `warnings`.
Light make_light(const description::Light& light, const FileAccess& access, const BoundingSphere& scene,
                 SpectrumStore& spectra, ColorSpace space, LightStore& store,
                 std::vector<description::Warning>& warnings);

/// Largest value over the visible range, and over the colour channels of RGB mode, of the radiance that the light
/// sends; of lights without extent, of the radiance that a white surface at the distance of the scene's radius would
/// send.
float largest_radiance(const Light& light, const BoundingSphere& scene);

}  // namespace lanthorn
