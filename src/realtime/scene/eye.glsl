// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Where a frame is seen from.
uniform vec3 eye;
uniform vec4 axis;  // of the view; a: 1 if its rays are parallel

vec3 direction_to_eye(vec3 position) { return axis.a > 0 ? -axis.xyz : normalize(eye - position); }
