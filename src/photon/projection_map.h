// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Projection maps (Jensen 1996; 2001, section 5.1.2): of each light, which of its photons can meet
// what.
#pragma once

#include <cstdint>

#include "light/emission_guide.h"
#include "scene/scene.h"

namespace lanthorn {

/// What photons should meet first.
enum class PhotonTarget : std::uint8_t {
  surfaces,
  specular,  ///< mirrors and clear glass
};

/// Photons start where a box around something of the target is in their way. They are drawn by a subdivision of the
/// numbers that emission is drawn from, so that it serves lights of every kind; whether a cell's photons can meet a box
/// is decided by a cone around a number of them, widened. As this is no proof, the rest of the light keeps a small
/// share of the photons. Without a target all light is even.
EmissionGuide make_projection_map(const Scene& scene, PhotonTarget target);

}  // namespace lanthorn
