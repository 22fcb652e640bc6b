// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Usage: bench_denoise_preview PICTURE.exr [REFERENCE.exr]
// Compares the preview of `serve` and `view` with the picture denoised at full quality: seconds of processor time, and
// relMSE as bench/denoise measures it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <optional>
#include <string>

#include "lanthorn/denoise.h"
#include "lanthorn/image_file.h"

namespace {

using lanthorn::Image;

double relative_mse(const Image& color, const Image& reference) {
  double mean = 0, sum = 0;
  const auto count = static_cast<double>(reference.pixels.size());
  for (const float r : reference.pixels) mean += static_cast<double>(r) / count;
  const auto clamped = [&](float value) { return std::min(static_cast<double>(value), 10 * mean); };
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    const double r = clamped(reference.pixels[i]), d = clamped(color.pixels[i]) - r;
    sum += d * d / (r * r + 0.01 * mean * mean);
  }
  return sum / count;
}

void print(const char* name, double seconds, const Image& color, const std::optional<Image>& reference) {
  fmt::print("{:10} {:6.2f} s", name, seconds);
  if (reference) fmt::print("   relMSE {:.5f}", relative_mse(color, *reference));
  fmt::print("\n");
}

// Runs `make` and returns its result; `seconds`: processor time of all threads.
template <class Make>
auto timed(double& seconds, Make&& make) {
  const std::clock_t start = std::clock();
  auto result = make();
  seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return result;
}

void run(const char* picture, const char* reference_file) {
  const Image noisy = lanthorn::read_image(picture);
  std::optional<Image> reference;
  if (reference_file) reference = select_layer(lanthorn::read_image(reference_file), "color");
  double seconds = 0;
  print("noisy", 0, *select_layer(noisy, "color"), reference);
  const Image preview = timed(seconds, [&] { return lanthorn::preview_without_noise(noisy); });
  print("preview", seconds, preview, reference);
  const Image denoised = timed(seconds, [&] { return lanthorn::denoise(noisy).picture; });
  print("denoised", seconds, *select_layer(denoised, "denoised"), reference);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: bench_denoise_preview PICTURE.exr [REFERENCE.exr]\n");
    return 2;
  }
  run(argv[1], argc > 2 ? argv[2] : nullptr);
  return 0;
} catch (const std::exception& problem) {
  std::fprintf(stderr, "bench_denoise_preview: %s\n", problem.what());
  return 1;
}
