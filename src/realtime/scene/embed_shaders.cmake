# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
# Writes OUT, a source with the texts of the shaders below FOLDER:  cmake -DFOLDER=... -DOUT=... -P embed_shaders.cmake
file(GLOB_RECURSE files ${FOLDER}/*.glsl)
set(text "#include \"realtime/scene/shader_files.h\"\n\nnamespace lanthorn {\n\nconst gl::ShaderFiles& shader_files() {\n")
string(APPEND text "  static const gl::ShaderFiles files(gl::ShaderFiles::Texts{\n")
foreach(file ${files})
  get_filename_component(name ${file} NAME)
  file(READ ${file} content)
  string(APPEND text "{\"${name}\", R\"glsl(${content})glsl\"},\n")
endforeach()
string(APPEND text "});\n  return files;\n}\n\n}  // namespace lanthorn\n")
file(WRITE ${OUT} "${text}")
