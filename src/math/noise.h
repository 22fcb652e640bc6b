// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Perlin 2002, "Improving Noise", and sums of its octaves (Perlin 1985, "An Image Synthesizer"), with the gradients and
// factors of pbrt-v4, so that its textures look the same.
#pragma once

#include "math/vec.h"

namespace lanthorn {

/// Gradient noise of mean 0, in about [-1, 1]: 0 on the integer lattice, twice continuously differentiable, of period
/// 256 along each axis. Returns 0 if a coordinate is not finite.
float perlin_noise(const Point& p);

/// Fractional Brownian motion: sum over i < octaves of roughness^i noise(1.99^i p).
float fbm(const Point& p, float roughness, int octaves);

/// Like `fbm`, with the absolute value of each octave.
float turbulence(const Point& p, float roughness, int octaves);

}  // namespace lanthorn
