// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Images in memory and in tiles on disk, and their coarser levels.
#include "texture/texture_cache.h"

#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <barrier>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "film/display.h"
#include "lanthorn/image.h"
#include "lanthorn/session.h"
#include "lanthorn/threads.h"
#include "math/hash.h"
#include "math/sampler.h"
#include "support/error_text.h"
#include "support/scene_text.h"
#include "support/temporary_dir.h"
#include "texture/image_texture.h"
#include "texture/texture_memory.h"

namespace lanthorn::texture_cache_test {
namespace {

using description::Encoding;
using description::ImageFilter;
using description::Wrap;

constexpr std::uint64_t mebi = std::uint64_t{1} << 20;

// Damages the tiles: all unlinked files that this process has open in the folder.
int damage_nameless_files(const std::filesystem::path& folder) {
  int damaged = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code code;
    const std::string target = std::filesystem::read_symlink(entry.path(), code).string();
    if (code || !target.starts_with(folder.string()) || !target.ends_with("(deleted)")) continue;
    const int file = ::open(entry.path().c_str(), O_RDWR | O_CLOEXEC);
    const off_t size = ::lseek(file, 0, SEEK_END);
    for (off_t at = 0; at < size; at += 1000) damaged += ::pwrite(file, "x", 1, at) == 1 ? 1 : 0;
    ::close(file);
  }
  return damaged;
}

class TextureCaches : public ::testing::Test {
 protected:
  // Values in [0,1), of which 8-bit files keep 256 levels.
  std::string write(const std::string& name, int width, int height, int channels, OIIO::TypeDesc type,
                    float least_alpha = 0) {
    std::vector<float> texels(static_cast<std::size_t>(width * height * channels));
    HashRng rng(7);
    for (std::size_t i = 0; i < texels.size(); ++i) {
      texels[i] = rng.next();
      const std::size_t stride = static_cast<std::size_t>(channels);
      if (stride % 2 == 0 && i % stride == stride - 1) texels[i] = std::max(texels[i], least_alpha);
    }
    const std::string path = (folder_.path() / name).string();
    const auto output = OIIO::ImageOutput::create(path);
    OIIO::ImageSpec spec(width, height, channels, type);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    EXPECT_TRUE(output->open(path, spec) && output->write_image(OIIO::TypeDesc::FLOAT, texels.data()));
    EXPECT_TRUE(output->close());
    return path;
  }
  // A checkerboard of single texels with values 0 and 255.
  std::string write_checkerboard(const std::string& name, int width, int height) {
    const std::string path = (folder_.path() / name).string();
    std::ofstream file(path, std::ios::binary);
    file << "P6\n" << width << ' ' << height << "\n255\n";
    std::string row(static_cast<std::size_t>(3 * width), '\0');
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < 3 * width; ++x) row[static_cast<std::size_t>(x)] = (x / 3 + y) % 2 == 0 ? '\xff' : '\0';
      file << row;
    }
    return path;
  }

  test::TemporaryDir folder_;
  FileAccess access_;
};

// Level 1 exists from four million texels on; these images have as many.
TEST_F(TextureCaches, CachedTexelsAreThoseInMemory) {
  struct Case {
    std::string file;
    ImageWish wish;
  };
  const std::string bytes = write("a.tif", 4099, 1031, 3, OIIO::TypeDesc::UINT8);
  const std::vector<Case> cases = {
      {bytes, {{}, true}},
      {write("b.png", 300, 201, 4, OIIO::TypeDesc::UINT8), {{}, true}},
      {write("opaque.png", 130, 64, 4, OIIO::TypeDesc::UINT8, 1), {{}, true}},
      {write("c.png", 65, 70, 3, OIIO::TypeDesc::UINT16), {{}, true}},
      {write("d.exr", 129, 70, 1, OIIO::TypeDesc::HALF), {{}, true}},
      {write("e.tif", 129, 70, 4, OIIO::TypeDesc::FLOAT), {{}, true}},
      {write("grey-b.png", 300, 201, 2, OIIO::TypeDesc::UINT8), {{}, true}},
      {write("grey-opaque.png", 130, 64, 2, OIIO::TypeDesc::UINT16, 1), {{}, true}},
      {write("wide.png", 129, 70, 3, OIIO::TypeDesc::UINT8), {{Encoding::automatic, 1, ColorSpace::rec2020}, true}},
      {bytes, {{Encoding::gamma, 1.8f}, false}}};
  const auto cache = std::make_shared<TextureCache>(mebi);
  for (const auto& [file, wish] : cases) {
    const TextureImage in_memory(file, access_, wish, {}), cached(file, access_, wish, {}, cache);
    ASSERT_TRUE(cached.is_cached());
    ASSERT_FALSE(in_memory.is_cached());
    ASSERT_EQ(cached.levels(), in_memory.levels());
    EXPECT_EQ(cached.has_alpha(), in_memory.has_alpha()) << file;
    EXPECT_EQ(in_memory.has_alpha(), file.ends_with("b.png") || file.ends_with("e.tif"));
    HashRng rng(1);
    for (int i = 0; i < 4000; ++i) {
      const float s = rng.next(), t = rng.next();
      const Vec2 st = Vec2(4 * s - 1, 4 * t - 1);
      const WrapModes wrap(static_cast<Wrap>(i % 4));
      const ImageFilter filter = i % 3 == 0 ? ImageFilter::point : ImageFilter::bilinear;
      const int level = i % cached.levels();
      const Rgb a = in_memory.rgb(st, wrap, filter, level), b = cached.rgb(st, wrap, filter, level);
      ASSERT_TRUE(a.r == b.r && a.g == b.g && a.b == b.b) << file << ' ' << level << ' ' << a.r << ' ' << b.r;
      ASSERT_EQ(in_memory.scalar(st, wrap, filter), cached.scalar(st, wrap, filter)) << file;
      ASSERT_EQ(in_memory.scalar(st, wrap, filter, alpha_channel), cached.scalar(st, wrap, filter, alpha_channel));
    }
  }
  EXPECT_FALSE(cache->problem());
  EXPECT_GT(cache->counts().tiles_read, 100u);
}

TEST(TextureLevels, HaveHalfOfTheRowsAndColumnsRoundedUp) {
  const TextureFormat format{67, 34, 1, false, {}};
  const int levels = all_levels_of(format);
  EXPECT_EQ(levels, 8);  // 67 34 17 9 5 3 2 1 columns
  std::vector<int> rows(static_cast<std::size_t>(levels));
  float last = 0;
  LevelMaker maker(format, levels, [&](int level, int y, const std::byte* row) {
    EXPECT_EQ(y, rows[static_cast<std::size_t>(level)]++);
    if (level == 1) std::memcpy(&last, row + 33 * sizeof last, sizeof last);
  });
  std::vector<float> row(67, 1.0f);
  row.back() = 5;  // level 1's last texels come from this column alone
  for (int y = 0; y < format.height; ++y) maker.add(reinterpret_cast<const std::byte*>(row.data()));
  EXPECT_EQ(rows, std::vector<int>({34, 17, 9, 5, 3, 2, 1, 1}));
  EXPECT_EQ(last, 5);
}

// The mean of linear values is kept. Rounding .5 to the nearest sRGB texel, 188, would be .6 % too bright.
TEST(TextureLevels, KeepTheMeanOfACheckerboard) {
  TextureFormat format{128, 64, 3, true, {}};
  for (unsigned i = 0; i < 256; ++i) format.decode[i] = linear_from_srgb(static_cast<float>(i) / 255.0f);
  const int levels = 4;
  std::vector<double> sums(levels);
  LevelMaker maker(format, levels, [&](int level, int, const std::byte* row) {
    for (int i = 0; i < 3 * level_size(format.width, level); ++i)
      sums[static_cast<std::size_t>(level)] +=
          static_cast<double>(format.decode[static_cast<std::size_t>(std::to_integer<int>(row[i]))]);
  });
  std::vector<std::byte> row(format.row_bytes());
  for (int y = 0; y < format.height; ++y) {
    for (std::size_t x = 0; x < row.size(); ++x)
      row[x] = (x / 3 + static_cast<std::size_t>(y)) % 2 == 0 ? std::byte{255} : std::byte{0};
    maker.add(row.data());
  }
  for (int level = 0; level < levels; ++level) {
    const int texels = 3 * level_size(format.width, level) * level_size(format.height, level);
    // Texel values are .0060 apart there, so random rounding has a standard deviation of at most .0030, at this level
    // and at the ones before it, which have 4, 16, ... times as many texels.
    const double deviation = .003 * std::sqrt(4.0 / 3 / texels);
    EXPECT_NEAR(sums[static_cast<std::size_t>(level)] / texels, .5, 6 * deviation) << level;
  }
}

// OpenImageIO's records of a thread outlive its caches, and a new cache often has the address of the last.
TEST_F(TextureCaches, AThreadOutlivesManyCaches) {
  const std::string first = write("first.png", 200, 200, 3, OIIO::TypeDesc::UINT8);
  const std::string second = write("second.png", 150, 250, 3, OIIO::TypeDesc::UINT16);
  constexpr int turns = 40;
  std::barrier step(2);
  std::unique_ptr<TextureImage> image;
  Rgb read{};
  const auto texel = [](const TextureImage& of) { return of.rgb({.5f, .5f}, Wrap::repeat, ImageFilter::point); };
  std::thread reader([&] {
    for (int i = 0; i < turns; ++i) {
      step.arrive_and_wait();
      read = texel(*image);
      step.arrive_and_wait();
    }
  });
  for (int i = 0; i < turns; ++i) {
    const std::string& file = i % 2 == 0 ? first : second;
    const auto cache = std::make_shared<TextureCache>(i % 3 == 0 ? 0 : mebi);
    image = std::make_unique<TextureImage>(file, access_, ImageWish{}, SourceLocation{}, cache);
    step.arrive_and_wait();
    step.arrive_and_wait();
    const Rgb expected = texel(TextureImage(file, access_, {}, {}));
    EXPECT_TRUE(read.r == expected.r && read.g == expected.g && read.b == expected.b) << i;
    EXPECT_FALSE(cache->problem());
    image.reset();
  }
  reader.join();
}

TEST_F(TextureCaches, ADamagedTileIsNamedAfterItsImage) {
  const std::string path = write("a.png", 200, 200, 3, OIIO::TypeDesc::UINT8);
  const auto cache = std::make_shared<TextureCache>(mebi);
  const TextureImage image(path, access_, {}, {"scene.pbrt", 3, 1}, cache);
  EXPECT_GT(damage_nameless_files(scratch_folder()), 0);
  image.rgb({.5f, .5f}, Wrap::repeat, ImageFilter::point);
  ASSERT_TRUE(cache->problem());
  EXPECT_EQ(std::string(cache->problem()->what()), "scene.pbrt:3:1: image \"" + path +
                                                       "\": a tile of it in the temporary file in " +
                                                       scratch_folder().string() + " is damaged: check that disk");
}

TEST_F(TextureCaches, ADamagedImageIsNamed) {
  const std::string path = write("a.png", 200, 200, 3, OIIO::TypeDesc::UINT8);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const auto cache = std::make_shared<TextureCache>(mebi);
  const std::string problem = test::error_text([&] { TextureImage(path, access_, {}, {"scene.pbrt", 3, 1}, cache); });
  EXPECT_TRUE(problem.starts_with("scene.pbrt:3:1: image \"" + path + "\" cannot be read: ")) << problem;
}

TEST(TextureMemory, KeepsSmallImagesAndAllIfTheyFit) {
  const std::vector<TextureImage::Need> needs{{30 * mebi, 0}, {mebi, 0}, {40 * mebi, 0}, {2 * mebi, 0}};
  using Cached = std::vector<bool>;
  TextureMemory enough(73 * mebi), little(60 * mebi), least(0);
  EXPECT_EQ(enough.plan(needs), Cached({false, false, false, false}));
  EXPECT_EQ(enough.cache(), nullptr);
  EXPECT_EQ(little.plan(needs), Cached({true, false, true, false}));
  ASSERT_NE(little.cache(), nullptr);
  EXPECT_EQ(little.cache()->bytes(), 57 * mebi);
  EXPECT_EQ(least.plan(needs), Cached({true, true, true, true}));
  EXPECT_EQ(enough.plan({{mebi, 0}}), Cached({true}));  // an image that is read later, when the memory is full
  const std::vector<TextureImage::Need> huge{{std::uint64_t{1} << 60, std::uint64_t{1} << 60}};
  const std::string problem = test::error_text([&] { TextureMemory(mebi).plan(huge); });
  EXPECT_TRUE(problem.starts_with("the textures take 1.0 EiB of memory, but --texture-memory allows 1.0 MiB"))
      << problem;
}

// A floor that extends far away, with a fine checkerboard.
std::string floor_of(const std::string& image) {
  return R"(LightSource "infinite" "float scale" 1
Texture "t" "spectrum" "imagemap" "string filename" ")" +
         image +
         R"("
Material "diffuse" "texture reflectance" "t"
Shape "trianglemesh" "point3 P" [-50 -1 0  50 -1 0  50 -1 100  -50 -1 100] "point2 uv" [0 0 8 0 8 8 0 8] "integer indices" [0 1 2 0 2 3]
)";
}
const std::string mirror = R"(Material "conductor"
Translate 0 0 6 Shape "sphere" "float radius" 1
)";

SceneDescription described(const std::string& image, std::uint64_t memory, const std::string& more = {}) {
  const std::string head =
      R"(Camera "perspective" "float fov" 60
Film "rgb" "integer xresolution" 40 "integer yresolution" 30
)";
  SceneDescription scene = read_pbrt_string(head + "WorldBegin\n" + floor_of(image) + more, ".", "floor");
  scene.access.texture_memory = memory;
  return scene;
}

TEST_F(TextureCaches, ThePictureIsTheSameForAnyBoundAndAnyThreads) {
  const std::string image = write_checkerboard("c.ppm", 4096, 1024);
  for (const std::string method : {"path", "vcm"}) {
    std::vector<float> first;
    for (const std::uint64_t memory : {16 * mebi, 1024 * mebi, std::uint64_t{0}})
      for (const unsigned threads : {1u, 2u}) {
        const ThreadLimit limit(threads);
        RenderOptions options;
        options.integrator = method;
        options.photons = 2000;
        const SharedScene scene = build_scene(described(image, memory, mirror));
        EXPECT_EQ(summarize(*scene).texture_disk_bytes > 0, memory < 1024 * mebi);
        Session session(scene, options);
        session.render({.passes = {0, 2}});
        const std::vector<float> pixels = session.picture().pixels;
        if (first.empty()) first = pixels;
        ASSERT_TRUE(pixels == first) << method << ' ' << memory << ' ' << threads;
        EXPECT_EQ(summarize(*scene).texture_tiles_read > 0, memory < 1024 * mebi);
      }
  }
}

TEST_F(TextureCaches, ARenderEndsWithTheNameOfADamagedTile) {
  const std::string image = write_checkerboard("c.ppm", 512, 512);
  const SharedScene scene = build_scene(described(image, 0));  // `path` reads no texture before the first pass
  RenderOptions options;
  options.integrator = "path";
  Session session(scene, options);
  EXPECT_GT(damage_nameless_files(scratch_folder()), 0);
  const std::string problem = test::error_text([&] { session.render({.passes = {0, 1}}); });
  EXPECT_NE(problem.find("image \"" + image + "\": a tile of it in the temporary file"), std::string::npos) << problem;
}

// Reflectance of the floor as rays see it, over random points around one place.
struct Seen {
  double mean = 0, variance = 0;
};
Seen seen(const Scene& scene, float distance, float spread) {
  constexpr int samples = 4000;
  HashRng rng(3);
  double sum = 0, squares = 0;
  for (int i = 0; i < samples; ++i) {
    const float u = rng.next(), v = rng.next();
    Ray ray{{u - 0.5f, -1 + distance, 50 + v - 0.5f}, {0, -1, 0}};
    ray.spread = spread;
    const std::optional<SurfacePoint> at = scene.intersect(ray, test::white);
    const auto value = static_cast<double>(std::get<Diffuse>(at->bsdf.get()).reflectance[0]);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / samples;
  return {mean, squares / samples - mean * mean};
}

TEST_F(TextureCaches, FootprintsAverageAFineCheckerboardFarAway) {
  // Texels measure 12.5 m / 4096 = 3 mm by 12 mm.
  const std::string image = write_checkerboard("c.ppm", 4096, 1024);
  const SharedScene scene = build_scene(described(image, 1024 * mebi));
  const Seen full = seen(*scene, 40, 0);
  EXPECT_NEAR(full.mean, .5, .03);
  EXPECT_GT(full.variance, .02);
  // The footprint is seven texels, too small for level 1: fewer than four pairs lie side by side.
  EXPECT_DOUBLE_EQ(seen(*scene, 40, 7.5f * .0122f / 40).variance, full.variance);
  // The footprint is eight texels: level 1.
  const Seen far = seen(*scene, 40, 8.5f * .0122f / 40);
  EXPECT_LT(far.variance, .02 * full.variance);
  EXPECT_NEAR(far.mean, .5, .003);
  // The footprint grows with distance.
  EXPECT_DOUBLE_EQ(seen(*scene, 4, 8.5f * .0122f / 40).variance, full.variance);
}

TEST_F(TextureCaches, FootprintsGoOnBehindTheBoundsOfMedia) {
  const std::string image = write_checkerboard("c.ppm", 4096, 1024);
  const auto albedo = [&](const std::string& more) {
    RenderOptions options;
    options.integrator = "path";
    Session session(build_scene(described(image, 1024 * mebi, more)), options);
    session.render({.passes = {0, 1}});
    return select_layer(session.picture(), "albedo")->pixels;
  };
  const std::string air = R"(MakeNamedMedium "air" "string type" "homogeneous" "float scale" 1e-6
)";
  const std::vector<float> direct = albedo("");
  const std::vector<float> behind = albedo(air + R"(MediumInterface "air" ""
Material "interface"
Shape "sphere"
)");
  ASSERT_EQ(behind.size(), direct.size());
  for (std::size_t i = 0; i < direct.size(); ++i) EXPECT_NEAR(behind[i], direct[i], .01f) << i;
}

}  // namespace
}  // namespace lanthorn::texture_cache_test
