// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "help.h"
#include "lanthorn/file.h"
#include "options.h"

namespace lanthorn::program {

namespace {

namespace fs = std::filesystem;

void write_text(const fs::path& path, const std::string& text) {
  std::error_code ignored;  // write_file reports the problem
  fs::create_directories(path.parent_path(), ignored);
  write_file(path, text);
}

void write_manual(const CLI::App& program, const fs::path& folder) {
  const std::string& name = program.get_name();
  const fs::path pages = folder / "man/man1";
  write_text(pages / (name + ".1"), man_page(program, program));
  for (const CLI::App* command : visible_commands(program))
    write_text(pages / (name + "-" + command->get_name() + ".1"), man_page(program, *command));
  write_text(folder / "bash-completion/completions" / name, bash_completion(program));
}

}  // namespace

void add_manual(CLI::App& app) {
  const auto folder = std::make_shared<std::string>();
  const OptionTable options{{.names = "folder",
                             .value = into(*folder, text_type("DIR")),
                             .brief = "Folder for man/man1 and bash-completion/completions",
                             .required = true}};
  add_command(app, {"manual", "Write the man pages and the bash completion into a folder", options, "",
                    [&app, folder] { write_manual(app, *folder); }})
      .group("");  // hidden from --help: only the build calls it
}

}  // namespace lanthorn::program
