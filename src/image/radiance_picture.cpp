// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// G. Ward, "Real Pixels", Graphics Gems II, 1991, and the reference manual of Radiance, "File Formats" (picture files).
#include "image/own_formats.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <vector>

namespace lanthorn {

namespace {

constexpr std::string_view ends_early = "ends before its last line";

[[noreturn]] void fail_picture(std::string_view problem) { throw std::runtime_error(std::string(problem)); }

/// Three mantissas and an exponent, or a run-length code in their place.
using Rgbe = std::array<unsigned char, 4>;

/// Reads a file from front to back.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  unsigned char byte() { return static_cast<unsigned char>(take(1).front()); }
  std::string_view take(std::size_t count) {
    if (count > rest_.size()) fail_picture(ends_early);
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  Rgbe rgbe() {
    const std::string_view four = take(4);
    Rgbe result{};
    for (std::size_t i = 0; i < 4; ++i) result[i] = static_cast<unsigned char>(four[i]);
    return result;
  }
  std::string_view line() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) fail_picture("its header has no end");
    const std::string_view line = take(end);
    take(1);
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
  }

 private:
  std::string_view rest_;
};

/// An axis of the resolution line: "-Y 512" means 512 rows, downwards.
struct Axis {
  char name = 0;
  bool decreasing = false;
  int count = 0;
};

/// The resolution line: scanlines follow one another along `slow`, the pixels of one along `fast`.
struct Resolution {
  Axis slow, fast;
};

Resolution parse_resolution(std::string_view line) {
  const auto axis = [&] {
    Axis result;
    if (line.size() < 3 || (line[0] != '+' && line[0] != '-') || (line[1] != 'X' && line[1] != 'Y') || line[2] != ' ')
      fail_picture("has no resolution line after its header");
    result.decreasing = line[0] == '-';
    result.name = line[1];
    line.remove_prefix(3);
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), result.count);
    if (error != std::errc() || result.count < 1) fail_picture("has a resolution that is not a number above 0");
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    return result;
  };
  Resolution resolution;
  resolution.slow = axis();
  if (line.starts_with(' ')) line.remove_prefix(1);
  resolution.fast = axis();
  if (!line.empty() || resolution.slow.name == resolution.fast.name)
    fail_picture("has a resolution line without width and height");
  return resolution;
}

std::array<float, 8> parse_primaries(std::string_view text) {
  std::array<float, 8> primaries{};
  for (float& number : primaries) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) fail_picture("has PRIMARIES that are not eight numbers");
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  return primaries;
}

struct Header {
  Resolution resolution;
  std::optional<std::array<float, 8>> primaries;
};

// Ignores the header's other variables (EXPOSURE, COLORCORR, …), as other programs do that use these files for
// lighting.
Header read_header(ByteReader& in) {
  constexpr std::string_view format = "FORMAT=", primaries = "PRIMARIES=";
  Header header;
  for (std::string_view line = in.line(); !line.empty(); line = in.line()) {
    if (line.starts_with(format) && line.substr(format.size()) != "32-bit_rle_rgbe")
      fail_picture("holds pixels that are not 32-bit_rle_rgbe");
    if (line.starts_with(primaries)) header.primaries = parse_primaries(line.substr(primaries.size()));
  }
  header.resolution = parse_resolution(in.line());
  return header;
}

// Components one after another, each in runs: n <= 128 literal bytes, or the next byte n - 128 times.
void read_components(ByteReader& in, std::vector<Rgbe>& line) {
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t i = 0; i < line.size();) {
      const unsigned code = in.byte(), count = code > 128 ? code - 128 : code;
      if (count == 0 || count > line.size() - i) fail_picture("holds a run that is longer than its line");
      if (code > 128) {
        const unsigned char value = in.byte();
        for (const std::size_t end = i + count; i < end; ++i) line[i][c] = value;
      } else {
        for (const char value : in.take(count)) line[i++][c] = static_cast<unsigned char>(value);
      }
    }
}

// Pixels one after another. Mantissas 1, 1, 1 repeat the previous pixel as often as the fourth byte says; consecutive
// repeat codes form one number, least significant byte first.
void read_pixels(ByteReader& in, const Rgbe& first, std::vector<Rgbe>& line) {
  Rgbe pixel = first;
  unsigned shift = 0;
  for (std::size_t i = 0; i < line.size();) {
    if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
      const std::size_t count = shift < 32 ? std::size_t{pixel[3]} << shift : line.size();
      if (i == 0 || count > line.size() - i) fail_picture("holds a run that is longer than its line");
      for (const std::size_t end = i + count; i < end; ++i) line[i] = line[i - 1];
      shift += 8;
    } else {
      line[i++] = pixel;
      shift = 0;
    }
    if (i < line.size()) pixel = in.rgbe();
  }
}

void read_scanline(ByteReader& in, std::vector<Rgbe>& line) {
  constexpr std::size_t shortest = 8, longest = 0x7FFF;  // of lines stored by component
  const Rgbe first = in.rgbe();
  const bool by_component =
      line.size() >= shortest && line.size() <= longest && first[0] == 2 && first[1] == 2 && (first[2] & 0x80) == 0;
  if (!by_component) return read_pixels(in, first, line);
  if ((std::size_t{first[2]} << 8 | first[3]) != line.size()) fail_picture("has a line of a different length");
  read_components(in, line);
}

std::array<float, 256> factors_of_exponents() {
  std::array<float, 256> factors{};
  constexpr int bias = 128, mantissa_bits = 8;
  for (int e = 1; e < 256; ++e) factors[static_cast<std::size_t>(e)] = std::ldexp(1.0f, e - bias - mantissa_bits);
  return factors;
}

void read_colors(ByteReader in, const Resolution& resolution, std::size_t channels, float* colors) {
  static const std::array<float, 256> factors = factors_of_exponents();
  const auto& [slow, fast] = resolution;
  const auto width = static_cast<std::ptrdiff_t>(slow.name == 'Y' ? fast.count : slow.count);
  // Step from one pixel of the file to the next, in pixels of the picture, whose rows go from the top: X increases, Y
  // decreases.
  const auto step_along = [&](const Axis& axis) {
    return axis.name == 'X' ? (axis.decreasing ? -1 : 1) : axis.decreasing ? width : -width;
  };
  const auto start_along = [&](const Axis& axis) {
    const std::ptrdiff_t step = step_along(axis);
    return step < 0 ? -step * (axis.count - 1) : 0;
  };
  std::ptrdiff_t start = start_along(slow) + start_along(fast);
  std::vector<Rgbe> line(static_cast<std::size_t>(fast.count));
  for (int i = 0; i < slow.count; ++i, start += step_along(slow)) {
    read_scanline(in, line);
    std::ptrdiff_t at = start;
    for (const Rgbe& pixel : line) {
      float* const color = colors + static_cast<std::size_t>(at) * channels;
      for (std::size_t c = 0; c < channels; ++c) color[c] = static_cast<float>(pixel[c]) * factors[pixel[3]];
      at += step_along(fast);
    }
  }
}

}  // namespace

OpenImage open_radiance_picture(std::string_view bytes) {
  ByteReader in(bytes);
  const auto [resolution, primaries] = read_header(in);
  OpenImage image;
  ImageHeader& header = image.header;
  const bool by_rows = resolution.slow.name == 'Y';
  header.width = by_rows ? resolution.fast.count : resolution.slow.count;
  header.height = by_rows ? resolution.slow.count : resolution.fast.count;
  header.window = {0, 0, header.width, header.height};
  header.channels = {"R", "G", "B"};
  header.pixel_bytes = 3 * sizeof(float);
  header.chromaticities = primaries;
  image.read = [in, resolution = resolution](int channels, SampleType /*float32*/, void* pixels) {
    read_colors(in, resolution, static_cast<std::size_t>(channels), static_cast<float*>(pixels));
  };
  return image;
}

}  // namespace lanthorn
