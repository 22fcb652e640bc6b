// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <string>

#include "commands.h"
#include "console.h"
#include "lanthorn/image_file.h"
#include "output.h"
#include "output_check.h"
#include "quantities.h"
#include "read_layer.h"
#include "render_arguments.h"

namespace lanthorn::program {

namespace {

struct DevelopCommand {
  std::string picture, output, layer = "color";
  std::uint64_t max_pixels = FileAccess::default_max_pixels;
  OutputSettings settings;
};

// Of the layer color all layers, since the exposure is measured by them.
Image picture_of(const DevelopCommand& a) {
  if (a.layer == "color") return read_image(a.picture, ColorEncoding::automatic, a.max_pixels);
  Image image = read_layer(a.picture, a.layer, a.max_pixels);
  if (image.channel_count() == 1)
    image.channels = {"Y"};
  else
    image.channels = {"R", "G", "B"};
  return image;
}

void run(const DevelopCommand& a) {
  check_outputs({{a.picture, "the picture"}}, {{a.output, "OUTPUT", {".png"}}}, a.settings.force);
  write_picture(a.output, picture_of(a), a.settings, false, read_image_metadata(a.picture));
  announce("{}: layer {} of {}\n", a.output, a.layer, a.picture);
}

}  // namespace

void add_develop(CLI::App& app) {
  CLI::App& c = *app.add_subcommand("develop", "Make a PNG of a picture: exposure, tone curve, layer");
  auto a = std::make_shared<DevelopCommand>();
  c.add_option("picture", a->picture, "Picture with linear colours (.exr)")->required()->type_name("FILE");
  c.add_option("output", a->output, "File to write (.png)")->required()->type_name("FILE");
  c.add_option("--layer", a->layer, "Layer to show: color, direct, indirect, caustic, albedo, normal, depth ...")
      ->capture_default_str();
  add_display_options(c, a->settings, "0");
  c.add_flag("--force", a->settings.force, "Replace a write-protected file");
  add_max_pixels(c, a->max_pixels);
  c.footer(
      "The .png is that which render writes with the same options. Settings that the picture holds are kept.\n\n"
      "Examples:\n"
      "  lanthorn develop picture.exr picture.png --exposure auto --filmic\n"
      "  lanthorn develop picture.exr caustic.png --layer caustic --exposure 2");
  c.callback([a] { run(*a); });
}

}  // namespace lanthorn::program
