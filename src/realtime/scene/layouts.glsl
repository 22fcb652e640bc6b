// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Structs in buffers that C++ and shaders share, after scene/constants.glsl. This text is valid in both languages
// (realtime/scene/layouts.h).

// Corner of a triangle in the space of its instance.
struct Vertex {
  vec3 position;
  float u;
  vec3 normal;  // shading, not normalised; 0: that of the triangle
  float v;
};

// A material in RGB mode.
struct Material {
  vec4 colour;    // reflectance of the diffuse base; a: GGX width
  vec4 through;   // transmittance of diffuse materials; eta of metals; f0 of others
  vec4 specular;  // k of metals; r: f90 of others
  uint kind;      // kind_diffuse ...
  uint flags;     // flag_exact ...
  uint layer;     // of the surface textures
  uint unused;
};

// A placed mesh.
struct Draw {
  mat4 to_world;
  mat4 normal_to_world;  // inverse transpose
  vec4 emission;         // radiance of emitters, W/(m² sr); a: 1 if both sides emit
  uint material;
  uint first_index;
  uint base_vertex;
  float slack;  // largest distance of the triangles from the true surface, m
  uint index_count;
  uint layer;        // of the surface textures: emission as a share of `emission`, opacity
  uint mesh;         // of the scene's model
  uint first_light;  // of the scene, if the mesh emits
};
