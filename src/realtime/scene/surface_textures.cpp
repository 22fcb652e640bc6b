// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/scene/surface_textures.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/parallel.h"

namespace lanthorn {

namespace {

/// The largest side at which all layers together take about a second of processor time.
int side_for(std::size_t layers) {
  constexpr std::size_t most_texels = std::size_t{1} << 22;
  constexpr int least = 256, most = 1024;
  int side = most;
  while (side > least && layers * static_cast<std::size_t>(side) * static_cast<std::size_t>(side) > most_texels)
    side /= 2;
  return side;
}

std::vector<glm::vec4> bake(const SurfaceLayer& layer, int side) {
  constexpr float most = 65504;  // of 16-bit floats
  const auto row_length = static_cast<std::size_t>(side);
  std::vector<glm::vec4> texels(row_length * row_length);
  parallel_for(0, side, [&](int y) {
    for (int x = 0; x < side; ++x)
      texels[static_cast<std::size_t>(y) * row_length + static_cast<std::size_t>(x)] =
          glm::min(layer((Vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) / static_cast<float>(side)), most);
  });
  return texels;
}

}  // namespace

bool SurfaceTextures::update(const std::vector<SurfaceLayer>& layers) {
  std::vector<glm::vec4> fingerprint;
  for (const SurfaceLayer& layer : layers) {
    const std::vector<glm::vec4> values = probe_square(layer);
    fingerprint.insert(fingerprint.end(), values.begin(), values.end());
  }
  if (texture_.name() != 0 && fingerprint == fingerprint_) return false;
  fingerprint_ = std::move(fingerprint);
  const int side = layers.empty() ? 1 : side_for(layers.size());
  texture_ = gl::Texture::array(GL_RGBA16F, side, side, std::max<int>(1, static_cast<int>(layers.size())));
  texture_.filter(GL_LINEAR, GL_LINEAR, GL_REPEAT);
  for (std::size_t i = 0; i < layers.size(); ++i)
    texture_.write({}, bake(layers[i], side).data(), 0, static_cast<int>(i));
  return true;
}

}  // namespace lanthorn
