// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <epoxy/gl.h>

#include "gl/object.h"

namespace lanthorn::gl {

inline void delete_vertex_array(GLuint name) { glDeleteVertexArrays(1, &name); }

using VertexArray = Object<delete_vertex_array>;

/// Without attributes. OpenGL draws nothing unless a vertex array is bound, even if shaders make all vertices.
inline VertexArray make_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return VertexArray(name);
}

}  // namespace lanthorn::gl
