// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// SIMD vectors of floats, by the vector extension of GCC and Clang.
#pragma once

#include <cstddef>

#include "math/vec.h"

namespace lanthorn {

#ifdef __AVX__
inline constexpr std::size_t simd_width = 8;
#else
inline constexpr std::size_t simd_width = 4;
#endif
using SimdFloat = float __attribute__((vector_size(simd_width * sizeof(float))));
/// Of a comparison: -1 in lanes where it is true, else 0.
using SimdMask = int __attribute__((vector_size(simd_width * sizeof(int))));

struct SimdVec3 {
  SimdFloat x, y, z;
};

inline SimdFloat dot(const Vec3& a, const SimdVec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline SimdFloat dot(const SimdVec3& a, const SimdVec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline SimdFloat absolute(const SimdFloat& v) { return v < 0 ? -v : v; }

}  // namespace lanthorn
