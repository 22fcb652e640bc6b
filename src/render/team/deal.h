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
/// round ends where the error is to be looked at, which depends on the number of passes alone, or when a checkpoint is
/// due. While its sums travel, the passes of the next round are rendered, but not of the one after that.
class Deal {
 public:
  /// `done`: passes of the state that is resumed.
  Deal(const StopRule& stop, const Team& team, std::vector<PassRange> done);

  enum class Answer : std::uint8_t {
    pass,  ///< render it
    wait,  ///< hand over the sums of `round` and ask again: the next passes depend on them
    end,   ///< no more passes
  };
  struct Dealt {
    Answer answer = Answer::end;
    std::uint64_t pass = 0, round = 0;
  };
  /// `seconds`: since the render began.
  Dealt next(double seconds);
  /// The sums of the oldest round that is not settled have been gathered. `enough`: the later ones are not wanted.
  void settle(bool enough);
  /// Ends the render with the passes that are dealt.
  void stop();

  /// The last round whose sums are wanted, once that is known.
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
  std::uint64_t pass_;   // the next one
  std::uint64_t count_;  // of passes dealt and done before
  std::uint64_t dealt_ = 0, dealt_in_round_ = 0;
  std::uint64_t round_, settled_;  // the one that is dealt, and the first that is not settled
  std::optional<std::uint64_t> last_, look_;
  double gathered_ = 0, preview_due_;  // seconds
};

}  // namespace lanthorn
