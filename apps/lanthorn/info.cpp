// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "commands.h"
#include "console.h"
#include "io/read_scene.h"
#include "render_arguments.h"
#include "render_file.h"
#include "scene/media_check.h"
#include "scene/scene.h"
#include "scene_file.h"

namespace lanthorn {

namespace {

std::string list_counts(const nlohmann::json& counts) {
  std::string text;
  for (const auto& [name, count] : counts.items())
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count.get<int>(), name);
  return text.empty() ? "none" : text;
}

std::string mebibytes(const nlohmann::json& bytes) {
  return fmt::format("{:.1f} MiB", bytes.get<double>() / (1 << 20));
}

// What a triangle costs, where there are enough of them to tell.
std::string per_triangle(const nlohmann::json& d) {
  const double triangles = d["triangles"].get<double>();
  if (triangles < 1000) return {};
  const auto& bytes = d["memory_bytes"];
  return fmt::format(" ({:.0f} bytes a triangle)",
                     (bytes["geometry"].get<double>() + bytes["bvh"].get<double>()) / triangles);
}

void print_warnings(const std::vector<description::Warning>& warnings) {
  for (const description::Warning& w : warnings) print("warning    {}\n", Error(w.location, w.message).what());
}

void print_table(const Scene& scene, const nlohmann::json& d) {
  const description::RenderHints& hints = scene.description().hints;
  const description::Film& film = scene.description().film;
  const auto& lo = d["bounds"]["min"];
  const auto& hi = d["bounds"]["max"];
  print("scene      {}\n", scene.description().filename);
  print("geometry   {} triangles, {} patches, {} quadrics, {} curve segments, {} instances\n",
        d["triangles"].get<std::uint64_t>(), d["patches"].get<std::uint64_t>(), d["quadrics"].get<std::uint64_t>(),
        d["curve_segments"].get<std::uint64_t>(), d["instances"].get<std::uint64_t>());
  print("bounds     ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m\n", lo[0].get<float>(), lo[1].get<float>(),
        lo[2].get<float>(), hi[0].get<float>(), hi[1].get<float>(), hi[2].get<float>());
  const auto& bytes = d["memory_bytes"];
  print("memory     geometry {}, BVH {}{}, textures {}\n", mebibytes(bytes["geometry"]), mebibytes(bytes["bvh"]),
        per_triangle(d), mebibytes(bytes["textures"]));
  print("lights     {}\n", list_counts(d["lights"]));
  print("materials  {}\n", list_counts(d["materials"]));
  print("textures   {}\n", d["textures"].get<std::uint64_t>());
  print("film       {} x {} pixels\n", film.width, film.height);
  print("asks for   integrator {}{}\n", hints.integrator.empty() ? "(none)" : hints.integrator,
        hints.pixel_samples ? fmt::format(", {} samples", *hints.pixel_samples) : "");
  print("features   {}{}{}\n", scene.has_dispersion() ? "dispersion " : "",
        scene.has_measured_spectra() ? "measured spectra " : "",
        scene.has_motion() || make_view(scene.description()).camera.moves() ? "motion " : "");
  print("built in   {:.3f} s\n", d["build_seconds"].get<double>());
  print_warnings(scene.warnings());
  print_warnings(media_warnings(scene, make_view(scene.description())));
}

void show_scene(const std::string& file, const ReadOptions& reading, bool as_json) {
  const Scene scene(read_scene(file, reading));
  const nlohmann::json d = describe_scene(scene);
  if (as_json)
    print("{}\n", d.dump(2));
  else
    print_table(scene, d);
}

}  // namespace

void add_info(CLI::App& app) {
  CLI::App& c = *app.add_subcommand("info", "Show what is in a scene, a saved state or a picture");
  struct Arguments {
    std::string file;
    bool json = false;
    ReadOptions reading;
  };
  auto a = std::make_shared<Arguments>();
  c.add_option("file", a->file,
               "Scene file (.pbrt, .gltf, .glb, .obj), saved state (.state) or picture (.exr, .png ...)")
      ->required()
      ->check(CLI::ExistingFile);
  c.add_flag("--json", a->json, "Print as JSON");
  add_read_options(c, a->reading);
  c.footer(
      "Of a scene: counts, bounds, memory, lights, materials, warnings. Of a state or a picture: the method, its\n"
      "settings, seed, passes, size, layers and version, as far as the file holds them. A damaged file is an error.");
  c.callback([a] {
    switch (kind_of_file(a->file)) {
      case FileKind::state:
        return show_state(a->file, a->json);
      case FileKind::picture:
        return show_picture(a->file, a->reading.max_pixels, a->json);
      case FileKind::other:
        return show_scene(a->file, a->reading, a->json);
    }
  });
}

}  // namespace lanthorn
