// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lanthorn::test {

/// A room lit only by reflection from a small spot-lit area of a wall.
inline const char* const spotlit_room = R"(
LookAt 0 1 3.4  0 0.9 0  0 1 0
Camera "perspective" "float fov" [42]
Film "rgb" "integer xresolution" [24] "integer yresolution" [24]
PixelFilter "box"
WorldBegin
LightSource "spot" "rgb I" [60 56 48] "point3 from" [-0.7 0.4 0.7] "point3 to" [1 1.6 0.3] "float coneangle" [7] "float conedeltaangle" [2]
Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
Shape "bilinearmesh" "point3 P" [-1 0 -1  1 0 -1  -1 0 4  1 0 4]
Shape "bilinearmesh" "point3 P" [-1 2 -1  1 2 -1  -1 2 4  1 2 4]
Shape "bilinearmesh" "point3 P" [-1 0 -1  1 0 -1  -1 2 -1  1 2 -1]
Shape "bilinearmesh" "point3 P" [-1 0 4  1 0 4  -1 2 4  1 2 4]
Material "diffuse" "rgb reflectance" [0.6 0.15 0.1]
Shape "bilinearmesh" "point3 P" [-1 0 -1  -1 0 4  -1 2 -1  -1 2 4]
Material "diffuse" "rgb reflectance" [0.75 0.75 0.75]
Shape "bilinearmesh" "point3 P" [1 0 -1  1 0 4  1 2 -1  1 2 4]
AttributeBegin
Material "coateddiffuse" "rgb reflectance" [0.2 0.4 0.2] "float roughness" [0.3]
Translate 0.45 0.3 0.2
Shape "sphere" "float radius" [0.3]
AttributeEnd
)";

}  // namespace lanthorn::test
