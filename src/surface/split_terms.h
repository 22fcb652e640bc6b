// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "spectrum/spectrum.h"

namespace lanthorn {

/// A closure as split-sum shading represents it (Karis 2013): Lambertian reflection, one GGX lobe with Schlick's
/// Fresnel term, and sheen.
struct SplitTerms {
  Spectrum diffuse{};             ///< reflectance for light from the viewer's side
  Spectrum diffuse_behind{};      ///< transmittance for light from the other side
  Spectrum f0{}, f90{};           ///< Fresnel term of the lobe at normal incidence and at grazing angles
  float alpha = 0;                ///< its GGX width
  Spectrum sheen{};               ///< reflectance of fibres for light from the viewer's side
  const char* missing = nullptr;  ///< name of the part of the closure that is left out, for messages
};

}  // namespace lanthorn
