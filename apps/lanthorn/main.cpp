// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <exception>
#include <map>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "commands.h"
#include "console.h"
#include "help.h"
#include "lanthorn/error.h"
#include "lanthorn/methods.h"
#include "lanthorn/text.h"
#include "lanthorn/threads.h"
#include "lanthorn/version.h"
#include "rescue.h"

namespace lanthorn::program {
namespace {

using Words = std::vector<std::string>;

// A file alone is rendered: no subcommand has a dot in its name. "help render --all" is "render --help --all".
Words completed(Words words) {
  if (words.empty() || words.front().starts_with('-')) return words;
  if (words.front() == "help") {
    words.erase(words.begin());
    const bool shows_all = !words.empty() && words.back() == "--all";
    words.resize(std::min<std::size_t>(words.size(), 1));
    words.emplace_back("--help");
    if (shows_all) words.emplace_back("--all");
  } else if (words.front().find('.') != std::string::npos) {
    words.insert(words.begin(), "render");
  }
  return words;
}

// "--name", "--name=value" or "-x", but not a negative number.
bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && std::isdigit(static_cast<unsigned char>(word[1])) == 0 && word[1] != '.';
}

Words long_names(const CLI::App& command) {
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
  return fmt::format("unknown option {}{}", name, did_you_mean(name, long_names(command)));
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

// Replaces CLI11's error messages by our own, which suggest the command or option that was probably meant.
void add_suggestions(CLI::App& program) {
  program.failure_message([](const CLI::App* app, const CLI::Error& error) {
    return fmt::format("lanthorn: {}\nRun with --help for more information.\n", printable(describe(*app, error)));
  });
}

int run_command(CLI::App& app, int argc, char** argv) {
  try {
    Words words = completed({argv + 1, argv + argc});
    std::reverse(words.begin(), words.end());  // the order that CLI11 expects
    app.parse(std::move(words));
    return 0;
  } catch (const CLI::RuntimeError& e) {
    return e.get_exit_code();
  } catch (const CLI::ParseError& e) {  // a request for help is also a ParseError
    return app.exit(e) == 0 ? 0 : 2;
  }
}

int say_internal_error(const std::exception& e) {
  say("lanthorn: internal error: {}\n", e.what());
  return 3;
}

int run(int argc, char** argv) {
  CLI::App app("Lanthorn renders light that other renderers lose: caustics, glass, water, lamps behind glass.",
               "lanthorn");
  app.set_version_flag("-v,--version", version);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, also after a signal if the passes so far are saved; 1 a comparison that failed; 2 bad "
      "input, or a\nfile that cannot be written; 3 an internal error.\n\n"
      "Examples:\n"
      "  lanthorn scene.pbrt                   # the same as lanthorn render scene.pbrt\n"
      "  lanthorn render scene.pbrt -o picture.png --time 30s\n"
      "  lanthorn help render");
  add_suggestions(app);
  add_render(app);
  add_serve(app);
  add_view(app);
  add_link(app);
  add_info(app);
  add_compare(app);
  add_converge(app);
  add_denoise(app);
  add_develop(app);
  add_convert(app);
  add_merge(app);
  add_shards(app);
  add_photons(app);
  add_ibl(app);
  add_list(app);
  add_manual(app);
  try {
    const ThreadLimit all_cores(0);  // limits commands without --threads, too, to the available threads
    const int code = run_command(app, argc, argv);
    finish_output();
    return code;
  } catch (const OutputError& e) {
    say_text(std::string("lanthorn: ") + e.what() + '\n');
    return 2;
  } catch (const Error& e) {
    say("lanthorn: {}\n", e.what());
    return 2;
  } catch (const std::bad_alloc&) {
    say("lanthorn: not enough memory: a smaller picture (--resolution), fewer light paths (--photons) or a smaller "
        "scene needs less\n");
    return 2;
  } catch (const std::system_error& e) {
    if (e.code() != std::errc::resource_unavailable_try_again) return say_internal_error(e);
    say("lanthorn: the system allows no further threads (ulimit -u, or the limit of a container)\n");
    return 2;
  } catch (const std::exception& e) {
    return say_internal_error(e);
  }
}

}  // namespace
}  // namespace lanthorn::program

int main(int argc, char** argv) {
  lanthorn::program::open_console();
  lanthorn::add_realtime_methods();
  return lanthorn::program::run(argc, argv);
}
