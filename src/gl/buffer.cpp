// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "gl/buffer.h"

#include <algorithm>
#include <cassert>

namespace lanthorn::gl {

namespace {

GLuint make_buffer(std::size_t bytes, const void* content) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  // OpenGL rejects empty buffers.
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 16)), bytes > 0 ? content : nullptr,
                       GL_DYNAMIC_STORAGE_BIT);
  return name;
}

}  // namespace

Buffer::Buffer(std::size_t bytes) : object_(make_buffer(bytes, nullptr)), bytes_(bytes) {}

// OpenGL would read content of 1 to 15 bytes beyond its end; it is written separately instead.
Buffer::Buffer(std::span<const std::byte> content)
    : object_(make_buffer(content.size(), content.size() < 16 ? nullptr : content.data())), bytes_(content.size()) {
  if (bytes_ < 16) write(0, content);
}

void Buffer::write(std::size_t offset, std::span<const std::byte> content) {
  assert(offset + content.size() <= bytes_);
  if (content.empty()) return;
  glNamedBufferSubData(name(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(content.size()), content.data());
}

void Buffer::read(std::size_t offset, std::span<std::byte> content) const {
  assert(offset + content.size() <= bytes_);
  if (content.empty()) return;
  glGetNamedBufferSubData(name(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(content.size()),
                          content.data());
}

void Buffer::clear() { glClearNamedBufferData(name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr); }

void reserve(Buffer& buffer, std::size_t bytes) {
  if (buffer.name() == 0 || buffer.bytes() < bytes) buffer = Buffer(bytes + bytes / 4);
}

}  // namespace lanthorn::gl
