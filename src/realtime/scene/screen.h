// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/object.h"
#include "gl/vertex_array.h"

namespace lanthorn {

/// The triangle of screen.vert.glsl, which covers all pixels of the render target.
class Screen {
 public:
  Screen() : no_vertices_(gl::make_vertex_array()) {}

  /// Runs the program in use in each pixel.
  void draw() const {
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(no_vertices_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

 private:
  gl::VertexArray no_vertices_;
};

}  // namespace lanthorn
