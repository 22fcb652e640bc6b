// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Renders that stop when their error is below a bound, and the error that they report.
#include <gtest/gtest.h>

#include <optional>

#include "cli_fixture.h"
#include "lanthorn/image_file.h"
#include "render/state.h"

namespace lanthorn {
namespace {

class Noise : public Cli {
 protected:
  static Words until(const std::string& method, const std::string& noise, const Words& more) {
    return render(Words{"-i", method, "-r", "24x24", "--noise", noise, "--force"} + more);
  }
};

TEST_F(Noise, EndsTheRenderWhenTheBoundIsReached) {
  for (const char* method : {"path", "bdpt", "vcm", "probppm", "sppm"}) {
    SCOPED_TRACE(method);
    std::uint64_t passes = 3;
    for (const auto& [noise, bound] : {std::pair("60%", 0.6), std::pair("0.2", 0.2)}) {
      succeed(until(method, noise, {"-o", "a.exr", "--json", "a.json"}));
      const nlohmann::json report = json("a.json"), error = report["error"];
      EXPECT_EQ(error["doubt"], "");
      EXPECT_LE(error["bound"], bound);
      EXPECT_LE(error["error"], error["bound"]);
      EXPECT_GT(report["passes_total"], passes);
      passes = report["passes_total"];
    }
  }
}

TEST_F(Noise, PassesAndTimeAreLimitsBesideIt) {
  succeed(until("path", "0.1%", {"-p", "5", "-o", "a.state"}));
  EXPECT_EQ(load_state(path("a.state")).pass_count(), 5u);
  succeed(until("path", "0.1%", {"-t", "0.1s", "-o", "a.state"}));
}

TEST_F(Noise, EndsAtTheSamePassWithAnyNumberOfThreads) {
  for (const char* method : {"path", "vcm", "sppm"}) {
    succeed(until(method, "30%", {"-T", "1", "-o", "one.exr", "-o", "one.state"}));
    succeed(until(method, "30%", {"-T", "3", "-o", "three.exr", "-o", "three.state"}));
    expect_equal_files("one.exr", "three.exr");
    expect_equal_files("one.state", "three.state");
  }
}

TEST_F(Noise, EndsAtTheSamePassAfterAResume) {
  for (const char* method : {"path", "vcm", "sppm"}) {
    succeed(until(method, "30%", {"-o", "whole.exr", "-o", "whole.state"}));
    succeed(until(method, "30%", {"-p", "4", "-o", "part.state"}));
    EXPECT_EQ(load_state(path("part.state")).pass_count(), 4u);
    succeed(until(method, "30%", {"--resume", "part.state", "-o", "resumed.exr", "-o", "resumed.state"}));
    expect_equal_files("whole.exr", "resumed.exr");
    expect_equal_files("whole.state", "resumed.state");
    // The bound is already reached: nothing is left to do.
    succeed(until(method, "30%", {"--resume", "whole.state", "-o", "again.exr"}));
    expect_equal_files("whole.exr", "again.exr");
  }
}

TEST_F(Noise, PicturesHaveTheErrorAsALayer) {
  succeed(render({"-i", "vcm", "-p", "16", "-o", "a.exr", "-o", "a.state"}));
  const Image image = read_image(path("a.exr"));
  const std::optional<Image> errors = select_layer(image, "error");
  ASSERT_TRUE(errors && select_layer(image, "bias"));
  double sum = 0;
  for (const float error : errors->pixels) {
    EXPECT_GE(error, 0);
    sum += static_cast<double>(error);
  }
  EXPECT_GT(sum, 0);
  succeed(render({"-i", "path", "-p", "16", "-o", "b.exr"}));
  EXPECT_FALSE(select_layer(read_image(path("b.exr")), "bias")) << "path tracing has none";
}

TEST_F(Noise, InfoTellsTheError) {
  succeed(render({"-i", "vcm", "-p", "16", "-o", "a.exr", "-o", "a.state", "--json", "a.json"}));
  for (const char* file : {"a.exr", "a.state"}) {
    const std::string text = succeed({"info", file}).out;
    EXPECT_TRUE(contains(text, "\nerror      below ")) << text;
    EXPECT_TRUE(contains(text, " with 90 % confidence; noise ")) << text;
  }
  EXPECT_EQ(nlohmann::json::parse(succeed({"info", "--json", "a.state"}).out)["error"], json("a.json")["error"]);
  EXPECT_EQ(nlohmann::json::parse(succeed({"info", "--json", "a.exr"}).out)["settings"]["error"],
            json("a.json")["error"]);
  succeed(render({"-i", "vcm", "-p", "2", "-o", "few.state"}));
  const std::string few = succeed({"info", "few.state"}).out;
  EXPECT_TRUE(contains(few, "\nerror      not known: there are too few passes; noise about ")) << few;
  succeed(render({"-i", "vcm", "-p", "1", "-o", "one.state", "-o", "one.exr"}));
  for (const char* file : {"one.state", "one.exr"}) {
    const std::string one = succeed({"info", file}).out;
    EXPECT_TRUE(contains(one, "\nerror      not known: there are too few passes\n")) << one;
  }
}

// The reported error is the same whether it is measured together with an .exr's layers or alone.
TEST_F(Noise, AllFilesTellTheSameError) {
  succeed(render({"-i", "vcm", "-p", "17", "-o", "a.png", "-o", "a.exr", "-o", "a.state"}));
  succeed(render({"-i", "vcm", "-p", "17", "-o", "b.png"}));
  succeed({"merge", "a.state", "-o", "c.exr"});
  succeed({"merge", "a.state", "-o", "d.png"});
  const auto info = [&](const char* file) { return nlohmann::json::parse(succeed({"info", "--json", file}).out); };
  const nlohmann::json error = info("a.state")["error"];
  for (const char* file : {"a.png", "a.exr", "b.png", "c.exr", "d.png"})
    EXPECT_EQ(info(file)["settings"]["error"], error) << file;
}

TEST_F(Noise, MethodsThatDoNotKnowTheirBiasSayNothing) {
  for (const char* method : {"photonmap", "reversephotonmap", "ppm"}) {
    refuse(until(method, "10%", {"-o", "a.exr"}), "has a bias that it does not measure");
    succeed(render({"-i", method, "-p", "12", "-o", "a.state", "--force"}));
    EXPECT_TRUE(contains(succeed({"info", "a.state"}).out, "not known: the bias of ")) << method;
    fs::remove(path("a.state"));
  }
}

TEST_F(Noise, BadBoundsAreRefused) {
  for (const char* bound : {"0", "0%", "-1%", "101%", "1.5", "little", "%", "nan"})
    refuse(until("path", bound, {"-o", "a.exr"}), "--noise");
}

}  // namespace
}  // namespace lanthorn
