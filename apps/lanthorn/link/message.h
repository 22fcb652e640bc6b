// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Messages of the protocol (docs/protocol.md) on a pipe: a header, a JSON object, and the bytes of its arrays.
#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lanthorn/plain_value.h"

namespace lanthorn::program {

/// The JSON object of a message as plain data; {"$array": ...} are arrays in the message's bytes.
struct LinkRequest {
  plain::Dict body;
  std::string problem;  ///< why the JSON cannot be understood; empty: it can
};

/// Waits for the next message; returns nothing at the end of the stream. Throws Error if the bytes do not form a
/// message. Nothing after such bytes can be read.
std::optional<LinkRequest> read_request(int file);

/// Throws Error if the client has closed the pipe.
void write_answer(int file, const nlohmann::json& body, std::span<const float> numbers);

/// Whether the client has closed its end of the pipe.
bool is_hung_up(int file);

}  // namespace lanthorn::program
