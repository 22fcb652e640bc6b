// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A box around the volume of the photon that is this instance.
#include "bsdf.glsl"
#include "photon.glsl"
uniform mat4 to_clip;
uniform uint first_photon;
// The photon, which all corners share: software drivers read buffers separately for each pixel.
flat out vec3 photon_position, photon_normal, photon_power, photon_wi;

// Corners of a strip of twelve triangles, counter-clockwise as seen from outside.
const uint corners[14] = uint[](0u, 1u, 4u, 5u, 7u, 1u, 3u, 0u, 2u, 4u, 6u, 7u, 2u, 3u);

void main() {
  Photon p = fetch_photon(int(first_photon) + gl_InstanceID);
  photon_position = p.position;
  photon_normal = p.normal;
  photon_power = p.power;
  photon_wi = p.wi;
  uint c = corners[gl_VertexID];
  vec3 corner = vec3(c & 1u, c >> 1u & 1u, c >> 2u) * 2 - 1;
  vec3 n = p.normal;
  vec3 s = normalize(abs(n.x) > 0.5 ? vec3(n.y, -n.x, 0) : vec3(0, n.z, -n.y)), t = cross(n, s);
  // A little larger, so that rounding in the rasteriser loses no pixel of the volume.
  vec3 world = p.position + box_enlargement * (radius * (corner.x * s + corner.y * t) + half_height * corner.z * n);
  gl_Position = to_clip * vec4(world, 1);
}
