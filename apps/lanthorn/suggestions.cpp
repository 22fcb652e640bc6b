// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "suggestions.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <map>
#include <string>
#include <vector>

#include "lanthorn/text.h"
#include "manual.h"

namespace lanthorn::program {

namespace {

using Words = std::vector<std::string>;

// "--name", "--name=value" or "-x", but not a negative number.
bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && std::isdigit(static_cast<unsigned char>(word[1])) == 0 && word[1] != '.';
}

Words option_names(const CLI::App& command) {
  Words names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// Options of earlier versions, and their replacements.
const std::map<std::string, std::string> removed_options{
    {"--frame", "write --at frame=36@24 for frame 36 at 24 a second"},
    {"--fps", "write --at frame=36@24 for frame 36 at 24 a second"},
    {"--filmic", "write --view-transform filmic"},
    {"--frames", "view counts --passes"},
    {"--method", "write --integrator"},
    {"-m", "write -i"},
    {"--no-checkpoint", "write --checkpoint none"},
    {"--no-preview", "write --preview none"},
    {"--pixels-per-degree", "FLIP is that of a 0.7 m wide 4K monitor seen from 0.7 m"},
    {"--irradiance-size", "the map has 32 texels along an edge of a face"}};

std::string unknown_option(const CLI::App& command, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  if (const auto removed = removed_options.find(name); removed != removed_options.end())
    return fmt::format("option {} was removed; {}", name, removed->second);
  return fmt::format("unknown option {}{}", name, did_you_mean(name, option_names(command)));
}

std::string unknown_command(const CLI::App& program, const std::string& word) {
  Words names;
  for (const CLI::App* command : visible_commands(program)) names.push_back(command->get_name());
  return fmt::format("unknown subcommand '{}'{}", word, did_you_mean(word, names));
}

// Unknown options are reported first: their values may have been mistaken for other arguments.
std::string describe(const CLI::App& program, const CLI::Error& error) {
  const auto chosen = program.get_subcommands();
  const CLI::App& command = chosen.empty() ? program : *chosen.front();
  const Words unknown = program.remaining(/*recurse=*/true);
  const auto word = std::find_if_not(unknown.begin(), unknown.end(), is_option);
  if (chosen.empty() && word != unknown.end()) return unknown_command(program, *word);
  if (const auto option = std::find_if(unknown.begin(), unknown.end(), is_option); option != unknown.end())
    return unknown_option(command, *option);
  if (!unknown.empty() && error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError))
    return fmt::format("'{}' was not expected: it belongs to no option of {}", unknown.front(), command.get_name());
  if (chosen.empty() && error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError))
    return "a scene or a subcommand is missing, such as 'lanthorn scene.pbrt' or 'lanthorn serve scene.pbrt'";
  const std::string text = error.what();
  const std::size_t twice = text.find(": At Most 1 required");
  return twice == text.npos ? text : text.substr(0, twice) + " was given more than once";
}

}  // namespace

void add_suggestions(CLI::App& program) {
  program.failure_message([](const CLI::App* app, const CLI::Error& error) {
    return fmt::format("lanthorn: {}\nRun with --help for more information.\n", printable(describe(*app, error)));
  });
}

}  // namespace lanthorn::program
