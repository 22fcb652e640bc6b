// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "help.h"
#include "lanthorn/version.h"
#include "options.h"

namespace lanthorn::program {

namespace {

// Troff's names for characters that it would otherwise typeset as different ones: see groff_char(7).
std::string_view troff_name(char c) {
  switch (c) {
    case '\\':
      return "\\(rs";
    case '-':
      return "\\-";
    case '\'':
      return "\\(aq";
    case '`':
      return "\\(ga";
    case '^':
      return "\\(ha";
    case '~':
      return "\\(ti";
    default:
      return {};
  }
}

std::string troff(std::string_view text) {
  std::string escaped = text.starts_with('.') ? "\\&" : "";  // a dot at the start of a line is a request
  for (const char c : text) {
    const std::string_view name = troff_name(c);
    name.empty() ? escaped += c : escaped += name;
  }
  return escaped;
}

std::string bold(std::string_view text) { return "\\fB" + troff(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + troff(text) + "\\fR"; }

// "lanthorn-render"
std::string page_name(const CLI::App& program, const CLI::App& command) {
  return &program == &command ? program.get_name() : program.get_name() + "-" + command.get_name();
}

// Indented lines, such as commands, stay separate lines; others are filled.
std::string paragraphs(const std::string& text) {
  std::istringstream lines(text);
  std::string out, line;
  bool as_typed = false, ended = true;
  while (std::getline(lines, line)) {
    const bool indented = line.starts_with("  ");
    if (as_typed && !indented) out += ".EE\n";
    if (!line.empty() && ended) out += ".PP\n";
    if (!as_typed && indented) out += ".EX\n";
    if (!line.empty()) out += troff(line) + "\n";
    as_typed = indented;
    ended = line.empty();
  }
  return as_typed ? out + ".EE\n" : out;
}

// The end of a command's help: text, then examples.
struct Footer {
  std::string text, examples;
};

Footer split_footer(const std::string& footer) {
  const std::size_t heading = footer.find("Example");
  if (heading == footer.npos) return {footer, ""};
  return {footer.substr(0, heading), footer.substr(footer.find('\n', heading) + 1)};
}

std::string synopsis(const CLI::App& program, const CLI::App& command) {
  if (&program == &command)
    return bold(program.get_name()) + " " + italic("SUBCOMMAND") + " [" + italic("OPTIONS") + "]\n";
  std::string line = bold(program.get_name() + " " + command.get_name()) + " [" + italic("OPTIONS") + "]";
  for (const CLI::Option* argument : visible_options(command, /*positional=*/true)) {
    const std::string name = italic(argument->get_name(true)) + (argument->get_items_expected_max() > 1 ? " ..." : "");
    line += argument->get_required() ? " " + name : " [" + name + "]";
  }
  return line + "\n";
}

// Conditions that --help expresses in its own notation, as sentences.
std::string conditions(const CLI::Option& option) {
  std::string text;
  if (option.get_required()) text += " Required.";
  for (const CLI::Option* other : option.get_excludes()) text += " Not together with " + other->get_name() + ".";
  return text;
}

std::string describe(const std::string& tag, const std::string& text) {
  return ".TP\n" + tag + "\n" + troff(text) + "\n";
}

std::string arguments(const CLI::App& command) {
  std::string out;
  for (const CLI::Option* argument : visible_options(command, /*positional=*/true))
    out += describe(italic(argument->get_name(true)), sentence(argument->get_description()) + conditions(*argument));
  return out;
}

std::string option_text(const CLI::Option& option) {
  std::string tag;
  for (const std::string& name : option_names(option)) tag += (tag.empty() ? "" : ", ") + bold(name);
  if (const std::string type = value_type(option); !type.empty()) tag += " " + italic(type);
  if (option.get_expected_max() > 1 && option.get_allow_extra_args()) tag += " ...";
  return describe(tag, sentence(option.get_description()) + conditions(option));
}

std::string options(const CLI::App& command) {
  std::string out;
  for (const HelpGroup& group : grouped_options(command)) {
    out += ".SS " + troff(group.title) + "\n";
    for (const CLI::Option* option : group.options) out += option_text(*option);
  }
  return out;
}

std::string subcommands(const CLI::App& program) {
  std::string out;
  for (const CLI::App* command : visible_commands(program))
    out += describe(bold(page_name(program, *command)) + "(1)", sentence(command->get_description()));
  return out;
}

std::string see_also(const CLI::App& program, const CLI::App& command) {
  std::string out;
  if (&program != &command) out = bold(program.get_name()) + "(1)";
  for (const CLI::App* other : visible_commands(program))
    if (other != &command) out += (out.empty() ? "" : ",\n") + bold(page_name(program, *other)) + "(1)";
  return out + "\n";
}

}  // namespace

std::string man_page(const CLI::App& program, const CLI::App& command) {
  const std::string name = page_name(program, command), description = command.get_description();
  const Footer footer = split_footer(command.get_footer());
  std::string title = name;
  std::transform(name.begin(), name.end(), title.begin(), [](unsigned char c) { return std::toupper(c); });
  // Lines are neither justified nor hyphenated, because commands must appear exactly as they are typed.
  std::string page =
      fmt::format(".TH {} 1 \"\" \"Lanthorn {}\" \"Lanthorn manual\"\n.ad l\n.nh\n.nr HY 0\n", troff(title), version);
  const auto section = [&page](const char* heading, const std::string& text) {
    if (!text.empty()) page += fmt::format(".SH {}\n{}", heading, text);
  };
  section("NAME", troff(name) + " \\- " + troff(description.substr(0, description.find_last_not_of('.') + 1)) + "\n");
  section("SYNOPSIS", synopsis(program, command));
  section("DESCRIPTION", troff(sentence(description)) + "\n" + paragraphs(footer.text));
  if (&program == &command) section("SUBCOMMANDS", subcommands(program));
  section("ARGUMENTS", arguments(command));
  section("OPTIONS", options(command));
  section("EXAMPLES", paragraphs(footer.examples));
  section("SEE ALSO", see_also(program, command));
  return page;
}

}  // namespace lanthorn::program
