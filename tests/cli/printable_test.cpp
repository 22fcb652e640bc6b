// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Whatever file names and file contents are, nothing is printed that a terminal would act on.
#include "support/printable.h"
#include "cli_fixture.h"
#include "render/state.h"

namespace lanthorn::printable_test {
namespace {

// Sets a terminal's title, with 7-bit and 8-bit control characters; deletes; changes the writing direction; forges a
// line.
const std::string evil = "\x1b]0;x\x07\xc2\x9b\x33\x31m\x7f\xe2\x80\xae\r\nlanthorn: forged";
// The text as a file name and in a shell.
const std::string evil_name = "a\x1b[31m\xc2\x9b\x7f\xe2\x80\xae\n";

class Printable : public Cli {
 protected:
  // Runs the program and checks everything that it prints.
  std::string check(const Words& words) const {
    const Ending ending = run(words);
    EXPECT_TRUE(ending.exit_code == 0 || ending.exit_code == 1 || ending.exit_code == 2)
        << testing::PrintToString(words) << ending.err;
    for (const std::string& text : {ending.out, ending.err}) {
      EXPECT_TRUE(test::is_printable(text)) << testing::PrintToString(words) << text;
      EXPECT_FALSE(contains(text, "\nlanthorn: forged")) << text;
    }
    return ending.out + ending.err;
  }
  void check_report(const std::string& name) const {
    const std::string text = bytes(name);
    EXPECT_TRUE(test::is_printable(text)) << name;
    EXPECT_TRUE(json(name).is_object()) << text;
  }

  void write_evil_state() const {
    succeed(render({"-i", "probppm", "-p", "1", "-r", "8x8", "-o", "good.state"}));
    RenderState state = load_state(path("good.state"));
    RenderIdentity& identity = state.record.identity;
    identity.parameters[evil] = evil;
    identity.files[evil] = {evil};
    identity.version = evil;
    identity.others[evil] = nlohmann::json(evil).dump();
    state.record.scene = evil;
    state.integrator = evil;
    save_state(state, path("evil.state"));
  }
  void write_evil_picture() const {
    const std::string name = "x\x1b[31m\xc2\x9b\x7f";
    const nlohmann::json metadata{
        {"integrator", evil}, {"scene", evil}, {"passes", evil}, {"parameters", {{evil, evil}}}};
    write_exr(path("evil.exr"), Image(4, 4, {"R", "G", "B", name + ".R", name + ".G", name + ".B"}), metadata.dump());
  }
  void write_evil_scene() const {
    std::string scene = tiny_scene;
    scene.replace(scene.find("tiny.exr"), 8, "out\x1b[31m\x7f.exr");
    const std::string first_line = evil.substr(0, evil.find('\r'));  // strings end with lines
    dir_.write("evil.pbrt", "Integrator \"" + first_line + "\"\n" + scene + "AttributeBegin\nMakeNamedMaterial \"" +
                                first_line + R"(" "string type" "diffuse" "string )" + first_line + R"(" ")" +
                                first_line + R"("
NamedMaterial ")" + first_line + "\"\nAttributeEnd\n");
  }
};

TEST_F(Printable, SettingsOfStates) {
  write_evil_state();
  const std::string said = check({"info", "evil.state"});
  EXPECT_TRUE(contains(said, R"(\x1b]0;x\x07\xc2\x9b31m\x7f\xe2\x80\xae\x0d\x0alanthorn: forged)")) << said;
  EXPECT_TRUE(contains(check({"info", "evil.state", "--json"}), R"(\u001b]0;x\u0007\u009b31m\u007f\u202e)"));
  check({"merge", "evil.state", "good.state", "-o", "a.exr"});
  check({"merge", "evil.state", "evil.state", "-o", "a.exr"});
  check({"merge", "evil.state", "-o", "a.exr"});
  check(render({"--resume", "evil.state", "-p", "1", "-r", "8x8", "-o", "a.exr"}));
  check(render({"-p", "1", "-r", "8x8", "-o", "evil.state"}));
}

TEST_F(Printable, LayersAndSettingsOfPictures) {
  write_evil_picture();
  const std::string said = check({"info", "evil.exr"});
  EXPECT_TRUE(contains(said, R"(x\x1b[31m\xc2\x9b\x7f)")) << said;
  check({"info", "evil.exr", "--json"});
  check({"develop", "evil.exr", "a.png", "--layer", "no such"});
  check({"develop", "evil.exr", "a.png"});
  check({"info", "a.png"});
  check({"compare", "evil.exr", "evil.exr", "--layer", evil, "--json", "compare.json"});
  check({"compare", "evil.exr", "evil.exr", "--layer", "x\x1b[31m\xc2\x9b\x7f", "--json", "compare.json"});
  check_report("compare.json");
}

TEST_F(Printable, TextOfScenes) {
  write_evil_scene();
  const std::string said = check({"info", "evil.pbrt"});
  EXPECT_TRUE(contains(said, "asks for   integrator \\x1b]0;x")) << said;
  check({"info", "evil.pbrt", "--json"});
  check({"render", "evil.pbrt", "-p", "1", "-n", "300", "-r", "8x8", "--json", "render.json"});
  check_report("render.json");
  check({"photons", "evil.pbrt", "-n", "300", "-o", "a.ply"});
  check({"converge", "evil.pbrt", "-n", "300", "-r", "8x8", "-p", "2", "--runs", "2", "--json", "converge.json"});
  check_report("converge.json");
  check({"convert", "evil.pbrt", "v4.pbrt"});
}

TEST_F(Printable, NamesOfFilesAndOptions) {
  const std::string scene = evil_name + ".pbrt", picture = evil_name + ".exr", state = evil_name + ".state";
  dir_.write(scene, tiny_scene);
  const Words few{"-p", "1", "-n", "300", "-r", "8x8"};
  check(Words{"render", scene, "-o", picture, "-o", state, "--json", "render.json"} + few);
  check_report("render.json");
  check({"info", scene});
  check({"info", picture});
  check({"info", picture, "--json"});
  check({"info", state});
  check({"compare", picture, picture, "--json", "compare.json"});
  check_report("compare.json");
  check({"compare", picture, picture, "--json", "-"});
  check({"develop", picture, evil_name + ".png"});
  check({"merge", state, "-o", "a.exr"});
  check({"merge", state, state, "-o", picture});
  check({"convert", scene, evil_name + "2.pbrt"});
  check({"photons", scene, "-n", "300", "-o", evil_name + ".ply"});
  check({"converge", scene, "-i", "path", "-r", "8x8", "-p", "2", "--runs", "2", "--json", "converge.json"});
  check_report("converge.json");
  check({"ibl", picture, "-o", evil_name});
  check({"list", evil});
  check({evil});
  check({"info", evil});
  check({"render", "--" + evil});
  check({"render", scene, "--set", evil + "=1"});
  check({"render", scene, "-i", evil});
  check({"render", scene, "--light", evil + "=1"});
  check({"render", scene, "--tev", evil});
  check({"render", scene, "-o", evil});
  check({"render", scene, "-r", evil});
  check({"serve", scene, "--bind", evil});
  check({"view", scene, "-i", evil});
}

}  // namespace
}  // namespace lanthorn::printable_test
