// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/realtime.h"
#include "lanthorn/threads.h"
#include "lanthorn/version.h"
#include "rescue.h"
#include "suggestions.h"

namespace lanthorn::program {
namespace {

// A file alone is rendered: no subcommand has a dot in its name. "help render --all" is "render --help --all".
std::vector<std::string> completed(std::vector<std::string> words) {
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

int run_command(CLI::App& app, int argc, char** argv) {
  try {
    std::vector<std::string> words = completed({argv + 1, argv + argc});
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
