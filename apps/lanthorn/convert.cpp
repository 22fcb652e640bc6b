// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/scene.h"
#include "options.h"
#include "output_check.h"

namespace lanthorn::program {

namespace {

struct ConvertCommand {
  std::string scene, output;
  ReadOptions reading;
};

void run(const ConvertCommand& a) {
  if (const std::string extension = lower_extension(a.scene); extension == ".exr" || extension == ".hdr")
    throw Error({a.scene}, "is a picture, not a scene; develop makes a .png of it");
  const std::filesystem::path folder = std::filesystem::path(a.output).parent_path();
  const UpgradedScene upgraded = upgrade_pbrt(a.scene, folder, a.reading);
  check_outputs(files_of(upgraded.files, a.scene), {{a.output, "OUTPUT", {".pbrt"}}});
  for (const description::Warning& warning : upgraded.warnings)
    warn("{}", Error(warning.location, warning.message).what());
  write_file(a.output, upgraded.text);
  announce("{}: {} as a pbrt-v4 file\n", a.output, a.scene);
}

OptionTable convert_options(ConvertCommand& a) {
  return {{.names = "scene",
           .value = into(a.scene, existing_file_type()),
           .brief = "Scene file of pbrt-v3 (.pbrt)",
           .required = true},
          required_file("output", a.output, "File to write (.pbrt)"),
          {.names = "--sandbox",
           .value = flag(a.reading.sandbox),
           .brief = "Read only files in the tree of the scene's folder"}};
}

}  // namespace

void add_convert(CLI::App& app) {
  const auto a = std::make_shared<ConvertCommand>();
  constexpr const char* footer =
      "Other commands read pbrt-v3 files directly; use convert to edit the scene or for other programs. A\n"
      "warning names each feature that is only approximated. Included files become part of the output; meshes\n"
      "and images stay where they are. Comments are lost. Images of infinite lights stay equirectangular, as Lanthorn\n"
      "reads them; pbrt-v4 itself needs its imgtool makeequiarea for them.\n\nExample:\n  lanthorn convert old.pbrt "
      "new.pbrt";
  add_command(app, {"convert", "Translate a pbrt-v3 scene to pbrt-v4", convert_options(*a), footer, [a] { run(*a); }});
}

}  // namespace lanthorn::program
