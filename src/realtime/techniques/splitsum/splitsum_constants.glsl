// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Numbers and structs that C++ and shaders share. This text is valid in both languages, after scene/layouts.glsl.
const int unit_reflections = unit_of_technique;
const int unit_irradiances = unit_of_technique + 1;
const int unit_brdf_terms = unit_of_technique + 2;
const int unit_bake_source = unit_of_technique;
const int storage_points = storage_of_technique;
const int storage_samples = storage_of_technique + 1;

// As ibl/environment.h and ibl/prefilter.h have them.
struct PointFlux {
  vec4 direction;
  vec4 flux;
};
struct LobeSample {
  vec4 direction;  // local; a: weight
  uvec4 level;     // x: of the source
};
