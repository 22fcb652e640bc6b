// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/guides/learned_emission.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "index/bucket_kdtree.h"
#include "math/sampling.h"
#include "path/direct_light.h"
#include "path/light_pass.h"
#include "photon/gather/kernels.h"
#include "photon/gather/photon_gather.h"
#include "photon/guides/projection_map.h"
#include "photon/media/volume_gather.h"
#include "photon/pilot_paths.h"

namespace lanthorn {

namespace {

using Numbers = TreeDistribution::Numbers;
using Cell = TreeDistribution::Cell;

constexpr int rounds = 4;
// Light paths of a round: those of a pass, but enough to learn from, and no more than the cells can use.
constexpr std::uint64_t least_of_round = 16384, most_of_round = 65536;
// Longest side of the grid of pilot pixels.
constexpr int learning_grid = 96;
// The same for the eye's importance.
constexpr int landing_grid = 256;
// Share of the photons that ignore the guide: while learning, and with the finished guide.
constexpr float exploring_share = 0.5f, defensive_share = 0.25f;

/// A point on a visible surface, or in a medium where an eye path scatters, or at the end of a gather ray from there.
struct HitPoint {
  Point position{0};
  Normal normal{0};  ///< 0 in a medium
  float radius = 0;  ///< of the disc or ball whose photons get credit, m; 0: no hit point
  bool ends_gather = false;
  float throughput =
      0;             ///< brightness that photons add to the pixel, per irradiance; in a medium, per flux in a volume
  float direct = 0;  ///< brightness of the pixel without photons

  /// Share of the pixel's light that photons of this flux contribute.
  float share_of(float flux) const {
    const float disc = pi * radius * radius;
    const float brightness = throughput * flux / (normal == Normal(0) ? disc * (4 * radius / 3) : disc);
    return brightness > 0 ? brightness / (brightness + direct) : 0.0f;
  }
};

/// Stores hit points at the first two vertices of an eye path that have a wide lobe.
struct HitPointVisitor {
  const PathContext& path;
  std::uint64_t seed;
  std::uint32_t number;  ///< of the path
  bool in_media;         ///< there are photons in media
  std::array<HitPoint, 2>& hits;

  Continuation operator()(const SurfaceVertex& vertex) const {
    if (!has_non_delta(vertex.at.bsdf)) return Continuation::go_on();
    if (wide_share(vertex) < 0.5f) return Continuation::go_on();
    return add(vertex, vertex.at.normal, albedo(vertex.at.bsdf, vertex.wi_local) * inv_pi);
  }
  Continuation operator()(const MediumVertex& vertex) const {
    if (!in_media || gather_probability(vertex.phase) < 0.5f) return Continuation::go_on();
    // Photons and the eye's flight have both been scattered by the same coefficient.
    const Spectrum scattering = scattering_at(path.scene.medium(vertex.state.medium), vertex.position, path.w);
    return add(vertex, Normal(0),
               map(scattering, [](float sigma) { return sigma > 0 ? pdf_uniform_sphere / sigma : 0.0f; }));
  }
  void operator()(const EscapeVertex&) const {}

 private:
  template <class Vertex>
  Continuation add(const Vertex& vertex, const Normal& normal, const Spectrum& scattered) const {
    const bool is_second = hits[0].radius > 0;
    hits[is_second ? 1 : 0] = {.position = position_of(vertex),
                               .normal = normal,
                               .radius = infinity,
                               .ends_gather = is_second,
                               .throughput = sum_of(vertex.state.beta * scattered) / sum_of(unit_beta(path.w)),
                               .direct = is_second ? hits[0].direct : direct_light(vertex)};
    return is_second ? Continuation::stop() : Continuation::go_on();
  }
  template <class Vertex>
  float direct_light(const Vertex& vertex) const {
    constexpr std::uint32_t samples = 4;
    float sum = 0;
    for (std::uint32_t i = 1; i <= samples; ++i) {
      Sampler sampler = Sampler::for_pixel(seed, Stream::pilot_camera, number, i);
      sum += sum_of(next_event(path.with(sampler), vertex, Continuation::stop()).radiance);
    }
    return sum / samples;
  }
};

/// Sets each radius to the distance of the nearest other hit points, so that the discs cover the visible surfaces.
void set_radii(std::vector<HitPoint>& hits) {
  std::vector<Point> positions(hits.size());
  std::transform(hits.begin(), hits.end(), positions.begin(), [](const HitPoint& h) { return h.position; });
  const BucketKdTree index = BucketKdTree::build(positions).index;
  for (HitPoint& hit : hits) {
    std::array<Neighbour, 6> others;  // the point itself is one of them
    const std::span<const Neighbour> found = index.nearest(hit.position, infinity, others);
    hit.radius = found.empty() ? 0.0f : std::sqrt(found.front().dist2);
  }
}

std::vector<HitPoint> find_hit_points(const RenderJob& job, PhotonUse use, bool in_media, const PassDraw& draw) {
  const PixelWindow film = job.view.film();
  const int columns = std::min(learning_grid, film.width()), rows = std::min(learning_grid, film.height());
  std::vector<std::array<HitPoint, 2>> of_paths(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for_each_pilot_path(job, draw, film, columns, rows, [&](const PathContext& path, const Ray&, std::uint32_t index) {
    return HitPointVisitor{path, job.settings.seed, index, in_media, of_paths[index]};
  });
  std::vector<HitPoint> hits;
  for (const auto& of_path : of_paths)
    for (const HitPoint& hit : of_path)
      if (hit.radius > 0 && (!hit.ends_gather || use == PhotonUse::gathering)) hits.push_back(hit);
  set_radii(hits);
  return hits;
}

/// What eye paths leave where photons must land first to light the picture: after their first wide lobe, and also at
/// the surface of that lobe if direct photons count.
struct Landings {
  std::vector<Point> places;
  std::vector<Importance> importance;  ///< on surfaces

  void append(const Landings& other) {
    places.insert(places.end(), other.places.begin(), other.places.end());
    importance.insert(importance.end(), other.importance.begin(), other.importance.end());
  }
};

struct ImportanceVisitor {
  Landings& landings;
  int wide_lobes;  ///< met so far; from 1 on, landings are collected
  bool in_media;

  Continuation operator()(const SurfaceVertex& vertex) {
    const WalkState& state = vertex.state;
    if (wide_lobes > 0) landings.places.push_back(vertex.at.position);
    if (wide_lobes > 0 && has_non_delta(vertex.at.bsdf))
      landings.importance.push_back(
          {{state.beta, vertex.at.position, vertex.wi, vertex.at.normal, {.dispersed = state.dispersed}},
           state.previous});
    if (wide_share(vertex) >= 0.5f) ++wide_lobes;
    return Continuation::go_on();
  }
  Continuation operator()(const MediumVertex& vertex) {
    if (in_media && wide_lobes > 0) landings.places.push_back(vertex.position);
    if (in_media && gather_probability(vertex.phase) >= 0.5f) ++wide_lobes;
    return Continuation::go_on();
  }
  void operator()(const EscapeVertex&) const {}
};

// Boxes around a few neighbouring points each, by halving at the median.
void add_boxes(std::span<Point> points, std::vector<PhotonBox>& to) {
  constexpr std::size_t most_points = 16;
  if (points.empty()) return;
  Bounds box;
  for (const Point& p : points) box.extend(p);
  if (points.size() <= most_points) {
    to.push_back({box, static_cast<float>(points.size())});
    return;
  }
  const Vec3 extent = box.extent();
  const int axis = extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
  const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
  std::nth_element(points.begin(), middle, points.end(),
                   [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; });
  const std::size_t half = points.size() / 2;
  add_boxes(points.first(half), to);
  add_boxes(points.subspan(half), to);
}

Landings find_landings(const RenderJob& job, PhotonUse use, bool in_media, const PassDraw& draw) {
  const PixelWindow film = job.view.film();
  const int columns = std::min(landing_grid, film.width()), rows = std::min(landing_grid, film.height());
  std::vector<Landings> of_paths(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for_each_pilot_path(job, draw, film, columns, rows, [&](const PathContext&, const Ray&, std::uint32_t index) {
    return ImportanceVisitor{of_paths[index], use == PhotonUse::gathering ? 1 : 0, in_media};
  });
  Landings all;
  for (const Landings& of_path : of_paths) all.append(of_path);
  return all;
}

// Disks around the middle of the landings and hit points. None if most of the scene lies between them.
std::optional<AimedDisks> disks_around(std::vector<Point> landings, const std::vector<HitPoint>& hits,
                                       const BoundingSphere& scene) {
  for (const HitPoint& hit : hits) landings.push_back(hit.position);
  if (landings.empty()) return {};
  std::vector<float> values(landings.size());
  const auto middle_of = [&](auto&& value) {
    std::transform(landings.begin(), landings.end(), values.begin(), value);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  Point centre;
  for (int axis = 0; axis < 3; ++axis) centre[axis] = middle_of([axis](const Point& p) { return p[axis]; });
  const float smallest = std::sqrt(middle_of([&](const Point& p) { return distance_squared(p, centre); }));
  constexpr float small = 0.25f;
  if (!(smallest > 0) || smallest > small * scene.radius) return {};
  return AimedDisks(scene, centre, smallest);
}

/// A light path of a round.
struct Start {
  std::uint32_t light = 0;
  Numbers at{};
  float credit = 0;
};

struct PilotPhoton {
  Point position{0};
  Normal normal{0};  ///< 0 in a medium
  float flux = 0;
  std::size_t path = 0;
  bool direct = false, caustic = false;
};

struct Round {
  std::vector<Start> starts;
  std::vector<PilotPhoton> photons;

  void append(const Round& other) {
    for (PilotPhoton photon : other.photons) {
      photon.path += starts.size();
      photons.push_back(photon);
    }
    starts.insert(starts.end(), other.starts.begin(), other.starts.end());
  }
};

struct PilotPhotonVisitor {
  Round& round;
  bool in_media;

  Continuation operator()(const SurfaceVertex& vertex) const {
    if (has_non_delta(vertex.at.bsdf)) add(vertex.state, vertex.at.position, vertex.at.normal);
    return Continuation::go_on();
  }
  // What has scattered often says little of where it started.
  Continuation operator()(const MediumVertex& vertex) const {
    constexpr int deepest = 16;
    if (in_media && vertex.state.depth <= deepest) add(vertex.state, vertex.position, Normal(0));
    return Continuation::go_on();
  }
  void operator()(const EscapeVertex&) const {}

 private:
  void add(const WalkState& state, const Point& position, const Normal& normal) const {
    const bool is_caustic = state.depth > 1 && state.non_delta == 0;
    round.photons.push_back(
        {position, normal, sum_of(state.beta), round.starts.size() - 1, state.depth == 1, is_caustic});
  }
};

Round trace_round(const RenderJob& job, std::uint32_t number, const LightGuide& guide, bool in_media,
                  const PassDraw& draw) {
  const LightPaths paths(
      job.scene, {job.settings.seed, Stream::pilot_emission, number,
                  std::clamp<std::uint64_t>(job.settings.photons, least_of_round, most_of_round), &guide.emission});
  std::vector<Round> chunks(paths.chunk_count());
  const WalkLimits limits{job.settings.max_depth - 1, 1};
  paths.for_each([&](const LightPath& start, Sampler& sampler, RayCounts& counts, std::size_t chunk) {
    Round& round = chunks[chunk];
    round.starts.push_back({start.index, emission_numbers(start, sampler).at});
    const PathContext path{job.scene, draw.w, sampler, counts, limits};
    with_directions(&guide, PilotPhotonVisitor{round, in_media}, [&](auto visitor) {
      walk_from_light(path, start, draw.of_path(sampler).time, std::move(visitor));
    });
  });
  Round all;
  for (const Round& chunk : chunks) all.append(chunk);
  return all;
}

bool counts_at(const PilotPhoton& photon, const HitPoint& hit, PhotonUse use) {
  if (use == PhotonUse::caustics && !photon.caustic) return false;
  if (photon.direct && !hit.ends_gather) return false;
  if (hit.normal == Normal(0)) return photon.normal == Normal(0);
  if (!is_in_disc(dot(photon.position - hit.position, hit.normal), hit.radius)) return false;
  return dot(photon.normal, hit.normal) > 0.5f;
}

// Returns the shares of the light at the hit points that photons contribute, their means.
LearnedEmission::Shares give_credit(Round& round, const std::vector<HitPoint>& hits, PhotonUse use) {
  std::vector<Point> positions(round.photons.size());
  std::transform(round.photons.begin(), round.photons.end(), positions.begin(),
                 [](const PilotPhoton& p) { return p.position; });
  const IndexBuild<BucketKdTree> built = BucketKdTree::build(positions);
  LearnedEmission::Shares shares;
  // Serial, because several hit points add to the same paths.
  for (const HitPoint& hit : hits) {
    const auto for_each_counted = [&](auto&& visit) {
      built.index.for_each_near(hit.position, hit.radius, [&](std::uint32_t slot, float) {
        const PilotPhoton& photon = round.photons[built.order[slot]];
        if (counts_at(photon, hit, use)) visit(photon);
      });
    };
    float total = 0, caustic = 0;
    for_each_counted([&](const PilotPhoton& photon) {
      total += photon.flux;
      if (photon.caustic) caustic += photon.flux;
    });
    if (!(total > 0)) continue;
    shares.all += static_cast<double>(hit.share_of(total));
    shares.caustic += static_cast<double>(hit.share_of(total) * caustic / total);
    const float credit_of_flux = hit.share_of(total) / total;
    for_each_counted(
        [&](const PilotPhoton& photon) { round.starts[photon.path].credit += photon.flux * credit_of_flux; });
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, hits.size()));
  return {shares.all / count, shares.caustic / count};
}

/// Subdivides the emission numbers of one light where its paths have credit.
class CreditSubdivision {
 public:
  /// Masses are shares of the photons of all lights. The share `known` is distributed by credit, whose sum over all
  /// lights is `all`; the share `rest` is distributed uniformly over this light. Only `axes` are halved.
  CreditSubdivision(float all, float known, float rest, std::vector<std::size_t> axes)
      : all_(all), known_(known), rest_(rest), axes_(std::move(axes)) {}

  TreeDistribution build(std::span<Start> starts) {
    TreeDistribution result;
    add(Cell{}, starts, known_ * credit_of(starts) / all_, 0, result);
    return result;
  }

 private:
  static constexpr int most_depth = 48;
  static constexpr std::size_t fewest_starts = 16;
  static constexpr float least_share = 1.0f / 16384;  // of all credit
  // Share of a cell's mass that its halves get in equal parts. Where few paths have credit, paths next to them
  // contribute too; without this share they would be rare and have a very large flux.
  static constexpr float doubt = 0.04f;

  static float credit_of(std::span<const Start> starts) {
    float sum = 0;
    for (const Start& s : starts) sum += s.credit;
    return sum;
  }
  static auto below(const Cell& cell, std::size_t axis) {
    const float middle = cell.half(axis, true).low[axis];
    return [axis, middle](const Start& s) { return s.at[axis] < middle; };
  }

  // The axis along which the credit of the two halves differs most.
  std::size_t most_uneven_axis(const Cell& cell, std::span<const Start> starts) const {
    const auto difference = [&](std::size_t axis) {
      const auto is_below = below(cell, axis);
      float sum = 0;
      for (const Start& s : starts) sum += is_below(s) ? s.credit : -s.credit;
      return std::fabs(sum);
    };
    std::size_t best = axes_.front();
    float most = difference(best);
    for (const std::size_t axis : std::span(axes_).subspan(1))
      if (const float own = difference(axis); own > most) {
        most = own;
        best = axis;
      }
    return best;
  }

  // `mass` is the part of `known` in this cell.
  std::uint32_t add(const Cell& cell, std::span<Start> starts, float mass, int depth, TreeDistribution& to) {
    if (axes_.empty() || starts.size() < fewest_starts || mass < least_share * known_ || depth == most_depth)
      return to.add_leaf(mass + rest_ * cell.volume());
    const std::size_t axis = most_uneven_axis(cell, starts);
    const auto middle = std::stable_partition(starts.begin(), starts.end(), below(cell, axis));
    const auto lower_count = static_cast<std::size_t>(middle - starts.begin());
    const std::span<Start> below_middle = starts.first(lower_count), above = starts.subspan(lower_count);
    const float lower_credit = credit_of(below_middle), upper_credit = credit_of(above);
    const float lower_share = (1 - doubt) * lower_credit / (lower_credit + upper_credit) + doubt / 2;
    const std::uint32_t lower = add(cell.half(axis, false), below_middle, lower_share * mass, depth + 1, to);
    const std::uint32_t upper = add(cell.half(axis, true), above, (1 - lower_share) * mass, depth + 1, to);
    return to.add_inner(axis, lower, upper);
  }

  float all_, known_, rest_;
  std::vector<std::size_t> axes_;
};

// The numbers by which rays of the light differ. By others credit differs by chance alone; and those that weights
// cannot tell from a ray would have to be integrated over for each.
std::vector<std::size_t> telling_axes(const Light& light) {
  std::vector<std::size_t> axes;
  const auto ray = sample_emission(light, Vec2(0.5f), Vec2(0.5f), Wavelengths::rgb(0.5f));
  if (!ray) return axes;
  const EmissionNumbers u = invert_emission(light, {ray->origin, ray->normal, Vec2(0)}, ray->direction);
  if (u.position) axes = {0, 1};
  if (u.direction) axes.insert(axes.end(), {2, 3});
  return axes;
}

/// `starts` have credit.
EmissionGuide guide_from(const Scene& scene, std::vector<Start> starts, float unknown_share,
                         const std::optional<AimedDisks>& disks) {
  const std::vector<Light>& lights = scene.lights();
  EmissionGuide guide(lights.size(), disks);
  std::stable_sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.light < b.light; });
  float all = 0, total_power = 0;
  for (const Start& s : starts) all += s.credit;
  for (const Light& light : lights) total_power += std::fmax(0.0f, power(light));
  if (!(all > 0)) return guide;
  auto begin = starts.begin();
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    const auto end = std::find_if(begin, starts.end(), [i](const Start& s) { return s.light != i; });
    const float share_of_power = std::fmax(0.0f, power(lights[i])) / total_power;
    if (share_of_power > 0) {
      const std::span<Start> own(begin, end);
      float credit = 0;
      for (const Start& s : own) credit += s.credit;
      guide.lights[i].relevance = (1 - unknown_share) * credit / all / share_of_power + unknown_share;
      guide.lights[i].numbers =
          CreditSubdivision(all, 1 - unknown_share, unknown_share * share_of_power, telling_axes(lights[i])).build(own);
    }
    begin = end;
  }
  return guide;
}

// Gives some credit to the starts of photons that may hit mirrors or glass, even if the pilot found none there. The
// paths through a lens that the pilot has missed lie near those that it has found; without credit each would have a
// very large flux.
void credit_seeds(std::vector<Start>& seeds, const std::vector<Start>& known) {
  constexpr float share = 0.125f;
  float all = 0;
  for (const Start& s : known) all += s.credit;
  for (Start& s : seeds) s.credit = share * all / static_cast<float>(seeds.size());
}

// Methods that merge weigh photons by the densities of their paths, which directions would change; paths of caustic
// photons end at the first wide lobe.
bool guides_directions(PhotonUse use) { return use == PhotonUse::indirect || use == PhotonUse::gathering; }

// Photons distributed among the lights by power. By a projection map's own masses, an environment with a coarse map
// would get almost all of them.
EmissionGuide shared_by_power(EmissionGuide guide) {
  for (EmissionGuide::OfLight& light : guide.lights) light.relevance = 1;
  return guide;
}

bool has_power(const Light& light) { return power(light) > 0; }

// Photons add light only where eye paths that go on meet something. Eye paths may miss small mirrors and glass, which
// projection maps find, and light that media scatter.
bool may_gain(const Scene& scene, const Landings& landings) {
  return !landings.places.empty() || scene.may_be_specular() || scene.has_scattering_media();
}

}  // namespace

LearnedEmission learn_emission(const RenderJob& job, PhotonUse use, bool in_media) {
  const Scene& scene = job.scene;
  if (std::none_of(scene.lights().begin(), scene.lights().end(), has_power)) return {};
  const PassDraw draw = draw_for_pass(job, 0);
  const std::vector<HitPoint> hits = find_hit_points(job, use, in_media, draw);
  // The first round uses projection maps, also that of mirrors and glass: in large scenes few photons emitted by power
  // reach a visible surface.
  Landings landings = find_landings(job, use, in_media, draw);
  if (!may_gain(scene, landings)) return {};
  const std::optional<AimedDisks> disks = disks_around(landings.places, hits, scene.bounding_sphere());
  LightGuide guide{shared_by_power(make_projection_map(scene, PhotonTarget::specular, disks))};
  if (guides_directions(use)) guide.directions = GuidePhotons::build(landings.importance, draw.w);
  Round round = trace_round(job, 0, guide, in_media, draw);
  std::vector<Start> seeds = round.starts, known;
  if (use != PhotonUse::caustics) {
    std::vector<PhotonBox> boxes;
    add_boxes(landings.places, boxes);
    guide.emission = shared_by_power(make_projection_map(scene, boxes, disks));
    round.append(trace_round(job, 1, guide, in_media, draw));
  }
  LearnedEmission learned;
  for (std::uint32_t number = 0; number < rounds; ++number) {
    if (number > 0) round = trace_round(job, number + 1, guide, in_media, draw);
    learned.shares = give_credit(round, hits, use);
    std::copy_if(round.starts.begin(), round.starts.end(), std::back_inserter(known),
                 [](const Start& start) { return start.credit > 0; });
    credit_seeds(seeds, known);
    std::vector<Start> starts = known;
    starts.insert(starts.end(), seeds.begin(), seeds.end());
    guide.emission =
        guide_from(scene, std::move(starts), number + 1 < rounds ? exploring_share : defensive_share, disks);
  }
  learned.guide = std::move(guide);
  return learned;
}

}  // namespace lanthorn
