// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "console.h"
#include "lanthorn/image_file.h"
#include "output.h"
#include "output_check.h"
#include "read_layer.h"
#include "render_arguments.h"

namespace lanthorn::program {

namespace {

struct DevelopCommand {
  std::string picture, output, layer = "color";
  std::uint64_t max_pixels = FileAccess::default_max_pixels;
  OutputSettings settings;
};

// For the layer color, reads all layers, because the exposure is measured from them.
Image picture_of(const DevelopCommand& a) {
  if (a.layer == "color") return read_image(a.picture, ColorEncoding::automatic, a.max_pixels);
  return as_color(read_layer(a.picture, a.layer, a.max_pixels));
}

std::vector<std::string> display_extensions() {
  std::vector<std::string> extensions = picture_extensions();
  std::erase(extensions, ".exr");
  return extensions;
}

void run(const DevelopCommand& a) {
  check_outputs({{a.picture, "the picture"}}, {{a.output, "OUTPUT", display_extensions()}}, a.settings.force);
  write_picture(a.output, picture_of(a), a.settings, false, read_image_metadata(a.picture));
  announce("{}: layer {} of {}\n", a.output, a.layer, a.picture);
}

OptionTable develop_options(DevelopCommand& a) {
  OptionTable table{required_file("picture", a.picture, "Picture with linear colours (.exr)"),
                    required_file("output", a.output, "File to write (.png, .jpg, .tif)"),
                    layer_option(a.layer, "Layer to show")};
  table = joined(std::move(table), display_options(a.settings, "0"));
  table.push_back(force_option(a.settings.force, "a write-protected file"));
  table.push_back(max_pixels_option(a.max_pixels));
  return table;
}

}  // namespace

void add_develop(CLI::App& app) {
  const auto a = std::make_shared<DevelopCommand>();
  constexpr const char* footer =
      "Writes the same picture as render with these options. Metadata of the input are kept.\n\n"
      "Examples:\n"
      "  lanthorn develop picture.exr picture.png --exposure auto --view-transform agx\n"
      "  lanthorn develop picture.exr caustic.png --layer caustic --exposure 2";
  add_command(app, {"develop", "Make a PNG, JPEG or TIFF of a picture: exposure, view transform, layer",
                    develop_options(*a), footer, [a] { run(*a); }});
}

}  // namespace lanthorn::program
