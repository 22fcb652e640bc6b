// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Which process of a team renders which pass, and when their sums are gathered.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lanthorn/session.h"
#include "lanthorn/team.h"

namespace lanthorn {

/// Rank 0 deals out the passes in order, one for each question, so that a fast process renders more of them.
///
/// The passes belong to rounds, one after the other, and a round's sums are gathered when all its passes are done. A
/// round ends when a checkpoint is due, or after a number of passes at which the error is to be looked at; these
/// numbers are fixed. While a round's sums travel, passes of the next round are rendered, but none of the round after
/// that.
class Deal {
 public:
  /// `done`: the passes that the resumed state has. Rank 0 does not deal them out again.
  Deal(const StopRule& stop, const Team& team, std::vector<PassRange> done);

  enum class Answer : std::uint8_t {
    pass,  ///< the process renders `pass`, which belongs to `round`
    wait,  ///< the process hands over its sums of `round` and asks again; they decide whether more passes follow
    end,   ///< there are no more passes
  };
  struct Dealt {
    Answer answer = Answer::end;
    std::uint64_t pass = 0, round = 0;
  };
  /// Answers one question. `seconds`: the time since the render began.
  Dealt next(double seconds);
  /// Marks the oldest unsettled round as settled, after its sums have been gathered. `enough`: the render ends with
  /// this round, and the sums of later rounds are thrown away.
  void settle(bool enough);
  /// Deals out no more passes. The render ends with the passes that are dealt.
  void stop();

  /// Returns the last round whose sums go into the picture, or nullopt while it is not known.
  std::optional<std::uint64_t> last_round() const { return last_; }
  bool is_settled() const { return last_ && settled_ > *last_; }

 private:
  bool is_done(std::uint64_t pass) const;
  bool must_stop(double seconds) const;
  bool is_gathering_due(double seconds) const;
  void end_round(double seconds);

  StopRule stop_;
  std::optional<double> gather_seconds_, preview_seconds_;
  std::vector<PassRange> done_;
  std::uint64_t pass_;   // the next pass
  std::uint64_t count_;  // number of passes that are dealt or were done before
  std::uint64_t dealt_ = 0, dealt_in_round_ = 0;
  std::uint64_t round_, settled_;  // the round that is dealt out, and the first unsettled one
  std::optional<std::uint64_t> last_, look_;
  double gathered_ = 0, preview_due_;  // seconds
};

}  // namespace lanthorn
