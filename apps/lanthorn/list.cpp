// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include "commands.h"
#include "console.h"
#include "lanthorn/methods.h"
#include "options.h"

namespace lanthorn::program {

namespace {

void run(const std::string& name) {
  if (name.empty()) {
    for (const MethodInfo& info : methods()) print("{:<16} {} ({})\n", info.name, info.summary, info.paper);
    return;
  }
  const MethodInfo& info = find_method(name);
  print("{}: {} ({})\n", info.name, info.summary, info.paper);
  for (const ParameterInfo& p : info.parameters) print("  {:<17} default {:<14} {}\n", p.name, p.default_value, p.help);
}

}  // namespace

void add_list(CLI::App& app) {
  const auto name = std::make_shared<std::string>();
  const OptionTable options{{.names = "integrator",
                             .value = into(*name, text_type("INTEGRATOR")),
                             .brief = "Show the parameters of this method, for --set NAME=VALUE"}};
  add_command(app, {"list", "List the integrators, or the parameters of one", options, "", [name] { run(*name); }});
}

}  // namespace lanthorn::program
