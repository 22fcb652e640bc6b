// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Separate from the readers' targets, which need not link the renderer.
#include <zlib.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <string>

#include "fuzz/require.h"
#include "fuzz/targets.h"
#include "lanthorn/error.h"
#include "render/state.h"

namespace lanthorn::fuzz {

namespace {

void check_passes(const RenderState& state) {
  for (std::size_t i = 0; i < state.passes.size(); ++i) {
    require(state.passes[i].begin < state.passes[i].end, "range of passes");
    require(i == 0 || state.passes[i - 1].end < state.passes[i].begin, "order of passes");
  }
}

// A state that can be read can be written, and read again with the same result.
void check_round_trip(const RenderState& state) {
  const std::vector<std::byte> bytes = encode_state(state);
  require(encode_state(decode_state(bytes, "t.state")) == bytes, "state that was written and read");
}

void check_merge(const RenderState& state) {
  if (!state.shardable || state.passes.empty()) return;
  RenderState other = state;
  const std::uint64_t end = state.passes.back().end;
  // Unrealistic times and passes beyond the last one cannot be doubled.
  if (end > std::uint64_t{1} << 32 || state.seconds > 1e11) return;
  other.passes = {{end, end + 3}};
  const RenderState merged = merge_states(state, other);
  require(merged.pass_count() == state.pass_count() + 3, "passes of a merge");
  check_passes(merged);
  check_round_trip(merged);
}

std::optional<RenderState> decode(std::span<const std::byte> bytes) {
  try {
    return decode_state(bytes, "t.state");
  } catch (const Error& error) {
    require(error.where.file == "t.state", error.what());
    return std::nullopt;
  }
}

// After the decoder has succeeded, nothing may throw.
void check_state(std::span<const std::byte> bytes) {
  const std::optional<RenderState> state = decode(bytes);
  if (!state) return;
  check_passes(*state);
  check_round_trip(*state);
  const Image image = state->film.resolve(state->pass_count());
  require(image.width == state->film.width() && image.height == state->film.height(), "size of the picture");
  require_same_identity(*state, state->record.identity, "t.state");
  check_merge(*state);
}

// The bytes with corrected header size (if there is a JSON value where the header begins) and checksum, which would
// otherwise reject most mutations.
std::string repaired(std::string_view bytes) {
  constexpr std::size_t size_at = 12, header_at = 16;
  std::string copy(bytes);
  if (copy.size() < header_at + sizeof(std::uint32_t)) return copy;
  const std::size_t body = copy.size() - sizeof(std::uint32_t);
  const auto put = [&](std::size_t at, std::uint32_t value) { std::memcpy(&copy[at], &value, sizeof(value)); };
  std::istringstream text(copy.substr(header_at, body - header_at));
  try {
    nlohmann::json header;
    text >> header;
    if (text.good()) put(size_at, static_cast<std::uint32_t>(text.tellg()));
  } catch (const nlohmann::json::exception&) {  // refused later
  }
  put(body, static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(copy.data()), body)));
  return copy;
}

}  // namespace

void read_state(std::string_view bytes) {
  for (const std::string& text : {std::string(bytes), repaired(bytes)})
    check_state(std::as_bytes(std::span<const char>(text)));
}

}  // namespace lanthorn::fuzz
