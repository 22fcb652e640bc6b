// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/team/gathering.h"

#include <fmt/format.h>

#include <utility>

#include "lanthorn/error.h"
#include "render/state_file.h"

namespace lanthorn {

namespace {

void add_packed(RenderState& sums, const PackedSums& more) { merge_into(sums, read_state(more.bytes, more.name)); }

}  // namespace

Gathering::Part& Gathering::part_of(std::uint64_t round) {
  if (taken_ && round <= *taken_)
    throw Error(fmt::format("sums of round {} arrive after this process has passed that round on", round));
  return parts_[round];
}

void Gathering::add_own(std::uint64_t round, RoundSums sums) {
  Part& part = part_of(round);
  ++part.arrived;
  if (!sums) return;
  part.sums = std::move(sums);
  for (const PackedSums& more : std::exchange(part.waiting, {})) add_packed(*part.sums, more);
}

void Gathering::add_child(std::uint64_t round, PackedSums sums) {
  Part& part = part_of(round);
  ++part.arrived;
  if (sums.bytes.empty()) return;
  if (part.sums)
    add_packed(*part.sums, sums);
  else
    part.waiting.push_back(std::move(sums));
}

std::optional<Gathering::Complete> Gathering::take_complete() {
  if (parts_.empty() || parts_.begin()->second.arrived < awaited_) return std::nullopt;
  auto node = parts_.extract(parts_.begin());
  taken_ = node.key();
  Part& part = node.mapped();
  Complete complete{node.key(), std::move(part.sums), {}};
  if (part.waiting.empty()) return complete;
  complete.packed = std::move(part.waiting.front());
  if (part.waiting.size() == 1) return complete;
  complete.sums = complete.take_sums();
  for (std::size_t i = 1; i < part.waiting.size(); ++i) add_packed(*complete.sums, part.waiting[i]);
  return complete;
}

RoundSums Gathering::Complete::take_sums() {
  const PackedSums child = std::exchange(packed, {});
  if (child.bytes.empty()) return std::exchange(sums, {});
  return decode_state(child.bytes, child.name);
}

std::vector<std::byte> Gathering::Complete::take_bytes() {
  if (sums) return encode_state(*std::exchange(sums, {}));
  return std::exchange(packed, {}).bytes;
}

TreeCheck::TreeCheck(int size, int awaited_at_first) : views_(static_cast<std::size_t>(size)), missing_(size - 1) {
  views_[0].awaited = static_cast<std::uint64_t>(awaited_at_first);
}

void TreeCheck::join(int rank, std::uint64_t parent, std::uint64_t awaited) {
  if (parent >= views_.size())
    throw Error(fmt::format("process {} of {} passes its sums on to process {}", rank, views_.size(), parent));
  views_[static_cast<std::size_t>(rank)].awaited = awaited;
  ++views_[parent].senders;
  if (--missing_ > 0) return;
  for (std::size_t i = 0; i < views_.size(); ++i)
    if (views_[i].senders != views_[i].awaited)
      throw Error(
          fmt::format("process {} of {} waits for the sums of {} processes, but {} pass theirs on to it: the processes "
                      "do not run the same program",
                      i, views_.size(), views_[i].awaited, views_[i].senders));
}

}  // namespace lanthorn
