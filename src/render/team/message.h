// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What the processes of a team tell each other.
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
  join,    ///< text: the settings of the render
  ask,     ///< a: passes rendered since the last question; counts of these
  failed,  ///< text: why the process cannot render
  // From rank 0.
  deal,     ///< a: pass, b: round
  wait,     ///< a: a round whose sums are wanted first; another answer follows
  end,      ///< a: the last round that is wanted
  give_up,  ///< the running pass; a: 1 if no pass of the running round is wanted
  // To the parent.
  sums,  ///< a: round; bytes of a state, or none
};

struct Message {
  MessageKind kind = MessageKind::end;
  std::uint64_t a = 0, b = 0;
  std::vector<std::byte> rest{};
};

std::vector<std::byte> encode(const Message& message);
/// Throws Error if the bytes are no message.
Message decode_message(std::span<const std::byte> bytes);

std::vector<std::byte> bytes_of(const std::string& text);
std::string text_of(std::span<const std::byte> bytes);

/// Counts that are summed over a team: passes, paths, rays and records.
std::vector<std::byte> encode_counts(const RenderStatistics& statistics);
void add_counts(RenderStatistics& sum, std::span<const std::byte> bytes);

}  // namespace lanthorn
