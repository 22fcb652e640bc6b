// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Eight floats that are processed together: by AVX2 where the build has it, else by loops that the compiler vectorises.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "math/vec.h"

namespace lanthorn {

/// A truth value in each lane.
struct LaneMask {
#ifdef __AVX2__
  __m256 v;  ///< all bits of a lane, or none

  friend LaneMask operator&(LaneMask a, LaneMask b) { return {_mm256_and_ps(a.v, b.v)}; }
  friend LaneMask operator~(LaneMask a) { return {_mm256_xor_ps(a.v, _mm256_castsi256_ps(_mm256_set1_epi32(-1)))}; }
#else
  std::uint32_t bits;  ///< one for each lane

  friend LaneMask operator&(LaneMask a, LaneMask b) { return {a.bits & b.bits}; }
  friend LaneMask operator~(LaneMask a) { return {~a.bits}; }
#endif
};

class Lanes {
 public:
  static constexpr std::uint32_t width = 8;

#ifdef __AVX2__
  Lanes(float all) : v_(_mm256_set1_ps(all)) {}  // implicit, so that numbers mix with lanes
  explicit Lanes(const std::array<float, width>& from) : v_(_mm256_loadu_ps(from.data())) {}
  explicit Lanes(const std::array<std::uint8_t, width>& from)
      : v_(_mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from.data()))))) {}
  explicit Lanes(const std::array<std::uint16_t, width>& from)
      : v_(_mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from.data()))))) {}
  std::array<float, width> stored() const {
    std::array<float, width> to;
    _mm256_storeu_ps(to.data(), v_);
    return to;
  }

  friend Lanes operator+(Lanes a, Lanes b) { return _mm256_add_ps(a.v_, b.v_); }
  friend Lanes operator-(Lanes a, Lanes b) { return _mm256_sub_ps(a.v_, b.v_); }
  friend Lanes operator*(Lanes a, Lanes b) { return _mm256_mul_ps(a.v_, b.v_); }
  friend Lanes operator/(Lanes a, Lanes b) { return _mm256_div_ps(a.v_, b.v_); }
  friend Lanes min(Lanes a, Lanes b) { return _mm256_min_ps(a.v_, b.v_); }
  friend Lanes max(Lanes a, Lanes b) { return _mm256_max_ps(a.v_, b.v_); }
  friend Lanes abs(Lanes a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v_); }
  friend LaneMask operator<(Lanes a, Lanes b) { return {_mm256_cmp_ps(a.v_, b.v_, _CMP_LT_OQ)}; }
  friend LaneMask operator<=(Lanes a, Lanes b) { return {_mm256_cmp_ps(a.v_, b.v_, _CMP_LE_OQ)}; }
  /// `a` in the lanes of the mask, `b` in the others.
  friend Lanes select(LaneMask mask, Lanes a, Lanes b) { return _mm256_blendv_ps(b.v_, a.v_, mask.v); }
  /// Bit i is set unless lane i of `a` is greater than that of `b`.
  friend std::uint32_t not_greater(Lanes a, Lanes b) {
    return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a.v_, b.v_, _CMP_NGT_UQ)));
  }

 private:
  Lanes(__m256 v) : v_(v) {}

  __m256 v_;
#else
  Lanes(float all) { v_.fill(all); }
  explicit Lanes(const std::array<float, width>& from) : v_(from) {}
  template <class Whole>
  explicit Lanes(const std::array<Whole, width>& from) {
    for (std::uint32_t i = 0; i < width; ++i) v_[i] = static_cast<float>(from[i]);
  }
  const std::array<float, width>& stored() const { return v_; }

  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return per_lane(a, b, [](float x, float y) { return x + y; });
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return per_lane(a, b, [](float x, float y) { return x - y; });
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return per_lane(a, b, [](float x, float y) { return x * y; });
  }
  friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return per_lane(a, b, [](float x, float y) { return x / y; });
  }
  friend Lanes min(const Lanes& a, const Lanes& b) {
    return per_lane(a, b, [](float x, float y) { return x < y ? x : y; });
  }
  friend Lanes max(const Lanes& a, const Lanes& b) {
    return per_lane(a, b, [](float x, float y) { return x > y ? x : y; });
  }
  friend Lanes abs(const Lanes& a) {
    return per_lane(a, a, [](float x, float) { return std::fabs(x); });
  }
  friend LaneMask operator<(const Lanes& a, const Lanes& b) {
    return {bits_of(a, b, [](float x, float y) { return x < y; })};
  }
  friend LaneMask operator<=(const Lanes& a, const Lanes& b) {
    return {bits_of(a, b, [](float x, float y) { return x <= y; })};
  }
  /// `a` in the lanes of the mask, `b` in the others.
  friend Lanes select(LaneMask mask, const Lanes& a, const Lanes& b) {
    Lanes result(b);
    for (std::uint32_t i = 0; i < width; ++i)
      if ((mask.bits >> i & 1u) != 0) result.v_[i] = a.v_[i];
    return result;
  }
  /// Bit i is set unless lane i of `a` is greater than that of `b`.
  friend std::uint32_t not_greater(const Lanes& a, const Lanes& b) {
    return bits_of(a, b, [](float x, float y) { return !(x > y); });
  }

 private:
  template <class Function>
  static Lanes per_lane(const Lanes& a, const Lanes& b, Function&& f) {
    Lanes result(0.0f);
    for (std::uint32_t i = 0; i < width; ++i) result.v_[i] = f(a.v_[i], b.v_[i]);
    return result;
  }
  template <class Test>
  static std::uint32_t bits_of(const Lanes& a, const Lanes& b, Test&& test) {
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < width; ++i) bits |= static_cast<std::uint32_t>(test(a.v_[i], b.v_[i])) << i;
    return bits;
  }

  std::array<float, width> v_;
#endif
};

/// Three coordinates in eight lanes.
struct LaneVec3 {
  Lanes x, y, z;

  friend LaneVec3 operator+(const LaneVec3& a, const LaneVec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend LaneVec3 operator-(const LaneVec3& a, const LaneVec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend LaneVec3 operator*(Lanes s, const LaneVec3& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend LaneVec3 abs(const LaneVec3& a) { return {abs(a.x), abs(a.y), abs(a.z)}; }
  friend Lanes dot(const LaneVec3& a, const LaneVec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend LaneVec3 cross(const LaneVec3& a, const LaneVec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

/// Coordinates of eight points, in memory.
struct StoredVec3 {
  alignas(32) std::array<std::array<float, Lanes::width>, 3> axis;

  LaneVec3 load() const { return {Lanes(axis[0]), Lanes(axis[1]), Lanes(axis[2])}; }
  Point lane(std::uint32_t lane) const { return {axis[0][lane], axis[1][lane], axis[2][lane]}; }
  void set(std::uint32_t lane, const Point& p) { axis[0][lane] = p.x, axis[1][lane] = p.y, axis[2][lane] = p.z; }
};

}  // namespace lanthorn
