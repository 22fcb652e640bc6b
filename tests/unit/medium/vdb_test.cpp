// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reading of NanoVDB files, which NanoVDB itself has written.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "lanthorn/error.h"
#include "math/hash.h"
#include "medium/density.h"
#include "support/error_text.h"
#include "support/temporary_dir.h"
#include "support/vdb_file.h"

namespace lanthorn::vdb_test {
namespace {

constexpr int size = 20;
constexpr float voxel = 0.1f;
const Point origin(1, -2, 0.5f);

float value(const Vec3& index) { return 0.2f + 0.03f * index.x + 0.02f * index.y + 0.01f * index.z; }

// Voxels 0 to 20 along each axis hold a linear function, which linear interpolation must reproduce.
std::string write_ramp(const test::TemporaryDir& folder, nanovdb::io::Codec codec) {
  const std::string file = (folder.path() / ("ramp" + std::to_string(static_cast<int>(codec)) + ".nvdb")).string();
  test::write_vdb(file, size, voxel, origin, value, codec);
  return file;
}

TEST(Vdb, DensitiesAreThoseOfTheGrid) {
  const test::TemporaryDir folder;
  for (const auto codec : {nanovdb::io::Codec::NONE, nanovdb::io::Codec::ZIP}) {
    const VdbDensity ramp(write_ramp(folder, codec), "density");
    HashRng rng(1);
    for (int i = 0; i < 1000; ++i) {
      const Vec3 index = static_cast<float>(size) * Vec3(rng.next(), rng.next(), rng.next());
      EXPECT_NEAR(ramp.at(origin + voxel * index), value(index), 1e-4f);
    }
    EXPECT_EQ(ramp.at(origin - Vec3(1)), 0);
    const Bounds box = ramp.box();
    EXPECT_LT(length_squared(box.min - origin), 2 * voxel * voxel);
    EXPECT_LT(length_squared(box.max - (origin + Vec3(size * voxel))), 6 * voxel * voxel);
    const Bounds cell{origin + Vec3(0.33f, 0.5f, 0.7f), origin + Vec3(0.52f, 1.1f, 1.2f)};
    const float bound = ramp.bound(cell);
    EXPECT_GE(bound, value((cell.max - origin) / voxel));
    EXPECT_LE(bound, value((cell.max - origin) / voxel + Vec3(2)));
  }
}

TEST(Vdb, BrokenFilesAreErrors) {
  const test::TemporaryDir folder;
  const std::string file = write_ramp(folder, nanovdb::io::Codec::NONE);
  EXPECT_THROW(VdbDensity(file, "smoke"), Error);
  EXPECT_THROW(VdbDensity((folder.path() / "none.nvdb").string(), "density"), Error);
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  for (const std::size_t kept : {0u, 10u, 200u, 1000u, 100000u}) {
    const auto cut = folder.write("cut.nvdb", bytes.str().substr(0, kept));
    EXPECT_THROW(VdbDensity(cut.string(), "density"), Error) << kept;
  }
}

TEST(Vdb, ValuesThatAreNotFiniteAreErrors) {
  const test::TemporaryDir folder;
  const std::string file = (folder.path() / "a.nvdb").string();
  for (const float bad : {NAN, INFINITY, -INFINITY}) {
    test::write_vdb(file, size, voxel, origin, [&](const Vec3& i) { return i == Vec3(17, 3, 9) ? bad : value(i); });
    EXPECT_NE(test::error_text([&] { VdbDensity(file, "density"); }).find("a value that is infinite or not a number"),
              std::string::npos);
  }
}

// Files of older versions have other headers, which must not be reported as damage.
TEST(Vdb, OtherVersionsAreNamed) {
  const test::TemporaryDir folder;
  std::ostringstream written;
  written << std::ifstream(write_ramp(folder, nanovdb::io::Codec::NONE), std::ios::binary).rdbuf();
  const auto message_of = [&](const std::string& bytes) {
    return test::error_text([&] { VdbDensity(folder.write("other.nvdb", bytes).string(), "density"); });
  };
  std::string old = written.str();
  const nanovdb::Version version(29, 3, 0);
  std::memcpy(old.data() + offsetof(nanovdb::io::Header, version), &version, sizeof(version));
  EXPECT_NE(message_of(old).find("has version 29.3.0 of the format; expected version 32.x"), std::string::npos)
      << message_of(old);
  EXPECT_NE(message_of(std::string(100, 'x')).find("is not a NanoVDB file"), std::string::npos);
}

}  // namespace
}  // namespace lanthorn::vdb_test
