// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/parallel_sort.h>

namespace lanthorn {

/// Sorts values in parallel. They must be distinct, so that the result does not depend on the threads.
template <class Values>
void parallel_sort(Values& values) {
  tbb::parallel_sort(values.begin(), values.end());
}

}  // namespace lanthorn
