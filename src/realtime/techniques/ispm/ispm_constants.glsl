// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Numbers and structs that C++ and shaders share. This text is valid in both languages, after scene/layouts.glsl.
const int unit_photons = unit_of_technique;
const int unit_tile_begins = unit_of_technique + 1;
const int unit_tile_photons = unit_of_technique + 2;
const int storage_texel_sums = storage_of_technique;
const int storage_row_sums = storage_of_technique + 1;
const int storage_photon_starts = storage_of_technique + 2;

// PhotonStart::state.
const float start_none = 0.0f;
const float start_incident = 1.0f;   // the CPU scatters it
const float start_scattered = 2.0f;  // the GPU has scattered it

// A photon that the GPU has begun.
struct PhotonStart {
  vec3 position;  // world
  float state;
  vec3 direction;  // of flight: arriving if incident, leaving if scattered
  float view;      // its light view
  vec3 power;      // W
  uint normal;     // geometric, of the surface; octahedral, 2 x 16 bits
};

const int tile_side = 8;               // pixels
const float box_enlargement = 1.02f;  // of boxes around photons' volumes, so that rounding loses no pixel of these
