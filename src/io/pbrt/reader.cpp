// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/reader.h"

#include <utility>

#include "io/pbrt/assembler.h"
#include "io/pbrt/parser.h"

namespace lanthorn::pbrt {

SceneDescription read(std::string_view text, std::filesystem::path folder, const std::string& name,
                      FileReader read_file, const FileAccess* access) {
  Context context;
  context.scene.filename = name;
  context.folder = std::move(folder);
  context.read_file = std::move(read_file);
  context.access = access;
  FileStack files;
  files.names.push_back(name);
  files.open.push_back((context.folder / std::filesystem::path(name).filename()).lexically_normal());
  Assembler assembler(context);
  const DirectiveSink build = [&](Directive d) { assembler.execute(std::move(d)); };
  assembler.finish(Parser(text, files.names.back(), files, build, context).parse());
  return std::move(context.scene);
}

}  // namespace lanthorn::pbrt
