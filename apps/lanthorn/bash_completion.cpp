// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <set>

#include "help.h"
#include "lanthorn/methods.h"
#include "lanthorn/version.h"

namespace lanthorn::program {

namespace {

using Words = std::vector<std::string>;

// Completes a command line, using the three tables printed before it in the script.
constexpr const char* engine = R"bash(
_lanthorn() {
  local current=${COMP_WORDS[COMP_CWORD]} previous='' before='' command='' integrator='' type='' candidates='' word
  COMPREPLY=()
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    [[ $word == = ]] && continue  # bash splits --option=value into three words
    [[ -z $command && $word != -* ]] && command=$word
    [[ $previous == -i || $previous == --integrator ]] && integrator=$word
    before=$previous previous=$word
  done
  [[ $current == = ]] && current=
  [[ $before == --set ]] && return  # the value of a parameter
  [[ $previous == -* ]] && type=$(_lanthorn_type "$command" "$previous")
  [[ -z $type && $current != -* ]] && type=$(_lanthorn_type "$command" '')
  case $type in
    FILE)
      compopt -o filenames 2>/dev/null
      mapfile -t COMPREPLY < <(compgen -f -- "$current")
      return ;;
    NAME=VALUE)
      compopt -o nospace 2>/dev/null
      candidates=$(_lanthorn_parameters "$integrator") ;;
    *'|'*) candidates=${type//|/ } ;;
    '') candidates=$(_lanthorn_words "$command") ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "$candidates" -- "$current")
}

complete -F _lanthorn lanthorn
)bash";

std::string function(const char* comment, const char* name, const char* subject, const std::string& cases) {
  return fmt::format("\n# {}\n{}() {{\n  case {} in\n{}  esac\n}}\n", comment, name, subject, cases);
}

std::string case_of(const Words& patterns, const std::string& answer) {
  return fmt::format("    {}) echo '{}' ;;\n", fmt::join(patterns, " | "), answer);
}

std::string quoted(const std::string& word) { return "'" + word + "'"; }

Words all_option_names(const CLI::App& command) {
  Words names;
  for (const CLI::Option* option : visible_options(command, /*positional=*/false))
    for (const std::string& name : option_names(*option)) names.push_back(name);
  return names;
}

std::string words(const CLI::App& program) {
  Words first;
  std::string cases;
  for (const CLI::App* command : visible_commands(program)) {
    first.push_back(command->get_name());
    cases += case_of({command->get_name()}, fmt::format("{}", fmt::join(all_option_names(*command), " ")));
  }
  for (const std::string& name : all_option_names(program)) first.push_back(name);
  return case_of({"''"}, fmt::format("{}", fmt::join(first, " "))) + cases;
}

// A type that lists words, such as rgb|spectral, completes to these words.
std::string completed_type(const CLI::Option& option) {
  std::string type = value_type(option);
  if (type != "INTEGRATOR") return type;
  Words names;
  for (const MethodInfo& info : methods()) names.push_back(info.name);
  return fmt::format("{}", fmt::join(names, "|"));
}

// All positional arguments of a command have one type.
std::string types(const CLI::App& program) {
  std::string cases;
  for (const CLI::App* command : visible_commands(program)) {
    const auto key = [command](const std::string& name) { return quoted(command->get_name() + " " + name); };
    if (const auto arguments = visible_options(*command, /*positional=*/true); !arguments.empty())
      cases += case_of({key("")}, completed_type(*arguments.front()));
    for (const CLI::Option* option : visible_options(*command, /*positional=*/false)) {
      Words patterns;
      for (const std::string& name : option_names(*option)) patterns.push_back(key(name));
      if (const std::string type = completed_type(*option); !type.empty()) cases += case_of(patterns, type);
    }
  }
  return cases;
}

std::string parameters() {
  std::set<std::string> all;
  std::string cases;
  for (const MethodInfo& info : methods()) {
    Words own;
    for (const ParameterInfo& parameter : info.parameters) own.push_back(parameter.name + "=");
    all.insert(own.begin(), own.end());
    cases += case_of({info.name}, fmt::format("{}", fmt::join(own, " ")));
  }
  return cases + case_of({"*"}, fmt::format("{}", fmt::join(all, " ")));
}

}  // namespace

std::string bash_completion(const CLI::App& program) {
  return fmt::format("# Bash completion for lanthorn {}, written by the program itself.\n", version) +
         function("Words that can follow subcommand $1; without it, the subcommands and the program's options.",
                  "_lanthorn_words", "$1", words(program)) +
         function("Value type of option $2 of subcommand $1; without an option, the type of its positional arguments.",
                  "_lanthorn_type", "\"$1 $2\"", types(program)) +
         function("The parameters of integrator $1; without it, those of all integrators.", "_lanthorn_parameters",
                  "$1", parameters()) +
         engine;
}

}  // namespace lanthorn::program
