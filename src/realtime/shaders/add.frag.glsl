// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A layer of light that the CPU has found, to be blended into that of the GPU.
layout(binding = 11) uniform sampler2DArray light;
uniform int layer;
layout(location = 0) out vec4 radiance;

void main() { radiance = texelFetch(light, ivec3(gl_FragCoord.xy, layer), 0); }
