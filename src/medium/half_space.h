// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lanthorn {

/// Reflectance of a half-space of a homogeneous medium behind a smooth dielectric interface, under even light from all
/// directions: the part of the light that has passed the interface inwards which leaves through it again. Light that
/// the interface reflects on the outside does not count. `albedo`: of a single scattering, in [0, 1]; `g`: of Henyey &
/// Greenstein's phase function, in (-1, 1); `eta`: index of refraction inside over outside, > 0. Within .0005 for
/// |g| <= .9.
double half_space_reflectance(double albedo, double g, double eta);

/// The inverse: the albedo of a single scattering for which the half-space has this reflectance, which is clamped to
/// [0, 1].
double half_space_albedo(double reflectance, double g, double eta);

}  // namespace lanthorn
