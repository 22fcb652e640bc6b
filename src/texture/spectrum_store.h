// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "lanthorn/error.h"
#include "lanthorn/scene_description.h"
#include "spectrum/curve.h"

namespace lanthorn {

/// Turns spectrum parameters into curves and owns the tables that they point to.
class SpectrumStore {
 public:
  /// For the role `illuminant`, the result has luminance 1, except that an RGB colour keeps its own luminance. A plain
  /// number c means the RGB colour (c, c, c) of `space`. Throws Error at `location` for unknown names.
  SpectrumCurve curve(const description::SpectrumValue& value, description::SpectrumRole role, ColorSpace space,
                      const SourceLocation& location);

 private:
  const DenseSpectrum* keep(const DenseSpectrum& table) { return &tables_.emplace_back(table); }
  std::deque<DenseSpectrum> tables_;  // a deque, so that addresses are stable
};

}  // namespace lanthorn
