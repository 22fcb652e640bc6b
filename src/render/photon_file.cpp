// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/photon_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "film/display.h"
#include "path/path_draw.h"
#include "photon/photon_pass.h"

namespace lanthorn {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is said to be little-endian");

template <std::size_t n>
void append(std::string& out, const std::array<float, n>& values) {
  out.append(reinterpret_cast<const char*>(values.data()), sizeof(values));
}

// As bright as a colour can be: powers of photons are of no scale that a viewer could know.
std::array<unsigned char, 3> hue_of(const Rgb& power) {
  const float largest = std::max({power.r, power.g, power.b, 1e-30f});
  const Rgb shown = to_display((1 / largest) * power, {});
  const auto byte = [](float x) { return static_cast<unsigned char>(std::lrint(255 * x)); };
  return {byte(shown.r), byte(shown.g), byte(shown.b)};
}

}  // namespace

PhotonFile trace_photon_file(const RenderJob& job, std::uint32_t pass, bool direct) {
  const RenderSettings& settings = job.settings;
  const PathDraw draw = draw_for_pass(job, pass);
  PhotonTracer tracer;
  tracer.trace(job.scene, {settings.seed, Stream::light, pass, settings.photons},
               {.first_depth = direct ? 1 : 2, .max_depth = settings.max_depth}, draw);
  PhotonFile file{.ply = {}, .light_paths = tracer.emitted(), .photons = tracer.stored()};
  file.ply = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment photons of {} light paths, pass {}\nelement vertex {}\n",
      file.light_paths, pass, file.photons);
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "dx", "dy", "dz", "power_r", "power_g", "power_b"})
    file.ply += fmt::format("property float {}\n", name);
  for (const char* name : {"red", "green", "blue", "caustic"}) file.ply += fmt::format("property uchar {}\n", name);
  file.ply += "end_header\n";
  for (const std::vector<Photon>& chunk : tracer.chunks())
    for (const Photon& photon : chunk) {
      const Spectrum light = photon.flags.dispersed ? photon.power * draw.w.dispersed : photon.power;
      const Rgb power = draw.w.to_rgb(light);
      const Point& p = photon.position;
      append(file.ply, std::array{p.x, p.y, p.z, photon.normal.x, photon.normal.y, photon.normal.z, photon.wi.x,
                                  photon.wi.y, photon.wi.z, power.r, power.g, power.b});
      for (const unsigned char byte : hue_of(power)) file.ply += static_cast<char>(byte);
      file.ply += photon.flags.caustic ? '\1' : '\0';
    }
  return file;
}

}  // namespace lanthorn
