// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lanthorn {

/// What light paths leave in media that scatter.
enum class MediumRecords : std::uint8_t {
  none,
  points,  ///< photons where they scatter
  beams    ///< their flights, up to the next surface: of each, all of the medium that it could scatter in
};

}  // namespace lanthorn
