// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The public headers alone, as an embedding program uses them.
#include <gtest/gtest.h>

#include "lanthorn/error.h"
#include "lanthorn/render.h"

namespace {

lanthorn::RenderRequest small_request() {
  lanthorn::RenderRequest request;
  request.scene = LANTHORN_SOURCE_DIR "/scenes/cornell-caustics.pbrt";
  request.integrator = "path";
  request.passes = 3;
  request.width = 24;
  request.height = 16;
  return request;
}

TEST(Api, RendersALayeredPicture) {
  const lanthorn::Image image = lanthorn::render(small_request());
  EXPECT_EQ(image.width, 24);
  EXPECT_EQ(image.height, 16);
  const auto samples = image.find_channel("samples");
  ASSERT_TRUE(samples && image.find_channel("caustic.R") && image.find_channel("R"));
  EXPECT_FLOAT_EQ(image.at(5, 5, *samples), 3);
  double sum = 0;
  for (int x = 0; x < image.width; ++x) sum += static_cast<double>(image.at(x, 8, 0));
  EXPECT_GT(sum, 0.1);
}

TEST(Api, ProgressCanStopARender) {
  lanthorn::RenderRequest request = small_request();
  request.passes = 1000;
  std::uint64_t last = 0;
  request.progress = [&](std::uint64_t passes) { return (last = passes) < 2; };
  lanthorn::render(request);
  EXPECT_EQ(last, 2u);
}

TEST(Api, WrongRequestsThrow) {
  lanthorn::RenderRequest request = small_request();
  request.integrator = "nosuch";
  EXPECT_THROW(lanthorn::render(request), lanthorn::Error);
  request = small_request();
  request.height.reset();
  EXPECT_THROW(lanthorn::render(request), lanthorn::Error);
}

}  // namespace
