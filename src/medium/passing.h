// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light that passes a point of a flight, for flights that end where they scatter.
#pragma once

#include <optional>
#include <variant>

#include "medium/medium.h"

namespace lanthorn {

/// True if the probability with which flights (`fly`) pass a point is known.
inline bool knows_passing(const Medium& medium) { return std::holds_alternative<HomogeneousMedium>(medium); }

/// Transmittance over `distance` (m), divided by the probability that a flight of throughput `beta` passes its end: the
/// flight's remaining flux relative to its start, by wavelength. 1 if all wavelengths are attenuated alike. Nullopt
/// unless `knows_passing`.
std::optional<Spectrum> passing_weight(const Medium& medium, float distance, const Spectrum& beta,
                                       const Wavelengths& w);

}  // namespace lanthorn
