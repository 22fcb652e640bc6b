// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <utility>

#include "commands.h"
#include "console.h"
#include "lanthorn/file.h"
#include "lanthorn/photons.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"
#include "lanthorn/threads.h"
#include "output_check.h"
#include "render_arguments.h"

namespace lanthorn::program {

namespace {

struct PhotonsCommand : RenderArguments {
  std::string output;
  std::uint32_t pass = 0;
  bool direct = false;
};

void run(const PhotonsCommand& a) {
  const RenderOptions& options = a.options;
  SceneDescription description = read_scene(a.scene, a.reading);
  check_outputs(files_of(description.files, a.scene), {{a.output, "-o", {".ply"}}});
  check_view(description.view, options);
  const ThreadLimit limit(a.threads);
  const SharedScene scene = build_scene(std::move(description));
  const Photons photons = trace_photons(*scene, description_of(*scene).view, options, a.pass, a.direct);
  write_file(a.output, encode_ply(photons));
  announce("{}: {} photons of {} light paths\n", a.output, photons.size(), photons.light_paths);
}

OptionTable photons_options(PhotonsCommand& a) {
  OptionTable own{
      required_file("-o,--output", a.output, "Output file: binary PLY"),
      {.names = "--pass",
       .value = into(a.pass, count_type({0, most_passes - 1})),
       .brief = "Pass whose photons are written",
       .otherwise = "0"},
      {.names = "--direct", .value = flag(a.direct), .brief = "Include photons that come directly from a light"}};
  return joined(render_options(a), std::move(own));
}

}  // namespace

void add_photons(CLI::App& app) {
  const auto a = std::make_shared<PhotonsCommand>();
  constexpr const char* footer =
      "Each vertex has x, y, z (m), nx, ny, nz (normal of the surface), dx, dy, dz (unit, towards where the photon "
      "came from),\npower_r, power_g, power_b (W; they sum to the flux that arrives at the surfaces), "
      "red, green,\nblue (the power's colour, for viewers) and caustic (1 if its path has met only mirrors and clear "
      "glass before).\n\nExample:\n  lanthorn photons scene.pbrt --photons 100000 -o photons.ply";
  add_command(app, {"photons", "Trace photons and write them as a point cloud (.ply)", photons_options(*a), footer,
                    [a] { run(*a); }});
}

}  // namespace lanthorn::program
