// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <epoxy/gl.h>

#include "gl/object.h"

namespace lanthorn::gl {

inline void delete_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }

using VertexArray = Object<delete_vertex_array>;

/// An empty vertex array. OpenGL draws nothing unless one is bound, even if shaders generate all vertices.
inline VertexArray make_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return VertexArray(name);
}

}  // namespace lanthorn::gl
