// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Ranges of passes: splits a render into parts for separate jobs, finds passes that are missing or double, prints
// ranges.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lanthorn/render_options.h"

namespace lanthorn::program {

/// Splits the passes into `count` ranges whose sizes differ by at most one.
std::vector<PassRange> split_passes(std::uint64_t passes, std::uint64_t count);

/// Passes of `expected` that the states lack, and passes that several states have.
struct PassCheck {
  std::vector<PassRange> missing, doubled;
};
PassCheck check_passes(const PassRange& expected, const std::vector<PassRange>& passes);

/// "0:25, 75:100"
std::string ranges_text(const std::vector<PassRange>& ranges);

}  // namespace lanthorn::program
