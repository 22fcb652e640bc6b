// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "render/state.h"

namespace lanthorn::test {

/// Gives a state this film, which shows the whole picture.
inline void set_film(RenderState& state, Film film) {
  state.film = std::move(film);
  const int width = state.film.width(), height = state.film.height();
  state.record.identity.resolution = {width, height};
  state.record.identity.crop = {0, 0, width, height};
}

}  // namespace lanthorn::test
