// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A room that exercises many features, for tests of what all integrators have in common.
#pragma once

namespace lanthorn::test {

/// Clear glass, a rough coat, rough metal, a textured wall, fog, three kinds of light, motion and a thin lens: anything
/// that could draw random numbers from a wrong stream.
inline const char* const varied_room = R"(
TransformTimes 0 1
LookAt 0 1 4.4  0 1 0  0 1 0
Camera "perspective" "float fov" [36] "float lensradius" [0.05] "float focaldistance" [4] "float shutteropen" [0] "float shutterclose" [1]
Film "rgb" "integer xresolution" [40] "integer yresolution" [30]
PixelFilter "mitchell"
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [17 12 4]
  Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-0.25 1.99 -0.25 0.25 1.99 -0.25 0.25 1.99 0.25 -0.25 1.99 0.25]
AttributeEnd
LightSource "point" "rgb I" [0.6 0.5 0.4] "point3 from" [-0.6 1.6 0.3]
LightSource "infinite" "rgb L" [0.1 0.1 0.2]
Texture "checks" "spectrum" "checkerboard" "rgb tex1" [0.8 0.8 0.8] "rgb tex2" [0.1 0.2 0.5] "float uscale" [6] "float vscale" [6]
Material "diffuse" "texture reflectance" "checks"
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 0 -1 1 0 -1 1 2 -1 -1 2 -1]
AttributeBegin
  Material "dielectric" "spectrum eta" "glass-F11"
  Translate 0.42 0.4 0.3
  Shape "sphere" "float radius" [0.4]
AttributeEnd
AttributeBegin
  ActiveTransform StartTime
  Translate -0.4 0.4 -0.35
  ActiveTransform EndTime
  Translate -0.4 0.6 -0.35
  ActiveTransform All
  Material "coateddiffuse" "rgb reflectance" [0.2 0.3 0.6] "float roughness" [0.1]
  Shape "sphere" "float radius" [0.4]
AttributeEnd
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [0.1 0.3 0.2] "rgb sigma_s" [1 2 3] "float g" [0.4]
AttributeBegin
  MediumInterface "fog" ""
  Material "interface"
  Translate 0.5 1.3 0.2
  Shape "sphere" "float radius" [0.3]
AttributeEnd
AttributeBegin
  Material "conductor" "float roughness" [0.1]
  Translate 0 1.4 -0.5
  Shape "sphere" "float radius" [0.3]
AttributeEnd
)";

}  // namespace lanthorn::test
