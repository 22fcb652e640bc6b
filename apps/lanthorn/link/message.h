// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Protocol messages (docs/protocol.md) on a pipe: a header, a JSON object, and the bytes of its arrays.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lanthorn/plain_value.h"

namespace lanthorn::program {

/// A message's JSON object as plain data; {"$array": ...} refers to arrays in the message's bytes.
struct LinkRequest {
  plain::Dict body;
  std::string problem;  ///< why the JSON is invalid; empty: it is valid
};

/// Waits for the next message; returns nullopt at the end of the stream. Throws Error if the bytes do not form a
/// message; the stream is then unusable.
std::optional<LinkRequest> read_request(int file);

/// Writes a message. Throws Error if the client has closed the pipe.
void write_answer(int file, const nlohmann::json& body, std::span<const float> numbers);

/// Waits until the client has ended: it no longer reads `output`, or it has closed `input`, has no request left in it,
/// and had `patience` for the answer to the last one. Never returns for regular files.
void wait_for_end_of_client(int input, int output, std::chrono::milliseconds patience);

}  // namespace lanthorn::program
