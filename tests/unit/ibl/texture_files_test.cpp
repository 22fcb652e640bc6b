// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Texture files are read at the byte offsets of their specifications. Environments are read from files in all layouts.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "lanthorn/error.h"
#include "lanthorn/ibl.h"
#include "lanthorn/image_file.h"
#include "math/packed_float.h"
#include "support/temporary_dir.h"

namespace lanthorn::texture_files_test {
namespace {

// A value that half floats can represent and that identifies its texel.
float value_at(int level, int face, int x, int y, int channel) {
  return static_cast<float>(level * 512 + face * 64 + y * 16 + x * 4 + channel) / 4;
}

std::vector<Image> levels_of_four() {
  std::vector<Image> levels;
  for (int level = 0; level < 3; ++level) {
    const int n = 4 >> level;
    Image image(6 * n, n, {"R", "G", "B"});
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < 6 * n; ++x)
        for (int c = 0; c < 3; ++c) image.at(x, y, static_cast<std::size_t>(c)) = value_at(level, x / n, x % n, y, c);
    levels.push_back(std::move(image));
  }
  return levels;
}

Texture texture_of(const std::vector<Image>& levels, TexelFormat format) {
  Texture texture;
  texture.format = format;
  for (const Image& level : levels) texture.levels.push_back(&level);
  return texture;
}

template <class T>
T read(const std::string& bytes, std::size_t offset) {
  T value{};
  EXPECT_LE(offset + sizeof value, bytes.size());
  if (offset + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

void expect_texels(const std::string& bytes, std::size_t offset, int level, int face) {
  const int n = 4 >> level;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const std::size_t at = offset + 8 * static_cast<std::size_t>(y * n + x);
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(decode_half(read<std::uint16_t>(bytes, at + 2 * static_cast<std::size_t>(c))),
                  value_at(level, face, x, y, c));
      ASSERT_EQ(read<std::uint16_t>(bytes, at + 6), 0x3C00);
    }
}

TEST(Ktx2, HasFacesAndLevelsWhereItsIndexSays) {
  const std::vector<Image> levels = levels_of_four();
  const std::string file = encode_ktx2(texture_of(levels, TexelFormat::half), {{"KTXorientation", "rd"}, {"a", "bc"}});
  EXPECT_EQ(file.substr(0, 12), std::string("\xABKTX 20\xBB\r\n\x1A\n", 12));
  const std::array<std::uint32_t, 9> expected{97, 2, 4, 4, 0, 0, 6, 3, 0};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(read<std::uint32_t>(file, 12 + 4 * i), expected[i]) << i;
  const auto dfd = read<std::uint32_t>(file, 48), kvd = read<std::uint32_t>(file, 56);
  EXPECT_EQ(read<std::uint32_t>(file, dfd), read<std::uint32_t>(file, 52));
  EXPECT_EQ(dfd + read<std::uint32_t>(file, 52), kvd);
  EXPECT_EQ(read<std::uint32_t>(file, kvd), 18u);
  EXPECT_EQ(file.substr(kvd + 4, 18), std::string("KTXorientation\0rd\0", 18));
  EXPECT_EQ(read<std::uint32_t>(file, 60), 24u + 12u) << "each padded to four bytes";
  std::uint64_t end = file.size();
  for (int level = 0; level < 3; ++level) {
    const std::size_t entry = 80 + 24 * static_cast<std::size_t>(level);
    const auto offset = read<std::uint64_t>(file, entry), size = read<std::uint64_t>(file, entry + 8);
    const std::uint64_t face_size = 8u * (16u >> (2 * level));
    EXPECT_EQ(offset % 8, 0u);
    EXPECT_EQ(size, 6 * face_size);
    EXPECT_EQ(read<std::uint64_t>(file, entry + 16), size);
    EXPECT_EQ(offset + size, end) << "the largest level is last";
    for (int face = 0; face < 6; ++face)
      expect_texels(file, offset + static_cast<unsigned>(face) * face_size, level, face);
    end = offset;
  }
}

TEST(Dds, HasAllLevelsOfAFaceTogether) {
  const std::vector<Image> levels = levels_of_four();
  const std::string file = encode_dds(texture_of(levels, TexelFormat::half));
  EXPECT_EQ(file.substr(0, 4), "DDS ");
  EXPECT_EQ(read<std::uint32_t>(file, 4), 124u);
  EXPECT_EQ(read<std::uint32_t>(file, 12), 4u);
  EXPECT_EQ(read<std::uint32_t>(file, 16), 4u);
  EXPECT_EQ(read<std::uint32_t>(file, 28), 3u);
  EXPECT_EQ(read<std::uint32_t>(file, 76), 32u);
  EXPECT_EQ(file.substr(84, 4), "DX10");
  EXPECT_EQ(read<std::uint32_t>(file, 112), 0xFE00u);
  EXPECT_EQ(read<std::uint32_t>(file, 128), 10u);
  EXPECT_EQ(read<std::uint32_t>(file, 136), 4u);
  std::size_t offset = 148;
  for (int face = 0; face < 6; ++face)
    for (int level = 0; level < 3; ++level) {
      expect_texels(file, offset, level, face);
      offset += 8u * (16u >> (2 * level));
    }
  EXPECT_EQ(file.size(), offset);
}

TEST(TextureFiles, HaveSharedExponentsOnRequest) {
  const std::vector<Image> levels = levels_of_four();
  const std::string ktx = encode_ktx2(texture_of(levels, TexelFormat::rgb9e5), {}),
                    dds = encode_dds(texture_of(levels, TexelFormat::rgb9e5));
  EXPECT_EQ(read<std::uint32_t>(ktx, 12), 123u);
  EXPECT_EQ(read<std::uint32_t>(dds, 128), 67u);
  const auto texel = decode_rgb9e5(read<std::uint32_t>(ktx, read<std::uint64_t>(ktx, 80) + 4));
  EXPECT_NEAR(texel[2], value_at(0, 0, 1, 0, 2), 0.01f);
  EXPECT_EQ(decode_rgb9e5(read<std::uint32_t>(dds, 152)), texel);
}

class EnvironmentFiles : public testing::Test {
 protected:
  // Values identify face, column and row.
  static Image face_image(int face) {
    Image image(2, 2, {"R", "G", "B"});
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 2; ++x) image.at(x, y, 0) = static_cast<float>(100 * face + 10 * y + x);
    return image;
  }
  static void paste(Image& sheet, int face, int column, int row, bool turned = false) {
    const Image from = face_image(face);
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 2; ++x)
        sheet.at(2 * column + x, 2 * row + y, 0) = from.at(turned ? 1 - x : x, turned ? 1 - y : y, 0);
  }
  std::filesystem::path save(const char* name, const Image& image) {
    write_exr(dir_.path() / name, image);
    return dir_.path() / name;
  }
  static void expect_strip(const Image& strip) {
    ASSERT_EQ(strip.width, 12);
    ASSERT_EQ(strip.height, 2);
    for (int face = 0; face < 6; ++face)
      for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x)
          EXPECT_EQ(strip.at(2 * face + x, y, 0), static_cast<float>(100 * face + 10 * y + x));
  }
  static std::string problem_of(const std::vector<std::filesystem::path>& files) {
    try {
      read_environment(files);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }

  test::TemporaryDir dir_;
};

TEST_F(EnvironmentFiles, OfCubesHaveSixLayouts) {
  std::vector<std::filesystem::path> faces;
  Image column(2, 12, {"R", "G", "B"}), row(12, 2, {"R", "G", "B"}), wide(8, 6, {"R", "G", "B"}),
      high(6, 8, {"R", "G", "B"});
  for (int face = 0; face < 6; ++face) {
    faces.push_back(save(("face" + std::to_string(face) + ".exr").c_str(), face_image(face)));
    paste(column, face, 0, face);
    paste(row, face, face, 0);
  }
  // +Y above and -Y below the row -X +Z +X -Z; in the vertical cross, -Z is below -Y, upside down.
  for (Image* cross : {&wide, &high}) {
    paste(*cross, 1, 0, 1);
    paste(*cross, 4, 1, 1);
    paste(*cross, 0, 2, 1);
    paste(*cross, 2, 1, 0);
    paste(*cross, 3, 1, 2);
  }
  paste(wide, 5, 3, 1);
  paste(high, 5, 1, 3, true);
  expect_strip(read_environment(faces));
  expect_strip(read_environment({save("column.exr", column)}));
  expect_strip(read_environment({save("row.exr", row)}));
  expect_strip(read_environment({save("wide.exr", wide)}));
  expect_strip(read_environment({save("high.exr", high)}));
}

TEST_F(EnvironmentFiles, ThatAreNoneAreNamed) {
  const auto odd = save("odd.exr", Image(10, 4, {"R", "G", "B"}));
  EXPECT_EQ(
      problem_of({odd}),
      odd.string() +
          ": is not an environment: it is 10 x 4 pixels; expected 2:1 (equirectangular), square (octahedral), a cube "
          "of 6:1, 1:6, or a cross of 4:3 or 3:4 with nothing beside its faces");
  // A photograph in the shape of a cross differs in that its corners are not empty.
  for (const auto& [width, height] : std::vector<std::array<int, 2>>{{8, 6}, {6, 8}}) {
    Image photograph(width, height, {"R", "G", "B"});
    for (std::size_t i = 0; i < photograph.pixels.size(); ++i)
      photograph.pixels[i] = 0.5f + 0.001f * static_cast<float>(i);
    EXPECT_NE(problem_of({save("photograph.exr", photograph)}).find("a cross of 4:3 or 3:4 with nothing beside"),
              std::string::npos);
  }
  const auto depth = save("depth.exr", Image(4, 2, {"Z"}));
  EXPECT_EQ(problem_of({depth}), depth.string() + ": is not an environment: it has no channels R, G, B");
  const auto face = save("face.exr", Image(2, 2, {"R", "G", "B"})),
             large = save("large.exr", Image(4, 4, {"R", "G", "B"}));
  EXPECT_EQ(problem_of({face, face, face, large, face, face}),
            large.string() + ": is 4 x 4 pixels, but " + face.string() + " is 2 x 2; all faces must have one size");
  EXPECT_EQ(problem_of({face, odd, face, face, face, face}),
            odd.string() + ": is 10 x 4 pixels; a face of a cube must be square");
  EXPECT_NE(problem_of({face, face}).find("not 2 files"), std::string::npos);
  Image dark(4, 2, {"R", "G", "B"});
  for (const float value : {0.0f, -1.0f, 3e38f}) {
    dark.at(1, 1, 0) = value;
    const auto file = save("dark.exr", dark);
    EXPECT_EQ(problem_of({file}),
              file.string() + ": is not an environment: it holds no light, that is, no number above 0 and up to 1e+30");
  }
  dark.at(1, 1, 0) = 1e-20f;
  EXPECT_EQ(problem_of({save("dark.exr", dark)}), "");
  Image face_of_nan(2, 2, {"R", "G", "B", "depth.Z"});
  face_of_nan.at(0, 0, 3) = HUGE_VALF;  // the sky's depth: no colour
  for (const float value : {std::nanf(""), HUGE_VALF, -HUGE_VALF}) {
    dark.at(3, 1, 2) = value;
    EXPECT_EQ(problem_of({save("dark.exr", dark)}),
              (dir_.path() / "dark.exr").string() +
                  ": cannot be an environment: its pixel (3, 1) is infinite or not a number");
    face_of_nan.at(1, 0, 1) = value;
    const auto bad = save("nan.exr", face_of_nan);
    EXPECT_EQ(problem_of({face, face, face, bad, face, face}),
              bad.string() + ": cannot be an environment: its pixel (1, 0) is infinite or not a number");
  }
  dir_.write("broken.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 512 +X 1024\n\x02\x02");
  EXPECT_EQ(problem_of({dir_.path() / "broken.hdr"}).find((dir_.path() / "broken.hdr").string()), 0u);
}

}  // namespace
}  // namespace lanthorn::texture_files_test
