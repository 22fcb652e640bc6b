// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "gl/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <initializer_list>
#include <vector>

#include "lanthorn/error.h"

namespace lanthorn::gl {

namespace {

inline void delete_shader(GLuint name) { glDeleteShader(name); }
using Shader = Object<delete_shader>;

/// The file's name in a line #include "name"; empty for other lines.
std::string_view included_file(std::string_view line) {
  constexpr std::string_view start = "#include \"";
  if (line.substr(0, start.size()) != start) return {};
  line.remove_prefix(start.size());
  return line.substr(0, line.find('"'));
}

std::string_view first_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

// Keeps line numbers for messages: "1(7)" is line 7 of the second file of the list.
void expand(const ShaderFiles::Texts& texts, std::string_view file, std::vector<std::string>& seen, std::string& out) {
  const auto found = texts.find(file);
  if (found == texts.end()) throw Error(fmt::format("there is no shader '{}'", file));
  const std::size_t number = seen.size();
  seen.emplace_back(file);
  std::string_view rest = found->second;
  out += fmt::format("#line 1 {}\n", number);
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const std::string_view line = first_line(rest);
    const std::string_view inner = included_file(line);
    if (inner.empty()) {
      out.append(line).append("\n");
      continue;
    }
    if (std::find(seen.begin(), seen.end(), inner) == seen.end()) expand(texts, inner, seen, out);
    out += fmt::format("#line {} {}\n", line_number + 1, number);
  }
}

/// `get`: glGetShaderInfoLog or glGetProgramInfoLog.
std::string log_of(GLuint object, void (*get)(GLuint, GLsizei, GLsizei*, GLchar*)) {
  std::string log(4096, '\0');
  GLsizei length = 0;
  get(object, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return log;
}

Shader compile(const ShaderFiles& files, GLenum stage, std::string_view file, std::string_view defines) {
  const std::string text = fmt::format("#version 450 core\n{}\n{}", defines, files.text(file));
  Shader shader(glCreateShader(stage));
  const char* pointer = text.c_str();
  glShaderSource(shader.name(), 1, &pointer, nullptr);
  glCompileShader(shader.name());
  GLint done = 0;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &done);
  if (done == GL_FALSE)
    throw Error(fmt::format("shader {} does not compile:\n{}", file, log_of(shader.name(), glGetShaderInfoLog)));
  return shader;
}

GLuint link(std::initializer_list<const Shader*> shaders, std::string_view file) {
  const GLuint program = glCreateProgram();
  for (const Shader* shader : shaders) glAttachShader(program, shader->name());
  glLinkProgram(program);
  for (const Shader* shader : shaders) glDetachShader(program, shader->name());
  GLint done = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &done);
  if (done != GL_FALSE) return program;
  const std::string log = log_of(program, glGetProgramInfoLog);
  glDeleteProgram(program);
  throw Error(fmt::format("shader {} does not link:\n{}", file, log));
}

}  // namespace

std::string ShaderFiles::text(std::string_view file) const {
  std::vector<std::string> seen;
  std::string out;
  expand(texts_, file, seen, out);
  return out;
}

Program::Program(const ShaderFiles& files, std::string_view vertex, std::string_view fragment,
                 std::string_view defines) {
  const Shader first = compile(files, GL_VERTEX_SHADER, vertex, defines);
  const Shader second = compile(files, GL_FRAGMENT_SHADER, fragment, defines);
  object_ = Object<delete_program>(link({&first, &second}, fragment));
}

Program Program::compute(const ShaderFiles& files, std::string_view file, std::string_view defines) {
  const Shader shader = compile(files, GL_COMPUTE_SHADER, file, defines);
  return Program(link({&shader}, file));
}

void Program::set(const char* uniform, int value) const { glProgramUniform1i(name(), place(uniform), value); }
void Program::set(const char* uniform, std::uint32_t value) const {
  glProgramUniform1ui(name(), place(uniform), value);
}
void Program::set(const char* uniform, std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
  glProgramUniform3ui(name(), place(uniform), x, y, z);
}
void Program::set(const char* uniform, float value) const { glProgramUniform1f(name(), place(uniform), value); }
void Program::set(const char* uniform, const Vec2& value) const {
  glProgramUniform2f(name(), place(uniform), value.x, value.y);
}
void Program::set(const char* uniform, const Vec3& value) const {
  glProgramUniform3f(name(), place(uniform), value.x, value.y, value.z);
}
void Program::set(const char* uniform, const glm::vec4& value) const {
  glProgramUniform4f(name(), place(uniform), value.x, value.y, value.z, value.w);
}
void Program::set(const char* uniform, const Mat4& value) const {
  glProgramUniformMatrix4fv(name(), place(uniform), 1, GL_FALSE, glm::value_ptr(value));
}

}  // namespace lanthorn::gl
