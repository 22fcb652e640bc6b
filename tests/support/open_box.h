// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "support/shapes.h"

namespace lanthorn::test {

/// Scene text up to WorldBegin, for a small picture of the space [-1, 1] x [0, 2] x [-1, 1].
inline const std::string camera =
    R"(LookAt 0 1 4.4  0 1 0  0 1 0
Camera "perspective" "float fov" [36]
Film "rgb" "integer xresolution" [24] "integer yresolution" [24]
PixelFilter "box"
WorldBegin
)";
/// A floor, a back wall, a red wall on the left, and a luminous ball below the position of the ceiling.
inline const std::string box =
    R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [17 12 4]
Translate 0 1.7 0
Shape "sphere" "float radius" [0.2]
AttributeEnd
Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
)" + patch("-1 0 -1  1 0 -1  -1 0 1  1 0 1") +
    patch("-1 0 -1  1 0 -1  -1 2 -1  1 2 -1") +
    R"(Material "diffuse" "rgb reflectance" [0.6 0.1 0.1]
)" + patch("-1 0 1  -1 0 -1  -1 2 1  -1 2 -1");

}  // namespace lanthorn::test
