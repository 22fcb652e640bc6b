// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "gl/debug_log.h"

#include <fmt/format.h>

#include <utility>

#include "gl/context.h"

namespace lanthorn::gl {

namespace {

const char* name_of_type(GLenum type) {
  switch (type) {
    case GL_DEBUG_TYPE_ERROR:
      return "error";
    case GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR:
      return "deprecated behaviour";
    case GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR:
      return "undefined behaviour";
    case GL_DEBUG_TYPE_PORTABILITY:
      return "portability";
    case GL_DEBUG_TYPE_PERFORMANCE:
      return "performance";
    default:
      return "message";
  }
}

void APIENTRY note(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum severity, GLsizei length, const GLchar* text,
                   const void* log) {
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION) return;
  auto& messages = *static_cast<std::vector<std::string>*>(const_cast<void*>(log));
  messages.push_back(
      fmt::format("OpenGL {}: {}", name_of_type(type), std::string(text, static_cast<std::size_t>(length))));
}

}  // namespace

DebugLog::DebugLog() : messages_(std::make_unique<std::vector<std::string>>()) {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(note, messages_.get());
}

void DebugLog::check() const {
  if (glGetGraphicsResetStatus() != GL_NO_ERROR)
    throw Unavailable("the OpenGL context was lost: the driver of the graphics card was reset");
  if (messages_->empty()) return;
  const std::vector<std::string> said = std::exchange(*messages_, {});
  throw Error(said.front());
}

}  // namespace lanthorn::gl
