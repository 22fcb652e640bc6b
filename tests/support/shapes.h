// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Directives of simple shapes. `corners`: four points, twelve numbers.
#pragma once

#include <string>

namespace lanthorn::test {

/// A flat quadrilateral made of two triangles; corners in order around it.
inline std::string quad(const std::string& corners) {
  return R"(Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [)" + corners + "]\n";
}
/// A bilinear patch; corners row by row.
inline std::string patch(const std::string& corners) {
  return R"(Shape "bilinearmesh" "point3 P" [)" + corners + "]\n";
}

}  // namespace lanthorn::test
