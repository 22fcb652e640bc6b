// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/methods.h"
#include "lanthorn/threads.h"
#include "render_command.h"
#include "serve/access.h"
#include "serve/http_server.h"
#include "serve/service.h"
#include "serve/viewer.h"
#include "signals.h"

namespace lanthorn::program {

namespace {

namespace fs = std::filesystem;

struct ServeCommand : RenderArguments, RenderFiles {
  SceneChanges changes;
  std::string address = "127.0.0.1";
  std::uint16_t port = 8080;
};

// The command line that renders the same picture.
std::string command_of(const ServeCommand& a, const ViewerScene& scene, std::uint64_t passes, bool denoises) {
  RenderCommand render;
  static_cast<RenderArguments&>(render) = a;
  render.threads = 0;
  render.options = scene.options;
  render.options.memory.reset();
  render.options.seconds.reset();
  render.options.noise.reset();
  render.options.passes = passes;
  render.reading.environment = scene.environment;
  render.changes = scene.changes;
  std::erase_if(render.changes.lights, [](const auto& light) { return light.second == 1; });
  render.output.denoise = denoises;
  render.outputs = {"picture.exr"};
  return render_command_line(render);
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
  say("Open this address in a browser; anyone who knows it can watch and control the render. Ctrl-C ends the "
      "server.\n");
  if (!is_loopback(a.address)) say("lanthorn: the connection is not encrypted: others on the network can read it\n");
}

// Runs until a signal arrives; the signal handler can only set a flag.
void run_viewer(Viewer& viewer) {
  using namespace std::chrono_literals;
  while (!stop_requested()) {
    std::this_thread::sleep_for(10ms);
    viewer.tend();
  }
  viewer.end();
}

void save(const ServeCommand& a, const std::vector<fs::path>& outputs, const Viewer& viewer) {
  if (outputs.empty()) return;
  set_stage(Stage::saving);
  const RenderState* state = viewer.state();
  if (state == nullptr) {
    say("lanthorn: no complete pass of this view was rendered: nothing to save\n");
    end_by_signal();
  }
  RenderFiles files = a;
  files.output.denoise = viewer.denoises();
  save_render(files, a.options, outputs, viewer.scene(), *state, {});
}

void run_serve(const ServeCommand& a) {
  handle_signals();
  const ThreadLimit limit(a.threads);
  SceneDescription description = read_scene(a.scene, a.reading);
  check_view(description.view, a.options);
  const std::vector<fs::path> outputs(a.outputs.begin(), a.outputs.end());
  if (!outputs.empty()) check_files(a, a.scene, description, outputs);
  const auto command = [&a](const ViewerScene& shown, std::uint64_t passes, bool denoises) {
    return command_of(a, shown, passes, denoises);
  };
  Viewer viewer(build_scene(std::move(description)),
                {command, {a.changes, a.options, a.reading.environment}, a.output.denoise, !outputs.empty()});
  SaidLines said;
  if (!a.quiet) announce_method(viewer.scene(), a.options, said);
  report_warnings(viewer.warnings(), said);
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

OptionTable serve_options(ServeCommand& a) {
  OptionTable own{
      {.names = "--port",
       .value = into(a.port, count_type({0, std::numeric_limits<std::uint16_t>::max()})),
       .brief = "Port to listen on; 0: any free port",
       .otherwise = std::to_string(a.port)},
      {.names = "--bind",
       .value = into(a.address, text_type("ADDRESS")),
       .brief = "IP address to listen on",
       .details = "127.0.0.1 is reachable only from this machine; 0.0.0.0 opens the server to the whole network.",
       .otherwise = a.address},
      {.names = "-p,--passes",
       .value = into(a.options.passes, count_type({1, most_passes})),
       .brief = "Pause after this many passes of a view",
       .otherwise = "continue"},
      {.names = "-t,--time",
       .value = into(a.options.seconds, duration_type()),
       .brief = "Pause after this time on a view: 30s, 1.5m, 2h"},
      {.names = "--noise",
       .value = into(a.options.noise, share_type()),
       .brief = "Pause when the estimated error is below this: 2%"},
      outputs_option(a.outputs, "Write the picture that is shown when the server ends", "nowhere")};
  OptionTable table = joined(joined(render_options(a), scene_change_options(a.changes)), std::move(own));
  table = joined(std::move(table), output_options(a.output));
  table.push_back({.names = "-q,--quiet", .value = flag(a.quiet), .brief = "Print only the address"});
  return table;
}

}  // namespace

void add_serve(CLI::App& app) {
  const auto a = std::make_shared<ServeCommand>();
  constexpr const char* footer =
      "The page shows the picture as it refines, moves the camera (drag: orbit; shift or right\n"
      "button: pan; wheel: zoom), sets lens and environment, dims lights, chooses method, size,\n"
      "layer, exposure and tone curve, denoises the picture, saves it and gives the command line\n"
      "that renders it. Its address holds a random token: without it, nothing can be read.\n"
      "From another machine: ssh -L 8080:localhost:8080 MACHINE, then open the address there.\n"
      "Nothing is rendered while nobody looks, unless -o is given.\n\n"
      "Examples:\n"
      "  lanthorn serve scene.pbrt\n"
      "  lanthorn serve scene.glb -i path -r 960x540 --port 0 -o last.exr";
  add_command(app, {"serve", "Show a scene in a browser while it renders, and move camera and lights",
                    serve_options(*a), footer, [a] { run_serve(*a); }});
}

}  // namespace lanthorn::program
