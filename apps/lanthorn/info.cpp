// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/machine.h"
#include "lanthorn/methods.h"
#include "lanthorn/scene.h"
#include "render_arguments.h"
#include "render_file.h"
#include "report_json.h"

namespace lanthorn::program {

namespace {

std::string list_counts(const std::map<std::string, int>& counts) {
  std::string text;
  for (const auto& [name, count] : counts) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  return text.empty() ? "none" : text;
}

std::string mebibytes(std::uint64_t bytes) { return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20)); }

// Bytes per triangle, if there are enough triangles for a meaningful figure.
std::string per_triangle(const SceneSummary& s) {
  if (s.triangles < 1000) return {};
  return fmt::format(" ({:.0f} bytes a triangle)",
                     static_cast<double>(s.geometry_bytes + s.bvh_bytes) / static_cast<double>(s.triangles));
}

std::string method_of(const Scene& scene) { return default_method(description_of(scene).hints.integrator).name; }

void print_table(const Scene& scene, const SceneSummary& s) {
  const SceneDescription& description = description_of(scene);
  const description::RenderHints& hints = description.hints;
  const description::Film& film = description.view.film;
  const Point &lo = s.bounds.min, &hi = s.bounds.max;
  print("scene      {}\n", description.filename);
  print("geometry   {} triangles, {} patches, {} quadrics, {} curve segments, {} instances\n", s.triangles, s.patches,
        s.quadrics, s.curves, s.instances);
  if (!s.bounds.empty())
    print("bounds     ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m\n", lo.x, lo.y, lo.z, hi.x, hi.y, hi.z);
  print(
      "memory     geometry {}, BVH {}{}, textures {}{}\n", mebibytes(s.geometry_bytes), mebibytes(s.bvh_bytes),
      per_triangle(s), mebibytes(s.texture_bytes),
      s.texture_disk_bytes > 0 ? fmt::format(" (with {} more in tiles on disk)", mebibytes(s.texture_disk_bytes)) : "");
  print("lights     {}\n", list_counts(s.lights));
  print("materials  {}\n", list_counts(s.materials));
  print("textures   {}\n", s.textures);
  print("film       {} x {} pixels\n", film.width, film.height);
  print("asks for   integrator {}{}\n", hints.integrator.empty() ? "(none)" : hints.integrator,
        hints.pixel_samples ? fmt::format(", {} samples", *hints.pixel_samples) : "");
  print("method     {}\n", method_of(scene));
  print("features   {}{}{}\n", s.has_dispersion ? "dispersion " : "", s.has_measured_spectra ? "measured spectra " : "",
        s.has_motion ? "motion " : "");
  print("built in   {:.3f} s\n", s.build_seconds);
  for (const description::Warning& w : warnings_of(scene, description.view))
    print("warning    {}\n", Error(w.location, w.message).what());
}

std::string gibibytes(std::optional<std::uint64_t> bytes) {
  return bytes ? fmt::format("{:.1f} GiB", static_cast<double>(*bytes) / (1 << 30)) : "unknown";
}

std::string or_unknown(const std::string& text) { return text.empty() ? "unknown" : text; }

std::string cores_text(const MachineInfo& m) {
  std::string text = m.cores > 0 ? fmt::format("{}, ", m.cores) : "";
  text += fmt::format("{} hardware threads", m.hardware_threads);
  for (const CoreKind& kind : m.core_kinds) text += fmt::format(", {} of {} cores", kind.threads, kind.name);
  return text;
}

std::string threads_text(const MachineInfo& m) {
  return fmt::format("{} by default; CPU affinity allows {}, {}", m.default_threads, m.allowed_threads,
                     m.cpu_quota ? fmt::format("the control group grants the time of {:.4g} cores", *m.cpu_quota)
                                 : "no control group limits the time");
}

std::string memory_text(const MachineInfo& m) {
  return fmt::format(
      "{}, {} available; {}", gibibytes(m.memory), gibibytes(m.memory_available),
      m.memory_limit ? "the control group allows " + gibibytes(m.memory_limit) : "no control group limits it");
}

void print_table(const MachineInfo& m) {
  print("processor  {}\n", or_unknown(m.processor));
  print("sets       {}\n", or_unknown(fmt::format("{}", fmt::join(m.instruction_sets, " "))));
  print("compiled   for {}\n", or_unknown(m.compiled_for));
  print("cores      {}\n", cores_text(m));
  print("threads    {}\n", threads_text(m));
  print("memory     {}\n", memory_text(m));
  print("gpu        {}\n", m.gpus.empty() ? "none found" : fmt::format("{}", fmt::join(m.gpus, ", ")));
  for (const NamedText& library : m.libraries) print("{:<10} {}\n", "version", library.name + " " + library.text);
}

nlohmann::json machine_json(const MachineInfo& m) {
  nlohmann::json kinds = nlohmann::json::object(), libraries = nlohmann::json::object();
  for (const CoreKind& kind : m.core_kinds) kinds[kind.name] = kind.threads;
  for (const NamedText& library : m.libraries) libraries[library.name] = library.text;
  return {{"processor", m.processor},
          {"instruction_sets", m.instruction_sets},
          {"compiled_for", m.compiled_for},
          {"cores", m.cores > 0 ? nlohmann::json(m.cores) : nlohmann::json()},
          {"hardware_threads", m.hardware_threads},
          {"core_kinds", kinds},
          {"allowed_threads", m.allowed_threads},
          {"cpu_quota", or_null(m.cpu_quota)},
          {"default_threads", m.default_threads},
          {"memory_bytes",
           {{"machine", or_null(m.memory)},
            {"limit", or_null(m.memory_limit)},
            {"available", or_null(m.memory_available)}}},
          {"gpus", m.gpus},
          {"libraries", libraries}};
}

// Prints the machine's hardware and the resources that this process may use, for `info --machine`.
void show_machine(bool as_json) {
  const MachineInfo machine = machine_info();
  if (as_json)
    print_text(report_text(machine_json(machine)));
  else
    print_table(machine);
}

void show_scene(const std::string& file, const ReadOptions& reading, bool as_json) {
  const SharedScene scene = build_scene(read_scene(file, reading, [&](const ExpectedMeshes& meshes) {
    constexpr double large = 1e9;  // bytes; smaller scenes load within seconds
    if (meshes.bytes >= large)
      say("{}: {} meshes with {:.0f} faces will take {:.1f} GiB of memory\n", file, meshes.files, meshes.faces,
          meshes.bytes / (1 << 30));
  }));
  const SceneSummary summary = summarize(*scene);
  if (!as_json) return print_table(*scene, summary);
  nlohmann::json report = scene_json(summary);
  report["method"] = method_of(*scene);
  print_text(report_text(report));
}

struct InfoCommand {
  std::string file;
  bool json = false, machine = false;
  ReadOptions reading;
};

OptionTable info_options(InfoCommand& a) {
  const OptionTable own{
      {.names = "file",
       .value = into(a.file, existing_file_type()),
       .brief = "Scene file (.pbrt, .gltf, .glb, .obj), saved state (.state) or picture (.exr, .png ...)"},
      {.names = "--machine",
       .value = flag(a.machine),
       .brief = "Show the processor, memory and limits of this machine, and versions of libraries",
       .details = "CPU affinity and control groups (containers) can leave less than the machine has."},
      {.names = "--json", .value = flag(a.json), .brief = "Print as JSON"}};
  return joined(own, read_options(a.reading));
}

void run(const InfoCommand& a) {
  if (a.machine != a.file.empty())
    throw Error(a.machine ? "info --machine takes no file" : "info: expected a file, or --machine");
  if (a.machine) return show_machine(a.json);
  switch (kind_of_file(a.file)) {
    case FileKind::state:
      return show_state(a.file, a.json);
    case FileKind::picture:
      return show_picture(a.file, a.reading.max_pixels, a.json);
    case FileKind::other:
      return show_scene(a.file, a.reading, a.json);
  }
}

}  // namespace

void add_info(CLI::App& app) {
  const auto a = std::make_shared<InfoCommand>();
  constexpr const char* footer =
      "For a scene: counts, bounds, memory, lights, materials, warnings. For a state or a picture: the method, its\n"
      "settings, seed, passes, size, layers and version, as far as the file holds them. A damaged file is an error.";
  add_command(app, {"info", "Show what is in a scene, a saved state or a picture, or what this machine has",
                    info_options(*a), footer, [a] { run(*a); }});
}

}  // namespace lanthorn::program
