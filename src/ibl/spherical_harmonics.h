// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Ramamoorthi & Hanrahan 2001: An Efficient Representation for Irradiance Environment Maps [R01]
// Sloan 2008: Stupid Spherical Harmonics (SH) Tricks [S08]
#pragma once

#include <array>

#include "ibl/environment.h"
#include "lanthorn/ibl.h"

namespace lanthorn {

/// Real spherical harmonics of order 3 as polynomials of the direction, at index l² + l + m.
std::array<float, 16> sh_basis(const Vec3& d);

/// Projection by a sum over all texels of the image, suns included. `windowed`: applies the weakest window that leaves
/// no irradiance below 0.
ShMaps project_to_sh(const Environment& environment, bool windowed);

}  // namespace lanthorn
