// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/sampler.h"

#ifdef __SSSE3__
#include <immintrin.h>
#endif

namespace lanthorn {

namespace {

using Lanes = std::array<std::uint32_t, 4>;
// The same four words as one vector, for the compilers' portable vector arithmetic.
using Vector = std::uint32_t __attribute__((vector_size(16)));
using Signed = std::int32_t __attribute__((vector_size(16)));
using Floats = float __attribute__((vector_size(16)));

template <class Word>
constexpr Word reverse_bits(Word x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}

#ifdef __SSSE3__
// Reverses the bytes of each word, and the bits of each byte by two tables of 16 entries.
Vector reverse_bits(Vector x) {
  const auto words = std::bit_cast<__m128i>(x);
  const __m128i bytes = _mm_shuffle_epi8(words, _mm_set_epi8(12, 13, 14, 15, 8, 9, 10, 11, 4, 5, 6, 7, 0, 1, 2, 3));
  const __m128i nibble = _mm_set1_epi8(15);
  const __m128i reversed = _mm_set_epi8(15, 7, 11, 3, 13, 5, 9, 1, 14, 6, 10, 2, 12, 4, 8, 0);
  const __m128i low = _mm_shuffle_epi8(reversed, _mm_and_si128(bytes, nibble));
  const __m128i high = _mm_shuffle_epi8(reversed, _mm_and_si128(_mm_srli_epi16(bytes, 4), nibble));
  return std::bit_cast<Vector>(_mm_or_si128(_mm_slli_epi16(low, 4), high));
}
#endif

// Direction numbers of the first four Sobol' dimensions (Joe & Kuo 2008), most significant bit first.
constexpr std::array<Lanes, 32> direction_numbers() {
  struct Polynomial {
    unsigned degree, a;
    std::array<std::uint32_t, 3> m;
  };
  constexpr std::array<Polynomial, 3> polynomials{{{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}}};
  std::array<Lanes, 32> v{};
  for (unsigned i = 0; i < 32; ++i) v[i][0] = 1u << (31 - i);
  for (unsigned d = 0; d < 3; ++d) {
    const auto& [s, a, m] = polynomials[d];
    for (unsigned i = 0; i < 32; ++i) {
      if (i < s) {
        v[i][d + 1] = m[i] << (31 - i);
        continue;
      }
      std::uint32_t x = v[i - s][d + 1] ^ (v[i - s][d + 1] >> s);
      for (unsigned k = 1; k < s; ++k)
        if ((a >> (s - 1 - k)) & 1u) x ^= v[i - k][d + 1];
      v[i][d + 1] = x;
    }
  }
  return v;
}

// For each byte of the bit-reversed index and each of its values, the four bit-reversed coordinates; a point is the XOR
// of four entries. Index and coordinates are bit-reversed because scrambling works from the lowest bit up.
constexpr std::array<std::array<Lanes, 256>, 4> make_tables() {
  constexpr auto v = direction_numbers();
  std::array<std::array<Lanes, 256>, 4> tables{};
  for (unsigned byte = 0; byte < 4; ++byte)
    for (unsigned value = 1; value < 256; ++value) {
      const unsigned low = value & (~value + 1);  // lowest set bit: the rest was tabulated before
      unsigned bit = 0;
      while (!((low >> bit) & 1u)) ++bit;
      for (unsigned d = 0; d < 4; ++d)
        tables[byte][value][d] = tables[byte][value ^ low][d] ^ reverse_bits(v[31 - (8 * byte + bit)][d]);
    }
  return tables;
}
alignas(64) constexpr auto tables = make_tables();

// Permutation in the style of Laine & Karras (2011) with Burley's constants: each bit is flipped depending on the lower
// bits alone. On reversed bits this is a nested uniform (Owen) scramble.
template <class Word>
constexpr Word laine_karras(Word x, Word seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return x;
}

}  // namespace

Sampler::Sampler(std::uint64_t key, std::uint32_t index)
    : key_(key), index_(index), reversed_index_(reverse_bits(index)) {}

Sampler Sampler::for_pixel(std::uint64_t seed, Stream stream, std::uint32_t pixel, std::uint32_t pass) {
  return {hash_words({seed, static_cast<std::uint64_t>(stream), pixel}), pass};
}

Sampler Sampler::for_light_path(std::uint64_t seed, Stream stream, std::uint32_t light, std::uint32_t pass,
                                std::uint32_t index) {
  return {hash_words({seed, static_cast<std::uint64_t>(stream), light, pass}), index};
}

Sampler Sampler::for_pass(std::uint64_t seed, std::uint32_t pass) {
  return {hash_words({seed, static_cast<std::uint64_t>(Stream::pass)}), pass};
}

void Sampler::draw_group(std::uint32_t group) {
  Group& values = values_[group % 2];
  const std::uint64_t group_key = mix_bits(key_ + 0x9e3779b97f4a7c15ull * (group + 1));
  if (group >= sobol_groups) {
    const std::uint64_t a = mix_bits(group_key ^ (0xd1342543de82ef95ull * (index_ + 1ull)));
    const std::uint64_t b = mix_bits(a + 0x9e3779b97f4a7c15ull);
    values = {unit_float(static_cast<std::uint32_t>(a)), unit_float(static_cast<std::uint32_t>(a >> 32)),
              unit_float(static_cast<std::uint32_t>(b)), unit_float(static_cast<std::uint32_t>(b >> 32))};
    return;
  }
  const std::uint32_t shuffled = laine_karras(reversed_index_, static_cast<std::uint32_t>(group_key));
  const auto load = [](const Lanes& lanes) { return std::bit_cast<Vector>(lanes); };
  const Vector point = load(tables[0][shuffled & 255u]) ^ load(tables[1][(shuffled >> 8) & 255u]) ^
                       load(tables[2][(shuffled >> 16) & 255u]) ^ load(tables[3][shuffled >> 24]);
  constexpr Vector dimension_keys{0x9e3779b9u, 0x3c6ef372u, 0xdaa66d2bu, 0x78dde6e4u};  // multiples of the golden ratio
  const Vector scrambled =
      reverse_bits(laine_karras(point, dimension_keys ^ static_cast<std::uint32_t>(group_key >> 32)));
  const auto bits = std::bit_cast<Signed>(scrambled >> 8);
  values = std::bit_cast<Group>(__builtin_convertvector(bits, Floats) * 0x1p-24f);
}

void Sampler::draw() {
  const std::uint32_t group = position_ / group_size, even = group & ~1u;
  if (samples_) {
    values_[group % 2] = samples_->group(group);
    drawn_from_ = group * group_size;
    drawn_ = group_size;
    return;
  }
  const bool has_even = drawn_ != 0 && drawn_from_ == even * group_size;
  drawn_from_ = even * group_size;
  drawn_ = (group - even + 1) * group_size;
  if (!has_even) draw_group(even);
  if (group != even) draw_group(group);
}

}  // namespace lanthorn
