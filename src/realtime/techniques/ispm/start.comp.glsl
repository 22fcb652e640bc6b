// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons at the texels of the bounce maps, drawn by importance. The closures that the GPU knows scatter them; the others
// are left to the CPU.
#include "bounce.glsl"
#include "frame.glsl"
#include "random.glsl"
layout(local_size_x = work_group) in;
layout(std430, binding = storage_photon_starts) writeonly buffer PhotonStarts { PhotonStart starts[]; };
uniform int view_count;
uniform uint photon_count;
uniform uvec3 key;  // of the random numbers: seed, seed, frame

vec4 uniform_numbers(uint photon, uint salt) {
  uvec4 bits = pcg4d(uvec4(photon, key.x ^ salt, key.y, key.z));
  return vec4(bits >> 8u) / 16777216.0;
}

// Smallest index in [first, last] whose sum exceeds the value.
uint find_row(uint first, uint last, float value) {
  while (first < last) {
    uint middle = (first + last) / 2u;
    if (row_sums[middle] > value) last = middle;
    else first = middle + 1u;
  }
  return first;
}
uint find_texel(uint first, uint last, float value) {
  while (first < last) {
    uint middle = (first + last) / 2u;
    if (texel_sums[middle] > value) last = middle;
    else first = middle + 1u;
  }
  return first;
}

vec3 cosine_hemisphere(vec2 u) {
  float r = sqrt(u.x), phi = 2 * pi * u.y;
  return vec3(r * cos(phi), r * sin(phi), sqrt(max(0, 1 - u.x)));
}
// A normal visible from w (Dupuy & Benyoub 2023, listing 3), for one width.
vec3 visible_normal(vec3 w, float alpha, vec2 u) {
  vec3 v = normalize(vec3(alpha * w.xy, w.z));
  float phi = 2 * pi * u.x, z = (1 - u.y) * (1 + v.z) - v.z, r = sqrt(max(0, 1 - z * z));
  vec3 h = vec3(r * cos(phi), r * sin(phi), z) + v;
  return normalize(vec3(alpha * h.xy, max(h.z, 1e-9)));
}

// Reflected direction, world, and f |cos| / pdf; a: 0 if the light is lost.
struct Scattered {
  vec3 direction;
  vec3 weight;
  bool exists;
};

Scattered scatter_diffuse(Material m, Surface at, mat3 frame, float side, vec4 u) {
  float r = max(at.colour.r, max(at.colour.g, at.colour.b)), t = max(m.through.r, max(m.through.g, m.through.b));
  float p = r + t > 0 ? r / (r + t) : 0;
  bool reflects = u.z < p;
  vec3 local = cosine_hemisphere(u.xy);
  local.z *= reflects ? side : -side;
  vec3 weight = reflects ? at.colour.rgb / p : m.through.rgb / (1 - p);
  return Scattered(frame * local, weight, r + t > 0 && local.z != 0);
}

Scattered scatter_metal(Material m, Surface at, mat3 frame, vec3 local_in, float side, vec4 u) {
  vec3 i = side * local_in;
  float alpha = at.colour.a;
  vec3 normal = visible_normal(i, alpha, u.xy);
  float cos_m = dot(i, normal);
  vec3 o = 2 * cos_m * normal - i;
  if (cos_m <= 0 || o.z <= 0) return Scattered(vec3(0), vec3(0), false);
  float li = stretched(i.z, alpha), lo = stretched(o.z, alpha);
  float g_over_g1 = o.z * (i.z + li) / (o.z * li + i.z * lo);
  return Scattered(frame * (side * o), fresnel_conductor(cos_m, m.through.rgb, m.specular.rgb) * g_over_g1, true);
}

Scattered scatter(Surface at, vec3 back, vec4 u) {
  Material m = at.material;
  mat3 frame = frame_around(at.normal);
  vec3 local_in = back * frame;
  float side = local_in.z < 0 ? -1.0 : 1.0;
  return m.kind == kind_metal ? scatter_metal(m, at, frame, local_in, side, u)
                              : scatter_diffuse(m, at, frame, side, u);
}

// The GPU scatters at flat triangles of the true surface, by closures that it samples.
bool scatters_here(Surface at) {
  Material m = at.material;
  return (m.flags & flag_exact) != 0u && (m.flags & flag_textured) == 0u && m.kind != kind_plastic &&
         dot(at.normal, at.facing) > 0.99999;
}

PhotonStart start_of(uint photon, int i, uint first, uint count) {
  PhotonStart none = PhotonStart(vec3(0), start_none, vec3(0), 0, vec3(0), 0u);
  LightView v = views[i];
  int size = textureSize(l_position, 0).x;
  uint first_row = v.maps.x * size, last_row = (v.maps.x + v.maps.y) * size - 1u;
  float total = row_sums[last_row];
  if (!(total > 0)) return none;
  vec4 u = uniform_numbers(photon, 0x9e3779b9u);
  float value = (float(photon - first) + u.x) / float(count) * total;
  uint row = find_row(first_row, last_row, value);
  float before = row > first_row ? row_sums[row - 1u] : 0;
  uint texel = find_texel(row * size, (row + 1u) * size - 1u, value - before);
  ivec3 at_texel = ivec3(texel - row * size, row % size, row / size);
  float own = texel_sums[texel] - (texel > row * size ? texel_sums[texel - 1u] : 0);
  if (!(own > 0)) return none;
  Window window = window_of(i, uint(at_texel.z) - v.maps.x, size);
  vec3 power = flux_of(v, window, at_texel.xy, size) * (total / (own * float(count)));
  vec3 flight = direction_of(v, window, at_texel.xy, size);
  Surface at = surface_in(at_texel);
  uint normal = encode_octahedral(at.facing) | 1u;  // never 0
  // Rays may pass where opacity is below 1: the CPU decides which.
  bool is_opaque = texelFetch(l_position, at_texel, 0).a == 1;
  if (!is_opaque || !scatters_here(at))
    return PhotonStart(at.position, start_incident, flight, float(i), power, normal);
  Scattered s = scatter(at, -flight, uniform_numbers(photon, 0x85ebca6bu));
  if (!s.exists) return none;
  return PhotonStart(at.position, start_scattered, s.direction, float(i), power * s.weight, normal);
}

void main() {
  uint photon = gl_GlobalInvocationID.x;
  if (photon >= photon_count) return;
  for (int i = 0; i < view_count; ++i) {
    uint first = views[i].maps.z, count = views[i].maps.w;
    if (photon >= first && photon < first + count) starts[photon] = start_of(photon, i, first, count);
  }
}
