// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "image/image_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/memory.h"
#include "image/own_formats.h"
#include "lanthorn/text.h"
#include "spectrum/rgb_matrix.h"

namespace lanthorn {

namespace {

using namespace std::string_view_literals;

// Limit for the size of decoded data. Deflate compresses by a factor of at most 1032; other codecs compress flat
// pictures more, but some bound is needed.
constexpr double always_plausible = 256 << 20, largest_ratio = 4096;

struct Kind {
  std::string_view first_bytes;
  const char* format;  // OpenImageIO's name
};
constexpr std::array kinds{
    Kind{"\x76\x2f\x31\x01"sv, "openexr"},
    Kind{"\x89PNG"sv, "png"},
    Kind{"\xff\xd8\xff"sv, "jpeg"},
    Kind{"#?"sv, "hdr"},
    Kind{"II*\0"sv, "tiff"},
    Kind{"MM\0*"sv, "tiff"},
    Kind{"II+\0"sv, "tiff"},
    Kind{"MM\0+"sv, "tiff"},
    Kind{"PF"sv, "pnm"},
    Kind{"Pf"sv, "pnm"},
    Kind{"P1"sv, "pnm"},
    Kind{"P2"sv, "pnm"},
    Kind{"P3"sv, "pnm"},
    Kind{"P4"sv, "pnm"},
    Kind{"P5"sv, "pnm"},
    Kind{"P6"sv, "pnm"},
    Kind{"BM"sv, "bmp"},
    Kind{"GIF8"sv, "gif"},
    Kind{"DDS "sv, "dds"},
    Kind{"8BPS"sv, "psd"},
    Kind{"SDPX"sv, "dpx"},
    Kind{"XPDS"sv, "dpx"},
    Kind{"FOR4"sv, "iff"},
};

// Targa files have no magic number; the header declares a colour map or none, and one of six types (Truevision 1991).
bool may_be_targa(std::string_view bytes) {
  constexpr std::size_t header = 18;
  if (bytes.size() < header) return false;
  const auto byte = [&](std::size_t i) { return static_cast<int>(static_cast<unsigned char>(bytes[i])); };
  const int map = byte(1), type = byte(2) & ~8, depth = byte(16);
  return (map == 0 || map == 1) && type >= 1 && type <= 3 &&
         (depth == 8 || depth == 15 || depth == 16 || depth == 24 || depth == 32);
}

const char* format_of(std::string_view bytes) {
  for (const Kind& kind : kinds)
    if (bytes.starts_with(kind.first_bytes)) return kind.format;
  if (bytes.size() >= 12 && bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP") return "webp";
  return may_be_targa(bytes) ? "targa" : nullptr;
}

std::uint64_t little_endian(std::string_view bytes, std::size_t at, unsigned count) {
  std::uint64_t value = 0;
  for (unsigned i = 0; i < count && at + i < bytes.size(); ++i)
    value |= std::uint64_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return value;
}

// Pixel counts from the headers of formats that OpenImageIO decodes on opening (GIF89a, section 18; RFC 9649).
std::optional<std::uint64_t> announced_pixels(std::string_view bytes, std::string_view format) {
  if (format == "gif") return little_endian(bytes, 6, 2) * little_endian(bytes, 8, 2);
  if (format != "webp") return {};
  const std::string_view chunk = bytes.substr(12, 4);
  constexpr std::uint64_t bits14 = 0x3fff;
  if (chunk == "VP8X") return (little_endian(bytes, 24, 3) + 1) * (little_endian(bytes, 27, 3) + 1);
  if (chunk == "VP8L") {
    const std::uint64_t sizes = little_endian(bytes, 21, 4);
    return ((sizes & bits14) + 1) * ((sizes >> 14 & bits14) + 1);
  }
  return (little_endian(bytes, 26, 2) & bits14) * (little_endian(bytes, 28, 2) & bits14);
}

// A library's error message on one line.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (text.ends_with(' ')) text.pop_back();
  return printable(text);
}

}  // namespace

ImageFile::ImageFile(std::string_view bytes, std::string what, SourceLocation where, std::uint64_t max_pixels)
    : file_size_(bytes.size()), what_(std::move(what)), where_(std::move(where)) {
  open(bytes, max_pixels,
       [&] { return format_ == "hdr" ? open_radiance_picture(bytes) : image_codec().open(bytes, format_.data()); });
}

ImageFile::ImageFile(const std::shared_ptr<std::FILE>& file, std::string what, SourceLocation where,
                     std::uint64_t max_pixels)
    : what_(std::move(what)), where_(std::move(where)) {
  constexpr std::size_t enough_for_headers = 64;
  std::string first(enough_for_headers, '\0');
  first.resize(std::fread(first.data(), 1, first.size(), file.get()));
  if (std::fseek(file.get(), 0, SEEK_END) == 0)
    file_size_ = static_cast<std::size_t>(std::max(0L, std::ftell(file.get())));
  std::rewind(file.get());
  open(first, max_pixels, [&] {
    if (format_ != "hdr") return image_codec().open_file(file, format_.data());
    require_memory(static_cast<double>(file_size_), where_, "the file");
    bytes_.resize(file_size_);
    bytes_.resize(std::fread(bytes_.data(), 1, bytes_.size(), file.get()));
    return open_radiance_picture(bytes_);
  });
}

void ImageFile::open(std::string_view first_bytes, std::uint64_t max_pixels, const std::function<OpenImage()>& open) {
  const char* const format = format_of(first_bytes);
  if (format == nullptr)
    fail("is not a supported image (EXR, PNG, JPEG, HDR, PFM, PNM, TIFF, TGA, WebP, BMP, GIF, DDS, DPX, IFF, PSD)");
  format_ = format;
  if (const auto pixels = announced_pixels(first_bytes, format)) check_pixels(*pixels, 4, max_pixels);
  guarded([&] { image_ = open(); });
  check_header(max_pixels);
  take_colours();
}

void ImageFile::take_colours() {
  const auto& stated = image_.header.chromaticities;
  states_colours_ = stated && *stated != Chromaticities{};
  if (!states_colours_) return;
  to_rec709_ = rec709_from(*stated);
  if (!to_rec709_)
    fail(fmt::format("has chromaticities that no colours can have: {}; expected x and y of red, green, blue and white",
                     fmt::join(*stated, " ")));
  if (*to_rec709_ == RgbMatrix()) to_rec709_.reset();
}

void ImageFile::check_pixels(std::uint64_t pixels, std::uint64_t pixel_bytes, std::uint64_t max_pixels) const {
  if (pixels > max_pixels) fail(fmt::format("has {} pixels, more than the {} of --max-pixels", pixels, max_pixels));
  const double bytes = static_cast<double>(pixels) * static_cast<double>(pixel_bytes);
  if (bytes > always_plausible + largest_ratio * static_cast<double>(file_size_))
    fail(fmt::format("announces {} of pixels, which its {} cannot hold", memory_text(bytes),
                     memory_text(static_cast<double>(file_size_))));
}

void ImageFile::check_header(std::uint64_t max_pixels) const {
  const ImageHeader& header = image_.header;
  if (header.deep) fail("is a deep image, which is not supported");
  if (header.depth > 1) fail("is a volume, not an image");
  if (header.width <= 0 || header.height <= 0 || header.channels.empty()) fail("is empty");
  const std::uint64_t pixels = static_cast<std::uint64_t>(header.width) * static_cast<std::uint64_t>(header.height);
  check_pixels(pixels, header.pixel_bytes, max_pixels);
}

void ImageFile::read(int channels, SampleType as, void* pixels) {
  guarded([&] { image_.read(channels, as, pixels); });
}

void ImageFile::read_rows(int first, int end, int channels, SampleType as, void* pixels) {
  guarded([&] { image_.read_rows(first, end, channels, as, pixels); });
}

void ImageFile::guarded(const std::function<void()>& body) const {
  try {
    body();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    fail("needs more memory than is available");
  } catch (const std::exception& problem) {
    fail("cannot be read: " + one_line(problem.what()));
  }
}

void ImageFile::fail(const std::string& problem) const { throw Error(where_, what_ + " " + problem); }

std::string not_finite(std::int64_t x, std::int64_t y) {
  return fmt::format("its pixel ({}, {}) is infinite or not a number", x, y);
}

}  // namespace lanthorn
