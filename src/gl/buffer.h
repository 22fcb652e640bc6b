// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gl/object.h"

namespace lanthorn::gl {

inline void delete_buffer(GLuint name) { glDeleteBuffers(1, &name); }

/// A fixed-size buffer in GPU memory.
class Buffer {
 public:
  Buffer() = default;
  explicit Buffer(std::size_t bytes);
  /// Makes a copy of the values.
  template <class T>
  explicit Buffer(const std::vector<T>& values) : Buffer(std::as_bytes(std::span(values))) {}
  explicit Buffer(std::span<const std::byte> content);

  GLuint name() const { return object_.name(); }
  std::size_t bytes() const { return bytes_; }
  void write(std::size_t offset, std::span<const std::byte> content);
  template <class T>
  void write(const std::vector<T>& values) {
    write(0, std::as_bytes(std::span(values)));
  }
  /// Waits for the GPU.
  void read(std::size_t offset, std::span<std::byte> content) const;
  template <class T>
  std::vector<T> read(std::size_t count) const {
    std::vector<T> values(count);
    read(0, std::as_writable_bytes(std::span(values)));
    return values;
  }
  void clear();
  /// For shaders: binding `index` of GL_SHADER_STORAGE_BUFFER.
  void bind_storage(GLuint index) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, index, name()); }

 private:
  Object<delete_buffer> object_;
  std::size_t bytes_ = 0;
};

/// Two buffers used alternately, for data rewritten in each frame: does not overwrite data of the previous frame that
/// the GPU still reads (McGuire & Luebke 2009, fig. 3). With one buffer, frames of llvmpipe (Mesa 22.3) differed.
class AlternatingBuffer {  // NOLINT(readability-identifier-naming): of a variable that the compiler makes
 public:
  /// Writes the values to the next buffer, which becomes current and has room for at least one value.
  template <class T>
  void write(const std::vector<T>& values);
  const Buffer& current() const { return buffers_[now_]; }

 private:
  Buffer buffers_[2];
  int now_ = 0;
};

/// Ensures that `buffer` holds at least `bytes`; its content is then undefined.
void reserve(Buffer& buffer, std::size_t bytes);

template <class T>
void AlternatingBuffer::write(const std::vector<T>& values) {
  now_ = 1 - now_;
  reserve(buffers_[now_], (values.size() + (values.empty() ? 1 : 0)) * sizeof(T));
  buffers_[now_].write(values);
}

}  // namespace lanthorn::gl
