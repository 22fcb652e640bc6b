// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <limits>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/shell.h"
#include "lanthorn/threads.h"
#include "quantities.h"
#include "render_arguments.h"
#include "render_output.h"
#include "scene_changes.h"
#include "serve/access.h"
#include "serve/http_server.h"
#include "serve/service.h"
#include "serve/viewer.h"
#include "signals.h"

namespace lanthorn::program {

namespace {

namespace fs = std::filesystem;

constexpr std::uint16_t default_port = 8080;

struct ServeCommand : RenderArguments, RenderFiles {
  SceneChanges changes;
  std::string address = "127.0.0.1";
  std::uint16_t port = default_port;
};

// The command line that renders the same picture.
std::string render_command(const ServeCommand& a, const SceneChanges& changes, std::uint64_t passes) {
  std::string text = "lanthorn render " + shell_word(a.scene);
  const auto add = [&text](const std::string& option, const std::string& value) {
    text += fmt::format(" {} {}", option, shell_word(value));
  };
  const RenderOptions& o = a.options;
  if (o.integrator) add("-i", *o.integrator);
  if (!a.resolution.empty()) add("-r", a.resolution);
  if (o.photons) add("-n", std::to_string(*o.photons));
  if (o.max_depth) add("-d", std::to_string(*o.max_depth));
  if (o.seed) add("-s", std::to_string(*o.seed));
  for (const std::string& setting : a.set) add("--set", setting);
  text += text_of_other_options(a);
  if (changes.look) add("--look-at", to_text(*changes.look));
  for (const auto& [name, factor] : changes.lights)
    if (factor != 1) add("--light", fmt::format("{}={}", name, factor));
  return text + fmt::format(" -p {} -o picture.exr", passes);
}

std::string title_of(const std::string& scene) {
  std::string title = fs::path(scene).stem().string();
  for (char& c : title)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
  return title.empty() ? "picture" : title;
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

bool is_loopback(const std::string& address) { return address.starts_with("127.") || address == "::1"; }
bool is_any(const std::string& address) { return address == "0.0.0.0" || address == "::"; }

void announce_address(const ServeCommand& a, std::uint16_t port, const std::string& token) {
  std::string host = is_any(a.address) ? host_name() : a.address;
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  print("http://{}:{}/{}/\n", host, port, token);
  finish_output();
  if (a.quiet) return;
  say("Open this address in a browser; whoever knows it can look and steer. Ctrl-C ends the server.\n");
  if (!is_loopback(a.address)) say("lanthorn: the connection is not encrypted: others in the network can read along\n");
}

// Runs the viewer until a signal comes.
void run_viewer(Viewer& viewer) {
  using namespace std::chrono_literals;
  // A signal handler can only set a flag.
  const std::jthread watch([&viewer](const std::stop_token& over) {
    while (!over.stop_requested() && !stop_requested()) std::this_thread::sleep_for(10ms);
    viewer.end();
  });
  viewer.run();
}

void save(const ServeCommand& a, const std::vector<fs::path>& outputs, const Viewer& viewer) {
  if (outputs.empty()) return;
  set_stage(Stage::saving);
  const Session* session = viewer.session();
  if (session == nullptr) {
    say("lanthorn: no whole pass was rendered of this view: nothing to save\n");
    end_by_signal();
  }
  save_render(a, outputs, viewer.scene(), session->state(), {});
}

void run_serve(const ServeCommand& a) {
  handle_signals();
  const RenderOptions options = parse_render_arguments(a);
  const ThreadLimit limit(a.threads);
  SceneDescription description = read_scene(a.scene, a.reading);
  check_view(description.view, options);
  const std::vector<fs::path> outputs(a.outputs.begin(), a.outputs.end());
  if (!outputs.empty()) check_files(a, a.scene, description, outputs);
  const auto command = [&a](const SceneChanges& changes, std::uint64_t passes) {
    return render_command(a, changes, passes);
  };
  Viewer viewer(build_scene(std::move(description)), {command, options, a.changes, !outputs.empty()});
  report_warnings(viewer.warnings());
  const std::string token = random_token();
  const ViewService service(viewer, a.output, title_of(a.scene), token, is_loopback(a.address) ? "" : host_name());
  const HttpServer server(a.address, a.port, [&service](const HttpRequest& request, const IsGone& is_gone) {
    return service.answer(request, is_gone);
  });
  set_stage(Stage::serving);
  announce_address(a, server.port(), token);
  run_viewer(viewer);
  save(a, outputs, viewer);
}

}  // namespace

void add_serve(CLI::App& app) {
  CLI::App& c = *app.add_subcommand("serve", "Show a scene in a browser while it renders, and move camera and lights");
  auto a = std::make_shared<ServeCommand>();
  add_render_arguments(c, *a);
  add_scene_changes(c, a->changes);
  add_count_option(c, "--port", fmt::format("Port to listen at; 0: any that is free. Default: {}", default_port),
                   {0, std::numeric_limits<std::uint16_t>::max()}, into(a->port));
  c.add_option("--bind", a->address,
               "Address to listen at, in numbers. Default: 127.0.0.1, which this machine alone can reach; 0.0.0.0: the "
               "whole network can")
      ->type_name("ADDRESS");
  add_count_option(c, "-p,--passes", "Rest after so many passes of a view. Default: go on", {1, most_passes},
                   into(a->options.passes));
  add_duration_option(c, "-t,--time", "Rest after this time on a view: 30s, 1.5m, 2h", into(a->options.seconds));
  c.add_option(
       "-o,--output", a->outputs,
       "Where to write the picture that is seen when the server ends: .exr (all layers), .png (color) or .state "
       "(to resume or merge); may be given several times. Default: nowhere")
      ->type_name("FILE")
      ->allow_extra_args(false);
  add_output_options(c, a->output);
  c.add_flag("-q,--quiet", a->quiet, "Print the address alone");
  c.footer(
      "The page shows the picture as it refines, moves the camera (drag: around what is in the middle; shift or right\n"
      "button: sideways; wheel: nearer and farther), dims lights, chooses layer, exposure and tone curve, saves the "
      "picture "
      "and\ngives the command line that renders it. Its address holds a random token: without it, nothing can be "
      "read.\n"
      "From another machine: ssh -L 8080:localhost:8080 MACHINE, then open the address there. Nothing is rendered "
      "while\n"
      "nobody looks, unless -o is given.\n\nExamples:\n"
      "  lanthorn serve scene.pbrt\n"
      "  lanthorn serve scene.glb -i path -r 960x540 --port 0 -o last.exr");
  c.callback([a] { run_serve(*a); });
}

}  // namespace lanthorn::program
