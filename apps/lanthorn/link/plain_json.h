// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Converts JSON with binary arrays to plain data.
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "lanthorn/plain_value.h"

namespace lanthorn::program {

/// Parses a JSON object. {"$array": "float32", "shape": [n, 3], "offset": bytes} refers to an array in `data`. Throws
/// Error for text that is not a JSON object, for excessive nesting, and for arrays that `data` does not contain.
plain::Dict dict_of_json(std::string_view text, const std::shared_ptr<const std::vector<std::byte>>& data);

}  // namespace lanthorn::program
