// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A render in parts that separate jobs make.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lanthorn/render_options.h"

namespace lanthorn::program {

/// The passes in `count` ranges that differ by one pass at most.
std::vector<PassRange> split_passes(std::uint64_t passes, std::uint64_t count);

/// What states with these passes lack of `expected`, and which passes several have.
struct PassCheck {
  std::vector<PassRange> missing, doubled;
};
PassCheck check_passes(const PassRange& expected, const std::vector<PassRange>& passes);

/// "0:25, 75:100"
std::string ranges_text(const std::vector<PassRange>& ranges);

}  // namespace lanthorn::program
