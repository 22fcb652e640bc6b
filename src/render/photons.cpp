// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Photons of a pass of the plan, and of light paths whose starts the caller chooses.
#include "lanthorn/photons.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "film/display.h"
#include "lanthorn/error.h"
#include "path/depth.h"
#include "path/light_pass.h"
#include "path/path_draw.h"
#include "path/walk.h"
#include "photon/guides/emission_choice.h"
#include "photon/photon_pass.h"
#include "render/method_of_file.h"
#include "render/plan.h"
#include "scene/medium_around.h"
#include "scene/scene.h"
#include "spectrum/curve.h"

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

// For light paths whose starts the caller chooses: records the photons of one, one at each vertex with a non-delta
// lobe.
struct SentPhotonVisitor {
  Photons& photons;
  std::uint32_t start;  ///< number of the PhotonStart
  int first_depth;
  int max_depth;  ///< of the paths that use the photons
  const Wavelengths& w;
  const DVec3& origin;  ///< the scene's origin in the coordinates of the file

  Continuation operator()(const SurfaceVertex& vertex) const {
    if (has_non_delta(vertex.at.bsdf)) add(vertex.state, vertex.at.position, vertex.wi, vertex.at.normal);
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& vertex) const {
    add(vertex.state, vertex.position, vertex.wi, Normal(0));
    return Continuation::go_on();
  }
  void operator()(const EscapeVertex&) const {}

 private:
  void add(const WalkState& state, const Point& position, const Direction& wi, const Normal& normal) const {
    if (state.depth < first_depth || state.scatterings() > max_depth) return;
    const PhotonClass of_scattered = state.non_delta == 0 ? PhotonClass::caustic : PhotonClass::indirect;
    photons.positions.emplace_back(DVec3(position) + origin);
    photons.normals.push_back(normal);
    photons.directions.push_back(wi);
    photons.powers.push_back(w.to_rgb(state.dispersed ? state.beta * w.dispersed : state.beta));
    photons.depths.push_back(state.scatterings());
    photons.classes.push_back(state.depth == 1 ? PhotonClass::direct : of_scattered);
    photons.starts.push_back(start);
  }
};

template <class T>
void append_to(std::vector<T>& all, const std::vector<T>& part) {
  all.insert(all.end(), part.begin(), part.end());
}

void append_part(Photons& all, const Photons& part) {
  append_to(all.positions, part.positions);
  append_to(all.normals, part.normals);
  append_to(all.directions, part.directions);
  append_to(all.powers, part.powers);
  append_to(all.depths, part.depths);
  append_to(all.classes, part.classes);
  append_to(all.starts, part.starts);
}

void check_power(const Rgb& power, std::size_t index) {
  const auto is_usable = [](float x) { return x >= 0 && std::isfinite(x); };
  if (!is_usable(power.r) || !is_usable(power.g) || !is_usable(power.b))
    throw Error(fmt::format("light path {}: expected a power of finite numbers that are not negative, got ({}, {}, {})",
                            index, power.r, power.g, power.b));
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

Photons trace_photons(const Scene& scene, const ViewDescription& view, const RenderOptions& options,
                      std::span<const PhotonStart> starts, std::uint32_t pass, bool direct) {
  if (starts.size() > std::numeric_limits<std::uint32_t>::max())
    throw Error(fmt::format("light paths: expected at most {}, got {}", std::numeric_limits<std::uint32_t>::max(),
                            starts.size()));
  const RenderPlan plan = plan_render(scene, view, options);
  const RenderSettings& settings = plan.settings;
  const PassDraw draw = draw_for_pass(plan.job(scene), pass * settings.parts);
  const WalkLimits limits{max_depth_of_photons(scene, settings.max_depth)};
  const MediumFinder media(scene);
  std::vector<Ray> rays;
  rays.reserve(starts.size());
  for (const PhotonStart& start : starts) {
    check_power(start.power, rays.size());
    rays.push_back(ray_in_scene(scene, start.ray, rays.size()));
  }
  std::vector<Photons> parts((starts.size() + light_path_chunk - 1) / light_path_chunk);
  parallel_chunks(starts.size(), light_path_chunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      stop_point();
      const auto number = static_cast<std::uint32_t>(i);
      Sampler sampler = Sampler::for_light_path(settings.seed, stream_of("sent photons"), 0, pass, number);
      RayCounts counts;
      const PathDraw own = draw.of_path(sampler);
      const PathContext path{scene, own.w, sampler, counts, limits};
      Ray ray = rays[i];
      ray.time = own.time;
      WalkState state;
      state.beta = evaluate_illuminant(starts[i].power, own.w);
      state.previous = ray.origin;
      state.medium = media.around(ray.origin, ray.time).value_or(MediumId::vacuum);
      if (state.beta.is_black()) continue;
      walk<Transport::importance>(path, ray, state,
                                  SentPhotonVisitor{parts[chunk], number, direct ? 1 : 2, settings.max_depth, own.w,
                                                    scene.description().origin});
    }
  });
  Photons photons{.light_paths = starts.size(), .pass = pass};
  for (const Photons& part : parts) append_part(photons, part);
  return photons;
}

}  // namespace lanthorn
