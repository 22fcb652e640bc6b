// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "texture/texture_format.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace lanthorn {

namespace {

constexpr std::size_t guesses = 4096;

// Well mixed bits of x (Wang 2007's finaliser, in the form of O'Neill 2014, "PCG", RXS-M-XS 32).
std::uint32_t mixed_bits(std::uint32_t x) {
  x = x * 747796405u + 2891336453u;
  x = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
  return (x >> 22u) ^ x;
}

}  // namespace

int all_levels_of(const TextureFormat& format) {
  if (format.is_8_bit && !std::is_sorted(format.decode.begin(), format.decode.end())) return 1;
  int levels = 1;
  while (level_size(std::max(format.width, format.height), levels - 1) > 1) ++levels;
  return levels;
}

std::size_t texels_of_levels(int width, int height, int levels) {
  std::size_t sum = 0;
  for (int level = 0; level < levels; ++level)
    sum += static_cast<std::size_t>(level_size(width, level)) * static_cast<std::size_t>(level_size(height, level));
  return sum;
}

LevelMaker::LevelMaker(const TextureFormat& format, int levels, TakeRow take)
    : format_(format), levels_(static_cast<std::size_t>(levels)), take_(std::move(take)) {
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = levels_[i];
    level.width = level_size(format.width, static_cast<int>(i));
    level.height = level_size(format.height, static_cast<int>(i));
    if (i + 1 == levels_.size()) continue;
    level.upper.resize(static_cast<std::size_t>(level.width) * format.texel_bytes());
    level.coarser.resize(static_cast<std::size_t>((level.width + 1) / 2) * format.texel_bytes());
  }
  if (!format.is_8_bit || levels < 2) return;
  first_guess_.resize(guesses + 1);
  const auto& decode = format.decode;
  for (std::size_t i = 0; i <= guesses; ++i) {
    const float value = decode.front() + (decode.back() - decode.front()) * (static_cast<float>(i) / guesses);
    const auto above = std::upper_bound(decode.begin(), decode.end(), value) - decode.begin();
    first_guess_[i] = static_cast<std::uint8_t>(std::clamp<std::ptrdiff_t>(above - 2, 0, 254));
  }
}

void LevelMaker::add(std::size_t i, const std::byte* row) {
  Level& level = levels_[i];
  const int y = level.rows++;
  take_(static_cast<int>(i), y, row);
  if (i + 1 == levels_.size()) return;
  const bool is_last = level.rows == level.height;
  if (y % 2 == 0 && !is_last) {
    std::memcpy(level.upper.data(), row, level.upper.size());
    return;
  }
  halve(i, y % 2 == 0 ? row : level.upper.data(), row);
  add(i + 1, level.coarser.data());
}

// Encodes a value as the sample below or the one above it, with probabilities such that the mean is the value.
std::uint8_t LevelMaker::encoded(float value, int channel, float u) const {
  if (format_.is_alpha(channel)) return static_cast<std::uint8_t>(std::min(255.0f, std::floor(value * 255.0f + u)));
  const auto& decode = format_.decode;
  const float range = decode.back() - decode.front();
  if (!(range > 0)) return 0;
  const float place = std::clamp((value - decode.front()) / range, 0.0f, 1.0f) * guesses;
  std::size_t sample = first_guess_[static_cast<std::size_t>(place)];
  while (sample < 254 && decode[sample + 1] <= value) ++sample;
  const float step = decode[sample + 1] - decode[sample];
  return static_cast<std::uint8_t>(step > 0 && u * step < value - decode[sample] ? sample + 1 : sample);
}

void LevelMaker::halve(std::size_t i, const std::byte* upper, const std::byte* lower) {
  Level& level = levels_[i];
  const auto stride = static_cast<std::size_t>(format_.channels);
  const auto width = static_cast<std::size_t>(level.width), half = (width + 1) / 2;
  // Each level and row has its own random numbers.
  const std::uint32_t seed =
      mixed_bits((static_cast<std::uint32_t>(i) << 27) ^ static_cast<std::uint32_t>(levels_[i + 1].rows));
  for (std::size_t x = 0; x < half; ++x) {
    const std::size_t left = 2 * x * stride, right = std::min(2 * x + 1, width - 1) * stride;
    for (std::size_t c = 0; c < stride; ++c) {
      const auto mean = [&](const auto& value) {
        return 0.25f * ((value(upper, left + c) + value(upper, right + c)) +
                        (value(lower, left + c) + value(lower, right + c)));
      };
      const std::size_t to = x * stride + c;
      const int channel = static_cast<int>(c);
      if (format_.is_8_bit) {
        const float exact = mean([&](const std::byte* row, std::size_t at) {
          return format_.value_8_bit(static_cast<std::uint8_t>(row[at]), channel);
        });
        const float u = static_cast<float>(mixed_bits(seed ^ static_cast<std::uint32_t>(4 * x + c)) >> 8) * 0x1p-24f;
        level.coarser[to] = static_cast<std::byte>(encoded(exact, channel, u));
      } else {
        const float exact = mean([](const std::byte* row, std::size_t at) {
          float value = 0;
          std::memcpy(&value, row + at * sizeof value, sizeof value);
          return value;
        });
        std::memcpy(level.coarser.data() + to * sizeof exact, &exact, sizeof exact);
      }
    }
  }
}

}  // namespace lanthorn
