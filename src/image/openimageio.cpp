// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The module behind `image_codec`. It uses nothing of the library but headers.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>
#include <mutex>
#include <stdexcept>

#include "image/image_codec.h"

namespace lanthorn {

namespace {

[[noreturn]] void fail(const OIIO::ImageInput& file) {
  const std::string problem = file.geterror();
  throw std::runtime_error(problem.empty() ? "damaged" : problem);
}

SampleType samples_of(const OIIO::TypeDesc& type) {
  switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
      return SampleType::uint8;
    case OIIO::TypeDesc::UINT16:
      return SampleType::uint16;
    case OIIO::TypeDesc::HALF:
      return SampleType::half;
    case OIIO::TypeDesc::FLOAT:
      return SampleType::float32;
    default:
      return SampleType::other;
  }
}
OIIO::TypeDesc type_of(SampleType samples) { return samples == SampleType::uint8 ? OIIO::TypeUInt8 : OIIO::TypeFloat; }

ImageHeader header_of(const OIIO::ImageSpec& spec) {
  ImageHeader header{.width = spec.width,
                     .height = spec.height,
                     .depth = spec.depth,
                     .window = {spec.x, spec.y, spec.full_width, spec.full_height},
                     .channels = spec.channelnames,
                     .alpha_channel = spec.alpha_channel,
                     .z_channel = spec.z_channel,
                     .samples = samples_of(spec.format),
                     .pixel_bytes = spec.pixel_bytes(true),
                     .deep = spec.deep,
                     .attributes = {}};
  for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
    ImageAttribute& own = header.attributes.emplace_back(ImageAttribute{attribute.name().string(), 0});
    if (attribute.type() == OIIO::TypeInt)
      own.value = attribute.get_int();
    else if (attribute.type() == OIIO::TypeFloat)
      own.value = attribute.get_float();
    else
      own.value = attribute.get_string();
  }
  return header;
}

/// A file in memory that OpenImageIO reads.
struct Input {
  OIIO::Filesystem::IOMemReader memory;
  std::unique_ptr<OIIO::ImageInput> file;

  explicit Input(std::string_view bytes) : memory(const_cast<char*>(bytes.data()), bytes.size()) {}
};

// OpenImageIO 2.4 corrupts memory where the headers of several JPEG files are read at the same time: one in 12 loads of
// a model with 16 of them crashed. Pixels may be read at the same time.
std::mutex opening;

OpenImage open(std::string_view bytes, const char* format) {
  const std::scoped_lock lock(opening);
  auto input = std::make_shared<Input>(bytes);
  input->file = OIIO::ImageInput::create(format);
  OIIO::ImageSpec config, spec;
  // Colours as the file stores them: premultiplied by alpha, they would be decoded wrongly.
  config["oiio:UnassociatedAlpha"] = 1;
  OIIO::Filesystem::IOProxy* proxy = &input->memory;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  if (!input->file || !input->file->supports("ioproxy"))
    throw std::runtime_error(std::string("OpenImageIO was built without ") + format);
  OIIO::ImageInput& file = *input->file;
  if (!file.open(std::string("image.") + format, spec, config)) fail(file);
  return {header_of(file.spec()), [input](int channels, SampleType as, void* pixels) {
            if (!input->file->read_image(0, 0, 0, channels, type_of(as), pixels)) fail(*input->file);
          }};
}

void use_one_thread() { OIIO::attribute("exr_threads", -1); }

}  // namespace

extern "C" const ImageCodec* lanthorn_image_codec() {
  static constexpr ImageCodec codec{open, use_one_thread};
  return &codec;
}

}  // namespace lanthorn
