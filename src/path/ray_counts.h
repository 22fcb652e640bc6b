// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "lanthorn/statistics.h"

namespace lanthorn {

/// A sum to which several threads add.
class SharedRayCounts {
 public:
  void add(const RayCounts& counts) {
    const std::lock_guard lock(mutex_);
    sum_ += counts;
  }
  /// To be called when all threads have added their counts.
  const RayCounts& sum() const { return sum_; }

 private:
  std::mutex mutex_;
  RayCounts sum_;
};

}  // namespace lanthorn
