// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/vcm/volume_merge.h"

#include <algorithm>

#include "base/parallel.h"
#include "integrators/vcm/merge_map.h"
#include "integrators/vcm/vcm_settings.h"
#include "photon/radius_schedule.h"
#include "photon/volume_estimators.h"
#include "photon/volume_radius.h"

namespace lanthorn {

namespace {

Ball item_of(const LightVertex& v, float radius) { return {v.at.position, radius}; }
Beam item_of(const LightBeam& b, float radius) { return {b.origin, b.direction, b.length, radius}; }

// An index of the items for queries of a kernel; null if there is no such kernel or no item.
template <class Set, class Item>
std::unique_ptr<Set> index_of(const std::vector<const Item*>& items, const std::optional<KernelIn>& kernel) {
  if (!kernel || items.empty()) return {};
  std::vector<decltype(item_of(*items[0], 0.0f))> shapes(items.size());
  parallel_chunks(items.size(), 1u << 13, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) shapes[i] = item_of(*items[i], kernel->support());
  });
  auto built = decltype(Set::index)::build(shapes);
  auto result = std::make_unique<Set>(Set{std::move(built.index), std::vector<const Item*>(items.size())});
  for (std::size_t slot = 0; slot < items.size(); ++slot) result->items[slot] = items[built.order[slot]];
  return result;
}

template <class Item>
void add_to(std::vector<std::vector<const Item*>>& media, const Item& item) {
  const auto i = static_cast<std::size_t>(item.medium);
  if (i >= media.size()) media.resize(i + 1);
  media[i].push_back(&item);
}

// Both subpaths at the point where they meet.
struct Meeting {
  const VolumeArrival &eye, &light;
  Direction to_light;  // towards the previous vertex of the light path
  int depth;           // of the photon
  bool caustic, dispersed;
  Spectrum flux;
};

// Where the merges of one flight or vertex go.
class MergeSum {
 public:
  MergeSum(const VolumeMergeContext& context, const WalkState& state, const Medium& medium, const Direction& wi,
           int eye_depth)
      : context_(context),
        state_(state),
        phase_(phase_of(medium)),
        extinction_(mean_extinction(medium, context.path.w)),
        wi_(wi),
        eye_depth_(eye_depth) {}

  bool reaches(int photon_depth) const { return eye_depth_ + photon_depth - 1 <= context_.max_depth; }
  // `own(collision, pass_light, pass_eye, sin)`: the estimator's part of `VolumeMerging::all`.
  template <class Own>
  void add(const Meeting& m, const Spectrum& factor, Own&& own) const {
    const Techniques& t = context_.techniques;
    const float sin = length(cross(wi_, m.to_light)), p = phase(phase_, wi_, m.to_light);
    const float collision = m.light.flight.collision, by_light = m.light.flight.pass, by_eye = m.eye.flight.pass;
    const float before = context_.subpath.coherence(), up_to_here = before * coherence(phase_);
    const float weight = weight_merge({m.eye.densities, p}, {m.light.densities, p, up_to_here},
                                      before * own(t.volume, collision, by_light, by_eye, sin),
                                      before * t.volume.all(collision, by_light, by_eye, sin), t);
    const Spectrum light = state_.beta * m.flux * factor * (p * weight);
    context_.layers.add(class_of_merge(state_, m.depth, m.caustic), technique::vm, light,
                        m.dispersed || state_.dispersed);
  }
  const VolumeMergeContext& context() const { return context_; }
  /// The medium's `mean_extinction`.
  float extinction() const { return extinction_; }

 private:
  const VolumeMergeContext& context_;
  const WalkState& state_;
  const HenyeyGreenstein& phase_;
  float extinction_;
  Direction wi_;
  int eye_depth_;
};

// A subpath that passes a point at the end of `segment`, through the same medium.
VolumeArrival arrive_after(const VolumeMergeContext& context, const PathStart& start, const Departure& departure,
                           float extinction, const Point& p, float time, float distance, float collision) {
  return arrive_in_medium(context.path.scene, start, departure, context.techniques, p, time,
                          extinction > 0 ? extinction * distance : 0.0f, collision);
}

// Photons that the eye's ray passes.
struct PointsAlong {
  const MergeSum& sum;
  const std::vector<const LightVertex*>& items;
  const EyeRay& eye;
  const KernelIn& kernel;

  bool wants(std::uint32_t slot) const { return sum.reaches(items[slot]->depth); }
  void meet(std::uint32_t slot, const VolumeMeeting& meeting) const {
    const LightVertex& v = *items[slot];
    const VolumeMergeContext& c = sum.context();
    const VolumeArrival light{v.densities, v.flight};
    const VolumeArrival arrival =
        arrive_after(c, c.subpath.start(), c.subpath.departure(), sum.extinction(),
                     eye.ray.origin + meeting.t * eye.ray.direction, v.at.time, meeting.t, v.flight.collision);
    sum.add({arrival, light, v.wi, v.depth, v.caustic, v.dispersed, v.beta},
            meeting.factor * kernel.weight(meeting.dist2),
            [](const VolumeMerging& m, float collision, float, float pass_eye, float) {
              return m.by_beam(collision, pass_eye);
            });
  }
};

// Beams that the eye's ray passes.
struct BeamsAlong {
  const MergeSum& sum;
  const std::vector<const LightBeam*>& items;
  const EyeRay& eye;
  const KernelIn& kernel;

  bool wants(std::uint32_t slot) const { return sum.reaches(items[slot]->depth); }
  void meet(std::uint32_t slot, const VolumeMeeting& meeting) const {
    const LightBeam& b = *items[slot];
    const VolumeMergeContext& c = sum.context();
    const Point p = eye.ray.origin + meeting.t * eye.ray.direction;
    const float collision = collision_density(eye.medium, p, c.path.w);
    const VolumeArrival light = arrive_after(c, b.start, b.departure, sum.extinction(),
                                             b.origin + meeting.s * b.direction, b.time, meeting.s, collision);
    const VolumeArrival arrival =
        arrive_after(c, c.subpath.start(), c.subpath.departure(), sum.extinction(), p, b.time, meeting.t, collision);
    sum.add({arrival, light, -b.direction, b.depth, b.caustic, b.dispersed, b.beta},
            meeting.factor * kernel.weight(meeting.dist2),
            [](const VolumeMerging& m, float coll, float pass_light, float pass_eye, float sin) {
              return m.by_beams(coll, pass_light, pass_eye, sin);
            });
  }
};

// Photons around the point where the eye path scatters.
struct PointsAt {
  const MergeSum& sum;
  const std::vector<const LightVertex*>& items;
  const VolumeArrival& eye;
  const KernelIn& kernel;

  bool wants(std::uint32_t slot) const { return sum.reaches(items[slot]->depth); }
  void meet(std::uint32_t slot, const VolumeMeeting& meeting) const {
    const LightVertex& v = *items[slot];
    const VolumeArrival light{v.densities, v.flight};
    sum.add({eye, light, v.wi, v.depth, v.caustic, v.dispersed, v.beta}, meeting.factor * kernel.weight(meeting.dist2),
            [](const VolumeMerging& m, float, float, float, float) { return m.point; });
  }
};

// Beams around that point.
struct BeamsAt {
  const MergeSum& sum;
  const std::vector<const LightBeam*>& items;
  const VolumeArrival& eye;
  const Medium& medium;
  const KernelIn& kernel;

  bool wants(std::uint32_t slot) const { return sum.reaches(items[slot]->depth); }
  void meet(std::uint32_t slot, const VolumeMeeting& meeting) const {
    const LightBeam& b = *items[slot];
    const VolumeArrival light =
        arrive_after(sum.context(), b.start, b.departure, sum.extinction(), b.origin + meeting.s * b.direction, b.time,
                     meeting.s, eye.flight.collision);
    sum.add({eye, light, -b.direction, b.depth, b.caustic, b.dispersed, b.beta},
            meeting.factor * kernel.weight(meeting.dist2),
            [](const VolumeMerging& m, float collision, float pass_light, float, float) {
              return m.by_photon_beam(collision, pass_light);
            });
  }
};

// What is left of the flux of beams that reach the next surface.
struct LongBeams {
  const PathContext& path;
  const Medium& medium;
  const BeamBvh& beams;
  std::uint64_t key;

  Spectrum operator()(std::uint32_t slot, float s) const {
    return along_beam(path, medium, beams.beam(slot), s, key, slot);
  }
};

}  // namespace

float VolumeKernels::widest_radius() const {
  float widest = 0;
  for (const std::optional<KernelIn>* kernel : {&point, &beam, &photon_beam, &beams})
    if (*kernel) widest = std::max(widest, (*kernel)->radius());
  return widest;
}

VolumeMerging VolumeKernels::merging(float light_paths, float beam_share) const {
  // The size of the box kernel that equals it.
  const auto size = [](const std::optional<KernelIn>& kernel) { return kernel ? kernel->box_size() : 0.0f; };
  return {light_paths * size(point), light_paths * size(beam), light_paths * beam_share * size(photon_beam),
          light_paths * beam_share * size(beams)};
}

VolumeRadii::VolumeRadii(const RenderJob& job, const VcmSettings& settings, const Kernel& kernel,
                         const LightGuide* guide)
    : kernel_(kernel) {
  if (!job.scene.has_scattering_media()) return;
  for (const VolumeEstimator estimator :
       {VolumeEstimator::point, VolumeEstimator::beam, VolumeEstimator::photon_beam, VolumeEstimator::beams}) {
    if (!settings.merges_by(estimator)) continue;
    const float radius = first_volume_radius(job, estimator, settings.volume_radius, kernel, guide, 1);
    if (radius > 0) radii_[static_cast<std::size_t>(estimator)] = radius;
  }
}

VolumeKernels VolumeRadii::kernels(double alpha, std::uint32_t pass) const {
  const auto kernel_of = [&](VolumeEstimator estimator) -> std::optional<KernelIn> {
    const std::optional<float> first = of(estimator);
    if (!first) return {};
    const int dimensions = kernel_dimensions(estimator);
    return KernelIn(dimensions, kernel_, *first * RadiusSchedule{1, alpha}.shrink(pass, dimensions));
  };
  return {kernel_of(VolumeEstimator::point), kernel_of(VolumeEstimator::beam), kernel_of(VolumeEstimator::photon_beam),
          kernel_of(VolumeEstimator::beams)};
}

VolumeMerges::VolumeMerges(const LightVertices& vertices, const VolumeKernels& kernels) : kernels_(kernels) {
  std::vector<std::vector<const LightVertex*>> points;
  std::vector<std::vector<const LightBeam*>> beams;
  for (std::size_t c = 0; c < vertices.chunk_count(); ++c) {
    if (kernels.uses_points())
      for (const LightVertex& v : vertices.chunk(c).vertices)
        if (v.phase) add_to(points, v);
    for (const LightBeam& b : vertices.chunk(c).beams) add_to(beams, b);
  }
  media_.resize(std::max(points.size(), beams.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    media_[i].around = index_of<Points>(points[i], kernels.point);
    media_[i].along = index_of<Points>(points[i], kernels.beam);
  }
  for (std::size_t i = 0; i < beams.size(); ++i) {
    media_[i].beams_around = index_of<Beams>(beams[i], kernels.photon_beam);
    media_[i].crossed = index_of<Beams>(beams[i], kernels.beams);
  }
}

std::size_t VolumeMerges::size() const {
  std::size_t sum = 0;
  for (const OfMedium& m : media_) {
    if (const Points* points = m.along ? m.along.get() : m.around.get()) sum += points->items.size();
    if (const Beams* beams = m.crossed ? m.crossed.get() : m.beams_around.get()) sum += beams->items.size();
  }
  return sum;
}

std::size_t VolumeMerges::memory_bytes() const {
  const auto bytes = [](const auto& set) { return set ? set->memory_bytes() : 0; };
  std::size_t sum = 0;
  for (const OfMedium& m : media_) sum += bytes(m.around) + bytes(m.along) + bytes(m.beams_around) + bytes(m.crossed);
  return sum;
}

void VolumeMerges::add_along(const VolumeMergeContext& context, const FlownSegment& flight) const {
  const auto i = static_cast<std::size_t>(flight.state.medium);
  if (i >= media_.size() || (!media_[i].along && !media_[i].crossed)) return;
  const OfMedium& medium = media_[i];
  const EyeRay eye(context.path, flight);
  const MergeSum sum(context, flight.state, eye.medium, -eye.ray.direction, flight.state.depth + 1);
  if (medium.along)
    meet_points_along(eye, medium.along->index, kernels_.beam->support(),
                      PointsAlong{sum, medium.along->items, eye, *kernels_.beam});
  if (medium.crossed)
    meet_beams_along(context.path, eye, medium.crossed->index,
                     LongBeams{context.path, eye.medium, medium.crossed->index, eye.key},
                     BeamsAlong{sum, medium.crossed->items, eye, *kernels_.beams});
}

void VolumeMerges::add_at(const VolumeMergeContext& context, const MediumVertex& v) const {
  const auto i = static_cast<std::size_t>(v.state.medium);
  if (i >= media_.size() || (!media_[i].around && !media_[i].beams_around)) return;
  const OfMedium& sets = media_[i];
  const PathContext& path = context.path;
  const Medium& medium = path.scene.medium(v.state.medium);
  const VolumeArrival eye{context.subpath.densities(), context.subpath.flight()};
  const MergeSum sum(context, v.state, medium, v.wi, v.state.depth);
  if (sets.around)
    meet_points_at(sets.around->index, v.position, scattering_at(medium, v.position, path.w),
                   PointsAt{sum, sets.around->items, eye, *kernels_.point});
  if (sets.beams_around)
    meet_beams_at(sets.beams_around->index, v.position,
                  LongBeams{path, medium, sets.beams_around->index, key_of_ray(path, v.state.depth, v.position, v.wi)},
                  BeamsAt{sum, sets.beams_around->items, eye, medium, *kernels_.photon_beam});
}

}  // namespace lanthorn
