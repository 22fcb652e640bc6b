// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "lanthorn/error_estimate.h"

namespace lanthorn::program {

/// The estimate's members by their names.
nlohmann::json estimate_json(const ErrorEstimate& error);

}  // namespace lanthorn::program
