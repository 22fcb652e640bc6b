# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
# cmake -DFOLDER=... -DOUTPUT=... -P embed_page.cmake: writes the files of the page as a C++ source.
set(source "// Made of the files in serve/page by serve/embed_page.cmake.\n#include <string_view>\nnamespace lanthorn::program {\n")
foreach(part document:index.html style:style.css program:viewer.js)
  string(REPLACE ":" ";" part ${part})
  list(GET part 0 name)
  list(GET part 1 file)
  file(READ ${FOLDER}/${file} bytes HEX)
  string(REGEX REPLACE "(..)" "\\\\x\\1" text "${bytes}")
  # Short strings, which the compiler concatenates: some compilers limit the length of a literal.
  string(REGEX REPLACE "(................................................................................................................................)" "\\1\"\n  \"" text "${text}")
  string(APPEND source "extern const std::string_view page_${name};\nconst std::string_view page_${name} =\n  \"${text}\";\n")
endforeach()
string(APPEND source "}  // namespace lanthorn::program\n")
file(WRITE ${OUTPUT} "${source}")
