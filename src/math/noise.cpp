// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/noise.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace lanthorn {

namespace {

// Perlin's own permutation of 0 to 255 (Perlin 2002, reference implementation).
constexpr std::array<std::uint8_t, 256> permutation = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

// The twelve edges of a cube, four of them repeated to fill sixteen. Perlin repeats the edges of a tetrahedron; pbrt
// repeats the ones used here, and scenes are made for pbrt's pictures.
constexpr std::array<std::array<float, 3>, 16> gradients = {{{1, 1, 0},
                                                             {-1, 1, 0},
                                                             {1, -1, 0},
                                                             {-1, -1, 0},
                                                             {1, 0, 1},
                                                             {-1, 0, 1},
                                                             {1, 0, -1},
                                                             {-1, 0, -1},
                                                             {0, 1, 1},
                                                             {0, -1, 1},
                                                             {0, 1, -1},
                                                             {0, -1, -1},
                                                             {1, 1, 0},
                                                             {-1, 1, 0},
                                                             {0, 1, -1},
                                                             {0, -1, -1}}};

constexpr float lacunarity = 1.99f;

struct LatticeCoordinate {
  std::uint8_t cell = 0;  ///< modulo 256
  float offset = 0;       ///< in [0, 1)
};
LatticeCoordinate lattice_coordinate(float x) {
  const float floor = std::floor(x);
  return {static_cast<std::uint8_t>(floor - 256 * std::floor(floor / 256)), x - floor};
}

float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }

template <class Shape>
float octave_sum(const Point& p, float roughness, int octaves, Shape shape) {
  float sum = 0, frequency = 1, amplitude = 1;
  for (int i = 0; i < octaves; ++i) {
    sum += amplitude * shape(perlin_noise(frequency * p));
    frequency *= lacunarity;
    amplitude *= roughness;
  }
  return sum;
}

}  // namespace

float perlin_noise(const Point& p) {
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return 0;
  const LatticeCoordinate x = lattice_coordinate(p.x), y = lattice_coordinate(p.y), z = lattice_coordinate(p.z);
  // Dot product of the gradient at a corner of the cell with the offset from that corner.
  const auto corner = [&](unsigned dx, unsigned dy, unsigned dz) {
    const unsigned hx = permutation[(x.cell + dx) & 255u];
    const unsigned hxy = permutation[(hx + y.cell + dy) & 255u];
    const std::array<float, 3>& g = gradients[permutation[(hxy + z.cell + dz) & 255u] & 15u];
    return g[0] * (x.offset - static_cast<float>(dx)) + g[1] * (y.offset - static_cast<float>(dy)) +
           g[2] * (z.offset - static_cast<float>(dz));
  };
  const float wx = fade(x.offset), wy = fade(y.offset);
  const auto plane = [&](unsigned dz) {
    return lerp(wy, lerp(wx, corner(0, 0, dz), corner(1, 0, dz)), lerp(wx, corner(0, 1, dz), corner(1, 1, dz)));
  };
  return lerp(fade(z.offset), plane(0), plane(1));
}

float fbm(const Point& p, float roughness, int octaves) {
  return octave_sum(p, roughness, octaves, [](float noise) { return noise; });
}

float turbulence(const Point& p, float roughness, int octaves) {
  return octave_sum(p, roughness, octaves, [](float noise) { return std::fabs(noise); });
}

}  // namespace lanthorn
