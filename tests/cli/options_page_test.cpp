// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// docs/options.md lists exactly the program's options and parameters, each with a reason.
#include <map>
#include <set>
#include <sstream>

#include "cli_fixture.h"

namespace lanthorn::options_page_test {
namespace {

/// For each name, the commands or methods that have it.
using Places = std::map<std::string, std::set<std::string>>;

Words split(const std::string& text, const std::string& separator) {
  Words parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end + separator.size();
  }
  return parts;
}

class OptionsPage : public Cli {
 protected:
  Words lines_of(const Words& command) const { return split(succeed(command).out, "\n"); }

  Words commands() const {
    Words names;
    bool found = false;
    for (const std::string& line : lines_of({"--help"})) {
      if (found && line.starts_with("  ")) names.push_back(line.substr(2, line.find(' ', 2) - 2));
      found = line == "Subcommands:" || (found && !line.empty());
    }
    return names;
  }
  Places options() const {
    Places places;
    for (const std::string& command : commands())
      for (const std::string& line : lines_of({command, "--help", "--all"}))
        if (line.starts_with("  -"))
          for (const std::string& name : split(line.substr(2, line.find(' ', 2) - 2), ","))
            places[name].insert(command);
    return places;
  }
  Places parameters() const {
    Places places;
    for (const std::string& method_line : lines_of({"list"})) {
      const std::string method = method_line.substr(0, method_line.find(' '));
      if (method.empty()) continue;
      for (const std::string& line : lines_of({"list", method}))
        if (line.starts_with("  ")) places[line.substr(2, line.find(' ', 2) - 2)].insert(method);
    }
    return places;
  }

  /// The rows of the table under a heading: | `name`, `name` | place, place | reason |
  static Places table(const std::string& heading, const std::set<std::string>& all) {
    const std::string page = file_bytes(LANTHORN_SOURCE_DIR "/docs/options.md");
    const std::size_t begin = page.find("\n## " + heading + "\n");
    EXPECT_NE(begin, std::string::npos) << heading;
    Places places;
    for (const std::string& line : split(page.substr(begin + 1, page.find("\n## ", begin + 1) - begin - 1), "\n")) {
      if (!line.starts_with("| `")) continue;
      const Words cells = split(line, " | ");
      EXPECT_EQ(cells.size(), 3u) << line;
      if (cells.size() != 3) continue;
      EXPECT_GT(cells[2].size(), std::string("x |").size()) << "no reason: " << line;
      for (const std::string& name : split(cells[0].substr(2), ", ")) {
        std::set<std::string>& known = places[name.substr(1, name.size() - 2)];
        EXPECT_TRUE(known.empty()) << "twice: " << name;
        const Words named = split(cells[1], ", ");
        known = cells[1] == "all" ? all : std::set<std::string>(named.begin(), named.end());
      }
    }
    return places;
  }
};

std::string text_of(const std::set<std::string>& places) {
  std::string text;
  for (const std::string& place : places) text += (text.empty() ? "" : ", ") + place;
  return text.empty() ? "nowhere" : text;
}

void expect_equal(const Places& program, const Places& page) {
  ASSERT_FALSE(program.empty());
  std::set<std::string> names;
  for (const auto& [name, places] : program) names.insert(name);
  for (const auto& [name, places] : page) names.insert(name);
  const auto where = [](const Places& all, const std::string& name) {
    const auto found = all.find(name);
    return text_of(found == all.end() ? std::set<std::string>() : found->second);
  };
  for (const std::string& name : names)
    EXPECT_EQ(where(program, name), where(page, name)) << "docs/options.md: the row of " << name;
}

TEST_F(OptionsPage, HasEveryOption) {
  const Words all = commands();
  expect_equal(options(), table("Options", {all.begin(), all.end()}));
}

TEST_F(OptionsPage, HasEveryParameter) { expect_equal(parameters(), table("Parameters of methods", {})); }

}  // namespace
}  // namespace lanthorn::options_page_test
