// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Flights that end where they scatter, seen at the points that they pass.
#pragma once

#include <optional>
#include <variant>

#include "medium/medium.h"

namespace lanthorn {

/// True if the probability with which flights (`fly`) pass a point is known.
inline bool knows_passing(const Medium& medium) { return std::holds_alternative<HomogeneousMedium>(medium); }

/// Transmittance over a distance (m), divided by the probability with which a flight of throughput `beta` passes its
/// end: what is left of its flux, by wavelength. 1 if all wavelengths are attenuated alike. Empty unless
/// `knows_passing`.
std::optional<Spectrum> passing_weight(const Medium& medium, float distance, const Spectrum& beta,
                                       const Wavelengths& w);

}  // namespace lanthorn
