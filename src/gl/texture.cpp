// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "gl/texture.h"

#include <fmt/format.h>

#include "lanthorn/error.h"

namespace lanthorn::gl {

namespace {

GLuint make_texture(GLenum target) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  return name;
}

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

Texture::Texture(GLenum target, GLenum format, int width, int height, int layers, int levels)
    : object_(make_texture(target)), width_(width), height_(height), layers_(layers), levels_(levels), target_(target) {
  if (has_layers())
    glTextureStorage3D(name(), levels, format, width, height, layers);
  else
    glTextureStorage2D(name(), levels, format, width, height);
  filter(GL_NEAREST, GL_NEAREST, GL_CLAMP_TO_EDGE);
}

Texture::Texture(GLenum format, int width, int height, int levels)
    : Texture(GL_TEXTURE_2D, format, width, height, 1, levels) {}

Texture Texture::array(GLenum format, int width, int height, int layers, int levels) {
  return {GL_TEXTURE_2D_ARRAY, format, width, height, layers, levels};
}

Texture Texture::volume(GLenum format, int width, int height, int depth, int levels) {
  return {GL_TEXTURE_3D, format, width, height, depth, levels};
}

void Texture::write(TexelType type, const void* texels, int level, int layer) {
  const int width = width_ >> level, height = height_ >> level;
  if (has_layers())
    glTextureSubImage3D(name(), level, 0, 0, layer, width, height, 1, type.format, type.type, texels);
  else
    glTextureSubImage2D(name(), level, 0, 0, width, height, type.format, type.type, texels);
}

void Texture::write_part(TexelType type, const void* texels, int x, int y, int width, int height) {
  glTextureSubImage2D(name(), 0, x, y, width, height, type.format, type.type, texels);
}

void Texture::read(TexelType type, std::span<std::byte> texels, int level) const {
  glGetTextureImage(name(), level, type.format, type.type, static_cast<GLsizei>(texels.size()), texels.data());
}

void Texture::clear() const {
  for (int level = 0; level < levels_; ++level) glClearTexImage(name(), level, GL_RGBA, GL_FLOAT, nullptr);
}

void Texture::filter(GLenum minify, GLenum magnify, GLenum wrap) const {
  glTextureParameteri(name(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
  glTextureParameteri(name(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnify));
  glTextureParameteri(name(), GL_TEXTURE_WRAP_S, static_cast<GLint>(wrap));
  glTextureParameteri(name(), GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap));
  glTextureParameteri(name(), GL_TEXTURE_WRAP_R, static_cast<GLint>(wrap));
}

void require_buffer_texels(std::size_t texels, std::string_view what, std::string_view remedy) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (texels > static_cast<std::size_t>(most))
    throw Error(fmt::format("{} take {} texels, and this OpenGL driver has {} at most; expected {}", what, texels, most,
                            remedy));
}

BufferTexture::BufferTexture(GLenum format) : object_(make_texture(GL_TEXTURE_BUFFER)), format_(format) {}

void BufferTexture::bind(GLuint unit, const Buffer& buffer) const {
  glTextureBuffer(object_.name(), format_, buffer.name());
  glBindTextureUnit(unit, object_.name());
}

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
