// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/scene/gbuffer.h"

#include <array>

#include "realtime/scene/layouts.h"

namespace lanthorn {

GBuffer::GBuffer(int width, int height)
    : position_(GL_RGBA32F, width, height),
      surface_(GL_RGBA32UI, width, height),
      colour_(GL_RGBA16F, width, height),
      emission_(GL_RGBA32F, width, height),
      lobe_(GL_RGBA16F, width, height),
      depth_(GL_DEPTH_COMPONENT32F, width, height),
      framebuffer_({&position_, &surface_, &colour_, &emission_, &lobe_}, &depth_) {}

void GBuffer::begin() const {
  framebuffer_.bind();
  constexpr std::array<GLfloat, 4> nothing{};
  constexpr std::array<GLuint, 4> no_surface{};
  constexpr GLfloat far = 0;
  const GLuint name = framebuffer_.name();
  glClearNamedFramebufferfv(name, GL_COLOR, 0, nothing.data());
  glClearNamedFramebufferuiv(name, GL_COLOR, 1, no_surface.data());
  glClearNamedFramebufferfv(name, GL_COLOR, 2, nothing.data());
  glClearNamedFramebufferfv(name, GL_COLOR, 3, nothing.data());
  glClearNamedFramebufferfv(name, GL_COLOR, 4, nothing.data());
  glClearNamedFramebufferfv(name, GL_DEPTH, 0, &far);
}

void GBuffer::bind() const {
  position_.bind(gpu::unit_g_position);
  surface_.bind(gpu::unit_g_surface);
  colour_.bind(gpu::unit_g_colour);
  lobe_.bind(gpu::unit_g_lobe);
}

}  // namespace lanthorn
