// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>

#include "gl/object.h"
#include "gl/texture.h"

namespace lanthorn::gl {

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
