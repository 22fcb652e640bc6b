// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The state of a render, the same for a checkpoint, a shard and a finished render.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "film/film.h"
#include "lanthorn/render_record.h"
#include "lanthorn/state.h"
#include "lanthorn/statistics.h"

namespace lanthorn {

/// The number of passes in these ranges.
std::uint64_t pass_count(std::span<const PassRange> passes);

struct RenderState {
  Film film;
  std::vector<PassRange> passes;            ///< done; sorted, disjoint, not touching, none empty
  std::string integrator;                   ///< its name in `lanthorn list`
  std::vector<std::byte> integrator_state;  ///< what the integrator saves
  RenderRecord record;
  bool shardable = true;  ///< passes do not depend on earlier ones
  double seconds = 0;     ///< spent rendering, over all processes
  PathEnds eye, light;    ///< of the paths of all passes (RayCounts)

  std::uint64_t pass_count() const { return lanthorn::pass_count(passes); }
  /// Records a pass as done; it must not be done yet.
  void add_pass(std::uint64_t pass);
  bool has_pass(std::uint64_t pass) const;
};

/// The part of a film that is shown, and its place in the whole picture. The pixels around it are a margin.
struct ShownPart {
  int x = 0, y = 0;  ///< of the first pixel that is shown, in the film
  int width = 0, height = 0;
  ImageWindow window;
  bool has_margin(const Film& film) const { return width != film.width() || height != film.height(); }
};
ShownPart shown_part(const RenderState& state);

/// Throws `lanthorn::Error` if the state's identity differs; the message names the first difference and `file`.
void require_same_identity(const RenderState& state, const RenderIdentity& identity, const std::string& file);

/// The inverse of `encode_state`. Throws `lanthorn::Error` at `file` unless the bytes are a complete, undamaged state
/// of this version.
RenderState decode_state(std::span<const std::byte> bytes, const std::string& file);

/// As `open_state`.
RenderState load_state(const std::filesystem::path& path);

/// As `merge`.
RenderState merge_states(const RenderState& a, const RenderState& b);

class StateReader;
/// Merges a saved state without loading its film; see `SavedState::merge_into`.
void merge_into(RenderState& sum, const StateReader& more);

/// A state without passes of the same render.
RenderState empty_like(const RenderState& state);

}  // namespace lanthorn
