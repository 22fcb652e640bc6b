// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/state.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "render/state.h"
#include "render/state_file.h"

namespace lanthorn {

ShownPart shown_part(const RenderState& state) {
  const RenderIdentity& identity = state.record.identity;
  const auto& [x0, y0, x1, y1] = identity.crop;
  const auto& [left, top, right, bottom] = identity.margin.value_or(std::array<int, 4>{});
  return {left, top, x1 - x0, y1 - y0, {x0, y0, identity.resolution[0], identity.resolution[1]}};
}

StateSummary summarize(const RenderState& state) {
  const ShownPart shown = shown_part(state);
  return {.integrator = state.integrator,
          .passes = state.passes,
          .pass_count = state.pass_count(),
          .seconds = state.seconds,
          .mergeable = state.shardable,
          .record = state.record,
          .width = shown.width,
          .height = shown.height,
          .window = shown.window,
          .margin = std::max({shown.x, shown.y, state.film.width() - shown.width - shown.x,
                              state.film.height() - shown.height - shown.y}),
          .report = state.film.report(),
          .cut_share = std::max(state.eye.share(), state.light.share())};
}

std::shared_ptr<RenderState> open_state(const std::filesystem::path& path) {
  return std::make_shared<RenderState>(load_state(path));
}

std::shared_ptr<RenderState> merge(const RenderState& a, const RenderState& b) {
  return std::make_shared<RenderState>(merge_states(a, b));
}

void merge_into(RenderState& sum, const RenderState& more) { add_state(sum, more); }

SavedState::SavedState(const std::filesystem::path& path)
    : reader_(std::make_unique<StateReader>(open_state_reader(path))) {}
SavedState::~SavedState() = default;
SavedState::SavedState(SavedState&&) noexcept = default;
SavedState& SavedState::operator=(SavedState&&) noexcept = default;

const std::vector<PassRange>& SavedState::passes() const { return reader_->head().passes; }

std::optional<std::string> SavedState::identity_difference(const RenderState& other) const {
  return lanthorn::identity_difference(reader_->head(), other);
}

std::shared_ptr<RenderState> SavedState::load() const { return std::make_shared<RenderState>(reader_->load()); }

void SavedState::merge_into(RenderState& sum) const { add_state(sum, *reader_); }

}  // namespace lanthorn
