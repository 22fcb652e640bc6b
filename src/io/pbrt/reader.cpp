// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/reader.h"

#include <utility>

#include "io/pbrt/assembler.h"
#include "io/pbrt/directive.h"
#include "io/pbrt/parser.h"
#include "io/pbrt/upgrade.h"

namespace lanthorn::pbrt {

namespace {

Context make_context(std::string_view text, std::filesystem::path folder, const std::string& name, FileReader read_file,
                     const FileAccess* access) {
  Context context;
  context.scene.filename = name;
  context.folder = std::move(folder);
  context.read_file = std::move(read_file);
  context.access = access;
  context.version = find_version_sign(
      text, name, [&](const std::filesystem::path& file) { return context.read_file(context.folder / file); });
  return context;
}

bool is_v3(const Context& context) { return context.version && context.version->is_v3; }

// Passes the file's directives to the sink. Returns the place of its end.
Place parse(std::string_view text, const DirectiveSink& sink, FileStack& files, Context& context) {
  const std::string& name = context.scene.filename;
  const std::string& own = *files.names.insert(name).first;
  files.open.push_back((context.folder / std::filesystem::path(name).filename()).lexically_normal());
  return Parser(text, own, files, sink, context).parse();
}

// Like `parse`, for a pbrt-v3 file: translates it to pbrt-v4's directives.
Place parse_upgraded(std::string_view text, const DirectiveSink& sink, FileStack& files, Context& context) {
  Upgrader upgrader(context, sink);
  const Place end = parse(
      text, [&](Directive d) { upgrader.translate(std::move(d)); }, files, context);
  upgrader.finish();
  return end;
}

}  // namespace

SceneDescription read(std::string_view text, std::filesystem::path folder, const std::string& name, FindMethod methods,
                      FileReader read_file, const FileAccess* access, MeshObserver observer) {
  Context context = make_context(text, std::move(folder), name, std::move(read_file), access);
  context.methods = std::move(methods);
  Assembler assembler(context, std::move(observer));
  FileStack files;
  const DirectiveSink build = [&](Directive d) { assembler.execute(std::move(d)); };
  try {
    assembler.finish((is_v3(context) ? parse_upgraded : parse)(text, build, files, context));
  } catch (const Error&) {
    if (context.has_deferred()) context.report_missing();  // a missing file may define what the error misses
    throw;
  }
  return std::move(context.scene);
}

UpgradedScene upgrade(std::string_view text, std::filesystem::path folder, const std::filesystem::path& target,
                      const std::string& name, FileReader read_file) {
  Context context = make_context(text, std::move(folder), name, std::move(read_file), nullptr);
  if (!is_v3(context))
    throw Error({name}, context.version
                            ? context.version->text + " in line " + std::to_string(context.version->location.line) +
                                  " belongs to pbrt-v4: there is nothing to convert"
                            : "nothing in the file is specific to pbrt-v3: there is nothing to convert");
  const auto canonical = [](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(path.empty() ? "." : path);
  };
  Writer writer(canonical(context.folder), canonical(target));
  FileStack files;
  parse_upgraded(
      text, [&](const Directive& d) { writer.write(d); }, files, context);
  return {std::move(writer).text() + "\n", std::move(context.scene.files), std::move(context.scene.warnings)};
}

}  // namespace lanthorn::pbrt
