// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/team/message.h"

#include <array>
#include <cstring>

#include "base/bytes.h"
#include "lanthorn/error.h"

namespace lanthorn {

namespace {

constexpr std::size_t head_bytes = 1 + 3 * sizeof(std::uint64_t);

auto counts_of(auto& s) {
  return std::array{&s.passes,         &s.light_paths,  &s.photons_stored,   &s.cache_records,
                    &s.cache_misses,   &s.rays.walk,    &s.rays.shadow,      &s.rays.spared,
                    &s.rays.eye.paths, &s.rays.eye.cut, &s.rays.light.paths, &s.rays.light.cut};
}

}  // namespace

std::vector<std::byte> encode(const Message& message) {
  std::vector<std::byte> bytes;
  bytes.reserve(head_bytes + message.rest.size());
  append_number(bytes, message.kind);
  append_number(bytes, message.a);
  append_number(bytes, message.b);
  append_number(bytes, message.first_round);
  bytes.insert(bytes.end(), message.rest.begin(), message.rest.end());
  return bytes;
}

Message decode_message(std::span<const std::byte> bytes) {
  if (bytes.size() < head_bytes || bytes[0] > static_cast<std::byte>(MessageKind::sums))
    throw Error("a process of the team sent an invalid message; do all processes run the same program?");
  Message message;
  message.kind = static_cast<MessageKind>(bytes[0]);
  const std::byte* at = &bytes[1];
  for (std::uint64_t* number : {&message.a, &message.b, &message.first_round}) {
    std::memcpy(number, at, sizeof *number);
    at += sizeof *number;
  }
  message.rest.assign(bytes.begin() + head_bytes, bytes.end());
  return message;
}

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::vector<std::byte> encode_counts(const RenderStatistics& statistics) {
  std::vector<std::byte> bytes;
  for (const std::uint64_t* count : counts_of(statistics)) append_number(bytes, *count);
  return bytes;
}

void add_counts(RenderStatistics& sum, std::span<const std::byte> bytes) {
  const auto counts = counts_of(sum);
  if (bytes.size() != counts.size() * sizeof(std::uint64_t)) return;  // the first question has none
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::uint64_t count = 0;
    std::memcpy(&count, &bytes[i * sizeof count], sizeof count);
    *counts[i] += count;
  }
}

}  // namespace lanthorn
