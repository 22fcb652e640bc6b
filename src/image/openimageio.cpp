// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The module behind `image_codec`. It uses only headers of the library.
#include <OpenImageIO/color.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "image/image_codec.h"
#include "image/openimageio_tiles.h"

// Declarations as in png.h.
struct png_struct_def;
using PngMessage = void (*)(png_struct_def*, const char* message);
using SetPngMessages = void (*)(png_struct_def*, void* owner, PngMessage on_error, PngMessage on_warning);
using PngJump = void (*)(const png_struct_def*, int);

namespace {

std::atomic<PngMessage> take_png_error{nullptr};

// libpng prints its own line if the error function returns, as OpenImageIO's does; this one does not return
// (png_error(3)).
void take_error_and_leave(png_struct_def* png, const char* message) {
  if (const PngMessage take = take_png_error) take(png, message);
  static const auto jump = reinterpret_cast<PngJump>(dlsym(RTLD_NEXT, "png_longjmp"));
  jump(png, 1);
}

}  // namespace

// Interposes libpng's function of this name for OpenImageIO's calls: symbol lookup finds this module before libpng.
extern "C" void png_set_error_fn(png_struct_def* png, void* owner, PngMessage on_error, PngMessage on_warning) {
  static const auto set = reinterpret_cast<SetPngMessages>(dlsym(RTLD_NEXT, "png_set_error_fn"));
  take_png_error = on_error;
  set(png, owner, take_error_and_leave, on_warning);
}

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

int rows_decoded_together(const OIIO::ImageSpec& spec) {
  const int rows = spec.tile_width > 0 ? spec.tile_height : spec.get_int_attribute("tiff:RowsPerStrip", 1);
  return std::clamp(rows, 1, std::max(1, spec.height));
}

// Of OpenEXR files, whose attribute this is.
std::optional<std::array<float, 8>> chromaticities_of(const OIIO::ImageSpec& spec, std::string_view format) {
  std::array<float, 8> stated{};
  const OIIO::TypeDesc type(OIIO::TypeDesc::FLOAT, static_cast<int>(stated.size()));
  if (format != "openexr" || !spec.getattribute("chromaticities", type, stated.data())) return std::nullopt;
  return stated;
}

ImageHeader header_of(const OIIO::ImageSpec& spec, std::string_view format) {
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
                     .row_step = rows_decoded_together(spec),
                     .chromaticities = chromaticities_of(spec, format),
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
struct MemoryInput {
  OIIO::Filesystem::IOMemReader source;
  std::unique_ptr<OIIO::ImageInput> file;

  explicit MemoryInput(std::string_view bytes) : source(const_cast<char*>(bytes.data()), bytes.size()) {}
};
/// A file on disk.
struct DiskInput {
  std::shared_ptr<std::FILE> stream;
  OIIO::Filesystem::IOFile source;
  std::unique_ptr<OIIO::ImageInput> file;

  explicit DiskInput(std::shared_ptr<std::FILE> from)
      : stream(std::move(from)), source(stream.get(), OIIO::Filesystem::IOProxy::Read) {}
};

// Serialises opening files. OpenImageIO 2.4 looks up names in ICC profiles in a map shared by all threads and inserts
// unknown names without a lock (issue 3756; fixed in later versions): one in 12 loads of a model with 16 JPEG files
// crashed. Profiles are read with the header; pixels may be read concurrently.
std::mutex opening;

void read_rows(OIIO::ImageInput& file, int first, int end, int channels, const OIIO::TypeDesc& type, void* pixels) {
  const OIIO::ImageSpec& spec = file.spec();
  const bool is_read = spec.tile_width > 0
                           ? file.read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + first, spec.y + end, 0, 1, 0,
                                             channels, type, pixels)
                           : file.read_scanlines(0, 0, spec.y + first, spec.y + end, 0, 0, channels, type, pixels);
  if (!is_read) fail(file);
}

template <class Input>
OpenImage open_input(const std::shared_ptr<Input>& input, const char* format) {
  const std::scoped_lock lock(opening);
  input->file = OIIO::ImageInput::create(format);
  OIIO::ImageSpec config, spec;
  // Colours as the file stores them: premultiplying by alpha first would decode them incorrectly.
  config["oiio:UnassociatedAlpha"] = 1;
  OIIO::Filesystem::IOProxy* proxy = &input->source;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  if (!input->file || !input->file->supports("ioproxy"))
    throw std::runtime_error(std::string("OpenImageIO was built without ") + format);
  OIIO::ImageInput& file = *input->file;
  if (!file.open(std::string("image.") + format, spec, config)) fail(file);
  return {header_of(file.spec(), format),
          [input](int channels, SampleType as, void* pixels) {
            if (!input->file->read_image(0, 0, 0, channels, type_of(as), pixels)) fail(*input->file);
          },
          [input](int first, int end, int channels, SampleType as, void* pixels) {
            read_rows(*input->file, first, end, channels, type_of(as), pixels);
          }};
}

OpenImage open(std::string_view bytes, const char* format) {
  return open_input(std::make_shared<MemoryInput>(bytes), format);
}

OpenImage open_file(std::shared_ptr<std::FILE> file, const char* format) {
  return open_input(std::make_shared<DiskInput>(std::move(file)), format);
}

std::vector<unsigned char> encode(const char* format, const CodecColors& colors, const std::string& text) {
  const std::unique_ptr<OIIO::ImageOutput> file = OIIO::ImageOutput::create(format);
  if (!file || !file->supports("ioproxy"))
    throw std::runtime_error(std::string("OpenImageIO was built without ") + format);
  const OIIO::TypeDesc type = colors.samples == SampleType::uint16 ? OIIO::TypeUInt16 : OIIO::TypeUInt8;
  OIIO::ImageSpec spec(colors.width, colors.height, 3, type);
  const bool is_tiff = std::string_view(format) == "tiff";
  spec.attribute("compression", is_tiff ? "zip" : "jpeg:95");
  spec.attribute("jpeg:subsampling", "4:4:4");
  // A colour space creates an Exif directory, for which OpenImageIO's TIFF writer would have to read its own output.
  if (!is_tiff) spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("ImageDescription", text);
  spec.attribute("Software", "Lanthorn");
  OIIO::Filesystem::IOVecOutput memory;
  OIIO::Filesystem::IOProxy* proxy = &memory;
  spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  if (!file->open(std::string("image.") + format, spec) || !file->write_image(type, colors.pixels) || !file->close())
    throw std::runtime_error(file->geterror());
  return memory.buffer();
}

// Names of linear Rec.709 in common configurations.
std::string linear_rec709_of(const OIIO::ColorConfig& config) {
  const std::vector<std::string> spaces = config.getColorSpaceNames();
  for (const char* name : {"lin_rec709", "lin_srgb", "Linear Rec.709 (sRGB)", "Linear Rec.709", "Linear BT.709",
                           "Utility - Linear - sRGB", "Linear sRGB", "Linear", "linear"})
    if (std::find(spaces.begin(), spaces.end(), name) != spaces.end()) return name;
  throw std::runtime_error("has no colour space for linear Rec.709 (lin_rec709)");
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

// The name, or the default if it is empty.
std::string chosen(const std::string& name, const std::vector<std::string>& names, const char* otherwise,
                   const char* kind) {
  const std::string choice = name.empty() && otherwise != nullptr ? otherwise : name;
  if (std::find(names.begin(), names.end(), choice) == names.end())
    throw std::runtime_error(std::string("has no ") + kind + " '" + choice + "'; expected one of " + listed(names));
  return choice;
}

void apply_view(const std::string& file, const std::string& wanted_display, const std::string& wanted_view, int width,
                int height, float* colors) {
  OIIO::ColorConfig config(file);
  if (config.has_error()) throw std::runtime_error("is not an OpenColorIO configuration: " + config.geterror());
  const std::string display =
      chosen(wanted_display, config.getDisplayNames(), config.getDefaultDisplayName(), "display");
  const std::string view =
      chosen(wanted_view, config.getViewNames(display), config.getDefaultViewName(display), "view");
  OIIO::ImageBuf pixels(OIIO::ImageSpec(width, height, 3, OIIO::TypeFloat), colors);
  if (!OIIO::ImageBufAlgo::ociodisplay(pixels, pixels, display, view, linear_rec709_of(config), "", false, "", "",
                                       &config))
    throw std::runtime_error("cannot be applied: " + pixels.geterror());
}

void use_one_thread() {
  OIIO::attribute("exr_threads", -1);
  OIIO::attribute("threads", 1);
}

std::string version() {
  const int number = OIIO::openimageio_version();  // of the library loaded at run time
  return std::to_string(number / 10000) + '.' + std::to_string(number / 100 % 100) + '.' + std::to_string(number % 100);
}

}  // namespace

extern "C" const ImageCodec* lanthorn_image_codec() {
  static constexpr ImageCodec codec{open,    open_file,       encode,    apply_view,  use_one_thread,
                                    version, make_tile_cache, add_image, read_texels, count_tiles};
  return &codec;
}

}  // namespace lanthorn
