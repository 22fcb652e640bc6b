// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Projection maps (Jensen 1996; 2001, section 5.1.2): for each light, the directions in which photons can hit a target.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "lanthorn/vec.h"
#include "light/emission_guide.h"
#include "scene/scene.h"

namespace lanthorn {

/// The targets that photons should hit first.
enum class PhotonTarget : std::uint8_t {
  surfaces,
  surfaces_and_media,  ///< media that scatter, too; if one has no end, photons are not aimed
  specular,            ///< mirrors and clear glass
};

/// A guide that starts photons where a bounding box of the target is in their way. It subdivides the domain of the
/// numbers that sample emission, so that it works for every kind of light. A cone around several sample photons of a
/// cell, slightly widened, decides whether the cell's photons can hit a box. Because this test is not exact, the
/// remaining cells keep a small share of the photons. Without a target in the scene the guide is uniform.
/// `disks`: where the photons of far lights start, if not from one disk that covers the scene.
EmissionGuide make_projection_map(const Scene& scene, PhotonTarget target, const std::optional<AimedDisks>& disks = {});

/// A box that photons should hit first.
struct PhotonBox {
  Bounds box;
  float weight = 0;  ///< share of the photons that it should get, up to a factor common to all boxes
};
/// The same for boxes of unequal weight. If few photons can hit a small box, all of these few are started.
EmissionGuide make_projection_map(const Scene& scene, std::span<const PhotonBox> boxes,
                                  const std::optional<AimedDisks>& disks = {});

}  // namespace lanthorn
