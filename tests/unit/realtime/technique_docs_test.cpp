// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The tables of docs/viewer.md agree with the techniques' declarations.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>

#include "lanthorn/file.h"
#include "realtime/techniques/technique.h"

namespace lanthorn::technique_docs_test {
namespace {

// Rows of the table that begins with this line, without the line below the header.
std::set<std::string> rows_after(const std::string& text, const std::string& head) {
  std::istringstream lines(text.substr(std::min(text.find(head), text.size())));
  std::set<std::string> rows;
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  while (std::getline(lines, line) && line.starts_with('|')) rows.insert(line);
  return rows;
}

TEST(TechniqueDocs, NameAllParametersWithTheirDefaults) {
  std::set<std::string> expected;
  const auto add = [&](const TechniqueParameter& p, const std::string& technique) {
    expected.insert(fmt::format("| {} | `{}` | {} | {} | {} |", technique, p.info.name, p.default_in_viewer(),
                                p.info.default_value, p.info.help));
  };
  for (const TechniqueInfo& technique : built_in_techniques())
    for (const TechniqueParameter& p : technique.description.parameters) add(p, '`' + technique.description.name + '`');
  for (const TechniqueParameter& p : light_parameters()) add(p, "all but `splitsum`");
  const std::string text = read_file(LANTHORN_SOURCE_DIR "/docs/viewer.md");
  EXPECT_EQ(rows_after(text, "| `--integrator` | `--set` |"), expected);
}

TEST(TechniqueDocs, NameAllTechniques) {
  std::set<std::string> names, documented;
  for (const TechniqueInfo& technique : built_in_techniques()) names.insert(technique.description.name);
  for (const std::string& row :
       rows_after(read_file(LANTHORN_SOURCE_DIR "/docs/viewer.md"), "| `--integrator` | light |"))
    if (row.starts_with("| `")) documented.insert(row.substr(3, row.find('`', 3) - 3));
  EXPECT_EQ(documented, names);
}

}  // namespace
}  // namespace lanthorn::technique_docs_test
