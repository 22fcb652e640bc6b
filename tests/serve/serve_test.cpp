// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Tests `lanthorn serve` through raw sockets.
#include <gtest/gtest.h>
#include <signal.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>
#include <vector>

#include "../cli/cli_fixture.h"
#include "http_client.h"
#include "lanthorn/denoise.h"
#include "lanthorn/error.h"
#include "lanthorn/image_file.h"
#include "support/printable.h"

namespace lanthorn::serve_test {

using test::Answer;
using test::HttpClient;
using namespace std::chrono_literals;

class Serve : public Cli {
 protected:
  // Starts the server and waits for its address.
  void start(const Words& more = {}, const std::string& scene = "tiny.pbrt") {
    process_ = std::make_unique<ChildProcess>(
        LANTHORN_PROGRAM, Words{"serve", scene, "--port", "0", "-n", "300", "-q"} + more, dir_.path());
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    std::string address;
    while ((address = process_->out_so_far()).find('\n') == std::string::npos && !process_->has_ended() &&
           std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(5ms);
    const std::size_t slash = address.find('/', 7), port = address.rfind(':', slash);
    host_ = address.substr(7, port - 7);
    ASSERT_NE(slash, std::string::npos) << address << process_->err_so_far();
    port_ = static_cast<std::uint16_t>(std::stoi(address.substr(port + 1)));
    root_ = address.substr(slash, address.find('\n') - slash);
  }
  HttpClient client() const { return HttpClient(port_); }
  Answer get(const std::string& resource) const { return client().get(root_ + resource); }
  int edit(const nlohmann::json& json) const { return client().post(root_ + "edit", json.dump()).status; }

  // Waits for the finished picture of an edit.
  nlohmann::json picture_of(const nlohmann::json& change) const {
    const Answer answer = client().post(root_ + "edit", change.dump());
    EXPECT_EQ(answer.status, 200) << change << ' ' << answer.body;
    if (answer.status != 200) return frame([](const nlohmann::json&) { return true; });
    const nlohmann::json revision = nlohmann::json::parse(answer.body)["revision"];
    return frame([&](const nlohmann::json& f) { return f["finished"] && f["revision"] == revision; });
  }
  // The command line shown after an edit renders exactly the picture that the page saves. Returns the command.
  std::string expect_same_picture(const nlohmann::json& change) {
    const std::string text = picture_of(change)["command"];
    const Answer exr = get("picture.exr");
    EXPECT_EQ(exr.status, 200);
    std::ofstream(path("served.exr"), std::ios::binary) << exr.body;
    std::istringstream words(text);
    Words command;
    for (std::string word; words >> word;) command.push_back(word);
    EXPECT_EQ(command.front(), "lanthorn");
    command.erase(command.begin());
    succeed(command + Words{"-q"});
    const Image served = read_image(path("served.exr")), rendered = read_image(path("picture.exr"));
    EXPECT_EQ(served.channels, rendered.channels);
    EXPECT_TRUE(served.pixels == rendered.pixels) << text;
    return text;
  }

  static nlohmann::json about(const Answer& answer) {
    std::uint32_t size = 0;
    if (answer.body.size() < 4) return {};
    std::memcpy(&size, answer.body.data(), 4);
    return nlohmann::json::parse(answer.body.substr(4, size), nullptr, false);
  }
  // The first frame for which `is_right` returns true.
  template <class Condition>
  nlohmann::json frame(Condition is_right) const {
    HttpClient watching = client();
    nlohmann::json last = {{"number", 0}};
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (std::chrono::steady_clock::now() < deadline) {
      const Answer answer = watching.get(root_ + "frame?layer=color&after=" + last["number"].dump());
      if (answer.status != 200) continue;
      last = about(answer);
      if (is_right(last)) return last;
    }
    ADD_FAILURE() << "no such frame; the last: " << last.dump();
    return last;
  }
  long memory() const {  // resident memory, kB
    std::ifstream status("/proc/" + std::to_string(process_->pid()) + "/status");
    for (std::string line; std::getline(status, line);)
      if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
    return 0;
  }

  std::unique_ptr<ChildProcess> process_;
  std::uint16_t port_ = 0;
  std::string root_, host_;
};

// The color of a frame, as half floats.
std::string color_of(const Answer& answer) {
  std::uint32_t size = 0;
  std::memcpy(&size, answer.body.data(), 4);
  return answer.body.substr(4 + size);
}

bool is_denoised(const nlohmann::json& frame) { return frame["denoised"].is_object() && !frame["denoised"]["preview"]; }
bool is_finished(const nlohmann::json& frame) { return frame["finished"]; }

TEST_F(Serve, NothingIsReadableWithoutTheToken) {
  start({"-p", "2"});
  EXPECT_EQ(root_.size(), 34u);
  EXPECT_EQ(get("").status, 200);
  const std::string wrong = "/" + std::string(32, '0') + "/";
  for (const std::string& path :
       {std::string("/"), std::string("/favicon.ico"), wrong, wrong + "frame", "/../tiny.pbrt" + root_,
        root_.substr(0, 33), root_ + "tiny.pbrt", root_ + "../tiny.pbrt", root_ + "%2e%2e/tiny.pbrt"})
    EXPECT_EQ(client().get(path).status, 404) << path;
  EXPECT_EQ(client().post(wrong + "edit", R"({"paused":true})").status, 404);
}

// No name or text from a file affects a terminal that shows an answer, or into which the command is pasted.
TEST_F(Serve, AnswersHoldNoControlCharacters) {
  const std::string name = "a\x1b[31m\xc2\x9b\x7f\xe2\x80\xae.pbrt";
  dir_.write(name, std::string(tiny_scene) +
                       "Material \"diffuse\" \"string \x1b]0;x\x07\xc2\x9b\x7f\" \"\xc2\x9b\"\nShape \"sphere\"\n");
  start({"-p", "1"}, name);
  const nlohmann::json about = frame(is_finished);
  const std::string command = about["command"];
  EXPECT_TRUE(contains(command, R"($'a\033[31m\302\233\177\342\200\256.pbrt')")) << command;
  const Answer seen = get("frame?layer=color&after=0");
  std::uint32_t size = 0;
  std::memcpy(&size, seen.body.data(), 4);
  const std::vector<std::string> answers{seen.body.substr(4, size), get("").body, get("scene").body,
                                         client().post(root_ + "edit", R"({"lights":{"\u001b\u009b":1}})").body};
  for (const std::string& text : answers) {
    EXPECT_FALSE(text.empty());
    EXPECT_TRUE(test::is_printable(text)) << text;
  }
}

TEST_F(Serve, OtherSitesAreRefused) {
  start({"-p", "2"});
  EXPECT_EQ(client().ask("GET " + root_ + " HTTP/1.1\r\nHost: evil.example\r\n\r\n").status, 421);
  EXPECT_EQ(client().ask("GET " + root_ + " HTTP/1.1\r\n\r\n").status, 421);
  EXPECT_EQ(client().post(root_ + "edit", "{}", "http://evil.example").status, 403);
  EXPECT_EQ(client().post(root_ + "edit", "{}").status, 200);
  const Answer page = get("");
  EXPECT_NE(page.head.find("Content-Security-Policy: default-src 'none'; script-src 'nonce-"), std::string::npos);
  EXPECT_EQ(page.body.find("{{"), page.body.find("{{no such placeholder"));
  EXPECT_EQ(page.body.find("src=\"http"), std::string::npos);
}

// The switch affects what is shown and saved, and the command line.
TEST_F(Serve, PicturesAtRestAreDenoised) {
  start({"-p", "4", "-r", "24x16", "-i", "path"});
  const nlohmann::json noisy = frame(is_finished);
  EXPECT_EQ(noisy["denoise"], false);
  EXPECT_TRUE(noisy["denoised"].is_null());
  for (const nlohmann::json& layer : noisy["layers"]) EXPECT_FALSE(contains(layer, "noise")) << layer;
  const std::string noisy_png = get("picture.png").body, noisy_color = color_of(get("frame?after=0&layer=color"));
  EXPECT_FALSE(contains(expect_same_picture(nlohmann::json::object()), "--denoise"));
  EXPECT_TRUE(can_denoise(read_image(path("served.exr"))));

  EXPECT_EQ(edit({{"denoise", true}}), 200);
  EXPECT_EQ(frame(is_denoised)["denoised"]["passes"], 4);
  EXPECT_NE(get("picture.png").body, noisy_png);
  EXPECT_NE(color_of(get("frame?after=0&layer=color")), noisy_color);
  EXPECT_NE(color_of(get("frame?after=0&layer=direct")), noisy_color);
  EXPECT_TRUE(contains(expect_same_picture(nlohmann::json::object()), "--denoise"));
  const Image saved = read_image(path("served.exr"));
  EXPECT_TRUE(saved.find_channel("denoised.direct.R") && saved.find_channel("denoised.error.R"));
  EXPECT_TRUE(contains(read_image_metadata(path("served.exr")), "denoised_error"));

  EXPECT_EQ(edit({{"denoise", false}}), 200);
  EXPECT_TRUE(frame([](const nlohmann::json& f) { return f["denoise"] == false; })["denoised"].is_null());
  EXPECT_EQ(get("picture.png").body, noisy_png);
}

TEST_F(Serve, PicturesOfTheEndAreDenoisedAsThePageSays) {
  for (const bool denoises : {true, false}) {
    start(denoises ? Words{"-p", "2", "-o", "end.exr"} : Words{"-p", "2", "-o", "end.exr", "--denoise"});
    EXPECT_EQ(frame(is_finished)["denoise"], !denoises);
    EXPECT_EQ(edit({{"denoise", denoises}}), 200);
    process_->send(SIGINT);
    EXPECT_EQ(process_->wait().exit_code, 0);
    EXPECT_EQ(read_image(path("end.exr")).find_channel("denoised.R").has_value(), denoises);
  }
}

// True if this machine has the IPv6 loopback address.
bool has_ipv6() {
  std::ifstream addresses("/proc/net/if_inet6");
  for (std::string line; std::getline(addresses, line);)
    if (line.starts_with("00000000000000000000000000000001")) return true;
  return false;
}

TEST_F(Serve, ListensWhereItIsTold) {
  const auto status_at = [&](const std::string& address) {
    try {
      return HttpClient(port_, address)
          .ask("GET " + root_ + " HTTP/1.1\r\nHost: " + host_ + ":" + std::to_string(port_) + "\r\n\r\n")
          .status;
    } catch (const lanthorn::Error&) {
      return 0;  // nothing listens there
    }
  };
  start({"-p", "1", "--bind", "127.0.0.2"});
  EXPECT_EQ(host_, "127.0.0.2");
  EXPECT_EQ(status_at("127.0.0.2"), 200);
  EXPECT_EQ(status_at("127.0.0.1"), 0);
  if (!has_ipv6()) GTEST_SKIP() << "SKIPPED, NOT TESTED: this machine has no IPv6";
  start({"-p", "1", "--bind", "::1"});
  EXPECT_EQ(host_, "[::1]");
  EXPECT_EQ(status_at("::1"), 200);
  EXPECT_EQ(status_at("127.0.0.1"), 0);
  start({"-p", "1", "--bind", "::"});
  EXPECT_EQ(status_at("::1"), 200);
}

TEST_F(Serve, BadEditsChangeNothing) {
  start({"-p", "2"});
  const nlohmann::json before = frame(is_finished);
  for (const char* body : {"",
                           "[]",
                           "null",
                           "{",
                           R"({"camera":1})",
                           R"({"camera":{"eye":[0,0,0],"target":[0,0,0],"up":[0,1,0]}})",
                           R"({"camera":{"eye":[0,0],"target":[0,0,1],"up":[0,1,0]}})",
                           R"({"lights":{"moon":1}})",
                           R"({"lights":{"light1":-1}})",
                           R"({"paused":"yes"})",
                           R"({"denoise":"yes"})",
                           R"({"method":"moonlight"})",
                           R"({"method":1})",
                           R"({"lens":{"fov":0}})",
                           R"({"lens":{"fov":"wide"}})",
                           R"({"lens":{"aperture":"wide"}})",
                           R"({"lens":{"focus":-1}})",
                           R"({"lens":{"focus":2}})",
                           R"({"lens":2})",
                           R"({"lens":{"focus_at":[1]}})",
                           R"({"environment":{"source":"tiny.pbrt"}})",
                           R"({"environment":{"source":"/etc/passwd"}})",
                           R"({"environment":{"source":"studio","scale":-1}})",
                           R"({"environment":{"source":"studio","rotation":"x"}})",
                           R"({"environment":"studio"})",
                           R"({"environment":{}})",
                           R"({"size":[64]})",
                           R"({"size":[0,64]})",
                           R"({"size":[64,-1]})",
                           R"({"size":"64x64"})"})
    EXPECT_EQ(client().post(root_ + "edit", body).status, 400) << body;
  // A readable environment that was not given when the server started.
  Image sky(2, 1, {"R", "G", "B"});
  sky.pixels.assign(6, 1.0f);
  write_exr(path("sky.exr"), sky);
  EXPECT_EQ(client().post(root_ + "edit", R"({"environment":{"source":"sky.exr"}})").status, 400);
  EXPECT_EQ(about(get("frame"))["number"], before["number"]);
}

TEST_F(Serve, TheCommandLineRendersTheSamePicture) {
  start({"-p", "3"});
  expect_same_picture({{"camera", {{"eye", {0.5, 1.25, 4}}, {"target", {0, 1, 0}}, {"up", {0.1, 1, 0}}}},
                       {"lights", {{"area1", 0.5}, {"light1", 2}}}});
  EXPECT_TRUE(contains(expect_same_picture({{"lens", {{"fov", 30}, {"aperture", 0.5}}}}), " --fov 30 --aperture 0.5 "));
  EXPECT_TRUE(contains(expect_same_picture({{"lens", {{"focus", 3.3}}}}), " --focus 3.3 "));
  EXPECT_TRUE(contains(expect_same_picture({{"lens", {{"focus", "auto"}}}}), " --focus auto "));
  expect_same_picture({{"lens", {{"focus_at", {5, 9}}}}});
  expect_same_picture({{"environment", {{"source", "studio"}}}});
  const std::string turned =
      expect_same_picture({{"environment", {{"source", "sunny"}, {"rotation", 30.5}, {"scale", 0.1}}}});
  EXPECT_TRUE(contains(turned, " --environment sunny --environment-rotate 30.5 --environment-scale 0.1 ")) << turned;
  const std::string closed = expect_same_picture({{"lens", {{"aperture", "off"}}}, {"environment", {{"source", ""}}}});
  EXPECT_TRUE(contains(closed, " --aperture off ")) << closed;
  EXPECT_FALSE(contains(closed, "--environment") || contains(closed, "--focus")) << closed;
}

TEST_F(Serve, AViewIsFinishedWhenItsErrorIsSmall) {
  start({"-i", "path", "--noise", "60%"});
  const nlohmann::json shown = frame(is_finished);
  EXPECT_TRUE(contains(shown["error"], "below ")) << shown["error"];
  EXPECT_GE(shown["passes"], 4);
  EXPECT_EQ(shown["seconds_left"], 0);
  EXPECT_FALSE(contains(shown["command"], "--noise")) << shown["command"];
}

TEST_F(Serve, AViewTellsTheTimeLeftUntilItsBound) {
  start({"-i", "path", "--noise", "0.1%"});
  const nlohmann::json shown = frame([](const nlohmann::json& f) { return !f["seconds_left"].is_null(); });
  EXPECT_GT(shown["seconds_left"], 0);
  EXPECT_FALSE(is_finished(shown));
}

TEST_F(Serve, AViewWithoutBoundTellsNoTimeLeft) {
  start({"-i", "path"});
  EXPECT_TRUE(frame([](const nlohmann::json& f) { return f["error"] != ""; })["seconds_left"].is_null());
}

TEST_F(Serve, AViewTellsWhatAutoHasFound) {
  start({"-p", "1"});
  EXPECT_TRUE(contains(frame(is_finished)["remark"], "caustics"));
}

// Not around the surface seen between its parts.
TEST_F(Serve, AModelTurnsAroundItsMiddle) {
  dir_.write("bars.obj",
             "v -1 -1 0\nv -.6 -1 0\nv -.6 1 0\nv -1 1 0\nf 1 2 3 4\n"
             "v .6 -1 0\nv 1 -1 0\nv 1 1 0\nv .6 1 0\nf 5 6 7 8\n"
             "v -1 -1 -3\nv 1 -1 -3\nv 1 1 -3\nv -1 1 -3\nf 9 10 11 12\n");
  start({"-p", "1", "-r", "24x16"}, "bars.obj");
  const std::array<double, 3> middle{0, 0, -1.5};
  const auto target = frame(is_finished)["camera"]["target"].get<std::array<double, 3>>();
  EXPECT_LT(std::hypot(target[0] - middle[0], target[1] - middle[1], target[2] - middle[2]), 0.3);
}

// A model without camera and light, which gets a studio and a framing camera.
TEST_F(Serve, TheCommandLineRendersTheSamePictureOfAModel) {
  dir_.write("model.obj", "v -1 0 0\nv 1 0 0\nv 1 2 0\nv -1 2 .5\nf 1 2 3 4\n");
  write_exr(path("sky.exr"), [] {
    Image image(4, 2, {"R", "G", "B"});
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = 0.1f * static_cast<float>(i % 7);
    return image;
  }());
  start({"-p", "2", "-r", "24x16", "--environment", "sky.exr", "--environment-rotate", "20", "--orbit", "20,10"},
        "model.obj");
  const std::string file = expect_same_picture({{"environment", {{"source", "sky.exr"}, {"rotation", 70}}}});
  EXPECT_TRUE(contains(file, " --environment sky.exr --environment-rotate 70 --orbit 20,10")) << file;
  expect_same_picture({{"lens", {{"fov", 60}, {"aperture", 0.5}}}});
  EXPECT_FALSE(contains(expect_same_picture({{"environment", {{"source", ""}}}}), "--environment"));
  expect_same_picture({{"environment", {{"source", "overcast"}, {"scale", 2}}}});
  const std::string placed =
      expect_same_picture({{"camera", {{"eye", {0.5, 1.25, 4}}, {"target", {0, 1, 0}}, {"up", {0, 1, 0}}}},
                           {"environment", {{"source", "sky.exr"}, {"rotation", 0}}}});
  EXPECT_FALSE(contains(placed, "--orbit") || contains(placed, "-rotate")) << placed;
  expect_same_picture({{"size", {16, 24}}, {"lens", {{"focus", "auto"}}}});
}

TEST_F(Serve, FocusIsPickedInThePicture) {
  start({"-p", "2", "--aperture", "1"});
  const nlohmann::json middle = frame(is_finished);
  EXPECT_TRUE(middle["lens"]["focuses_middle"]);
  const nlohmann::json size = middle["full_size"];
  const nlohmann::json picked =
      picture_of({{"lens", {{"focus_at", {0.5 * size[0].get<double>(), 0.5 * size[1].get<double>()}}}}});
  EXPECT_FALSE(picked["lens"]["focuses_middle"]);
  EXPECT_NEAR(picked["lens"]["focus"].get<double>(), middle["lens"]["focus"].get<double>(), 1e-5);
  const nlohmann::json floor =
      picture_of({{"lens", {{"focus_at", {0.5 * size[0].get<double>(), 0.84 * size[1].get<double>()}}}}});
  EXPECT_LT(floor["lens"]["focus"].get<double>(), middle["lens"]["focus"].get<double>() - 0.1);
  EXPECT_TRUE(floor["moved"]);
  const nlohmann::json home = picture_of({{"home", true}});
  EXPECT_EQ(home["lens"], middle["lens"]);
}

// Environments add and remove lights, together with their factors.
TEST_F(Serve, LightsAreThoseOfTheEnvironment) {
  start({"-p", "1"});
  const auto lights = [&] { return nlohmann::json::parse(get("scene").body)["lights"]; };
  const nlohmann::json own = lights();
  picture_of({{"environment", {{"source", "overcast"}}}});
  ASSERT_EQ(lights().size(), own.size() + 1);
  EXPECT_EQ(lights().back(), (nlohmann::json{{"name", "light2"}, {"description", "Environment"}}));
  const nlohmann::json dimmed = picture_of({{"lights", {{"light1", 0.5}, {"light2", 0.25}}}});
  EXPECT_TRUE(contains(dimmed["command"], "--light light2=0.25")) << dimmed["command"];
  const nlohmann::json back = picture_of({{"environment", {{"source", ""}}}});
  EXPECT_EQ(lights(), own);
  EXPECT_EQ(back["lights"], (nlohmann::json{{"light1", 0.5}}));
}

TEST_F(Serve, MethodAndSizeCanBeChanged) {
  start({"-p", "2", "-i", "probppm", "--set", "radius=0.1"});
  const nlohmann::json first = frame(is_finished);
  ASSERT_EQ(edit({{"method", "path"}, {"size", {24, 20}}}), 200);
  const nlohmann::json shown =
      frame([](const nlohmann::json& f) { return f["finished"] && f["integrator"] == "path"; });
  EXPECT_EQ(shown["full_size"], (nlohmann::json{24, 20}));
  const std::string command = shown["command"];
  EXPECT_TRUE(contains(command, " -i path -n 300 -r 24x20 ")) << command;
  EXPECT_FALSE(contains(command, "radius")) << "it is a parameter of the other method: " << command;
  ASSERT_EQ(edit({{"method", "probppm"}, {"size", first["full_size"]}}), 200);
  const nlohmann::json again =
      frame([](const nlohmann::json& f) { return f["finished"] && f["integrator"] == "probppm"; });
  EXPECT_TRUE(contains(again["command"], "--set radius=0.1")) << again["command"];
}

// The picture stays, with the reason, and the server continues from it.
TEST_F(Serve, WhatDoesNotFitIntoMemoryIsTakenBack) {
  start({"-p", "2", "--memory", "64M"});
  const nlohmann::json first = frame(is_finished);
  ASSERT_EQ(edit({{"size", {8000, 8000}}}), 200);
  const nlohmann::json refused = frame([](const nlohmann::json& f) { return f["problem"] != "" && f["finished"]; });
  EXPECT_TRUE(contains(refused["problem"], "memory")) << refused["problem"];
  EXPECT_EQ(refused["full_size"], first["full_size"]);
  EXPECT_EQ(refused["command"], first["command"]);
  ASSERT_EQ(edit({{"lights", {{"area1", 0.5}}}}), 200);
  const nlohmann::json next =
      frame([](const nlohmann::json& f) { return f["finished"] && f["lights"].contains("area1"); });
  EXPECT_EQ(next["problem"], "");
}

TEST_F(Serve, LightsHaveWords) {
  start({"-p", "1"});
  const nlohmann::json scene = nlohmann::json::parse(get("scene").body);
  EXPECT_EQ(scene["lights"], (nlohmann::json{{{"name", "area1"}, {"description", "Lamp, ceiling"}},
                                             {{"name", "light1"}, {"description", "Spot light, front"}}}));
}

TEST_F(Serve, HomeIsTheFilesOwnView) {
  start({"-p", "1"});
  const nlohmann::json before = frame(is_finished);
  edit({{"camera", {{"eye", {1, 1, 4}}, {"target", {0, 1, 0}}, {"up", {0, 1, 0}}}}, {"lights", {{"area1", 0}}}});
  EXPECT_NE(frame([](const nlohmann::json& f) { return f["finished"] && f["moved"]; })["camera"], before["camera"]);
  edit({{"home", true}});
  const nlohmann::json after = frame([](const nlohmann::json& f) { return f["finished"] && !f["moved"]; });
  EXPECT_EQ(after["camera"], before["camera"]);
  EXPECT_EQ(after["command"], before["command"]);
}

TEST_F(Serve, PausesAndGoesOn) {
  start();
  edit({{"paused", true}});
  const nlohmann::json paused = frame([](const nlohmann::json& f) { return f["paused"].get<bool>(); });
  std::this_thread::sleep_for(300ms);
  const nlohmann::json later = about(get("frame"));
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(about(get("frame"))["passes"], later["passes"]);
  edit({{"paused", false}});
  frame([&](const nlohmann::json& f) { return !f["coarse"] && f["passes"] > later["passes"]; });
}

TEST_F(Serve, TenThousandRequestsLeaveTheMemoryAsItWas) {
  start({"-p", "2"});
  frame(is_finished);
  const auto ask = [&](int count) {
    HttpClient one = client();
    for (int i = 0; i < count; ++i) {
      if (one.get(i % 4 == 0 ? "/wrong" : root_ + "frame").status == 0) one = client();
    }
  };
  ask(500);
  [[maybe_unused]] const long before = memory();
  std::vector<std::jthread> clients;
  for (int i = 0; i < 8; ++i) clients.emplace_back([&] { ask(1250); });
  clients.clear();
#ifndef __SANITIZE_THREAD__  // ThreadSanitizer keeps a history of accesses in the process's memory
  EXPECT_LT(memory(), before + 32 * 1024);
#endif
  EXPECT_EQ(get("").status, 200);
}

TEST_F(Serve, EightClientsSeeThePicture) {
  start();
  std::vector<std::jthread> clients;
  for (int i = 0; i < 8; ++i)
    clients.emplace_back([&] { frame([](const nlohmann::json& f) { return !f["coarse"] && f["passes"] > 3; }); });
}

TEST_F(Serve, ASignalEndsItAtOnceAndSavesThePictureOfWhatIsSeen) {
  start({"-o", "last.exr", "-o", "last.state"});
  edit({{"lights", {{"area1", 0}}}});
  const nlohmann::json shown =
      frame([](const nlohmann::json& f) { return !f["coarse"] && f["lights"].contains("area1"); });
  process_->send(SIGINT);
  const Ending ending = process_->wait();
  EXPECT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_FALSE(bytes("last.exr").empty());
  // The command line can resume it.
  succeed({"render", "tiny.pbrt", "-n", "300", "-q", "--light", "area1=0", "--resume", "last.state", "-p", "100000",
           "-t", "0.01s", "-o", "more.exr"});
}

TEST_F(Serve, WithoutOutputASignalJustEndsIt) {
  start();
  process_->send(SIGTERM);
  const Ending ending = process_->wait();
  EXPECT_EQ(ending.exit_code, 0) << ending.err;
  EXPECT_EQ(files(), Words{"tiny.pbrt"});
}

TEST_F(Serve, SaysThatAutoTakesThePlaceOfTheFilesIntegrator) {
  dir_.write("volpath.pbrt", std::string(R"(Integrator "volpath"
)") + tiny_scene);
  const std::string line = R"(method auto: in place of pbrt's "volpath", which the file names (-i path: that method)
)";
  const auto said = [&](const Words& more) {
    ChildProcess process(LANTHORN_PROGRAM, Words{"serve", "volpath.pbrt", "--port", "0", "-n", "300"} + more,
                         dir_.path());
    while (!contains(process.err_so_far(), "Open this address") && !process.has_ended())
      std::this_thread::sleep_for(5ms);
    process.send(SIGTERM);
    return process.wait().err;
  };
  const std::string text = said({});
  EXPECT_TRUE(contains(text, line)) << text;
  EXPECT_FALSE(contains(said({"-i", "path"}), "method auto"));
  start({"-p", "1"}, "volpath.pbrt");
  EXPECT_EQ(frame(is_finished)["integrator"], "auto");
}

TEST_F(Serve, BadInputIsRefused) {
  start({"-p", "1"});
  refuse({"serve", "none.pbrt"}, "none.pbrt");
  refuse({"serve", "tiny.pbrt", "--port", std::to_string(port_)}, "cannot listen at 127.0.0.1 port");
  refuse({"serve", "tiny.pbrt", "--port", "70000"}, "--port");
  refuse({"serve", "tiny.pbrt", "--bind", "nowhere"}, "nowhere");
  refuse({"serve", "tiny.pbrt", "--look-at", "1,2,3"}, "expected nine numbers");
  refuse({"serve", "tiny.pbrt", "--look-at", "0,0,0,0,0,1,0,0,1"}, "must not lie on one line");
  refuse({"serve", "tiny.pbrt", "--light", "moon=1"}, "the scene has area1 to light1");
  refuse({"serve", "tiny.pbrt", "--light", "area1"}, "expected NAME=FACTOR");
  refuse({"serve", "tiny.pbrt", "-o", "a.gif"}, ".exr");
}

}  // namespace lanthorn::serve_test
