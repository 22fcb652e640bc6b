// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

namespace lanthorn {

/// A point and a radius (m).
struct Ball {
  Point centre;
  float radius;
};

}  // namespace lanthorn
