// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "gl/framebuffer.h"

#include <fmt/format.h>

#include <vector>

#include "lanthorn/error.h"

namespace lanthorn::gl {

namespace {

GLuint make_framebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return name;
}

void attach(GLuint framebuffer, GLenum place, const Texture& texture, int layer) {
  if (texture.has_layers())
    glNamedFramebufferTextureLayer(framebuffer, place, texture.name(), 0, layer);
  else
    glNamedFramebufferTexture(framebuffer, place, texture.name(), 0);
}

}  // namespace

Framebuffer::Framebuffer(std::initializer_list<const Texture*> colours, const Texture* depth, int layer)
    : object_(make_framebuffer()) {
  std::vector<GLenum> places;
  for (const Texture* colour : colours) {
    places.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(places.size()));
    attach(name(), places.back(), *colour, layer);
    width_ = colour->width();
    height_ = colour->height();
  }
  if (depth != nullptr) {
    attach(name(), GL_DEPTH_ATTACHMENT, *depth, layer);
    width_ = depth->width();
    height_ = depth->height();
  }
  glNamedFramebufferDrawBuffers(name(), static_cast<GLsizei>(places.size()), places.data());
  const GLenum status = glCheckNamedFramebufferStatus(name(), GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throw Error(fmt::format("OpenGL cannot draw into these textures (status {:#x})", status));
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name());
  glViewport(0, 0, width_, height_);
}

}  // namespace lanthorn::gl
