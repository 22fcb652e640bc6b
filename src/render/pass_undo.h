// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "film/film.h"
#include "lanthorn/session.h"
#include "render/state.h"

namespace lanthorn {

/// A film as it was before a pass.
class PassUndo {
 public:
  explicit PassUndo(Undo rule) : rule_(rule) {}

  /// Call before each pass, with the duration of the previous one, if there was one. Returns whether this pass can be
  /// undone.
  bool begin(const RenderState& state, std::optional<double> pass_seconds);
  /// Restores the state as it was at `begin`, which must have returned true. With Undo::never the state is left without
  /// passes and cannot be used.
  void restore(RenderState& state);

 private:
  bool is_worth_it(const RenderState& state, std::optional<double> pass_seconds) const;
  bool copy(const Film& film);

  Undo rule_;
  std::optional<Film> copy_;
  std::optional<double> copy_seconds_;
};

}  // namespace lanthorn
