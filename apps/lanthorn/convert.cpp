// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <span>
#include <string>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/file.h"
#include "lanthorn/scene.h"
#include "output_check.h"
#include "render_arguments.h"

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
    spdlog::warn("{}", Error(warning.location, warning.message).what());
  write_file(a.output, std::as_bytes(std::span(upgraded.text)));
  announce("{}: {} as a pbrt-v4 file\n", a.output, a.scene);
}

}  // namespace

void add_convert(CLI::App& app) {
  CLI::App& c = *app.add_subcommand("convert", "Translate a pbrt-v3 scene to pbrt-v4");
  auto a = std::make_shared<ConvertCommand>();
  c.add_option("scene", a->scene, "Scene file of pbrt-v3 (.pbrt)")->required()->check(CLI::ExistingFile);
  c.add_option("output", a->output, "File to write (.pbrt)")->required()->type_name("FILE");
  c.add_flag("--sandbox", a->reading.sandbox, "Read only files in the tree of the scene's folder");
  c.footer(
      "Other commands read pbrt-v3 files as they are; this one is for editing the scene, and for other programs. A\n"
      "warning names each kind of thing that is only approximated. Included files become part of the output; meshes\n"
      "and images stay where they are. Comments are lost. Images of infinite lights stay equirectangular, as Lanthorn\n"
      "reads them; pbrt-v4 itself needs its imgtool makeequiarea for them.\n\nExample:\n  lanthorn convert old.pbrt "
      "new.pbrt");
  c.callback([a] { run(*a); });
}

}  // namespace lanthorn::program
