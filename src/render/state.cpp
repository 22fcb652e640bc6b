// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/state.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "lanthorn/error.h"
#include "render/record.h"
#include "render/state_file.h"

namespace lanthorn {

namespace {

/// The ranges, sorted, and joined where they touch. Empty if two overlap.
std::optional<std::vector<PassRange>> joined(std::vector<PassRange> ranges) {
  std::sort(ranges.begin(), ranges.end(), [](const PassRange& a, const PassRange& b) { return a.begin < b.begin; });
  std::vector<PassRange> result;
  for (const PassRange& range : ranges) {
    if (!result.empty() && range.begin < result.back().end) return std::nullopt;
    if (!result.empty() && range.begin == result.back().end)
      result.back().end = range.end;
    else
      result.push_back(range);
  }
  return result;
}

/// Whole microseconds or so: such numbers add exactly, in any order.
double coarse(double seconds) { return std::round(seconds * 0x1p20) * 0x1p-20; }

}  // namespace

std::uint64_t pass_count(std::span<const PassRange> passes) {
  std::uint64_t count = 0;
  for (const PassRange& range : passes) count += range.end - range.begin;
  return count;
}

bool RenderState::has_pass(std::uint64_t pass) const {
  return std::any_of(passes.begin(), passes.end(),
                     [&](const PassRange& range) { return range.begin <= pass && pass < range.end; });
}

void RenderState::add_pass(std::uint64_t pass) {
  assert(!has_pass(pass));
  passes.push_back({pass, pass + 1});
  if (auto sorted = joined(passes)) passes = std::move(*sorted);
}

std::optional<std::string> identity_difference(const RenderState& a, const RenderState& b) {
  return identity_difference(a.record.identity, b.record.identity);
}

std::optional<std::string> difference_to_replaced(const RenderState& there, const RenderState& state) {
  RenderIdentity one = there.record.identity, other = state.record.identity;
  one.coarse.reset();
  other.coarse.reset();
  return identity_difference(one, other);
}

void require_same_identity(const RenderState& state, const RenderIdentity& identity, const std::string& file) {
  const auto difference = identity_difference(state.record.identity, identity);
  if (difference)
    throw Error({file}, fmt::format("belongs to another render: it differs in {}; give the scene and settings it was "
                                    "made with, or another file",
                                    *difference));
}

namespace {

void require_mergeable(const RenderState& a, const RenderState& b) {
  if (a.integrator != b.integrator)
    throw Error(fmt::format("cannot merge: integrators differ ({} and {})", std::min(a.integrator, b.integrator),
                            std::max(a.integrator, b.integrator)));
  if (!a.shardable || !b.shardable)
    throw Error(
        fmt::format("cannot merge: each pass of {} depends on the passes before it, so that its renders can be resumed "
                    "but not put together from shards",
                    a.integrator));
  if (const auto difference = identity_difference(a, b))
    throw Error(fmt::format("cannot merge: the renders differ in {}", *difference));
}

void require_films_fit(bool they_do) {
  if (!they_do) throw Error("cannot merge: the films differ in size, scale or contents");
}

std::vector<PassRange> passes_of_both(const RenderState& a, const RenderState& b) {
  std::vector<PassRange> ranges = a.passes;
  ranges.insert(ranges.end(), b.passes.begin(), b.passes.end());
  auto passes = joined(std::move(ranges));
  if (!passes) throw Error("cannot merge: some passes are in both; make shards with disjoint --pass-range");
  return *std::move(passes);
}

// All but the films.
void add_head(RenderState& sum, const RenderState& more, std::vector<PassRange> passes) {
  sum.integrator_state = std::max(sum.integrator_state, more.integrator_state);  // any that is not empty serves
  sum.passes = std::move(passes);
  sum.seconds = coarse(sum.seconds) + coarse(more.seconds);
  sum.eye += more.eye;
  sum.light += more.light;
  sum.record = common_record(sum.record, more.record);  // what differs does not hold for the sum
}

}  // namespace

void merge_into(RenderState& sum, const RenderState& more) {
  require_mergeable(sum, more);
  require_films_fit(sum.film.compatible(more.film));
  std::vector<PassRange> passes = passes_of_both(sum, more);
  sum.film.merge(more.film);
  add_head(sum, more, std::move(passes));
}

void merge_into(RenderState& sum, const StateReader& more) {
  require_mergeable(sum, more.head());
  require_films_fit(more.fits(sum.film));
  std::vector<PassRange> passes = passes_of_both(sum, more.head());
  more.add_to(sum.film);
  add_head(sum, more.head(), std::move(passes));
}

RenderState merge_states(const RenderState& a, const RenderState& b) {
  RenderState merged = a;
  merge_into(merged, b);
  return merged;
}

RenderState empty_like(const RenderState& state) {
  RenderState empty;
  const Film& film = state.film;
  empty.film = Film::with_exponent(film.width(), film.height(), film.step_exponent(), film.contents());
  empty.integrator = state.integrator;
  empty.record = state.record;
  empty.shardable = state.shardable;
  return empty;
}

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

void SavedState::merge_into(RenderState& sum) const { lanthorn::merge_into(sum, *reader_); }

}  // namespace lanthorn
