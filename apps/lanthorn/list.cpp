// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "commands.h"
#include "console.h"
#include "lanthorn/methods.h"

namespace lanthorn::program {

void add_list(CLI::App& app) {
  CLI::App& c = *app.add_subcommand("list", "List the integrators, or the parameters of one");
  auto name = std::make_shared<std::string>();
  c.add_option("integrator", *name, "Show the parameters of this one, for --set name=value")->type_name("INTEGRATOR");
  c.callback([name] {
    if (name->empty()) {
      for (const MethodInfo& info : methods()) print("{:<10} {} ({})\n", info.name, info.summary, info.paper);
      return;
    }
    const MethodInfo& info = find_method(*name);
    print("{}: {} ({})\n", info.name, info.summary, info.paper);
    for (const ParameterInfo& p : info.parameters)
      print("  {:<16} default {:<14} {}\n", p.name, p.default_value, p.help);
  });
}

}  // namespace lanthorn::program
