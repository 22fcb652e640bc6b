// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/memory.h"
#include "film/display.h"
#include "image/image_encoder.h"
#include "image/image_file.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"

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

}  // namespace

std::vector<unsigned char> encode_exr(const Image& image, const std::string& metadata) {
  std::vector<ImageAttribute> attributes = attributes_of(parse_metadata(metadata));
  if (std::any_of(image.channels.begin(), image.channels.end(), is_spectral_channel)) {
    // Fichet, Pacanowski & Wilkie 2021, "An OpenEXR Layout for Spectral Images", §3.
    attributes.push_back({"spectralLayoutVersion", "1.0"});
    attributes.push_back({"emissiveUnits", "W.m^-2.sr^-1"});
  }
  return encode_openexr(image, attributes);
}

std::vector<unsigned char> encode_png(const Image& image, const DisplaySettings& display, const std::string& metadata) {
  const auto color = select_layer(image, "color");
  if (!color) throw Error("cannot write: the picture has no channels R, G, B");
  if (color->pixels.empty()) throw Error("cannot write: the picture is empty");
  std::vector<std::uint8_t> pixels(color->pixels.size());
  const auto emission = display.display_emission ? select_layer(image, "emission") : std::nullopt;
  const auto rgb_at = [](const Image& layer, std::size_t i) {
    return Rgb{layer.pixels[i], layer.pixels[i + 1], layer.pixels[i + 2]};
  };
  for (std::size_t i = 0; i + 2 < pixels.size(); i += 3) {
    const Rgb encoded = emission ? to_display(rgb_at(*color, i), rgb_at(*emission, i), display)
                                 : to_display(rgb_at(*color, i), display);
    const auto to_byte = [](float x) { return static_cast<std::uint8_t>(std::lround(x * 255)); };
    pixels[i] = to_byte(encoded.r);
    pixels[i + 1] = to_byte(encoded.g);
    pixels[i + 2] = to_byte(encoded.b);
  }
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
  throw Error({path.string()}, "unknown kind of picture; its name must end in .exr (all layers, linear) or .png");
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
  const bool integers = header.samples != SampleType::float32 && header.samples != SampleType::half;
  if (encoding == ColorEncoding::srgb || (encoding == ColorEncoding::automatic && integers)) decode_srgb(image, header);
  return image;
}

std::string read_image_metadata(const fs::path& path) {
  const std::string bytes = read_file(path);
  const ImageFile file(bytes, "the file", {path.string()}, FileAccess::default_max_pixels);
  json metadata = json::object();
  for (const ImageAttribute& attribute : file.header().attributes)
    if (attribute.name.starts_with(attribute_prefix))
      std::visit([&](const auto& value) { metadata[attribute.name.substr(attribute_prefix.size())] = value; },
                 attribute.value);
  return metadata.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace lanthorn
