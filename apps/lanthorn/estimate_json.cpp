// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_json.h"

namespace lanthorn::program {

nlohmann::json estimate_json(const ErrorEstimate& error) {
  return {{"noise", error.noise},
          {"bias", error.bias},
          {"error", error.error},
          {"bound", error.bound},
          {"doubt", error.doubt}};
}

}  // namespace lanthorn::program
