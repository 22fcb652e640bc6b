// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Emitting shapes.
#pragma once

#include <vector>

#include "lanthorn/scene_description.h"
#include "light/light.h"
#include "scene/geometry.h"
#include "scene/lights.h"

namespace lanthorn {

/// The lights of the shape `source`, stored in world space as `shape`: one per triangle, patch or quadric, in the order
/// of its primitives (the two halves of a patch share one). `radiance`: the light's radiance, compiled, with its images
/// loaded. As in pbrt-v4, `power` is that of each primitive unless the shape shares it; if a texture makes the
/// primitives differ, it is the power of a primitive of mean brightness. An alpha of 0 everywhere makes lights that no
/// ray can hit. If textures are involved (`varies`), `shape` must outlive the lights.
std::vector<Light> make_area_lights(const ShapeStore& shape, const description::Shape& source,
                                    const description::AreaLight& light, const SpectrumInput& radiance,
                                    const Transform& to_world, LightStore& store);

}  // namespace lanthorn
