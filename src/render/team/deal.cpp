// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/team/deal.h"

#include <algorithm>
#include <utility>

#include "render/looks.h"
#include "render/state.h"

namespace lanthorn {

Deal::Deal(const StopRule& stop, const Team& team, std::vector<PassRange> done)
    : stop_(stop),
      gather_seconds_(team.gather_seconds),
      preview_seconds_(team.preview_seconds),
      done_(std::move(done)),
      pass_(stop.passes.begin),
      count_(pass_count(done_)),
      round_(team.rounds),
      settled_(team.rounds),
      preview_due_(preview_seconds_.value_or(0)) {
  if (stop.noise) look_ = next_look(count_).passes;
}

bool Deal::is_done(std::uint64_t pass) const {
  return std::any_of(done_.begin(), done_.end(),
                     [&](const PassRange& range) { return range.begin <= pass && pass < range.end; });
}

bool Deal::must_stop(double seconds) const {
  if (stop_.drop && stop_.drop->load()) return true;
  // At least one pass is rendered, however early the stop, because there must be a picture.
  return dealt_ > 0 &&
         ((stop_.interrupted && stop_.interrupted->load()) || (stop_.seconds && seconds >= *stop_.seconds));
}

bool Deal::is_gathering_due(double seconds) const {
  return (gather_seconds_ && seconds - gathered_ >= *gather_seconds_) || (preview_seconds_ && seconds >= preview_due_);
}

void Deal::end_round(double seconds) {
  ++round_;
  dealt_in_round_ = 0;
  if (look_ == count_) look_ = next_look(count_).passes;
  gathered_ = seconds;
  if (preview_seconds_ && seconds >= preview_due_) preview_due_ = 2 * seconds;
}

Deal::Dealt Deal::next(double seconds) {
  if (last_) return {};
  while (pass_ < stop_.passes.end && is_done(pass_)) ++pass_;
  if (pass_ >= stop_.passes.end || must_stop(seconds)) {
    stop();
    return {};
  }
  if (dealt_in_round_ > 0 && (look_ == count_ || is_gathering_due(seconds))) {
    const bool is_under_way = settled_ < round_;
    if (!is_under_way)
      end_round(seconds);
    else if (look_ == count_)
      return {Answer::wait, 0, settled_};
  }
  ++count_, ++dealt_, ++dealt_in_round_;
  return {Answer::pass, pass_++, round_};
}

void Deal::settle(bool enough) {
  if (enough && !last_) last_ = settled_;
  ++settled_;
}

void Deal::stop() {
  if (!last_) last_ = round_;
}

}  // namespace lanthorn
