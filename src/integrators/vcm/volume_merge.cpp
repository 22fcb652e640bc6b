// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/vcm/volume_merge.h"

#include <algorithm>

#include "base/parallel.h"
#include "integrators/vcm/merge_map.h"
#include "integrators/vcm/vcm_settings.h"
#include "path/depth.h"
#include "photon/flux_classes.h"
#include "photon/media/volume_estimators.h"

namespace lanthorn {

namespace {

Ball item_of(const LightVertex& v, float radius) { return {v.at.position, radius}; }
Beam item_of(const LightBeam& b, float radius) { return {b.origin, b.direction, b.length, radius}; }

// An index for the queries of a kernel; null if there is no such kernel or no item.
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

// A photon or beam and both subpaths at the point where they meet.
struct Meeting {
  const VolumeArrival &eye, &light;
  Direction to_light;  // towards the previous vertex of the light path
  int depth;           // of the photon's vertex
  bool caustic, dispersed;
  Spectrum flux;

  static Meeting with(const LightVertex& v, const VolumeArrival& eye, const VolumeArrival& light) {
    return {eye, light, v.wi, v.depth, v.caustic, v.dispersed, v.beta};
  }
  static Meeting with(const LightBeam& b, const VolumeArrival& eye, const VolumeArrival& light) {
    return {eye, light, -b.direction, b.depth, b.caustic, b.dispersed, b.beta};
  }
};

// An estimator's factor of the light of a meeting, without flux and phase function.
struct KernelFactor {
  Spectrum light;
  float bias_share;  // see Kernel
};

// Adds the merges of one flight or vertex.
class MergeSum {
 public:
  MergeSum(const VolumeMergeContext& context, const WalkState& state, const Medium& medium, const Direction& wi,
           int eye_scatterings)
      : context_(context),
        state_(state),
        phase_(phase_of(medium)),
        extinction_(mean_extinction(medium, context.path.w)),
        wi_(wi),
        eye_scatterings_(eye_scatterings) {}

  bool reaches(int photon_scatterings) const { return eye_scatterings_ + photon_scatterings - 1 <= context_.max_depth; }
  const PathContext& path() const { return context_.path; }

  // Densities of the eye path if it scattered at p, `t` (m) along its flight.
  VolumeArrival eye_at(const Point& p, float t, float time, float collision) const {
    return arrive(context_.subpath.start(), context_.subpath.departure(), p, t, time, collision);
  }
  // Densities of the light path if it scattered `s` (m) along its flight.
  VolumeArrival light_at(const LightBeam& b, float s, float collision) const {
    return arrive(b.start, b.departure, b.origin + s * b.direction, s, b.time, collision);
  }

  // `own(collision, pass_light, pass_eye, sin)`: the estimator's part of `VolumeMerging::all`.
  template <class Own>
  void add(const Meeting& m, const KernelFactor& factor, Own&& own) const {
    const Techniques& t = context_.bidirectional.techniques;
    const float sin = length(cross(wi_, m.to_light)), p = phase(phase_, wi_, m.to_light);
    const float collision = m.light.flight.collision, by_light = m.light.flight.pass, by_eye = m.eye.flight.pass;
    const float before = context_.subpath.coherence(), up_to_here = before * coherence(phase_);
    const TechniqueSum densities =
        sum_of_volume_merge(end_of_eye_path(m.eye.densities, p, state_.non_delta > 0),
                            end_of_light_path(m.light.densities, p, m.depth > 1 && !m.caustic, up_to_here),
                            before * own(t.volume, collision, by_light, by_eye, sin),
                            before * t.volume.all(collision, by_light, by_eye, sin), t);
    const Spectrum light = state_.beta * m.flux * factor.light * (p * densities.weight(t));
    const bool is_dispersed = m.dispersed || state_.dispersed;
    context_.layers.add(class_of_merge(state_, m.depth == 1, m.caustic), technique::vm, light, is_dispersed);
    context_.layers.add_bias(factor.bias_share * light, is_dispersed);
    if (!context_.log) return;
    context_.log->found.push_back(
        {flux_of(light, is_dispersed, context_.path.w), densities, &TechniqueDensities::media});
    context_.log->count(&EyeWork::media_merges, state_.non_delta == 0);
  }

 private:
  // `flown` (m): since the departure, through this medium.
  VolumeArrival arrive(const PathStart& start, const Departure& departure, const Point& p, float flown, float time,
                       float collision) const {
    return arrive_in_medium(context_.path.scene, start, departure, context_.bidirectional.techniques, p, time,
                            extinction_ > 0 ? extinction_ * flown : 0.0f, collision);
  }

  const VolumeMergeContext& context_;
  const WalkState& state_;
  const HenyeyGreenstein& phase_;
  float extinction_;  // the medium's `mean_extinction`
  Direction wi_;
  int eye_scatterings_;
};

// Visitor of an estimator: `take(item, meeting, factor)`.
template <class Item, class Take>
struct Visitor {
  const MergeSum& sum;
  const std::vector<const Item*>& items;
  const KernelIn& kernel;
  Take take;

  bool wants(std::uint32_t slot) const { return sum.reaches(items[slot]->scatterings); }
  void meet(std::uint32_t slot, const VolumeMeeting& m) const {
    take(*items[slot], m, KernelFactor{m.factor * kernel.weight(m.dist2), kernel.bias_share(m.dist2)});
  }
};
template <class Item, class Take>
Visitor(const MergeSum&, const std::vector<const Item*>&, const KernelIn&, Take) -> Visitor<Item, Take>;

// Fraction of a beam's flux that is left at its point s, for beams that reach the next surface.
struct LongBeams {
  const PathContext& path;
  const Medium& medium;
  const BeamBvh& beams;
  std::uint64_t key;

  Spectrum operator()(std::uint32_t slot, float s) const {
    return along_beam(path, medium, beams.beam(slot), s, key, slot);
  }
};

// Photons that the eye's ray passes.
template <class Points>
void add_points_along(const MergeSum& sum, const EyeRay& eye, const Points& points, const KernelIn& kernel) {
  const auto take = [&](const LightVertex& v, const VolumeMeeting& m, const KernelFactor& factor) {
    const VolumeArrival light{v.densities, v.flight};
    const VolumeArrival at_eye =
        sum.eye_at(eye.ray.origin + m.t * eye.ray.direction, m.t, v.at.time, v.flight.collision);
    sum.add(Meeting::with(v, at_eye, light), factor,
            [](const VolumeMerging& merging, float collision, float, float pass_eye, float) {
              return merging.by_beam(collision, pass_eye);
            });
  };
  meet_points_along(eye, points.index, kernel.support(), Visitor{sum, points.items, kernel, take});
}

// Beams that the eye's ray passes.
template <class Beams>
void add_beams_along(const MergeSum& sum, const EyeRay& eye, const Beams& beams, const KernelIn& kernel) {
  const auto take = [&](const LightBeam& b, const VolumeMeeting& m, const KernelFactor& factor) {
    const Point p = eye.ray.origin + m.t * eye.ray.direction;
    const float collision = collision_density(eye.medium, p, sum.path().w);
    const VolumeArrival light = sum.light_at(b, m.s, collision), at_eye = sum.eye_at(p, m.t, b.time, collision);
    sum.add(Meeting::with(b, at_eye, light), factor,
            [](const VolumeMerging& merging, float coll, float pass_light, float pass_eye, float sin) {
              return merging.by_beams(coll, pass_light, pass_eye, sin);
            });
  };
  meet_beams_along(sum.path(), eye, beams.index, LongBeams{sum.path(), eye.medium, beams.index, eye.key},
                   Visitor{sum, beams.items, kernel, take});
}

// Photons around the point where the eye path scatters.
template <class Points>
void add_points_at(const MergeSum& sum, const MediumVertex& at, const VolumeArrival& eye, const Points& points,
                   const KernelIn& kernel) {
  const auto take = [&](const LightVertex& v, const VolumeMeeting&, const KernelFactor& factor) {
    const VolumeArrival light{v.densities, v.flight};
    sum.add(Meeting::with(v, eye, light), factor,
            [](const VolumeMerging& merging, float, float, float, float) { return merging.point; });
  };
  const PathContext& path = sum.path();
  meet_points_at(points.index, at.position, scattering_at(path.scene.medium(at.state.medium), at.position, path.w),
                 Visitor{sum, points.items, kernel, take});
}

// Beams around the point where the eye path scatters.
template <class Beams>
void add_beams_at(const MergeSum& sum, const MediumVertex& at, const VolumeArrival& eye, const Beams& beams,
                  const KernelIn& kernel) {
  const auto take = [&](const LightBeam& b, const VolumeMeeting& m, const KernelFactor& factor) {
    const VolumeArrival light = sum.light_at(b, m.s, eye.flight.collision);
    sum.add(Meeting::with(b, eye, light), factor,
            [](const VolumeMerging& merging, float collision, float pass_light, float, float) {
              return merging.by_photon_beam(collision, pass_light);
            });
  };
  const PathContext& path = sum.path();
  const std::uint64_t key = key_of_ray(path, at.state.depth, at.position, at.wi);
  meet_beams_at(beams.index, at.position, LongBeams{path, path.scene.medium(at.state.medium), beams.index, key},
                Visitor{sum, beams.items, kernel, take});
}

}  // namespace

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
  const OfMedium& sets = media_[i];
  const EyeRay eye(context.path, flight);
  const MergeSum sum(context, flight.state, eye.medium, -eye.ray.direction,
                     scatterings_on_flight(context.path.scene, flight.state));
  if (sets.along) add_points_along(sum, eye, *sets.along, *kernels_.beam);
  if (sets.crossed) add_beams_along(sum, eye, *sets.crossed, *kernels_.beams);
}

void VolumeMerges::add_at(const VolumeMergeContext& context, const MediumVertex& v) const {
  const auto i = static_cast<std::size_t>(v.state.medium);
  if (i >= media_.size() || (!media_[i].around && !media_[i].beams_around)) return;
  const OfMedium& sets = media_[i];
  const VolumeArrival eye{context.subpath.densities(), context.subpath.flight()};
  const MergeSum sum(context, v.state, context.path.scene.medium(v.state.medium), v.wi, v.state.scatterings());
  if (sets.around) add_points_at(sum, v, eye, *sets.around, *kernels_.point);
  if (sets.beams_around) add_beams_at(sum, v, eye, *sets.beams_around, *kernels_.photon_beam);
}

}  // namespace lanthorn
