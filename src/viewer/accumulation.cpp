// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer/accumulation.h"

#include <algorithm>
#include <string>
#include <vector>

#include "realtime/scene/shader_files.h"

namespace lanthorn {

Accumulation::Accumulation(int width, int height)
    : screen_(GL_RGBA8, width, height),
      accumulate_(shader_files(), "screen.vert.glsl", "accumulate.frag.glsl"),
      tone_(shader_files(), "screen.vert.glsl", "tone.frag.glsl") {
  for (gl::Texture& layer : layers_) layer = gl::Texture(GL_RGBA32F, width, height);
  layer_target_ = gl::Framebuffer({&layers_[0], &layers_[1], &layers_[2], &layers_[3]});
  screen_target_ = gl::Framebuffer({&screen_});
  screen_.filter(GL_LINEAR, GL_LINEAR, GL_CLAMP_TO_EDGE);
  constexpr std::array<GLfloat, 4> black{};
  for (GLint i = 0; i < 4; ++i) glClearNamedFramebufferfv(layer_target_.name(), GL_COLOR, i, black.data());
}

void Accumulation::add(const Renderer& renderer, float factor) {
  renderer.gbuffer().emission().bind(gpu::unit_layer_emission);
  renderer.layers().direct.bind(gpu::unit_layer_direct);
  renderer.layers().indirect.bind(gpu::unit_layer_indirect);
  renderer.layers().caustic.bind(gpu::unit_layer_caustic);
  ++frames_;
  layer_target_.bind();
  accumulate_.use();
  accumulate_.set("factor", factor);
  accumulate_.set("share", 1 / static_cast<float>(frames_));
  // mean_n = mean_{n-1} + (frame - mean_{n-1}) / n. The first frame replaces the previous content, even NaN.
  if (frames_ > 1) {
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  } else {
    glDisable(GL_BLEND);
  }
  screen_triangle_.draw();
  glDisable(GL_BLEND);
}

void Accumulation::load(const Image& image) {
  frames_ = 0;
  std::vector<glm::vec4> texels(static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()));
  const bool has_layers = select_layer(image, light_layer_names[1]).has_value();
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    const auto layer = select_layer(image, l == 0 && !has_layers ? "color" : light_layer_names[l]);
    std::fill(texels.begin(), texels.end(), glm::vec4(0));
    if (layer && layer->pixels.size() == 3 * texels.size())
      for (std::size_t i = 0; i < texels.size(); ++i)
        texels[i] = {layer->pixels[3 * i], layer->pixels[3 * i + 1], layer->pixels[3 * i + 2], 1};
    layers_[l].write({GL_RGBA, GL_FLOAT}, texels.data());
  }
}

void Accumulation::present(const ToneSettings& tone) {
  for (GLuint i = 0; i < 4; ++i) layers_[i].bind(gpu::unit_layer_emission + i);
  screen_target_.bind();
  tone_.use();
  tone_.set("shown", tone.shown);
  tone_.set("exposure", tone.exposure);
  tone_.set("curve", static_cast<int>(tone.curve));
  tone_.set("highlight_strength", tone.highlight_strength);
  tone_.set("height", 0);
  glDisable(GL_BLEND);
  screen_triangle_.draw();
}

Image Accumulation::read() const {
  std::vector<std::string> names{"R", "G", "B"};
  for (const char* layer : light_layer_names)
    for (const char* channel : {".R", ".G", ".B"}) names.push_back(std::string(layer) + channel);
  Image image(width(), height(), names);
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    const auto texels = layers_[l].read<glm::vec4>({GL_RGBA, GL_FLOAT}, 1);
    for (std::size_t i = 0; i < texels.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        const float value = texels[i][static_cast<glm::length_t>(c)];
        image.pixels[i * names.size() + c] += value;
        image.pixels[i * names.size() + 3 * (l + 1) + c] = value;
      }
  }
  return image;
}

}  // namespace lanthorn
