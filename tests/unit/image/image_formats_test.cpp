// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Our own readers and writers of image formats, against OpenImageIO.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "film/display.h"
#include "image/image_file.h"
#include "image/own_formats.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/image_file.h"
#include "lanthorn/threads.h"
#include "support/error_text.h"
#include "support/exr_colours.h"
#include "support/jpeg.h"
#include "support/temporary_dir.h"

namespace lanthorn::image_formats_test {
namespace {

using test::error_text;

class ImageFormats : public testing::Test {
 protected:
  std::unique_ptr<OIIO::ImageInput> open_elsewhere(const char* name, const std::vector<unsigned char>& bytes) {
    dir_.write(name, std::string(bytes.begin(), bytes.end()));
    auto file = OIIO::ImageInput::open((dir_.path() / name).string());
    EXPECT_TRUE(file) << OIIO::geterror();
    return file;
  }
  // All channels, by their names in the file.
  static void expect_pixels(OIIO::ImageInput& file, const Image& image) {
    const OIIO::ImageSpec& spec = file.spec();
    ASSERT_EQ(spec.width, image.width);
    ASSERT_EQ(spec.height, image.height);
    ASSERT_EQ(static_cast<std::size_t>(spec.nchannels), image.channel_count());
    std::vector<float> pixels(image.pixels.size());
    ASSERT_TRUE(file.read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.data())) << file.geterror();
    for (std::size_t c = 0; c < image.channel_count(); ++c) {
      const auto from = static_cast<std::size_t>(spec.channelindex(image.channels[c]));
      ASSERT_LT(from, image.channel_count()) << image.channels[c];
      for (std::size_t i = c, j = from; i < pixels.size(); i += image.channel_count(), j += image.channel_count())
        ASSERT_EQ(pixels[j], image.pixels[i]) << image.channels[c];
    }
  }

  test::TemporaryDir dir_;
};

// Some channels compress well, one does not compress; scan lines end within a chunk.
Image uneven_image(int width, int height) {
  Image image(width, height, {"samples", "R", "G", "B", "a layer whose name is longer than 31.X", "depth.Z"});
  std::mt19937 random(5);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      image.at(x, y, 0) = 64;
      for (std::size_t c = 1; c < 4; ++c) image.at(x, y, c) = 0.01f * static_cast<float>(x * y) + static_cast<float>(c);
      image.at(x, y, 4) = static_cast<float>(random()) - 2e9f;
      image.at(x, y, 5) = INFINITY;
    }
  return image;
}

TEST_F(ImageFormats, OpenExrIsReadElsewhereAsItWasWritten) {
  for (const auto& [width, height] : {std::pair{37, 50}, std::pair{64, 16}, std::pair{1, 1}, std::pair{300, 1}}) {
    Image image = uneven_image(width, height);
    image.window = {3, 5, 400, 300};
    const std::vector<unsigned char> bytes =
        encode_openexr(image, {{"text", "M\xc3\xbcller"}, {"number", -7}, {"half", 0.5f}});
    EXPECT_EQ(bytes[5], 4) << "names are long";
    const auto file = open_elsewhere("a.exr", bytes);
    expect_pixels(*file, image);
    const OIIO::ImageSpec& spec = file->spec();
    EXPECT_EQ(spec.x, 3);
    EXPECT_EQ(spec.y, 5);
    EXPECT_EQ(spec.full_width, 400);
    EXPECT_EQ(spec.full_height, 300);
    EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
    EXPECT_EQ(spec.get_string_attribute("text"), "M\xc3\xbcller");
    EXPECT_EQ(spec.get_int_attribute("number"), -7);
    EXPECT_EQ(spec.get_float_attribute("half"), 0.5f);
  }
}

TEST_F(ImageFormats, OpenExrStoresWhatDoesNotCompressAsItIs) {
  Image image(64, 32, {"Y"});
  std::mt19937 random(7);
  for (float& value : image.pixels)
    value = std::ldexp(static_cast<float>(random()), static_cast<int>(random() % 200) - 100);
  const std::vector<unsigned char> bytes = encode_openexr(image, {});
  EXPECT_LT(bytes.size(), 4 * image.pixels.size() + 400) << "pixels, and a header";
  expect_pixels(*open_elsewhere("a.exr", bytes), image);
  std::fill(image.pixels.begin(), image.pixels.end(), 0.3f);
  EXPECT_LT(encode_openexr(image, {}).size(), 600u);
}

TEST_F(ImageFormats, OpenExrIsTheSameForAnyNumberOfThreads) {
  const Image image = uneven_image(80, 200);
  const auto encode_with = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return encode_openexr(image, {});
  };
  EXPECT_EQ(encode_with(1), encode_with(3));
}

TEST_F(ImageFormats, OpenExrSaysWhatItCannotHold) {
  EXPECT_EQ(error_text([] { encode_openexr(Image(0, 0, {"R"}), {}); }),
            "cannot write: OpenEXR has no images of 0 x 0 pixels with 1 channels");
  Image wide;  // pixels are not read
  wide.width = 1 << 26;
  wide.height = 1;
  wide.channels = {"R"};
  EXPECT_NE(error_text([&] { encode_openexr(wide, {}); }).find("67108864 x 1 pixels"), std::string::npos);
  EXPECT_NE(error_text([] {
              encode_openexr(Image(1, 1, {"R"}), {{std::string(256, 'n'), 1}});
            }).find("more than 255 characters"),
            std::string::npos);
}

TEST_F(ImageFormats, OtherProgramsKnowColoursAndDepthOfOpenExr) {
  Image image(2, 1, {"R", "G", "B", "depth.Z", "normal.Z"});
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i);
  const auto file = open_elsewhere("a.exr", encode_exr(image));
  const OIIO::ImageSpec& spec = file->spec();
  EXPECT_EQ(spec.z_channel, spec.channelindex("Z"));
  EXPECT_GE(spec.z_channel, 0);
  EXPECT_GE(spec.channelindex("normal.Z"), 0);
  std::array<float, 8> rec709{};
  ASSERT_TRUE(spec.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), rec709.data()));
  EXPECT_EQ(rec709, (std::array<float, 8>{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f}));
  // Here the layer is unchanged.
  write_exr(dir_.path() / "b.exr", image);
  const Image again = read_image(dir_.path() / "b.exr");
  ASSERT_TRUE(again.find_channel("depth.Z"));
  EXPECT_EQ(again.at(1, 0, *again.find_channel("depth.Z")), 8);
}

// The colour of the issue: .5 .2 .1 in ACEScg is .7198 .1620 .0775, by the Academy's matrix.
TEST_F(ImageFormats, ColoursOfOpenExrBecomeRec709) {
  Image image(1, 1, {"R", "G", "B", "A", "diffuse.R", "diffuse.G", "diffuse.B", "normal.X", "normal.Y", "normal.Z"});
  image.pixels = {0.5f, 0.2f, 0.1f, 0.4f, 1, 0.4f, 0.2f, 0.5f, 0.2f, 0.1f};
  const auto read_as = [&](const std::string& bytes) { return read_image(dir_.write("c.exr", bytes)); };
  const auto value = [](const Image& read, const char* channel) { return read.at(0, 0, *read.find_channel(channel)); };
  const Image read = read_as(test::exr_of(image, test::acescg));
  constexpr std::array<float, 3> expected{0.71984f, 0.16198f, 0.07750f};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string component(1, "RGB"[c]);
    EXPECT_NEAR(value(read, component.c_str()), expected[c], 2e-5f) << component;
    EXPECT_NEAR(value(read, ("diffuse." + component).c_str()), 2 * expected[c], 4e-5f) << component;
  }
  EXPECT_EQ(value(read, "A"), 0.4f);
  EXPECT_EQ(value(read, "normal.X"), 0.5f);
  EXPECT_EQ(value(read, "normal.Z"), 0.1f);
  // Written again, it states Rec.709 and keeps its colours. A file without a statement is Rec.709.
  write_exr(dir_.path() / "again.exr", read);
  const Image again = read_image(dir_.path() / "again.exr");
  const Image unstated = read_as(test::exr_without_chromaticities(image)), zeros = read_as(test::exr_of(image, {}));
  for (const std::string& channel : image.channels) {
    EXPECT_EQ(value(again, channel.c_str()), value(read, channel.c_str())) << channel;
    EXPECT_EQ(value(unstated, channel.c_str()), image.at(0, 0, *image.find_channel(channel))) << channel;
    EXPECT_EQ(value(zeros, channel.c_str()), image.at(0, 0, *image.find_channel(channel))) << channel;
  }
  const auto problem = [&](const std::array<float, 8>& chromaticities) {
    return error_text([&] { read_as(test::exr_of(image, chromaticities)); });
  };
  EXPECT_NE(problem({0.6f, 0.3f, 0.6f, 0.3f, 0.1f, 0.1f, 0.3f, 0.3f}).find("chromaticities that no colours can have"),
            std::string::npos);
  EXPECT_NE(problem({NAN, 0.3f, 0.2f, 0.7f, 0.1f, 0.1f, 0.3f, 0.3f}).find("has chromaticities"), std::string::npos);
}

// A gradient, which JPEG keeps within a few steps.
TEST_F(ImageFormats, JpegAndTiffShowWhatPngDoes) {
  Image image(64, 32, {"R", "G", "B"});
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      image.at(x, y, 0) = 0.1f + static_cast<float>(x) / 80;
      image.at(x, y, 1) = 0.1f + static_cast<float>(y) / 40;
      image.at(x, y, 2) = 0.2f;
    }
  const DisplaySettings display{.exposure = 1, .curve = ToneCurve::agx};
  const Image shown = displayed(image, display);
  for (std::size_t i = 0; i < shown.pixels.size(); i += 3) {
    const Rgb expected = to_display({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]}, display);
    constexpr float tolerance = 1e-6f;  // far below a step of 8 or 16 bits
    ASSERT_NEAR(shown.pixels[i], expected.r, tolerance);
    ASSERT_NEAR(shown.pixels[i + 1], expected.g, tolerance);
    ASSERT_NEAR(shown.pixels[i + 2], expected.b, tolerance);
  }
  for (const auto& [name, step, type] :
       std::vector<std::tuple<std::string, float, OIIO::TypeDesc>>{{"a.tif", 0.5f / 65535, OIIO::TypeUInt16},
                                                                   {"a.TIFF", 0.5f / 65535, OIIO::TypeUInt16},
                                                                   {"a.png", 0.5f / 255, OIIO::TypeUInt8},
                                                                   {"a.jpg", 6.0f / 255, OIIO::TypeUInt8},
                                                                   {"a.jpeg", 6.0f / 255, OIIO::TypeUInt8}}) {
    SCOPED_TRACE(name);
    const auto path = dir_.path() / name;
    write_image(path, image, display, R"({"integrator":"vcm","passes":3})");
    const auto file = OIIO::ImageInput::open(path.string());
    ASSERT_TRUE(file) << OIIO::geterror();
    EXPECT_EQ(file->spec().format, type);
    std::vector<float> pixels(shown.pixels.size());
    ASSERT_TRUE(file->read_image(0, 0, 0, 3, OIIO::TypeFloat, pixels.data()));
    for (std::size_t i = 0; i < pixels.size(); ++i) ASSERT_NEAR(pixels[i], shown.pixels[i], step + 1e-6f) << i;
    EXPECT_EQ(nlohmann::json::parse(read_image_metadata(path))["integrator"], "vcm");
  }
  EXPECT_NE(error_text([&] { write_image(dir_.path() / "a.gif", image); }).find(".png, .jpg, .jpeg, .tif, .tiff"),
            std::string::npos);
}

// A configuration with a view that halves the logarithm, display = linear^0.5, and one with a view that keeps only red.
TEST_F(ImageFormats, OpenColorIoShowsWhatItsConfigurationSays) {
  dir_.write("own.ocio", R"(ocio_profile_version: 2
roles: {default: raw, scene_linear: lin_rec709}
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  Screen:
    - !<View> {name: Root, colorspace: root}
    - !<View> {name: Red, colorspace: red}
active_displays: [Screen]
active_views: [Root, Red]
colorspaces:
  - !<ColorSpace> {name: raw, isdata: true}
  - !<ColorSpace> {name: lin_rec709}
  - !<ColorSpace>
    name: root
    from_scene_reference: !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
  - !<ColorSpace>
    name: red
    from_scene_reference: !<MatrixTransform> {matrix: [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]}
)");
  const std::string config = (dir_.path() / "own.ocio").string();
  Image image(1, 1, {"R", "G", "B"});
  image.pixels = {0.25f, 0.04f, 0.16f};
  const auto shown = [&](const std::string& display, const std::string& view, float exposure) {
    return displayed(image, {.exposure = exposure, .ocio = OcioView{config, display, view}}).pixels;
  };
  const auto expect = [](const std::vector<float>& pixels, const std::vector<float>& expected) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(pixels[i], expected[i], 1e-4f) << i;
  };
  expect(shown("", "", 0), {0.5f, 0.2f, 0.4f});
  expect(shown("", "", 2), {1, 0.4f, 0.8f});
  expect(shown("Screen", "Red", 0), {0.25f, 0, 0});
  EXPECT_NE(error_text([&] { shown("Screen", "Blue", 0); }).find("no view 'Blue'; expected one of Root, Red"),
            std::string::npos);
  EXPECT_NE(error_text([&] {
              displayed(image, {.ocio = OcioView{"nosuch.ocio", "", ""}});
            }).find("no such file"),
            std::string::npos);
}

TEST_F(ImageFormats, PngIsReadElsewhereAsItWasWritten) {
  for (const int width : {1, 7, 300}) {
    constexpr int height = 5;
    std::vector<std::uint8_t> colors(3 * static_cast<std::size_t>(width) * height);
    std::mt19937 random(3);
    for (std::uint8_t& value : colors) value = static_cast<std::uint8_t>(random());
    const std::vector<unsigned char> bytes =
        encode_png_colors(width, colors, {{"lanthorn:scene", "M\xc3\xbcller"}, {"x:empty", ""}});
    EXPECT_EQ(std::string(bytes.begin() + 37, bytes.begin() + 41), "sRGB");
    const auto file = open_elsewhere("a.png", bytes);
    ASSERT_EQ(file->spec().width, width);
    ASSERT_EQ(file->spec().height, height);
    std::vector<std::uint8_t> found(colors.size());
    ASSERT_TRUE(file->read_image(0, 0, 0, 3, OIIO::TypeUInt8, found.data())) << file->geterror();
    EXPECT_EQ(found, colors);
    EXPECT_EQ(file->spec().get_string_attribute("lanthorn:scene"), "M\xc3\xbcller");
    EXPECT_EQ(file->spec().get_string_attribute("oiio:ColorSpace"), "sRGB");
  }
}

class RadiancePicture : public testing::Test {
 protected:
  Image read(const std::string& bytes) { return read_image(dir_.write("a.hdr", bytes)); }
  std::string problem(const std::string& bytes) {
    const auto path = dir_.write("a.hdr", bytes);
    return error_text([&] { read_image(path); }).substr(path.string().size());
  }
  static std::string with_header(const std::string& resolution, const std::string& pixels) {
    return "#?RADIANCE\n# a comment\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n" + resolution + "\n" + pixels;
  }

  test::TemporaryDir dir_;
};

TEST_F(RadiancePicture, HasThePixelsThatOpenImageIOReads) {
  const std::string path = (dir_.path() / "a.hdr").string();
  for (const int width : {4, 8, 129, 500}) {  // lines shorter than 8 pixels are not stored by component
    OIIO::ImageSpec spec(width, 20, 3, OIIO::TypeFloat);
    std::vector<float> pixels(static_cast<std::size_t>(width) * 20 * 3, 0);
    std::mt19937 random(2);
    for (std::size_t i = 0; i < pixels.size() / 2; ++i)
      pixels[i] = std::ldexp(static_cast<float>(random() % 1000), static_cast<int>(random() % 60) - 40);
    const auto output = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(output && output->open(path, spec) && output->write_image(OIIO::TypeFloat, pixels.data()) &&
                output->close());
    const auto input = OIIO::ImageInput::open(path);
    ASSERT_TRUE(input && input->read_image(0, 0, 0, 3, OIIO::TypeFloat, pixels.data()));
    const Image image = read_image(path);
    EXPECT_EQ(image.pixels, pixels) << width;
    EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  }
}

TEST_F(RadiancePicture, HoldsMantissasTimesAPowerOfTwo) {
  const Image image = read(with_header("-Y 1 +X 3", std::string("\x80\x40\xff\x81\x01\x02\x03\x01\xff\xff\xff\0", 12)));
  const std::vector<float> expected{1, 0.5f, 255.0f / 128, 0x1p-135f, 0x2p-135f, 0x3p-135f, 0, 0, 0};
  EXPECT_EQ(image.pixels, expected);
}

// Two by two pixels: a is at the upper left of the picture, b at the upper right, c and d below.
TEST_F(RadiancePicture, LinesRunAsItsResolutionSays) {
  const std::string a("\x80\0\0\x81", 4), b("\x40\0\0\x81", 4), c("\x20\0\0\x81", 4), d("\x10\0\0\x81", 4);
  const std::vector<float> expected{1, 0, 0, 0.5f, 0, 0, 0.25f, 0, 0, 0.125f, 0, 0};
  EXPECT_EQ(read(with_header("-Y 2 +X 2", a + b + c + d)).pixels, expected);
  EXPECT_EQ(read(with_header("-Y 2 -X 2", b + a + d + c)).pixels, expected);
  EXPECT_EQ(read(with_header("+Y 2 +X 2", c + d + a + b)).pixels, expected);
  EXPECT_EQ(read(with_header("+Y 2 -X 2", d + c + b + a)).pixels, expected);
  EXPECT_EQ(read(with_header("+X 2 -Y 2", a + c + b + d)).pixels, expected);
  EXPECT_EQ(read(with_header("+X 2 +Y 2", c + a + d + b)).pixels, expected);
  EXPECT_EQ(read(with_header("-X 2 -Y 2", b + d + a + c)).pixels, expected);
  EXPECT_EQ(read(with_header("-X 2 +Y 2\r", d + b + c + a)).pixels, expected);
  const Image high = read(with_header("+X 1 -Y 3", a + b + c));
  EXPECT_EQ(high.width, 1);
  EXPECT_EQ(high.height, 3);
  EXPECT_EQ(high.at(0, 2, 0), 0.25f);
}

TEST_F(RadiancePicture, PixelsMayBeRepeated) {
  const std::string a("\x80\0\0\x81", 4), b("\x40\0\0\x81", 4);
  const auto repeat = [](char count) { return std::string("\x01\x01\x01", 3) + count; };
  const Image short_run = read(with_header("-Y 1 +X 5", a + repeat(3) + b));
  for (int x = 0; x < 5; ++x) EXPECT_EQ(short_run.at(x, 0, 0), x < 4 ? 1 : 0.5f);
  const Image two_runs = read(with_header("-Y 1 +X 6", a + repeat(2) + b + repeat(2)));
  for (int x = 0; x < 6; ++x) EXPECT_EQ(two_runs.at(x, 0, 0), x < 3 ? 1 : 0.5f);
  // 2 and then 256 times 1.
  const Image long_run = read(with_header("-Y 1 +X 260", a + repeat(2) + repeat(1) + b));
  for (int x = 0; x < 260; ++x) EXPECT_EQ(long_run.at(x, 0, 0), x < 259 ? 1 : 0.5f) << x;
}

// Primaries of DCI-P3 with Rec.709's white: white stays, and red leaves the gamut of Rec.709.
TEST_F(RadiancePicture, ItsPrimariesAreThoseOfItsColours) {
  const auto colour = [&](const std::string& primaries, const std::string& pixel) {
    return read("#?RADIANCE\nPRIMARIES=" + primaries + "\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + pixel).pixels;
  };
  const std::string p3 = " .68 .32 .265 .69 .15 .06 .3127 .329", white("\x80\x80\x80\x81", 4), red("\x80\0\0\x81", 4);
  for (const float x : colour(p3, white)) EXPECT_NEAR(x, 1, 1e-5f);
  // The published matrix from Display P3 to sRGB (CSS Color 4).
  const std::vector<float> in_rec709 = colour(p3, red);
  EXPECT_NEAR(in_rec709[0], 1.22494f, 1e-4f);
  EXPECT_NEAR(in_rec709[1], -0.04206f, 1e-4f);
  EXPECT_NEAR(in_rec709[2], -0.01964f, 1e-4f);
  EXPECT_EQ(colour("0 0 0 0 0 0 0 0", red), (std::vector<float>{1, 0, 0})) << "as Photoshop writes them";
  EXPECT_NE(problem("#?RADIANCE\nPRIMARIES=.68 .32 nothing\n\n-Y 1 +X 1\n" + red).find("not eight numbers"),
            std::string::npos);
}

// Nine pixels of value 1, one run per component.
std::string line_of_nine() { return std::string("\x02\x02\0\x09\x89\x80\x89\x80\x89\x80\x89\x81", 12); }

TEST_F(RadiancePicture, DamagedOnesAreErrors) {
  const std::string whole = with_header("-Y 2 +X 9", line_of_nine() + line_of_nine());
  EXPECT_EQ(read(whole).pixels, std::vector<float>(54, 1));
  for (std::size_t size = 2; size < whole.size(); ++size)
    EXPECT_NE(problem(whole.substr(0, size)).find(": the file cannot be read: "), std::string::npos) << size;
  EXPECT_EQ(problem(whole.substr(0, whole.size() - 1)), ": the file cannot be read: ends before its last line");
  const auto line = [](const std::string& bytes) { return with_header("-Y 1 +X 9", bytes + std::string(60, '\x05')); };
  const std::string run_too_long = ": the file cannot be read: holds a run that is longer than its line";
  EXPECT_EQ(problem(line(std::string("\x02\x02\0\x09\x8a\x80", 6))), run_too_long);
  EXPECT_EQ(problem(line(std::string("\x02\x02\0\x09\x0a\x80", 6))), run_too_long);
  EXPECT_EQ(problem(line(std::string("\x02\x02\0\x09\0", 5) + line_of_nine().substr(4))), run_too_long) << "of nothing";
  EXPECT_EQ(problem(line(std::string("\x05\x05\x05\x05\x01\x01\x01\x09", 8))), run_too_long);
  EXPECT_EQ(problem(line("\x01\x01\x01\x01")), run_too_long) << "nothing to repeat";
  EXPECT_EQ(problem(line(std::string("\x02\x02\0\x0a", 4))),
            ": the file cannot be read: has a line of a different length");
  EXPECT_EQ(problem("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234"),
            ": the file cannot be read: holds pixels that are not 32-bit_rle_rgbe");
  for (const char* const resolution : {"-Y 1", "-Y 1 +Y 1", "Y 1 X 1", "-Y 0 +X 1", "-Y -1 +X 1", "-Y 9999999999 +X 1",
                                       "-Y 1 +X 1 +Z 1", "-Z 1 +X 1", "-Y  1 +X 1"})
    EXPECT_NE(problem(with_header(resolution, "1234")).find("resolution"), std::string::npos) << resolution;
  EXPECT_NE(problem(with_header("-Y 100000 +X 100000", "")).find("has 10000000000 pixels"), std::string::npos);
}

// In at least eight of ten runs of this test, OpenImageIO 2.4 crashed if headers were opened at the same time: it adds
// unknown names to one shared map.
TEST_F(ImageFormats, HeadersWithColourProfilesAreOpenedByManyThreads) {
  const std::string jpeg = test::grey_jpeg();
  constexpr std::size_t files = 4000;
  std::atomic<std::size_t> next{0}, good{0};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t)
      threads.emplace_back([&] {
        for (std::size_t i = next++; i < files; i = next++) {
          const std::string bytes = test::with_profile(jpeg, test::profile_of_unknown_tags(i));
          const ImageFile file(bytes, "the file", {}, 1u << 20);
          good += file.header().width == 8 ? 1 : 0;
        }
      });
  }
  EXPECT_EQ(good, files);
}

}  // namespace
}  // namespace lanthorn::image_formats_test
