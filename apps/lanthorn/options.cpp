// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <CLI/CLI.hpp>
#include <cctype>
#include <iterator>

#include "help.h"
#include "lanthorn/text.h"

namespace lanthorn::program {

namespace {

using Words = std::vector<std::string>;

CLI::Option* register_option(CLI::App& app, const Option& option) {
  const std::string name = option.long_name();
  const auto read = option.value.read;
  if (option.value.arity == Arity::flag) return app.add_flag_callback(option.names, [read, name] { read(name, ""); });
  if (option.value.arity == Arity::one)
    return app.add_option_function<std::string>(option.names,
                                                [read, name](const std::string& word) { read(name, word); });
  return app
      .add_option_function<Words>(option.names,
                                  [read, name](const Words& words) {
                                    for (const std::string& word : words) read(name, word);
                                  })
      ->allow_extra_args(option.value.arity == Arity::several);
}

void register_options(CLI::App& app, const OptionTable& table) {
  std::map<std::string, CLI::Option*> registered;
  for (const Option& option : table) {
    CLI::Option* const known = register_option(app, option);
    known->description(option.description(/*in_short=*/false))->required(option.required);
    if (!option.value.type.empty()) known->type_name(option.value.type);
    registered[option.long_name()] = known;
  }
  for (const Option& option : table)
    if (!option.excludes.empty()) registered.at(option.long_name())->excludes(registered.at(option.excludes));
}

// A word that begins with a dash would be taken for an option, unless it is a number.
bool looks_like_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && std::isdigit(static_cast<unsigned char>(word[1])) == 0;
}

std::string printed(const Option& option, const std::string& word) {
  if (option.is_argument()) return shell_word(looks_like_option(word) ? "./" + word : word);
  if (option.value.arity == Arity::flag) return option.short_name();
  if (looks_like_option(word)) return shell_word(option.long_name() + "=" + word);
  return option.short_name() + " " + shell_word(word);
}

}  // namespace

std::string sentence(const std::string& text) { return text.ends_with('.') ? text : text + '.'; }

std::string Option::description(bool in_short) const {
  std::string text = brief;
  if (!in_short && !details.empty()) text = sentence(text) + ' ' + details;
  if (!otherwise.empty()) text = sentence(text) + " Default: " + otherwise;
  return text;
}

Option file_option(const std::string& names, std::string& file, const std::string& brief) {
  return {.names = names, .value = into(file, text_type("FILE")), .brief = brief};
}

Option required_file(const std::string& names, std::string& file, const std::string& brief) {
  Option option = file_option(names, file, brief);
  option.required = true;
  return option;
}

OptionTable joined(OptionTable table, OptionTable more) {
  table.insert(table.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  return table;
}

OptionTable without(OptionTable table, const std::string& name) {
  std::erase_if(table, [&](const Option& option) { return option.long_name() == name; });
  return table;
}

CLI::App& add_command(CLI::App& program, Command command) {
  CLI::App& app = *program.add_subcommand(command.name, command.summary);
  add_help(app, command.options);
  register_options(app, command.options);
  group_options(app, command.options);
  app.footer(command.footer);
  app.callback(std::move(command.run));
  return app;
}

std::string command_line(const std::string& command, const OptionTable& table) {
  std::string text = command;
  for (const Option& option : table)
    for (const std::string& word : option.value.print()) text += ' ' + printed(option, word);
  return text;
}

std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

void refuse_value(const std::string& option, const std::string& text, const std::string& expected,
                  const std::vector<std::string>& known) {
  throw CLI::ValidationError(
      fmt::format("{} {}: expected {}{}", option, excerpt(text), expected, did_you_mean(text, known)));
}

}  // namespace lanthorn::program
