// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gl/object.h"

namespace lanthorn::gl {

inline void delete_texture(GLuint name) { glDeleteTextures(1, &name); }

/// How a texture's texels are exchanged with the CPU.
struct TexelType {
  GLenum format = GL_RGBA;  ///< GL_RED, GL_RGBA, GL_RGBA_INTEGER, GL_DEPTH_COMPONENT ...
  GLenum type = GL_FLOAT;
};

/// A 2D texture, or an array of them, of fixed size. Looked up at the nearest texel and clamped at its edges, unless
/// `filter` says otherwise.
class Texture {
 public:
  Texture() = default;
  /// `format`: sized, e.g. GL_RGBA32F.
  Texture(GLenum format, int width, int height, int levels = 1);
  static Texture array(GLenum format, int width, int height, int layers, int levels = 1);

  GLuint name() const { return object_.name(); }
  int width() const { return width_; }
  int height() const { return height_; }
  int layers() const { return layers_; }
  int levels() const { return levels_; }
  /// `layer`: of an array.
  void write(TexelType type, const void* texels, int level = 0, int layer = 0);
  /// All texels of a level, row by row from OpenGL's lower end, layer by layer. Waits for the GPU.
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
  void generate_mipmaps() const { glGenerateTextureMipmap(name()); }
  /// For samplers of shaders.
  void bind(GLuint unit) const { glBindTextureUnit(unit, name()); }
  /// For images of shaders; all layers of an array.
  void bind_image(GLuint unit, GLenum access, GLenum format, int level = 0) const {
    glBindImageTexture(unit, name(), level, is_array_ ? GL_TRUE : GL_FALSE, 0, access, format);
  }
  bool is_array() const { return is_array_; }

 private:
  Texture(GLenum format, int width, int height, int layers, int levels, bool is_array);

  Object<delete_texture> object_;
  int width_ = 0, height_ = 0, layers_ = 1, levels_ = 1;
  bool is_array_ = false;
};

}  // namespace lanthorn::gl
