// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "manual.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <span>

#include "commands.h"
#include "lanthorn/file.h"

namespace lanthorn::program {

namespace {

namespace fs = std::filesystem;

void write_text(const fs::path& path, const std::string& text) {
  std::error_code ignored;  // write_file says what is wrong
  fs::create_directories(path.parent_path(), ignored);
  write_file(path, std::as_bytes(std::span(text)));
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

std::vector<const CLI::App*> visible_commands(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::vector<const CLI::Option*> visible_options(const CLI::App& command, bool positional) {
  return command.get_options([positional](const CLI::Option* option) {
    return !option->get_group().empty() && option->get_positional() == positional;
  });
}

std::vector<std::string> option_names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::string value_type(const CLI::Option& option) {
  if (option.get_type_size() == 0) return {};
  const std::string type = option.get_type_name();  // TEXT:FILE, if it is checked to be a file
  return type.substr(type.rfind(':') + 1);
}

void add_manual(CLI::App& app) {
  CLI::App& c = *app.add_subcommand("manual", "Write the man pages and the bash completion into a folder");
  c.group("");  // not in --help: the build calls it
  auto folder = std::make_shared<std::string>();
  c.add_option("folder", *folder, "Where man/man1 and bash-completion/completions are made")->required();
  c.callback([&app, folder] { write_manual(app, *folder); });
}

}  // namespace lanthorn::program
