// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "lanthorn/statistics.h"

namespace lanthorn {

/// A sum to which several threads add.
class SharedRayCounts {
 public:
  void add(const RayCounts& counts) {
    walk_ += counts.walk;
    shadow_ += counts.shadow;
    spared_ += counts.spared;
  }
  RayCounts sum() const { return {walk_, shadow_, spared_}; }

 private:
  std::atomic<std::uint64_t> walk_{0}, shadow_{0}, spared_{0};
};

}  // namespace lanthorn
