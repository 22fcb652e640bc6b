// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Textures: to be sampled, and to be drawn into.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

#include "gl/buffer.h"
#include "gl/object.h"

namespace lanthorn::gl {

inline void delete_texture(GLuint name) { glDeleteTextures(1, &name); }

/// How texels are exchanged with the CPU.
struct TexelType {
  GLenum format = GL_RGBA;  ///< GL_RED, GL_RGBA, GL_RGBA_INTEGER, GL_DEPTH_COMPONENT ...
  GLenum type = GL_FLOAT;
};

/// A 2D texture, an array of 2D textures, or a 3D texture, of fixed size. Sampling uses the nearest texel and clamps at
/// edges, unless `filter` says otherwise.
class Texture {
 public:
  Texture() = default;
  /// `format`: sized, e.g. GL_RGBA32F.
  Texture(GLenum format, int width, int height, int levels = 1);
  static Texture array(GLenum format, int width, int height, int layers, int levels = 1);
  static Texture volume(GLenum format, int width, int height, int depth, int levels = 1);

  GLuint name() const { return object_.name(); }
  int width() const { return width_; }
  int height() const { return height_; }
  int layers() const { return layers_; }  ///< for a volume, its depth
  int levels() const { return levels_; }
  /// `layer`: of an array.
  void write(TexelType type, const void* texels, int level = 0, int layer = 0);
  /// Writes a rectangle of a 2D texture.
  void write_part(TexelType type, const void* texels, int x, int y, int width, int height);
  /// All texels of a level, row by row from OpenGL's bottom row, layer by layer. Waits for the GPU.
  void read(TexelType type, std::span<std::byte> texels, int level = 0) const;
  template <class T>
  std::vector<T> read(TexelType type, int channels) const {
    std::vector<T> values(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) *
                          static_cast<std::size_t>(layers_) * static_cast<std::size_t>(channels));
    read(type, std::as_writable_bytes(std::span(values)));
    return values;
  }
  /// GL_NEAREST, GL_LINEAR ..., GL_CLAMP_TO_EDGE, GL_REPEAT ...
  void filter(GLenum minify, GLenum magnify, GLenum wrap) const;
  /// Sets all levels to 0.
  void clear() const;
  void generate_mipmaps() const { glGenerateTextureMipmap(name()); }
  /// Binds the texture to a sampler unit.
  void bind(GLuint unit) const { glBindTextureUnit(unit, name()); }
  /// Binds all layers to an image unit.
  void bind_image(GLuint unit, GLenum access, GLenum format, int level = 0) const {
    glBindImageTexture(unit, name(), level, has_layers() ? GL_TRUE : GL_FALSE, 0, access, format);
  }
  bool has_layers() const { return target_ != GL_TEXTURE_2D; }

 private:
  Texture(GLenum target, GLenum format, int width, int height, int layers, int levels);

  Object<delete_texture> object_;
  int width_ = 0, height_ = 0, layers_ = 1, levels_ = 1;
  GLenum target_ = GL_TEXTURE_2D;
};

/// Throws Error if shaders of this driver cannot access this many texels of a buffer: "WHAT take N texels, and this
/// OpenGL driver has M at most; expected REMEDY".
void require_buffer_texels(std::size_t texels, std::string_view what, std::string_view remedy);

/// A buffer that shaders read with texelFetch.
class BufferTexture {
 public:
  BufferTexture() = default;
  /// `format`: sized, e.g. GL_RGBA32UI.
  explicit BufferTexture(GLenum format);
  /// Binds the buffer to a sampler unit. See `require_buffer_texels`.
  void bind(GLuint unit, const Buffer& buffer) const;

 private:
  Object<delete_texture> object_;
  GLenum format_ = GL_R32UI;
};

inline void delete_framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }

/// Textures as render targets. They must outlive the framebuffer's use.
class Framebuffer {
 public:
  Framebuffer() = default;
  /// Draws into the colours, in this order, with `depth` (null: none). For texture arrays, draws into `layer`. Throws
  /// Error if OpenGL cannot draw into these textures.
  explicit Framebuffer(std::initializer_list<const Texture*> colours, const Texture* depth = nullptr, int layer = 0);

  GLuint name() const { return object_.name(); }
  /// Binds it for drawing and sets the viewport to all of it.
  void bind() const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  Object<delete_framebuffer> object_;
  int width_ = 0, height_ = 0;
};

}  // namespace lanthorn::gl
