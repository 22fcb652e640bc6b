// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Image-space photon mapping (McGuire & Luebke 2009): photons start in the lights' maps, the CPU follows their later
// bounces while the GPU draws G-buffer and direct light, and their volumes are drawn over the visible surfaces.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "index/hash_grid.h"
#include "path/light_layers.h"
#include "path/lobe_split.h"
#include "path/walk.h"
#include "photon/gather/kernels.h"
#include "photon/gather/photon_hit.h"
#include "photon/gather/pilot_radius.h"
#include "photon/gather/radius_schedule.h"
#include "realtime/scene/projection.h"
#include "realtime/techniques/frame_context.h"
#include "realtime/techniques/ispm/photon_light.h"
#include "realtime/techniques/ispm/photon_walk.h"

namespace lanthorn {

namespace {

/// A kernel that holds some dozen of 20,000 photons on the surfaces of a room.
float fitting_radius(const Scene& scene, const View& view) {
  constexpr float radius_share = 0.05f;
  return radius_share * seen_radius(scene, view);
}

/// The photon volume of the frame; its radius depends on the frame's number alone (Knaus & Zwicker 2011).
PhotonVolume photon_volume(const FrameContext& frame) {
  const TechniqueChoice& choice = frame.settings.technique;
  const float first =
      choice.is_auto("radius") ? fitting_radius(frame.scene, frame.view) : static_cast<float>(choice.number("radius"));
  const float radius = first * RadiusSchedule{1, choice.number("alpha")}.radius(frame.settings.views.frame);
  // Photons lie on round shapes, but the visible points of these lie on triangles around them.
  const float slack = std::min(1.1f * frame.gpu_scene.largest_slack(), 0.5f * radius);
  return {radius, search_flatness * radius + slack};
}

PhotonGather gather_of(const FrameContext& frame) {
  // Software OpenGL is slow at triangles.
  const std::string& gather = frame.settings.technique.text("gather");
  return gather == "tiles" || (gather == "auto" && frame.is_software) ? PhotonGather::tiles : PhotonGather::splat;
}

/// The photons of a frame, for gathering at points. The kernel is the same as in photon.glsl.
class NearPhotons {
 public:
  NearPhotons(SharedPhotons photons, const PhotonVolume& volume);

  bool holds(const SharedPhotons& photons, const PhotonVolume& volume) const {
    return photons_ == photons && volume_ == volume;
  }
  /// Adds the photons' light that the vertex scatters to the eye, as far as the split leaves it to photons.
  void gather(const SurfaceVertex& vertex, const LobeSplit& split, int max_depth, LightLayers& layers) const;

 private:
  Spectrum light_of(const GpuPhoton& photon, const GatherVertex& met, const LobeSplit& split) const;

  SharedPhotons photons_;
  PhotonVolume volume_;
  float reach_;
  IndexBuild<HashGrid> index_;
};

NearPhotons::NearPhotons(SharedPhotons photons, const PhotonVolume& volume)
    : photons_(std::move(photons)), volume_(volume), reach_(std::hypot(volume.radius, volume.half_height)) {
  std::vector<Point> points;
  points.reserve(photons_->photons.size());
  for (const GpuPhoton& photon : photons_->photons) points.push_back(photon.position);
  index_ = HashGrid::build(points, reach_);
}

void NearPhotons::gather(const SurfaceVertex& vertex, const LobeSplit& split, int max_depth,
                         LightLayers& layers) const {
  const GatherVertex met(vertex);
  Spectrum indirect, caustic;
  index_.index.for_each_near(vertex.at.position, reach_, [&](std::uint32_t slot, float) {
    const std::uint32_t i = index_.order[slot];
    if (!met.admits({.eye_scatterings = max_depth - static_cast<int>(photons_->depths[i])})) return;
    (i < photons_->indirect ? indirect : caustic) += light_of(photons_->photons[i], met, split);
  });
  const bool is_dispersed = met.is_dispersed(false);  // photons have their colour already
  layers.add(PathClass::indirect, vertex.state.beta * indirect, is_dispersed);
  layers.add(vertex.state.non_delta == 0 ? PathClass::caustic : PathClass::indirect, vertex.state.beta * caustic,
             is_dispersed);
}

Spectrum NearPhotons::light_of(const GpuPhoton& photon, const GatherVertex& met, const LobeSplit& split) const {
  const Vec3 offset = met.vertex().at.position - photon.position;
  const float height = dot(offset, photon.surface_normal()), r2 = volume_.radius * volume_.radius;
  const float flat2 = length_squared(offset) - height * height;
  if (flat2 >= r2 || std::fabs(height) > volume_.half_height) return {};
  const std::optional<PhotonHit> hit = met.scatter(photon.incident());
  if (!hit) return {};
  const Spectrum power(photon.power.x, photon.power.y, photon.power.z, 0);
  return hit->f * power * (split.wide(hit->pdf) * hit->ratio * 2 * inv_pi / r2 * (1 - flat2 / r2));
}

class ImageSpacePhotons final : public Technique {
 public:
  explicit ImageSpacePhotons(const TechniqueShaders& shaders)
      : bounces_(shaders.files, shaders.surfaces), light_(shaders.files, shaders.surfaces) {}

  void prepare(const FrameContext& frame) override;
  void draw(const FrameContext& frame) override;
  VertexLight light_at_vertices(const FrameContext& frame) override;

 private:
  /// The inputs that photons depend on. They are kept while only the eye moves.
  struct Source {
    std::uint64_t light_maps = 0;
    int max_depth = 0;

    friend bool operator==(const Source&, const Source&) = default;
  };
  void follow(const FrameContext& frame);

  BounceMap bounces_;
  PhotonLight light_;
  std::vector<PhotonStart> starts_;  // from `prepare` until they are followed
  std::optional<Source> source_;     // of the photons; none: of none
  std::optional<NearPhotons> near_;  // kept while the photons are
};

void ImageSpacePhotons::prepare(const FrameContext& frame) {
  const FrameSettings& s = frame.settings;
  if (source_ == Source{frame.light_maps_version, s.max_depth}) return;
  source_.reset();
  starts_.clear();
  if (frame.light_views.empty() || s.photons == 0) return;
  frame.timer.begin("photons of the maps");
  bounces_.start(frame.light_maps, static_cast<int>(frame.light_views.size()), s.photons, s.views.seed, s.views.frame);
  starts_ = bounces_.read();
}

void ImageSpacePhotons::follow(const FrameContext& frame) {
  const FrameSettings& s = frame.settings;
  // Meanwhile the GPU does the work that it was given so far.
  frame.timer.end();
  glFlush();
  const auto begin = std::chrono::steady_clock::now();
  FramePhotons found =
      walk_photons(frame.scene, frame.light_views, starts_, {s.views.seed, s.views.frame, s.max_depth, s.disperses});
  frame.report.rays += found.rays;
  frame.report.stages.push_back({"photon walk (CPU)", milliseconds_since(begin)});
  light_.upload(std::move(found));
  starts_.clear();
  source_ = {frame.light_maps_version, s.max_depth};
}

void ImageSpacePhotons::draw(const FrameContext& frame) {
  if (!source_) follow(frame);
  frame.timer.begin("photon volumes");
  const PhotonVolume volume = photon_volume(frame);
  light_.draw(frame.seen, frame.rays, frame.to_clip, volume, gather_of(frame), frame.eye_paths, frame.layers.indirect,
              frame.layers.caustic);
  frame.report.photons_per_bounce = light_.photons()->per_bounce;
  frame.report.photons_started = light_.photons()->started;
  frame.report.radius = volume.radius;
}

VertexLight ImageSpacePhotons::light_at_vertices(const FrameContext& frame) {
  const SharedPhotons& photons = light_.photons();
  const PhotonVolume volume = photon_volume(frame);
  if (photons->photons.empty()) {
    near_.reset();
    return {};
  }
  if (!near_ || !near_->holds(photons, volume)) near_.emplace(photons, volume);
  return [this](const SurfaceVertex& vertex, const LobeSplit& split, int max_depth, LightLayers& layers) {
    near_->gather(vertex, split, max_depth, layers);
  };
}

/// Measured by a pilot pass, so that the first pass gathers about ten photons.
ParameterValues pilot_radius(const RenderJob& job) {
  constexpr double photons_of_first_gather = 10;
  const float radius = choose_first_radius(job, RadiusChoice{}, photons_of_first_gather).typical();
  if (!(radius > 0)) return {};
  return {{"radius", fmt::format("{}", radius)}};
}

std::vector<TechniqueParameter> parameters() {
  return {{.info = radius_reduction_info("0.6667"), .numbers = NumberRange{1e-3, 1}},
          {.info = {"radius", "auto", "first radius: auto (one for the scene), or a length in metres"},
           .words = {"auto"},
           .numbers = NumberRange{.kind = NumberRange::Kind::above_least},
           .control = PanelControl{.label = "Radius",
                                   .tip = "Of the first frame after a change. It shrinks while the camera rests.",
                                   .low = 0.25 / 400,
                                   .high = 0.25,
                                   .format = "%.4g m",
                                   .is_logarithmic = true,
                                   .is_length = true}},
          {.info = {"gather", "auto",
                    "splat (photon volumes are drawn), tiles (tiles of pixels find their photons), or auto: tiles in "
                    "software, else splat"},
           .words = {"auto", "splat", "tiles"},
           .control = PanelControl{.label = "Gather", .words = {"Automatic", "Splatted", "Tiled"}}}};
}

}  // namespace

TechniqueInfo ispm_technique() {
  return {.description = {.name = "ispm",
                          .title = "Image-space photons",
                          .summary = "image-space photon mapping by OpenGL, as the viewer draws it: for diffuse and "
                                     "rough surfaces",
                          .paper = "McGuire & Luebke 2009",
                          .parameters = parameters(),
                          .has_photons = true},
          .make = [](const TechniqueShaders& shaders) -> std::unique_ptr<Technique> {
            return std::make_unique<ImageSpacePhotons>(shaders);
          },
          .plan =
              [](const FrameSettings& settings) {
                return FramePlan{.eye_paths_find_indirect = true, .photons = settings.photons};
              },
          .fit_view = [](const Scene& scene, const View& view) -> ParameterValues {
            return {{"radius", fmt::format("{}", fitting_radius(scene, view))}};
          },
          .fit_render = pilot_radius};
}

}  // namespace lanthorn
