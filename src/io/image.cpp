// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "base/memory.h"
#include "film/display.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "texture/image_file.h"
#include "texture/picture_threads.h"

namespace lanthorn {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

constexpr std::string_view attribute_prefix = "lanthorn:";

json parse_metadata(const std::string& text) { return text.empty() ? json::object() : json::parse(text); }

void set_attributes(OIIO::ImageSpec& spec, const json& metadata) {
  for (const auto& member : metadata.items()) {
    const std::string name = std::string(attribute_prefix) + member.key();
    const json& value = member.value();
    const bool small = value.is_number_integer() &&
                       (!value.is_number_unsigned() || value.get<std::uint64_t>() < 1u << 31) &&
                       std::abs(value.get<std::int64_t>()) < std::int64_t{1} << 31;
    if (value.is_string())
      spec.attribute(name, value.get<std::string>());
    else if (small)
      spec.attribute(name, value.get<int>());
    else if (value.is_number_float())
      spec.attribute(name, value.get<float>());
    else
      spec.attribute(name, value.dump());
  }
}

/// Encodes a file in memory, so that all disk errors occur in one place, `write_file`.
template <class T>
void write(const fs::path& path, const char* format, const OIIO::ImageSpec& spec, const OIIO::TypeDesc& type,
           const T* pixels) {
  std::vector<unsigned char> encoded;
  OIIO::Filesystem::IOVecOutput proxy(encoded);
  limit_picture_threads();
  const auto output = OIIO::ImageOutput::create(format);
  if (!output || !output->supports("ioproxy"))
    throw Error({path.string()}, fmt::format("cannot write: OpenImageIO was built without {}", format));
  if (!output->set_ioproxy(&proxy) || !output->open(path.string(), spec) || !output->write_image(type, pixels) ||
      !output->close())
    throw Error({path.string()}, "cannot write: " + output->geterror());
  write_file(path, std::as_bytes(std::span(encoded)));
}

bool is_color_channel(const OIIO::ImageSpec& spec, int channel) {
  return channel != spec.alpha_channel && channel != spec.z_channel;
}

void decode_srgb(Image& image, const OIIO::ImageSpec& spec) {
  const std::size_t count = image.channel_count();
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    if (is_color_channel(spec, static_cast<int>(i % count))) image.pixels[i] = linear_from_srgb(image.pixels[i]);
}

}  // namespace

void write_exr(const fs::path& path, const Image& image, const std::string& metadata) {
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channel_count()), OIIO::TypeFloat);
  spec.channelnames = image.channels;
  spec.x = image.window.x;
  spec.y = image.window.y;
  spec.full_x = spec.full_y = 0;
  spec.full_width = image.window.full_width > 0 ? image.window.full_width : image.width;
  spec.full_height = image.window.full_height > 0 ? image.window.full_height : image.height;
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // otherwise OpenImageIO writes the current time
  if (std::any_of(image.channels.begin(), image.channels.end(), is_spectral_channel)) {
    // Fichet, Pacanowski & Wilkie 2021, "An OpenEXR Layout for Spectral Images", §3.
    spec.attribute("spectralLayoutVersion", "1.0");
    spec.attribute("emissiveUnits", "W.m^-2.sr^-1");
  }
  set_attributes(spec, parse_metadata(metadata));
  write(path, "openexr", spec, OIIO::TypeFloat, image.pixels.data());
}

void write_png(const fs::path& path, const Image& image, const DisplaySettings& display, const std::string& metadata) {
  const auto color = select_layer(image, "color");
  if (!color) throw Error({path.string()}, "cannot write: the picture has no channels R, G, B");
  std::vector<std::uint8_t> pixels(color->pixels.size());
  for (std::size_t i = 0; i + 2 < pixels.size(); i += 3) {
    const Rgb encoded = to_display({color->pixels[i], color->pixels[i + 1], color->pixels[i + 2]}, display);
    const auto to_byte = [](float x) { return static_cast<std::uint8_t>(std::lround(x * 255)); };
    pixels[i] = to_byte(encoded.r);
    pixels[i + 1] = to_byte(encoded.g);
    pixels[i + 2] = to_byte(encoded.b);
  }
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  json texts = parse_metadata(metadata);  // PNG attributes are text, numbers included
  for (json& value : texts)
    if (!value.is_string()) value = value.dump();
  set_attributes(spec, texts);
  write(path, "png", spec, OIIO::TypeUInt8, pixels.data());
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
  const OIIO::ImageSpec& spec = file.spec();
  require_memory(static_cast<double>(spec.image_pixels()) * spec.nchannels * sizeof(float), place, "the image");
  Image image(spec.width, spec.height, spec.channelnames);
  image.window = {spec.x, spec.y, spec.full_width, spec.full_height};
  file.read(spec.nchannels, OIIO::TypeFloat, image.pixels.data());
  const bool integers = spec.format.basetype != OIIO::TypeDesc::FLOAT && spec.format.basetype != OIIO::TypeDesc::HALF;
  if (encoding == ColorEncoding::srgb || (encoding == ColorEncoding::automatic && integers)) decode_srgb(image, spec);
  return image;
}

std::string read_image_metadata(const fs::path& path) {
  const std::string bytes = read_file(path);
  const ImageFile file(bytes, "the file", {path.string()}, FileAccess::default_max_pixels);
  json metadata = json::object();
  for (const auto& attribute : file.spec().extra_attribs) {
    const std::string name = attribute.name().string();
    if (!name.starts_with(attribute_prefix)) continue;
    json& value = metadata[name.substr(attribute_prefix.size())];
    if (attribute.type() == OIIO::TypeInt)
      value = attribute.get_int();
    else if (attribute.type() == OIIO::TypeFloat)
      value = attribute.get_float();
    else
      value = attribute.get_string();
  }
  return metadata.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace lanthorn
