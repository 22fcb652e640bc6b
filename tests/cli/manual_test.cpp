// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The man pages and the bash completion that the program writes, against its own --help.
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <regex>
#include <sstream>

#include "cli_fixture.h"

namespace lanthorn::manual_test {
namespace {

class Manual : public Cli {
 protected:
  Manual() { succeed({"manual", "share"}); }

  Words lines_of_help(const Words& command) const {
    const Words flags = command.empty() ? Words{"--help"} : Words{"--help", "--all"};
    std::istringstream help(succeed(command + flags).out);
    Words lines;
    for (std::string line; std::getline(help, line);) lines.push_back(line);
    return lines;
  }
  Words commands() const {
    Words names;
    bool found = false;
    for (const std::string& line : lines_of_help({})) {
      if (found && line.starts_with("  ")) names.push_back(line.substr(2, line.find(' ', 2) - 2));
      found = line == "Subcommands:" || (found && !line.empty());
    }
    return names;
  }
  /// {"--help", "-h", "-i", "--integrator" ...}: lines of options begin with "  -i,--integrator ".
  Words options(const Words& command) const {
    Words names;
    for (const std::string& line : lines_of_help(command)) {
      if (!line.starts_with("  -")) continue;
      std::istringstream together(line.substr(2, line.find(' ', 2) - 2));
      for (std::string name; std::getline(together, name, ',');) names.push_back(name);
    }
    return names;
  }
  /// The man pages: the program's own and one per subcommand.
  Words pages() const {
    Words names{"share/man/man1/lanthorn.1"};
    for (const std::string& command : commands()) names.push_back("share/man/man1/lanthorn-" + command + ".1");
    return names;
  }
  /// The completions that bash offers for the last word.
  Words complete(const Words& words) const {
    const std::string script =
        R"(source share/bash-completion/completions/lanthorn || exit 1
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
_lanthorn
[ ${#COMPREPLY[@]} = 0 ] || printf '%s\n' "${COMPREPLY[@]}")";
    const Ending ending =
        ChildProcess("/bin/bash", Words{"--norc", "-c", script, "bash", "lanthorn"} + words, dir_.path()).wait();
    EXPECT_EQ(ending.exit_code, 0) << ending.err;
    EXPECT_EQ(ending.err, "");
    std::istringstream out(ending.out);
    Words offers;
    for (std::string line; std::getline(out, line);) offers.push_back(line);
    return offers;
  }
};

bool is_among(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// In troff's notation: \fB\-\-max\-depth\fR.
std::string bold(const std::string& option) {
  std::string text = "\\fB";
  for (const char c : option) text += c == '-' ? "\\-" : std::string(1, c);
  return text + "\\fR";
}

bool is_there(const char* program) {
  return ChildProcess("/bin/sh", {"-c", "command -v " + std::string(program)}, "/").wait().exit_code == 0;
}

TEST_F(Manual, HasAPageForEveryCommandThatNamesItsOptions) {
  ASSERT_TRUE(is_among(commands(), "list"));
  for (const std::string& command : commands()) {
    const std::string page = bytes("share/man/man1/lanthorn-" + command + ".1");
    const Words names = options({command});
    ASSERT_FALSE(names.empty()) << command;
    for (const std::string& option : names) EXPECT_TRUE(contains(page, bold(option))) << command << ' ' << option;
    EXPECT_TRUE(contains(bytes("share/man/man1/lanthorn.1"), bold("lanthorn-" + command) + "(1)")) << command;
  }
  for (const std::string& option : options({}))
    EXPECT_TRUE(contains(bytes("share/man/man1/lanthorn.1"), bold(option))) << option;
}

// The words of a help whose lines are filled, with one blank between them.
std::string unwrapped(const std::string& help) {
  std::istringstream words(help);
  std::string text;
  for (std::string word; words >> word;) text += (text.empty() ? "" : " ") + word;
  return text;
}

TEST_F(Manual, TheHelpOfRenderFitsOnTwoScreens) {
  constexpr std::ptrdiff_t two_screens = 50;
  for (const std::string command : {"render", "serve", "view"}) {
    const std::string help = succeed({command, "--help"}).out;
    EXPECT_LE(std::count(help.begin(), help.end(), '\n'), two_screens) << help;
    for (const char* common : {"--output", "--resolution", "--denoise", "--integrator", "--environment"})
      EXPECT_TRUE(contains(help, common)) << common << help;
    for (const char* rare : {"--max-depth", "--environment-up", "--sandbox", "Default:"})
      EXPECT_FALSE(contains(help, rare)) << rare << help;
    EXPECT_TRUE(contains(help, "'lanthorn " + command + " --help --all' shows all ")) << help;
  }
}

TEST_F(Manual, TheHelpWithAllHasEveryOptionByGroup) {
  const std::string help = succeed({"render", "--help", "--all"}).out;
  std::size_t at = 0;
  for (const char* in_order : {"\nResult:\n", "  --crop ", "\nMethod:\n", "-d,--max-depth ", "\nCamera and light:\n",
                               "  --look-at ", "\nAnimation:\n", "  --frames ", "\nDisplay:\n", "  --ocio ",
                               "\nMachine and files:\n", "  --sandbox ", "\nHelp:\n", "\nLayers of .exr"}) {
    at = help.find(in_order, at);
    ASSERT_NE(at, std::string::npos) << in_order << help;
  }
  EXPECT_EQ(succeed({"render", "--all"}).out, help);
  EXPECT_EQ(succeed({"help", "render", "--all"}).out, help);
  EXPECT_EQ(succeed({"render", "-h"}).out, succeed({"render", "--help"}).out);
}

TEST_F(Manual, TheHelpHasLinesOf80Columns) {
  constexpr std::size_t width = 80;
  for (const std::string& command : commands())
    for (const std::string& line : lines_of_help({command})) {
      // Examples, and the tables that 'lanthorn list' prints, too.
      const bool is_as_typed = line.starts_with("  lanthorn ") || contains(line, " default ");
      if (!is_as_typed) {
        EXPECT_LE(line.size(), width) << command << '\n' << line;
      }
    }
}

TEST_F(Manual, DetailsAreInTheWholeHelpAndInThePage) {
  const std::string details = "The scene is not counted";
  EXPECT_FALSE(contains(unwrapped(succeed({"render", "--help"}).out), details));
  EXPECT_TRUE(contains(unwrapped(succeed({"render", "--help", "--all"}).out), details));
  const std::string page = bytes("share/man/man1/lanthorn-render.1");
  EXPECT_TRUE(contains(page, details));
  EXPECT_TRUE(contains(page, ".SS Camera and light\n")) << page;
  // A command of few options has all of them, with their defaults.
  EXPECT_TRUE(contains(unwrapped(succeed({"ibl", "--help"}).out), "Default: square"));
}

// Other sentences may begin with the name of a value.
TEST_F(Manual, SentencesOfTheHelpAreWhole) {
  const std::regex mangled("[^.][.] (the|a|an|it|its|this|these|each|all|every|if|in|of|on|with) ");
  for (const std::string& command : commands()) {
    const std::string help = unwrapped(succeed({command, "--help", "--all"}).out);
    std::smatch found;
    EXPECT_FALSE(std::regex_search(help, found, mangled)) << command << ": " << found.str() << found.suffix();
  }
}

TEST_F(Manual, DoesNotNameTheCommandThatWritesIt) {
  EXPECT_FALSE(is_among(commands(), "manual"));
  EXPECT_FALSE(fs::exists(path("share/man/man1/lanthorn-manual.1")));
  EXPECT_FALSE(is_among(complete({"man"}), "manual"));
}

TEST_F(Manual, IsTroffWithoutWarnings) {
  if (!is_there("groff")) {
    std::fprintf(stderr, "*** SKIPPED: there is no groff (package groff-base); the pages ARE NOT CHECKED ***\n");
    GTEST_SKIP();
  }
  for (const std::string& page : pages()) {
    const Ending ending = ChildProcess("/bin/sh", {"-c", "groff -man -ww -Tutf8 -P-cbou " + page}, dir_.path()).wait();
    EXPECT_EQ(ending.err, "") << page;
    EXPECT_TRUE(contains(ending.out, "--help")) << ending.out;
    EXPECT_FALSE(contains(ending.out, "lan\u2010")) << ending.out;  // hyphenated: not as it is typed
    if (contains(page, "render")) {
      EXPECT_TRUE(contains(ending.out, "  lanthorn render scene.pbrt --noise 5% --denoise -o picture.png\n"))
          << ending.out;
      EXPECT_TRUE(contains(ending.out, "'lanthorn list' shows")) << ending.out;
      EXPECT_TRUE(contains(ending.out, "Default: 2^30.")) << ending.out;
    }
  }
}

TEST_F(Manual, CompletionOffersCommandsAndOptions) {
  EXPECT_EQ(complete({"con"}), (Words{"converge", "convert"}));
  EXPECT_EQ(complete({""}), commands() + options({}));
  const auto sorted = [](Words words) {
    std::sort(words.begin(), words.end());
    return words;
  };
  for (const std::string& command : commands())
    EXPECT_EQ(sorted(complete({command, "-"})), sorted(options({command}))) << command;
  EXPECT_EQ(complete({"render", "tiny.pbrt", "--pre"}), (Words{"--preview"}));
  EXPECT_EQ(complete({"render", "-q", "--max-d"}), (Words{"--max-depth"}));
}

TEST_F(Manual, CompletionOffersValuesByTheirType) {
  dir_.write("a picture.exr", "");
  EXPECT_EQ(complete({"render", "ti"}), (Words{"tiny.pbrt"}));
  EXPECT_EQ(complete({"render", "tiny.pbrt", "-o", "a"}), (Words{"a picture.exr"}));
  EXPECT_EQ(complete({"compare", "a.exr", "b.exr", "--runs", "x.exr", "a"}), (Words{"a picture.exr"}));
  EXPECT_EQ(complete({"render", "-i", "reverse"}), (Words{"reversephotonmap"}));
  EXPECT_EQ(complete({"render", "--integrator", "=", "reverse"}), (Words{"reversephotonmap"}));
  EXPECT_EQ(complete({"list", "pat"}), (Words{"path"}));
  EXPECT_EQ(complete({"render", "--color", "s"}), (Words{"spectral"}));
  EXPECT_EQ(complete({"render", "--color", "="}), (Words{"rgb", "spectral"}));
  EXPECT_EQ(complete({"render", "tiny.pbrt", "--passes", ""}), Words{});
}

TEST_F(Manual, CompletionOffersEveryParameterOfTheIntegrator) {
  const auto parameters = [&](const std::string& integrator) {
    std::istringstream list(succeed({"list", integrator}).out);
    Words names;
    for (std::string line; std::getline(list, line);)
      if (line.starts_with("  ")) names.push_back(line.substr(2, line.find(' ', 2) - 2) + "=");
    return names;
  };
  for (const std::string integrator : {"probppm", "photonmap", "mlt", "path"}) {
    ASSERT_FALSE(parameters(integrator).empty());
    EXPECT_EQ(complete({"render", "-i", integrator, "tiny.pbrt", "--set", ""}), parameters(integrator));
  }
  EXPECT_EQ(complete({"render", "--set", "chain"}),
            (Words{"chain-length="}));  // a parameter of mlt: no integrator is named
  EXPECT_EQ(complete({"render", "--set", "chain-length", "=", "1"}), Words{});
  EXPECT_EQ(complete({"render", "--set", "chain-length", "=", "10", "ti"}), (Words{"tiny.pbrt"}));
}

TEST_F(Manual, CompletionIsRegistered) {
  const std::string script = "source share/bash-completion/completions/lanthorn && complete -p lanthorn";
  EXPECT_EQ(ChildProcess("/bin/bash", {"--norc", "-c", script}, dir_.path()).wait().out,
            "complete -F _lanthorn lanthorn\n");
}

TEST_F(Manual, SaysWhereItCannotBeWritten) { refuse({"manual", "tiny.pbrt"}, "tiny.pbrt/man/man1"); }

}  // namespace
}  // namespace lanthorn::manual_test
