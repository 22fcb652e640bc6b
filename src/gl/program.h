// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "gl/object.h"
#include "lanthorn/vec.h"

namespace lanthorn::gl {

/// Shader sources by file name. A line #include "name" is replaced by the text of that file, once.
class ShaderFiles {
 public:
  using Texts = std::map<std::string, std::string, std::less<>>;
  explicit ShaderFiles(Texts texts) : texts_(std::move(texts)) {}

  /// A file with everything that it includes. Throws Error if a file is missing.
  std::string text(std::string_view file) const;

 private:
  Texts texts_;
};

inline void delete_program(GLuint name) { glDeleteProgram(name); }

/// A linked shader program, with its uniforms by name.
class Program {
 public:
  Program() = default;
  /// Throws Error with file and OpenGL's messages if a shader is invalid. `defines`: lines placed before each shader.
  Program(const ShaderFiles& files, std::string_view vertex, std::string_view fragment, std::string_view defines = {});
  static Program compute(const ShaderFiles& files, std::string_view file, std::string_view defines = {});

  GLuint name() const { return object_.name(); }
  void use() const { glUseProgram(name()); }

  // Sets a uniform; does nothing if the shaders do not use it.
  void set(const char* uniform, int value) const;
  void set(const char* uniform, std::uint32_t value) const;
  void set(const char* uniform, float value) const;
  void set(const char* uniform, std::uint32_t x, std::uint32_t y, std::uint32_t z) const;
  void set(const char* uniform, const Vec2& value) const;
  void set(const char* uniform, const Vec3& value) const;
  void set(const char* uniform, const glm::vec4& value) const;
  void set(const char* uniform, const Mat4& value) const;

 private:
  explicit Program(GLuint name) : object_(name) {}
  GLint place(const char* uniform) const { return glGetUniformLocation(name(), uniform); }

  Object<delete_program> object_;
};

}  // namespace lanthorn::gl
