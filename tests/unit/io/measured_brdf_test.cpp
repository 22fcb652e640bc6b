// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/measured_brdf.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "lanthorn/error.h"
#include "math/vec.h"
#include "support/measured_conductor.h"

namespace lanthorn::measured_brdf_test {
namespace {

MeasuredData small_measurement() {
  return test::measure({.indices = {{1, 2}, {1, 3}, {1, 4}, {1, 5}},
                        .wavelengths = {400, 500, 600, 700},
                        .elevations = 3,
                        .normals = 5,
                        .warped = 4});
}

std::string message_of(const std::string& bytes) {
  try {
    parse_measured_brdf(bytes, "a.bsdf");
  } catch (const Error& error) {
    EXPECT_EQ(error.where.file, "a.bsdf");
    return error.message;
  }
  return "";
}

TEST(MeasuredBrdfFile, HoldsWhatWasWritten) {
  const MeasuredData written = small_measurement();
  const MeasuredData read = parse_measured_brdf(test::bsdf_file(written), "a.bsdf");
  EXPECT_EQ(read.phi, written.phi);
  EXPECT_EQ(read.theta, written.theta);
  EXPECT_EQ(read.wavelengths, written.wavelengths);
  for (const auto grids : {&MeasuredData::ndf, &MeasuredData::sigma, &MeasuredData::vndf, &MeasuredData::luminance,
                           &MeasuredData::reflectance}) {
    EXPECT_EQ((read.*grids).width, (written.*grids).width);
    EXPECT_EQ((read.*grids).height, (written.*grids).height);
    EXPECT_EQ((read.*grids).values, (written.*grids).values);
  }
  EXPECT_TRUE(read.weighted);
  EXPECT_TRUE(read.is_isotropic());
}

TEST(MeasuredBrdfFile, ColoursAndSymmetricSurfacesAreRead) {
  MeasuredData written = test::measure({.alpha_x = 0.4f,
                                        .alpha_y = 0.2f,
                                        .indices = {3, {1, 2}},
                                        .azimuths = 4,
                                        .elevations = 2,
                                        .normals = 4,
                                        .warped = 3,
                                        .symmetry = 4});
  written.weighted = false;
  const MeasuredData read = parse_measured_brdf(test::bsdf_file(written), "a.bsdf");
  EXPECT_TRUE(read.wavelengths.empty());
  EXPECT_EQ(read.channel_count(), 3u);
  EXPECT_EQ(read.symmetry, 4);
  EXPECT_FALSE(read.weighted);
  EXPECT_FALSE(read.is_isotropic());
}

TEST(MeasuredBrdfFile, EveryTruncationIsRefused) {
  const std::string whole = test::bsdf_file(small_measurement());
  ASSERT_EQ(message_of(whole), "");
  for (std::size_t size = 0; size < whole.size(); size += size < 700 ? 1 : 37)
    EXPECT_NE(message_of(whole.substr(0, size)), "") << size;
  EXPECT_EQ(message_of(""), "is not a tensor file");
  EXPECT_EQ(message_of(whole.substr(0, 20)), "ends inside its header");
}

TEST(MeasuredBrdfFile, HostileHeadersAreRefusedWithoutAllocating) {
  const auto with = [](std::uint16_t dimensions, std::uint64_t offset, std::uint64_t extent) {
    std::string bytes("tensor_file\0\1\0\1\0\0\0\1\0a", 21);
    const auto put = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
    put(dimensions);
    put(std::uint8_t{10});
    put(offset);
    for (int i = 0; i < dimensions; ++i) put(extent);
    return bytes;
  };
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(message_of(with(1, 0, most)), "has a field that is empty or larger than the file");
  EXPECT_EQ(message_of(with(3, 0, std::uint64_t{1} << 32)), "has a field that is empty or larger than the file");
  EXPECT_EQ(message_of(with(1, 0, 0)), "has a field that is empty or larger than the file");
  EXPECT_EQ(message_of(with(1, most, 1)), "has a field that extends beyond the file");
  EXPECT_EQ(message_of(with(60000, 0, 1)), "has a field of 60000 dimensions");
  std::string many = with(1, 0, 1);
  many[17] = '\x7f';
  EXPECT_EQ(message_of(many), "has 2130706433 fields, more than 1024");
  std::string other_version = with(1, 0, 1);
  other_version[12] = 2;
  EXPECT_EQ(message_of(other_version), "is a tensor file of version 2.0; version 1 can be read");
}

TEST(MeasuredBrdfFile, MessagesSayWhatIsWrong) {
  const auto changed = [](const std::function<void(MeasuredData&)>& change) {
    MeasuredData data = small_measurement();
    change(data);
    return message_of(test::bsdf_file(data));
  };
  EXPECT_EQ(changed([](MeasuredData& d) { std::swap(d.theta[0], d.theta[1]); }),
            R"(the values of "theta_i" are not ascending)");
  EXPECT_EQ(changed([](MeasuredData& d) { d.theta.back() = 3; }), R"("theta_i" is not between 0 and pi / 2)");
  EXPECT_EQ(changed([](MeasuredData& d) { d.wavelengths[2] = 400; }),
            R"(the values of "wavelengths" are not ascending)");
  EXPECT_EQ(changed([](MeasuredData& d) { d.sigma.values[3] = std::nanf(""); }),
            R"(field "sigma" has a value that is not finite)");
  EXPECT_EQ(changed([](MeasuredData& d) { std::fill_n(d.vndf.values.begin() + 25, 25, 0.0f); }),
            R"("vndf" has no visible normal for some incident direction)");
  const auto with_azimuths = [](const std::vector<float>& phi) {
    MeasuredData d = small_measurement();
    d.phi = phi;
    for (NodeGrids* grids : {&d.vndf, &d.luminance, &d.reflectance}) {
      const std::vector<float> one = grids->values;
      for (std::size_t i = 1; i < phi.size(); ++i) grids->values.insert(grids->values.end(), one.begin(), one.end());
    }
    return message_of(test::bsdf_file(d));
  };
  EXPECT_EQ(with_azimuths({-pi, 0, pi}), "");
  EXPECT_EQ(with_azimuths({-3, 0, 1}), R"("phi_i" spans neither a full, a half nor a quarter turn)");
  EXPECT_EQ(with_azimuths({0, 1, pi}), R"("phi_i" must begin at -pi if it spans less than a full turn)");
  EXPECT_EQ(with_azimuths({0, -1}), R"(the values of "phi_i" are not ascending)");
  test::TensorFileWriter file;
  file.add("phi_i", {1}, {0.0f});
  EXPECT_EQ(message_of(file.bytes()), R"(has no field "theta_i")");
  file.add("theta_i", {1, 1}, {0.0f});
  EXPECT_EQ(message_of(file.bytes()), R"(field "theta_i" has 2 dimensions, not 1)");
  file.add("theta_i", {1}, {0.0f});
  EXPECT_EQ(message_of(file.bytes()), R"(has two fields "theta_i")");
  test::TensorFileWriter grids;
  grids.add("phi_i", {1}, {0.0f});
  grids.add("theta_i", {2}, {0.0f, 1.0f});
  grids.add("ndf", {2, 2}, std::vector<float>(4, 1.0f));
  grids.add("sigma", {2, 2}, std::vector<float>(4, 1.0f));
  test::TensorFileWriter small = grids;
  grids.add("vndf", {1, 3, 2, 2}, std::vector<float>(12, 1.0f));
  EXPECT_EQ(message_of(grids.bytes()), R"(the size of "vndf" does not fit the numbers of directions and wavelengths)");
  small.add("vndf", {1, 2, 1, 2}, std::vector<float>(4, 1.0f));
  EXPECT_EQ(message_of(small.bytes()), R"(the grid of "vndf" is too small)");
  small.add("note", 2, {1}, "x");
  EXPECT_EQ(message_of(small.bytes()), R"(the grid of "vndf" is too small)") << "other fields and types do not matter";
}

}  // namespace
}  // namespace lanthorn::measured_brdf_test
