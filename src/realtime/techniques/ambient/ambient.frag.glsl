// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A constant instead of indirect light.
#include "shade.glsl"
uniform vec3 ambient;  // irradiance, W/m²

vec3 shade(ivec2 pixel, Surface at, vec3 wi) { return at.colour.rgb / pi * ambient; }
