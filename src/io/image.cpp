// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/memory.h"
#include "film/display.h"
#include "image/image_codec.h"
#include "image/image_file.h"
#include "image/own_formats.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/text.h"
#include "spectrum/rgb_matrix.h"

namespace lanthorn {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

constexpr std::string_view attribute_prefix = "lanthorn:";

json parse_metadata(const std::string& text) { return text.empty() ? json::object() : json::parse(text); }

std::vector<ImageAttribute> attributes_of(const json& metadata) {
  std::vector<ImageAttribute> attributes;
  for (const auto& member : metadata.items()) {
    const std::string name = std::string(attribute_prefix) + member.key();
    const json& value = member.value();
    const bool small = value.is_number_integer() &&
                       (!value.is_number_unsigned() || value.get<std::uint64_t>() < 1u << 31) &&
                       std::abs(value.get<std::int64_t>()) < std::int64_t{1} << 31;
    if (value.is_string())
      attributes.push_back({name, value.get<std::string>()});
    else if (small)
      attributes.push_back({name, value.get<int>()});
    else if (value.is_number_float())
      attributes.push_back({name, value.get<float>()});
    else
      attributes.push_back({name, value.dump()});
  }
  return attributes;
}

bool is_color_channel(const ImageHeader& header, int channel) {
  return channel != header.alpha_channel && channel != header.z_channel;
}

void decode_srgb(Image& image, const ImageHeader& header) {
  const std::size_t count = image.channel_count();
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (is_color_channel(header, static_cast<int>(i % count))) image.pixels[i] = linear_from_srgb(image.pixels[i]);
}

// Converts each layer of channels R, G, B. Other channels, such as X, Y, Z of vectors and alpha, are not colours.
void convert_colours(Image& image, const RgbMatrix& to_rec709) {
  constexpr std::string_view red = "R";
  for (std::size_t r = 0; r < image.channels.size(); ++r) {
    const std::string& name = image.channels[r];
    if (name != red && !name.ends_with(".R")) continue;
    const std::string layer = name.substr(0, name.size() - red.size());
    const auto g = image.find_channel(layer + "G"), b = image.find_channel(layer + "B");
    if (!g || !b) continue;
    for (std::size_t pixel = 0; pixel < image.pixels.size(); pixel += image.channels.size()) {
      float* const at = &image.pixels[pixel];
      const Rgb c = to_rec709 * Rgb{at[r], at[*g], at[*b]};
      at[r] = c.r, at[*g] = c.g, at[*b] = c.b;
    }
  }
}

// NaN becomes black.
template <class Integer>
std::vector<Integer> whole_numbers(const Image& displayed) {
  constexpr auto largest = static_cast<float>(std::numeric_limits<Integer>::max());
  std::vector<Integer> numbers;
  numbers.reserve(displayed.pixels.size());
  for (const float x : displayed.pixels)
    numbers.push_back(static_cast<Integer>(std::lround((x > 0 ? std::fmin(x, 1.0f) : 0) * largest)));
  return numbers;
}

template <class Function>
auto with_codec(const std::string& file, Function&& function) {
  try {
    return function(image_codec());
  } catch (const Error&) {
    throw;
  } catch (const std::exception& problem) {
    throw Error({file}, printable(problem.what()));
  }
}

void apply_ocio(const OcioView& ocio, float gain, Image& colors) {
  read_file(ocio.config);  // reports problems with the file itself
  for (float& x : colors.pixels) x = std::isfinite(x) ? x * gain : 0;
  with_codec(ocio.config, [&](const ImageCodec& codec) {
    codec.apply_view(ocio.config, ocio.display, ocio.view, colors.width, colors.height, colors.pixels.data());
  });
}

void apply_curve(const DisplaySettings& display, Image& colors) {
  std::vector<float>& values = colors.pixels;
  DisplaySettings settings = display;
  if (settings.curve == ToneCurve::highlights && !settings.brightest) settings.brightest = brightest_level(colors);
  const DisplayTransform transform(settings);
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    const Rgb encoded = transform({values[i], values[i + 1], values[i + 2]});
    values[i] = encoded.r, values[i + 1] = encoded.g, values[i + 2] = encoded.b;
  }
}

// Adds linear light to sRGB-encoded colours.
void add_light(const Image& light, Image& encoded) {
  for (std::size_t i = 0; i < encoded.pixels.size(); ++i) {
    const float sum = linear_from_srgb(encoded.pixels[i]) + std::fmax(light.pixels[i], 0.0f);
    encoded.pixels[i] = srgb_from_linear(std::fmin(sum, 1.0f));
  }
}

// 8 bits for JPEG and 16 for TIFF. The metadata are one text that begins with our prefix.
std::vector<unsigned char> encode_by_codec(const char* format, const Image& displayed, const std::string& metadata) {
  const std::string text = std::string(attribute_prefix) + parse_metadata(metadata).dump();
  CodecColors colors{displayed.width, displayed.height, SampleType::uint8, nullptr};
  const auto encoded = [&](const auto& numbers, SampleType samples) {
    colors.samples = samples;
    colors.pixels = numbers.data();
    return with_codec({}, [&](const ImageCodec& codec) { return codec.encode(format, colors, text); });
  };
  return std::string_view(format) == "tiff" ? encoded(whole_numbers<std::uint16_t>(displayed), SampleType::uint16)
                                            : encoded(whole_numbers<std::uint8_t>(displayed), SampleType::uint8);
}

// OpenEXR uses other names for some layers.
void rename_channel(Image& image, std::string_view from, const char* to) {
  if (const auto channel = image.find_channel(from)) image.channels[*channel] = to;
}
constexpr const char *depth_channel = "depth.Z", *depth_in_file = "Z";

}  // namespace

std::vector<unsigned char> encode_exr(const Image& image, const std::string& metadata) {
  std::vector<ImageAttribute> attributes = attributes_of(parse_metadata(metadata));
  if (std::any_of(image.channels.begin(), image.channels.end(), is_spectral_channel)) {
    // Fichet, Pacanowski & Wilkie 2021, "An OpenEXR Layout for Spectral Images", §3.
    attributes.push_back({"spectralLayoutVersion", "1.0"});
    attributes.push_back({"emissiveUnits", "W.m^-2.sr^-1"});
  }
  if (!image.find_channel(depth_channel) || image.find_channel(depth_in_file)) return encode_openexr(image, attributes);
  Image renamed = image;
  rename_channel(renamed, depth_channel, depth_in_file);
  return encode_openexr(renamed, attributes);
}

Image as_color(Image layer) {
  if (layer.channel_count() == 1)
    layer.channels = {"Y"};
  else
    layer.channels = {"R", "G", "B"};
  return layer;
}

Image displayed(const Image& image, const DisplaySettings& display) {
  std::optional<Image> color = select_layer(image, "color");
  if (!color && layer_names(image).size() == 1) color = select_layer(as_color(image), "color");
  if (!color) throw Error("cannot show: the picture has several layers, but none is the colour (R, G, B)");
  if (color->pixels.empty()) throw Error("cannot write: the picture is empty");
  color->channels = {"R", "G", "B"};
  std::vector<float>& values = color->pixels;
  const std::optional<Image> emission = display.display_emission ? select_layer(image, "emission") : std::nullopt;
  if (emission)
    for (std::size_t i = 0; i < values.size(); ++i) values[i] -= emission->pixels[i];
  if (display.ocio)
    apply_ocio(*display.ocio, std::exp2(display.exposure), *color);
  else
    apply_curve(display, *color);
  if (emission) add_light(*emission, *color);
  return *std::move(color);
}

std::vector<unsigned char> encode_png(const Image& image, const DisplaySettings& display, const std::string& metadata) {
  const std::vector<std::uint8_t> pixels = whole_numbers<std::uint8_t>(displayed(image, display));
  std::vector<PngText> texts;
  const json members = parse_metadata(metadata);
  for (const auto& member : members.items())
    texts.push_back({std::string(attribute_prefix) + member.key(),
                     member.value().is_string() ? member.value().get<std::string>() : member.value().dump()});
  return encode_png_colors(image.width, pixels, texts);
}

void write_exr(const fs::path& path, const Image& image, const std::string& metadata) {
  const std::vector<unsigned char> bytes = encode_exr(image, metadata);
  write_file(path, std::as_bytes(std::span(bytes)));
}

void write_png(const fs::path& path, const Image& image, const DisplaySettings& display, const std::string& metadata) {
  const std::vector<unsigned char> bytes = encode_png(image, display, metadata);
  write_file(path, std::as_bytes(std::span(bytes)));
}

void write_image(const fs::path& path, const Image& image, const DisplaySettings& display,
                 const std::string& metadata) {
  const std::string extension = lower_extension(path);
  if (extension == ".exr") return write_exr(path, image, metadata);
  if (extension == ".png") return write_png(path, image, display, metadata);
  const bool is_jpeg = extension == ".jpg" || extension == ".jpeg",
             is_tiff = extension == ".tif" || extension == ".tiff";
  if (!is_jpeg && !is_tiff)
    throw Error({path.string()},
                fmt::format("unknown kind of picture; expected a name that ends in .exr (all layers, linear), {}",
                            fmt::join(picture_extensions().begin() + 1, picture_extensions().end(), ", ")));
  const std::vector<unsigned char> bytes =
      encode_by_codec(is_jpeg ? "jpeg" : "tiff", displayed(image, display), metadata);
  write_file(path, std::as_bytes(std::span(bytes)));
}

const std::vector<std::string>& picture_extensions() {
  static const std::vector<std::string> extensions{".exr", ".png", ".jpg", ".jpeg", ".tif", ".tiff"};
  return extensions;
}

Image read_image(const fs::path& path, ColorEncoding encoding, std::uint64_t max_pixels) {
  const std::string bytes = read_file(path);
  const SourceLocation place{path.string()};
  ImageFile file(bytes, "the file", place, max_pixels);
  const ImageHeader& header = file.header();
  require_memory(
      static_cast<double>(header.width) * header.height * static_cast<double>(header.channels.size()) * sizeof(float),
      place, "the image");
  Image image(header.width, header.height, header.channels);
  image.window = header.window;
  file.read(static_cast<int>(header.channels.size()), image.pixels.data());
  if (!image.find_channel(depth_channel)) rename_channel(image, depth_in_file, depth_channel);
  const bool integers = header.samples != SampleType::float32 && header.samples != SampleType::half;
  if (encoding == ColorEncoding::srgb || (encoding == ColorEncoding::automatic && integers)) decode_srgb(image, header);
  if (file.to_rec709()) convert_colours(image, *file.to_rec709());
  return image;
}

std::string read_image_metadata(const fs::path& path) {
  const std::string bytes = read_file(path);
  const ImageFile file(bytes, "the file", {path.string()}, FileAccess::default_max_pixels);
  json metadata = json::object();
  for (const ImageAttribute& attribute : file.header().attributes) {
    const auto* const text = std::get_if<std::string>(&attribute.value);
    if (attribute.name == "ImageDescription" && text != nullptr && text->starts_with(attribute_prefix))
      if (json all = json::parse(text->substr(attribute_prefix.size()), nullptr, false); all.is_object())
        metadata.update(all);
    if (attribute.name.starts_with(attribute_prefix))
      std::visit([&](const auto& value) { metadata[attribute.name.substr(attribute_prefix.size())] = value; },
                 attribute.value);
  }
  return metadata.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace lanthorn
