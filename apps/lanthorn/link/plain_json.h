// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// JSON with binary arrays as plain data.
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "lanthorn/plain_value.h"

namespace lanthorn::program {

/// The text of a JSON object. {"$array": "float32", "shape": [n, 3], "offset": bytes} is an array in `data`. Throws
/// Error for text that is no JSON object, for objects nested too deeply, and for arrays that `data` does not hold.
plain::Dict dict_of_json(std::string_view text, const std::shared_ptr<const std::vector<std::byte>>& data);

}  // namespace lanthorn::program
