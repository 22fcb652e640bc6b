// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Messages between the processes of a team.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lanthorn/statistics.h"
#include "lanthorn/team.h"

namespace lanthorn {

enum class MessageKind : std::uint8_t {
  // To rank 0.
  /// Says which render the process takes part in; a: the rank that it passes its sums on to, b: the number of
  /// processes that pass theirs on to it, rest: the text of its record.
  join,
  ask,     ///< asks for the next pass; rest: the counts of the passes since the last question
  failed,  ///< says why the process cannot render; rest: the text
  // From rank 0.
  deal,     ///< deals out pass a, which belongs to round b
  wait,     ///< asks for the sums of round a; another answer follows
  end,      ///< says that there are no more passes; a: the last round whose sums go into the picture
  give_up,  ///< asks to give up the running pass; a: 1 if the whole running round is not needed
  // To the parent.
  sums,  ///< passes on the sums of round a; rest: the bytes of a state, empty if there are no passes
};

struct Message {
  MessageKind kind = MessageKind::end;
  std::uint64_t a = 0, b = 0;
  std::vector<std::byte> rest{};
  /// The first round of the sender's render, which tells renders apart: a process may begin the next one while others
  /// still end this one. 0 also if the sender does not render.
  std::uint64_t first_round = 0;
};

std::vector<std::byte> encode(const Message& message);
/// The inverse of `encode`. Throws Error if the bytes do not form a message.
Message decode_message(std::span<const std::byte> bytes);

std::vector<std::byte> bytes_of(const std::string& text);
std::string text_of(std::span<const std::byte> bytes);

/// Encodes the counts that rank 0 sums over the team: passes, paths, rays and records.
std::vector<std::byte> encode_counts(const RenderStatistics& statistics);
/// Adds what `encode_counts` has encoded.
void add_counts(RenderStatistics& sum, std::span<const std::byte> bytes);

}  // namespace lanthorn
