// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <exception>
#include <new>
#include <string>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/realtime.h"
#include "lanthorn/threads.h"
#include "lanthorn/version.h"
#include "rescue.h"
#include "suggestions.h"

namespace {

int run_command(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::RuntimeError& e) {
    return e.get_exit_code();
  } catch (const CLI::ParseError& e) {  // help is one of them
    return app.exit(e) == 0 ? 0 : 2;
  }
}

int run(int argc, char** argv) {
  CLI::App app("Lanthorn renders light that other renderers lose: caustics, glass, water, lamps behind glass.",
               "lanthorn");
  app.set_version_flag("--version", lanthorn::version);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, also after a signal if the passes so far are saved; 1 a comparison that failed; 2 bad "
      "input, "
      "or a\nfile that cannot be written; 3 an internal error.\n\n"
      "Examples:\n"
      "  lanthorn render scene.pbrt -o picture.png --time 30s\n"
      "  lanthorn render --help");
  lanthorn::add_suggestions(app);
  lanthorn::add_render(app);
  lanthorn::add_serve(app);
  lanthorn::add_view(app);
  lanthorn::add_info(app);
  lanthorn::add_compare(app);
  lanthorn::add_converge(app);
  lanthorn::add_develop(app);
  lanthorn::add_convert(app);
  lanthorn::add_merge(app);
  lanthorn::add_photons(app);
  lanthorn::add_ibl(app);
  lanthorn::add_list(app);
  lanthorn::add_manual(app);
  try {
    const lanthorn::ThreadLimit all_cores(0);  // or the threads that there are, for commands without --threads too
    const int code = run_command(app, argc, argv);
    lanthorn::finish_output();
    return code;
  } catch (const lanthorn::OutputError& e) {
    lanthorn::say_text(std::string("lanthorn: ") + e.what() + '\n');
    return 2;
  } catch (const lanthorn::Error& e) {
    lanthorn::say("lanthorn: {}\n", e.what());
    return 2;
  } catch (const std::bad_alloc&) {
    lanthorn::say(
        "lanthorn: not enough memory: a smaller picture (--resolution), fewer light paths (--photons) or a "
        "smaller scene needs less\n");
    return 2;
  } catch (const std::exception& e) {
    lanthorn::say("lanthorn: internal error: {}\n", e.what());
    return 3;
  }
}

}  // namespace

int main(int argc, char** argv) {
  lanthorn::open_console();
  lanthorn::add_realtime_methods();
  return run(argc, argv);
}
