// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/state.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "render/state.h"
#include "render/state_file.h"

namespace lanthorn {

namespace {

using nlohmann::json;

// An array of `count` numbers in the identity. Empty if there is none: a file may hold anything.
std::optional<std::vector<int>> integers(const json& identity, const char* name, std::size_t count) {
  const auto found = identity.find(name);
  if (found == identity.end() || !found->is_array() || found->size() != count) return std::nullopt;
  std::vector<int> values;
  for (const json& value : *found) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > 1u << 20) return std::nullopt;
    values.push_back(value.get<int>());
  }
  return values;
}

bool is_set(const RenderState& state, const char* setting) {
  const json settings = json::parse(state.settings);
  const auto found = settings.find(setting);
  return found != settings.end() && found->is_boolean() && found->get<bool>();
}

}  // namespace

ShownPart shown_part(const RenderState& state) {
  const json identity = json::parse(state.settings).value("identity", json::object());
  const auto resolution = integers(identity, "resolution", 2), crop = integers(identity, "crop", 4),
             margin = integers(identity, "margin", 4);
  ShownPart part{0, 0, state.film.width(), state.film.height(), {}};
  if (!resolution || !crop) return part;
  part.window = {(*crop)[0], (*crop)[1], (*resolution)[0], (*resolution)[1]};
  if (!margin) return part;
  const auto& [left, top, right, bottom] = std::array{(*margin)[0], (*margin)[1], (*margin)[2], (*margin)[3]};
  // A file may hold anything.
  if (left + right >= part.width || top + bottom >= part.height) return part;
  part.x = left;
  part.y = top;
  part.width -= left + right;
  part.height -= top + bottom;
  return part;
}

StateSummary summarize(const RenderState& state) {
  const ShownPart shown = shown_part(state);
  return {.integrator = state.integrator,
          .passes = state.passes,
          .pass_count = state.pass_count(),
          .seconds = state.seconds,
          .mergeable = state.shardable,
          .settings = state.settings,
          .measures_exposure = is_set(state, "measures_exposure"),
          .display_emission = is_set(state, "display_emission"),
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
