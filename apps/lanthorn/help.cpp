// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "help.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <sstream>
#include <string_view>

namespace lanthorn::program {

namespace {

constexpr std::size_t line_width = 80, text_column = 26;
constexpr const char* help_title = "Help";
constexpr std::size_t most_shown = 20;  // options; a command with more hides its rare ones

// Options that several commands have, in their order. Those that are not here come at the end of the group that they
// name. If they name none, they belong to one command; they come first, as "Options", and are common.
struct OptionGroup {
  const char* title;
  std::vector<std::string> common, others;
};

const std::vector<OptionGroup>& option_groups() {
  static const std::vector<OptionGroup> groups{
      {"Result",
       {"--output", "--resolution", "--noise", "--time", "--passes", "--denoise", "--resume"},
       {"--crop", "--pass-range", "--checkpoint", "--reproducible", "--force", "--json"}},
      {"Method", {"--integrator", "--set"}, {}},
      {"Camera and light",
       {"--camera", "--orbit", "--turntable", "--fov", "--aperture", "--environment"},
       {"--variant", "--focus", "--look-at", "--environment-rotate", "--environment-scale", "--environment-up",
        "--light", "--window-glass"}},
      {"Animation", {}, {"--frames", "--at"}},
      {"Display", {"--exposure", "--view-transform"}, {"--ocio", "--preview", "--tev"}},
      {"Machine and files",
       {"--threads", "--missing", "--quiet"},
       {"--verbose", "--memory", "--texture-memory", "--max-pixels", "--sandbox"}}};
  return groups;
}

bool is_among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const OptionGroup* group_that_lists(const std::string& name) {
  for (const OptionGroup& group : option_groups())
    if (is_among(group.common, name) || is_among(group.others, name)) return &group;
  return nullptr;
}

bool is_rare(const Option& option) {
  const OptionGroup* const group = group_that_lists(option.long_name());
  return group ? is_among(group->others, option.long_name()) : !option.group.empty();
}

std::string title_of(const Option& option) {
  if (const OptionGroup* const group = group_that_lists(option.long_name())) return group->title;
  return option.group.empty() ? "Options" : option.group;
}

// Fills lines with the words of a text that starts at `column`; further lines are indented by `indent`.
std::string wrapped(std::string_view text, std::size_t column, std::size_t indent) {
  std::string out;
  std::istringstream words{std::string(text)};
  bool is_first = true;
  for (std::string word; words >> word; is_first = false) {
    if (!is_first && column + 1 + word.size() > line_width) {
      out += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (!is_first) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  return out + '\n';
}

// Paragraphs are filled; lines that are indented, such as commands, stay as they are.
std::string filled(const std::string& text) {
  std::string out, paragraph;
  const auto end_paragraph = [&] {
    if (!paragraph.empty()) out += wrapped(paragraph, 0, 0);
    paragraph.clear();
  };
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && !line.starts_with("  ") && !line.starts_with("Example")) {
      paragraph += line + ' ';
      continue;
    }
    end_paragraph();
    out += line + '\n';
  }
  end_paragraph();
  return out;
}

class HelpFormatter final : public CLI::Formatter {
 public:
  bool is_short = false;
  bool hides_options = false;  // omits rare options, defaults, and the footer except its examples
  std::string hint{};          // last line, which names --all

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode) const override {
    std::string text = make_description(app) + make_usage(app, std::move(name));
    if (const auto arguments = visible_options(*app, /*positional=*/true); !arguments.empty())
      text += make_group("Arguments", true, arguments);
    for (const HelpGroup& group : grouped_options(*app))
      if (!is_short || group.title != help_title) text += make_group(group.title, false, group.options);
    std::string footer = app->get_footer();
    if (hides_options) footer.erase(0, std::min(footer.find("Example"), footer.size()));
    if (!footer.empty()) text += '\n' + filled(footer);
    return hint.empty() ? text : text + '\n' + hint + '\n';
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    std::string name = "  " + make_option_name(option, is_positional);
    if (option->get_type_size() != 0 && !option->get_type_name().empty()) name += ' ' + option->get_type_name();
    if (option->get_expected_max() == CLI::detail::expected_max_vector_size) name += " ...";
    if (option->get_required()) name += " (required)";
    const bool is_long = name.size() + 2 > text_column;
    name += is_long ? '\n' + std::string(text_column, ' ') : std::string(text_column - name.size(), ' ');
    std::string text = option->get_description();
    if (!is_short)
      for (const CLI::Option* other : option->get_excludes())
        text = sentence(text) + " Not together with " + other->get_name() + '.';
    return name + wrapped(text, text_column, text_column);
  }
};

// Empty if there is nothing more to show.
std::string hint_of(const CLI::App& command, const OptionTable& table) {
  const auto options = std::count_if(table.begin(), table.end(), [](const Option& o) { return !o.is_argument(); });
  const bool has_more = table.size() > most_shown || std::any_of(table.begin(), table.end(), [](const Option& option) {
                          return !option.details.empty();
                        });
  if (!has_more) return {};
  return fmt::format("'lanthorn {} --help --all' shows all {} options, with details and defaults.", command.get_name(),
                     options);
}

}  // namespace

void add_help(CLI::App& command, const OptionTable& table) {
  const auto formatter = std::make_shared<HelpFormatter>();
  const auto options = std::make_shared<const OptionTable>(table);
  command.formatter(formatter);
  command.set_help_flag();
  command
      .add_flag_callback(
          "--all", [] { throw CLI::CallForHelp(); }, "With --help: print all options, with details and defaults")
      ->group(help_title);
  command
      .add_flag_callback(
          "-h,--help",
          [&command, formatter, options] {
            formatter->is_short = true;
            formatter->hint = hint_of(command, *options);
            formatter->hides_options = options->size() > most_shown;
            for (const Option& option : *options) {
              CLI::Option* const known = command.get_option(option.long_name());
              known->description(formatter->hides_options ? option.brief : option.description(/*in_short=*/true));
              if (formatter->hides_options && is_rare(option)) known->group("");
            }
            throw CLI::CallForHelp();
          },
          "Print this help: the common options")
      ->group(help_title);
}

void group_options(CLI::App& command, const OptionTable& table) {
  for (const Option& option : table)
    if (!option.is_argument()) command.get_option(option.long_name())->group(title_of(option));
}

std::vector<const CLI::Option*> visible_options(const CLI::App& command, bool positional) {
  return command.get_options([positional](const CLI::Option* option) {
    return !option->get_group().empty() && option->get_positional() == positional;
  });
}

std::vector<HelpGroup> grouped_options(const CLI::App& command) {
  std::vector<HelpGroup> groups{{"Options", {}}};
  for (const OptionGroup& group : option_groups()) {
    groups.push_back({group.title, {}});
    for (const std::vector<std::string>& names : {group.common, group.others})
      for (const std::string& name : names)
        if (const CLI::Option* option = command.get_option_no_throw(name); option && option->get_group() == group.title)
          groups.back().options.push_back(option);
    for (const CLI::Option* option : visible_options(command, /*positional=*/false))
      if (option->get_group() == group.title && !group_that_lists(option->get_name()))
        groups.back().options.push_back(option);
  }
  groups.push_back({help_title, {}});
  for (const CLI::Option* option : visible_options(command, /*positional=*/false)) {
    if (option->get_group() == help_title) groups.back().options.push_back(option);
    if (option->get_group() == groups.front().title) groups.front().options.push_back(option);
  }
  std::erase_if(groups, [](const HelpGroup& group) { return group.options.empty(); });
  return groups;
}

std::vector<const CLI::App*> visible_commands(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::vector<std::string> option_names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::string value_type(const CLI::Option& option) {
  if (option.get_type_size() == 0) return {};
  return option.get_type_name();
}

}  // namespace lanthorn::program
