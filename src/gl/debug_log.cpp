// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "gl/debug_log.h"

#include <fmt/format.h>

#include <utility>

#include "gl/context.h"

namespace lanthorn::gl {

namespace {

// Ignores other messages (performance, portability, deprecated functions), which do not affect the frame.
void APIENTRY note(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum /*severity*/, GLsizei length,
                   const GLchar* text, const void* log) {
  if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
  auto& messages = *static_cast<std::vector<std::string>*>(const_cast<void*>(log));
  const char* kind = type == GL_DEBUG_TYPE_ERROR ? "error" : "undefined behaviour";
  messages.push_back(fmt::format("OpenGL {}: {}", kind, std::string(text, static_cast<std::size_t>(length))));
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
