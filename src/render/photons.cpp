// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/photons.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include "film/display.h"
#include "path/path_draw.h"
#include "photon/guides/emission_choice.h"
#include "photon/photon_pass.h"
#include "render/method_of_file.h"
#include "render/plan.h"
#include "scene/scene.h"

namespace lanthorn {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is said to be little-endian");

template <std::size_t n>
void append(std::string& out, const std::array<float, n>& values) {
  out.append(reinterpret_cast<const char*>(values.data()), sizeof(values));
}

// The colour of a power, scaled to full brightness, because viewers do not know the scale of powers.
std::array<unsigned char, 3> hue_of(const Rgb& power) {
  const float largest = std::max({power.r, power.g, power.b, 1e-30f});
  const Rgb shown = to_display((1 / largest) * power, {});
  const auto byte = [](float x) { return static_cast<unsigned char>(std::lrint(255 * x)); };
  return {byte(shown.r), byte(shown.g), byte(shown.b)};
}

PhotonClass class_of(const PhotonFlags& flags) {
  if (flags.direct) return PhotonClass::direct;
  return flags.caustic ? PhotonClass::caustic : PhotonClass::indirect;
}

// `share`: weight of these paths, 1 / the number of parts of the pass. `max_depth`: of the tracer's rule.
void append_photons(Photons& photons, const PhotonTracer& tracer, const Wavelengths& w, float share, int max_depth,
                    const Vec3& origin) {
  const std::size_t count = photons.positions.size() + tracer.stored();
  for (std::vector<Vec3>* const vectors : {&photons.positions, &photons.normals, &photons.directions})
    vectors->reserve(count);
  photons.powers.reserve(count);
  photons.depths.reserve(count);
  photons.classes.reserve(count);
  const auto add = [&](const Photon& photon, const Normal& normal) {
    photons.positions.push_back(photon.position + origin);
    photons.normals.push_back(normal);
    photons.directions.push_back(photon.wi);
    photons.powers.push_back(share * w.to_rgb(photon.flags.dispersed ? photon.power * w.dispersed : photon.power));
    photons.depths.push_back(max_depth - photon.flags.eye_scatterings);
    photons.classes.push_back(class_of(photon.flags));
  };
  for (const std::vector<Photon>& chunk : tracer.chunks())
    for (const Photon& photon : chunk) add(photon, photon.normal);
  for (const std::vector<MediumPhoton>& chunk : tracer.medium_chunks())
    for (const MediumPhoton& photon : chunk) add(photon.photon, Normal(0));
}

// `auto` aims its light paths as `vcm` does by default.
Emission aim(const RenderPlan& plan, const RenderJob& job) {
  const bool is_auto = plan.info->name == automatic_method;
  const Parameters parameters =
      is_auto ? Parameters(find_integrator(method_without_pilot).parameters, {}, automatic_method) : plan.parameters;
  if (!parameters.all().contains("emission")) return {};
  return choose_emission(emission_choice(parameters), PhotonUse::indirect, job, MediumRecords::points);
}

}  // namespace

Photons trace_photons(const Scene& scene, const ViewDescription& view, const RenderOptions& options, std::uint32_t pass,
                      bool direct) {
  const RenderPlan plan = plan_render(scene, view, options);
  const RenderSettings& settings = plan.settings;
  const RenderJob job = plan.job(scene);
  const Emission emission = aim(plan, job);
  Photons photons{.pass = pass};
  for (std::uint32_t part = 0; part < settings.parts; ++part) {
    const std::uint32_t number = pass * settings.parts + part;
    const PassDraw draw = draw_for_pass(job, number);
    PhotonTracer tracer;
    tracer.trace(scene, {settings.seed, Stream::light, number, settings.photons},
                 {.first_depth = direct ? 1 : 2,
                  .max_depth = settings.max_depth,
                  .media = MediumRecords::points,
                  .first_medium_depth = direct ? 1 : 2},
                 draw, emission.get());
    photons.light_paths += tracer.emitted();
    append_photons(photons, tracer, draw.w, 1 / static_cast<float>(settings.parts), settings.max_depth,
                   Vec3(scene.description().origin));
  }
  return photons;
}

std::string encode_ply(const Photons& photons) {
  std::string ply = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment photons of {} light paths, pass {}\nelement vertex {}\n",
      photons.light_paths, photons.pass, photons.size());
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "dx", "dy", "dz", "power_r", "power_g", "power_b"})
    ply += fmt::format("property float {}\n", name);
  for (const char* name : {"red", "green", "blue", "caustic"}) ply += fmt::format("property uchar {}\n", name);
  ply += "end_header\n";
  for (std::size_t i = 0; i < photons.size(); ++i) {
    for (const Vec3& v : {photons.positions[i], photons.normals[i], photons.directions[i]})
      append(ply, std::array{v.x, v.y, v.z});
    const Rgb& power = photons.powers[i];
    append(ply, std::array{power.r, power.g, power.b});
    for (const unsigned char byte : hue_of(power)) ply += static_cast<char>(byte);
    ply += photons.classes[i] == PhotonClass::caustic ? '\1' : '\0';
  }
  return ply;
}

}  // namespace lanthorn
