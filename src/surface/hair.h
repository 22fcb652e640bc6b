// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "math/frame.h"
#include "surface/sample.h"

namespace lanthorn {

/// A hair or a strand of fur: a dielectric cylinder that absorbs inside (Chiang, Bitterli, Tappan, Burley 2016, "A
/// Practical and Controllable Hair and Fur Model for Production Path Tracing"; Marschner et al. 2003). The frame's x
/// axis runs along the hair. Scatters all around; as flux through the hair's width, so that `eval` is divided by the
/// cosine to z that the rendering equation multiplies by.
struct Hair {
  Spectrum sigma_a{};                  ///< absorbed inside, per radius of the hair
  float h = 0;                         ///< where the ray meets the hair across its width, in (-1, 1)
  float eta = 1.55f;                   ///< index of refraction, above 1
  float beta_m = 0.3f, beta_n = 0.3f;  ///< roughness along and around the hair, in [0,1]
  float alpha = 2;                     ///< degrees by which the cuticle's scales are tilted
};

/// Absorption that gives a mass of such hair about this colour when seen from outside (Chiang et al. 2016, eq. 9).
float hair_absorption(float reflectance, float beta_n);

// The functions of every closure have the meanings, units and conventions of those of `Bsdf` in bsdf.h.

Spectrum eval(const Hair& hair, const Vec3& wi, const Vec3& wo, Transport transport);
float pdf(const Hair& hair, const Vec3& wi, const Vec3& wo);
std::optional<BsdfSample> sample(const Hair& hair, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport);
/// Share of the light from wi that is scattered, all lobes together.
Spectrum hair_albedo(const Hair& hair, const Vec3& wi);

inline bool is_smooth(const Hair& /*any*/) { return false; }

}  // namespace lanthorn
