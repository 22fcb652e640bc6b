// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "lanthorn/effort_report.h"
#include "path/mis.h"

namespace lanthorn {

/// What an eye path finds and does, for the pilot of `auto`; other renders keep none.
struct EyePathLog {
  struct Contribution {
    float flux;              ///< with its weight (`flux_of`)
    TechniqueSum densities;  ///< behind the weight
    Technique technique;
  };
  std::vector<Contribution> found;
  EyeWork work, short_work;  ///< `short_work`: of these, what a short eye path does, too (`Techniques::goes_on`)

  void count(double EyeWork::*operation, bool is_short) {
    ++(work.*operation);
    if (is_short) ++(short_work.*operation);
  }
};

}  // namespace lanthorn
