// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The option table: printed values parse to the same values, and every entry has help.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <set>

#include "cli_fixture.h"
#include "lanthorn/description_data.h"
#include "render_command.h"

namespace lanthorn::command_line_test {
namespace {

using namespace program;

// Valid words of each type, different from all options' defaults; the first is printed as it is typed.
const std::map<std::string, Words> samples{
    {"COUNT", {"17", "0.5k"}},
    {"NUMBER", {"1.25", "0.2"}},
    {"TIME", {"90", "30s", "1.5m"}},
    {"SIZE", {"1048576", "512M"}},
    {"SHARE", {"0.02", "5%"}},
    {"FILE", {"tiny.pbrt"}},
    {"INTEGRATOR", {"vcm"}},
    {"HOST:PORT", {"localhost:14158"}},
    {"rgb|spectral", {"rgb", "spectral"}},
    {"error|skip", {"skip"}},
    {"WIDTHxHEIGHT", {"640x480", "800"}},
    {"NAME", {"Camera.001"}},
    {"y|z", {"z"}},
    {"YAW,PITCH", {"30,-10", "+45,0.5"}},
    {"none|highlights|filmic|agx", {"filmic", "agx"}},
    {"CONFIG[:DISPLAY/VIEW]", {"a.ocio", "a.ocio:sRGB/Film, low contrast"}},
    {"FIRST:END[@FPS]", {"0:48", "12:24@30"}},
    {"X0,Y0,X1,Y1", {"1,2,30,40"}},
    {"NUMBERS", {"0,1,4.4,0,1,0,0,1,0", "-1e-3,0.1,4,0,1,0,0,1,0"}},
    {"NAME=FACTOR", {"area1=0", "light1=0.5"}},
    {"NAME=VALUE", {"name=a b=c", "radius=0.1"}},
    {"FIRST:END", {"0:50", "1k:2k"}},
};
// Text that no option of the type accepts.
const std::map<std::string, Words> wrong{
    {"COUNT", {"", "many", "1.5", "-1"}},
    {"NUMBER", {"", "nan", "one", "1k"}},
    {"TIME", {"", "5q", "nan", "frame=3", "frame=3@0", "@24"}},
    {"SIZE", {"", "2Q", "0"}},
    {"rgb|spectral", {"", "spctral"}},
    {"error|skip", {"", "grey"}},
    {"WIDTHxHEIGHT", {"", "0", "-8", "16x", "x16", "16x16x", "1.5x2"}},
    {"y|z", {"", "x"}},
    {"YAW,PITCH", {"", "30", "30,", ",1", "a,b", "1,2,3"}},
    {"none|highlights|filmic|agx", {"", "aces"}},
    {"CONFIG[:DISPLAY/VIEW]", {""}},
    {"FIRST:END[@FPS]", {"", "1", "2:2", "0:9@0", "0:9@", "0:9@x"}},
    {"X0,Y0,X1,Y1", {"", "0,0,8", "0,0,8,8,", "0 0 8 8"}},
    {"NUMBERS", {"", "0,1,4,0,1,0,0,1", "0,1,4,0,1,0,0,1,0,", "a,b,c,d,e,f,g,h,i"}},
    {"NAME=FACTOR", {"", "light1", "=1", "light1=", "light1=-1", "light1=nan"}},
    {"NAME=VALUE", {"", "radius", "=1"}},
    {"FIRST:END", {"", "1", "2:2", "0:1:2", "0:4294967296"}},
};

class CommandLine : public Cli {
 protected:
  CommandLine() : before_(fs::current_path()) { fs::current_path(dir_.path()); }
  ~CommandLine() override { fs::current_path(before_); }

  /// Parses the words as `render` does.
  static RenderCommand read(const Words& words) {
    RenderCommand render;
    CLI::App app;
    add_command(app, {"render", "", render_command_options(render), "", [] {}});
    Words reversed{"render"};
    reversed.insert(reversed.end(), words.begin(), words.end());
    std::reverse(reversed.begin(), reversed.end());
    app.parse(reversed);
    return render;
  }
  /// Splits the text into words as a shell does.
  Words in_shell(const std::string& text) const {
    std::istringstream lines(run_shell("printf '%s\\n' " + text).out);
    Words words;
    for (std::string line; std::getline(lines, line);) words.push_back(line);
    return words;
  }

 private:
  fs::path before_;
};

TEST_F(CommandLine, EveryOptionIsPrintedAsItIsRead) {
  RenderCommand first, second;
  const OptionTable table = render_command_options(first), again = render_command_options(second);
  std::set<std::string> names;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Option& option = table[i];
    SCOPED_TRACE(option.names);
    EXPECT_TRUE(names.insert(option.long_name()).second) << "named twice";
    EXPECT_TRUE(option.value.print().empty()) << "the default";
    const bool is_flag = option.value.arity == Arity::flag;
    ASSERT_TRUE(is_flag || samples.contains(option.value.type)) << "no sample of " << option.value.type;
    for (const std::string& word : is_flag ? Words{""} : samples.at(option.value.type)) {
      RenderCommand fresh_arguments;
      const Option fresh = render_command_options(fresh_arguments)[i];
      fresh.value.read(option.long_name(), word);
      const Words printed = fresh.value.print();
      ASSERT_EQ(printed.size(), 1u) << word;
      again[i].value.read(option.long_name(), printed.front());
      EXPECT_EQ(again[i].value.print().back(), printed.front());
      table[i].value.read(option.long_name(), word);
      EXPECT_EQ(table[i].value.print().back(), printed.front());
    }
  }
}

TEST_F(CommandLine, EveryOptionRefusesWhatIsNotOfItsType) {
  RenderCommand arguments;
  for (const Option& option : render_command_options(arguments)) {
    if (!wrong.contains(option.value.type)) continue;
    for (const std::string& word : wrong.at(option.value.type)) {
      SCOPED_TRACE(option.names + " '" + word + "'");
      try {
        option.value.read(option.long_name(), word);
        FAIL() << "was taken";
      } catch (const CLI::ValidationError& e) {
        EXPECT_TRUE(contains(e.what(), option.long_name() + " " + word + ": expected ")) << e.what();
      }
    }
    EXPECT_TRUE(option.value.print().empty()) << option.names;
  }
}

TEST_F(CommandLine, EveryOptionSaysBrieflyWhatItIs) {
  constexpr std::size_t longest = 90;
  RenderCommand arguments;
  for (const Option& option : render_command_options(arguments)) {
    SCOPED_TRACE(option.names);
    EXPECT_FALSE(option.brief.empty());
    EXPECT_LE(option.brief.size(), longest);
    EXPECT_FALSE(option.brief.ends_with('.') && !option.brief.ends_with("...")) << option.brief;
    EXPECT_TRUE(option.details.empty() || option.details.ends_with('.')) << option.details;
    EXPECT_FALSE(option.otherwise.ends_with('.')) << option.otherwise;
  }
}

TEST_F(CommandLine, AndPlainDataHaveAllOptionsOfTheList) {
  RenderCommand arguments;
  const OptionTable table = render_command_options(arguments);
  for_each_render_option([&](const auto& listed) {
    EXPECT_TRUE(std::any_of(table.begin(), table.end(), [&](const Option& option) {
      return option.long_name() == flag_name(listed.name);
    })) << listed.name;
    plain::Dict data;
    data.set(listed.name, {});
    EXPECT_NO_THROW(options_of_data(data)) << listed.name;
  });
}

TEST_F(CommandLine, IsQuotedForAShell) {
  fs::copy_file("tiny.pbrt", "a room's.pbrt");
  RenderCommand render;
  render.scene = "a room's.pbrt";
  render.options.integrator = "vcm";
  render.options.resolution = {64, 48};
  render.options.set = {{"radius", "0.1"}, {"emission", "$HOME"}};
  render.changes.look = LookAt{{-1, 0.1, 4}, {0, 1, 0}, {0, 1, 0}};
  render.changes.lights = {{"area1", 0.1f}};
  render.output.measures_exposure = false;
  render.output.display.exposure = -1.5f;
  render.outputs = {"-a.png", "b.exr"};
  const std::string line = render_command_line(render);
  EXPECT_EQ(line,
            "lanthorn render 'a room'\\''s.pbrt' -i vcm -r 64x48 --set 'emission=$HOME' --set radius=0.1 --look-at "
            "-1,0.1,4,0,1,0,0,1,0 --light area1=0.1 --output=-a.png -o b.exr --exposure -1.5");
  Words words = in_shell(line);
  words.erase(words.begin(), words.begin() + 2);
  const RenderCommand read_again = read(words);
  EXPECT_EQ(render_command_line(read_again), line);
  EXPECT_EQ(read_again.scene, render.scene);
  EXPECT_EQ(read_again.options.set, render.options.set);
  EXPECT_EQ(read_again.changes.look, render.changes.look);
  EXPECT_EQ(read_again.outputs, render.outputs);
  EXPECT_EQ(read_again.output.measures_exposure, false);
}

// For a picture shown in a window: scenes with and without an exposure of their own.
TEST_F(CommandLine, HasTheExposureThatIsShown) {
  const auto line = [](float stops, bool is_measured, bool film_measures, std::optional<ToneCurve> curve = {}) {
    RenderCommand render;
    render.scene = "tiny.pbrt";
    const ToneCurve otherwise = is_measured ? ToneCurve::highlights : ToneCurve::none;
    render.output = shown_as({stops, curve.value_or(otherwise)}, is_measured, film_measures);
    return render_command_line(render);
  };
  const std::string plain = "lanthorn render tiny.pbrt";
  EXPECT_EQ(line(0, false, false), plain);
  EXPECT_EQ(line(1.5f, false, false), plain + " --exposure 1.5");
  EXPECT_EQ(line(0, false, true), plain + " --exposure 0");
  EXPECT_EQ(line(1.5f, false, true), plain + " --exposure 1.5");
  EXPECT_EQ(line(1.5f, true, true), plain);
  EXPECT_EQ(line(1.5f, true, false), plain + " --exposure auto");
  EXPECT_EQ(line(0, true, true, ToneCurve::none), plain + " --view-transform none");
  EXPECT_EQ(line(0, false, false, ToneCurve::highlights), plain + " --view-transform highlights");
}

TEST_F(CommandLine, OneOptionIsTheTimeOfAnAnimation) {
  const auto at = [](const std::string& word) { return read({"tiny.pbrt", "--at", word}).reading.at; };
  EXPECT_EQ(at("1.5"), 1.5);
  EXPECT_EQ(at("1.5s"), 1.5);
  EXPECT_EQ(at("2m"), 120);
  EXPECT_EQ(at("0"), 0);
  EXPECT_EQ(at("frame=36@24"), 1.5);
  EXPECT_EQ(at("frame=0@24"), 0);
}

TEST_F(CommandLine, OneOptionSaysWhenAndWhether) {
  const RenderCommand often = read({"tiny.pbrt", "--checkpoint", "10m", "--preview", "5s"});
  EXPECT_EQ(often.checkpoint_seconds, 600);
  EXPECT_EQ(often.preview_seconds, 5);
  EXPECT_FALSE(often.no_checkpoint || often.no_preview);
  const RenderCommand never = read({"tiny.pbrt", "--checkpoint", "none", "--preview", "none"});
  EXPECT_FALSE(never.checkpoint_seconds || never.preview_seconds);
  EXPECT_TRUE(never.no_checkpoint && never.no_preview);
  EXPECT_EQ(render_command_line(never), "lanthorn render tiny.pbrt --checkpoint none --preview none");
  refuse({"render", "tiny.pbrt", "--preview", "never"}, "expected a duration such as 30s, 5m or 2h, or none");
}

TEST_F(CommandLine, RemovedOptionsSayWhatToDoInstead) {
  refuse({"render", "tiny.pbrt", "--frame", "36"}, "option --frame was removed; write --at frame=36@24");
  refuse({"render", "tiny.pbrt", "--fps=12"}, "option --fps was removed; write --at frame=36@24");
  refuse({"render", "tiny.pbrt", "--no-preview"}, "option --no-preview was removed; write --preview none");
  refuse({"compare", "a.exr", "b.exr", "--pixels-per-degree", "60"}, "option --pixels-per-degree was removed; FLIP is");
}

}  // namespace
}  // namespace lanthorn::command_line_test
