// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace lanthorn {

using ViewerClock = std::chrono::steady_clock;

inline double seconds_since(ViewerClock::time_point start) {
  return std::chrono::duration<double>(ViewerClock::now() - start).count();
}

}  // namespace lanthorn
