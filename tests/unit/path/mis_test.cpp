// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The recursive weights of bidirectional methods against their definition: a technique's density divided by the sum
// over all techniques that can generate the path. Here densities are computed as products over the path's vertices.
#include "path/mis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "math/hash.h"

namespace lanthorn::mis_test {
namespace {

// A path x_0 ... x_k from a light, which the lens then sees. Index i: at vertex x_i. `p`: towards x_{i-1}. `n`: towards
// x_{i+1} (from x_k, towards the lens).
struct RandomPath {
  Techniques techniques;
  bool can_be_hit;
  double emission_area, emission_direction, direct_area;  // densities of the light's end
  double lens_density;                                    // at x_k, per area perpendicular to the first eye ray
  std::vector<double> distance2;                          // between x_i and x_{i+1}
  std::vector<double> cos_p, cos_n;
  std::vector<double> forward, reverse;  // per solid angle: light walks from x_{i-1} to x_{i+1}, eye walks back
  std::vector<bool> delta, merges;
  std::vector<bool> in_medium;
  std::vector<double> collision;  // per metre, where walks scatter in media; 1 on surfaces
  std::vector<double> pass;       // probability of passing from x_i to x_{i+1}
  std::vector<double> sin;        // of the angle between the segments
  std::vector<double> coherence;  // of eye paths that scatter there; 1 at delta lobes

  int last() const { return static_cast<int>(cos_p.size()) - 1; }
};

RandomPath random_path(HashRng& rng) {
  const auto positive = [&] { return static_cast<double>(std::exp(3 * rng.next() - 1.5f)); };
  const auto cosine = [&] { return static_cast<double>(0.05f + 0.95f * rng.next()); };
  RandomPath path;
  const auto k = 1 + static_cast<int>(5 * rng.next());
  const bool merging = rng.next() < 0.7f;
  path.techniques.connects = !merging || rng.next() < 0.7f;
  path.techniques.light_paths = 1000;
  path.techniques.merging = merging ? static_cast<float>(10 * positive()) : 0.0f;
  path.can_be_hit = rng.next() < 0.7f;
  path.emission_area = positive();
  path.emission_direction = positive();
  path.direct_area = positive();
  path.lens_density = 1000 * positive();
  const auto kernel = [&] { return merging && rng.next() < 0.7f ? static_cast<float>(positive()) : 0.0f; };
  path.techniques.volume = {kernel(), kernel(), kernel(), kernel()};
  for (int i = 0; i <= k; ++i) {
    path.distance2.push_back(positive());
    const bool delta = i > 0 && rng.next()<0.3f, medium = i> 0 && !delta && rng.next() < 0.5f;
    path.cos_p.push_back(medium ? 1 : cosine());
    path.cos_n.push_back(medium ? 1 : cosine());
    path.delta.push_back(delta);
    path.in_medium.push_back(medium);
    path.merges.push_back(i > 0 && !delta && !medium && rng.next() < 0.9f);
    path.collision.push_back(medium ? positive() : 1);
    path.pass.push_back(cosine());
    path.sin.push_back(cosine());
    path.coherence.push_back(delta || rng.next() < 0.3f ? 1 : rng.next() < 0.3f ? 0 : cosine());
    path.forward.push_back(delta ? 1 : positive());
    path.reverse.push_back(delta ? 1 : positive());
  }
  if (path.techniques.connects) path.techniques.connections = rng.next() < 0.3f ? 0.0f : 4 * rng.next();
  path.techniques.volume_part = rng.next() < 0.3f ? 0.0f : 1.0f;
  path.techniques.lens_part = rng.next() < 0.3f ? 0.0f : 1.0f;
  path.techniques.goes_on = rng.next() < 0.5f;
  return path;
}

// Number of scatterings at x_first ... x_last by lobes that are not delta.
int scatterings(const RandomPath& path, int first, int last) {
  int count = 0;
  for (int i = first; i <= last; ++i) count += path.delta[static_cast<unsigned>(i)] ? 0 : 1;
  return count;
}
// Whether eye paths may be long enough to end at x_i.
bool eye_path_reaches(const RandomPath& path, int i) {
  return path.techniques.goes_on || scatterings(path, i + 1, path.last()) <= (i == 0 ? 1 : 0);
}

// Density at x_i of the light walk and of the eye walk, per area. In media: per volume for walks that end there
// (`by_`), per area perpendicular to the walk for walks that pass (`direction_by_`).
double direction_by_light(const RandomPath& path, int i) {
  const auto u = static_cast<unsigned>(i);
  const double direction = i == 1 ? path.emission_direction : path.forward[u - 1];
  return direction * path.cos_p[u] / path.distance2[u - 1];
}
double direction_by_eye(const RandomPath& path, int i) {
  const auto u = static_cast<unsigned>(i);
  if (i == path.last()) return path.lens_density * path.cos_n[u];
  return path.reverse[u + 1] * path.cos_n[u] / path.distance2[u];
}
double by_light(const RandomPath& path, int i) {
  if (i == 0) return path.emission_area;
  const auto u = static_cast<unsigned>(i);
  return direction_by_light(path, i) * path.pass[u - 1] * path.collision[u];
}
double by_eye(const RandomPath& path, int i) {
  const auto u = static_cast<unsigned>(i);
  return direction_by_eye(path, i) * path.pass[u] * path.collision[u];
}

float samples_of_connection(const RandomPath& path, int s) {
  const int k = path.last();
  return s == k + 1 ? path.techniques.lens_part * path.techniques.light_paths
         : s >= 2   ? path.techniques.connections
                    : 1;
}

// Density of technique s: 0 is a hit, 1 next-event estimation, 2 ... k the connection of x_{s-1} and x_s, k + 1 the
// lens.
double density_of_connection(const RandomPath& path, int s) {
  const int k = path.last();
  const auto is_delta = [&](int i) { return path.delta[static_cast<unsigned>(i)]; };
  if (s == 0 && !path.can_be_hit) return 0;
  if (s > 0 && !path.techniques.connects) return 0;
  if (s <= k && !eye_path_reaches(path, s)) return 0;
  if ((s >= 2 && is_delta(s - 1)) || (s >= 1 && s <= k && is_delta(s))) return 0;
  // With merging alone, the walk only keeps the light that photons cannot provide.
  if (s == 0 && !path.techniques.connects)
    for (int i = 1; i <= k; ++i)
      if (!is_delta(i)) return 0;
  double product = static_cast<double>(samples_of_connection(path, s));
  for (int i = 0; i < s; ++i) product *= s == 1 ? path.direct_area : by_light(path, i);
  for (int i = s; i <= k; ++i) product *= by_eye(path, i);
  return product;
}
// Density of merging with a photon at x_m.
double density_of_merge(const RandomPath& path, int m) {
  if (!path.merges[static_cast<unsigned>(m)] || (m == 1 && path.techniques.connects)) return 0;
  if (!eye_path_reaches(path, m)) return 0;
  double product = static_cast<double>(path.techniques.merging);
  for (int i = 0; i <= m; ++i) product *= by_light(path, i);
  for (int i = m; i <= path.last(); ++i) product *= by_eye(path, i);
  return product;
}

// Product of the coherences of the eye path's vertices before x_m.
double coherence_before(const RandomPath& path, int m) {
  double product = 1;
  for (int j = m + 1; j <= path.last(); ++j) product *= path.coherence[static_cast<unsigned>(j)];
  return product;
}
// Density of merging at x_m in a medium, by kind of estimator: both walks scatter there, or the ray of one or of both
// passes by.
enum class Kind : std::uint8_t { point, beam, photon_beam, beams };
constexpr std::array kinds{Kind::point, Kind::beam, Kind::photon_beam, Kind::beams};
double density_of_volume_merge(const RandomPath& path, int m, Kind kind) {
  const auto i = static_cast<unsigned>(m);
  if (!path.in_medium[i] || !eye_path_reaches(path, m)) return 0;
  const VolumeMerging& v = path.techniques.volume;
  double product = coherence_before(path, m) * static_cast<double>(path.techniques.volume_part);
  for (int j = 0; j < m; ++j) product *= by_light(path, j);
  for (int j = m + 1; j <= path.last(); ++j) product *= by_eye(path, j);
  switch (kind) {
    case Kind::point:
      return product * by_light(path, m) * by_eye(path, m) * static_cast<double>(v.point);
    case Kind::beam:
      return product * by_light(path, m) * direction_by_eye(path, m) * static_cast<double>(v.beam);
    case Kind::photon_beam:
      return product * direction_by_light(path, m) * by_eye(path, m) * static_cast<double>(v.photon_beam);
    case Kind::beams:
      return product * direction_by_light(path, m) * direction_by_eye(path, m) * path.sin[i] *
             static_cast<double>(v.beams);
  }
  return 0;
}

struct Recursion {
  std::vector<SubpathDensities> light, eye;  // at x_i
};
Recursion recursion(const RandomPath& path) {
  const int k = path.last();
  const auto f = [](double x) { return static_cast<float>(x); };
  Recursion r;
  r.light.resize(static_cast<unsigned>(k) + 1);
  r.eye.resize(static_cast<unsigned>(k) + 1);
  // Scatters at x_i, which the walk has reached by a flight of probability `pass`. `share`: factor on merging there.
  const auto leave = [&](SubpathDensities& d, unsigned i, const VolumeMerging& seen, double pass, Scattering s,
                         double share) {
    if (path.delta[i]) {
      d.scatter_delta(s.cos);
      return 0.0f;
    }
    const FlightDensity flight{f(pass), f(path.collision[i])};
    const VolumeMerging::Sum merged =
        path.in_medium[i] ? seen.before_next(flight, f(path.sin[i])) : VolumeMerging::Sum{};
    s.merging_media = f(share) * merged.a;
    d.scatter(s, path.techniques.connects);
    return f(share) * merged.b / s.pdf;
  };
  float over_pass = 0;
  SubpathDensities d =
      SubpathDensities::from_light(f(path.emission_area * path.emission_direction), f(path.direct_area),
                                   path.can_be_hit && path.techniques.connects ? f(path.cos_n[0]) : 0.0f);
  for (unsigned i = 1; i <= static_cast<unsigned>(k); ++i) {
    if (i > 1)
      over_pass = leave(d, i - 1, path.techniques.volume.reversed(), path.pass[i - 2],
                        {.cos = f(path.cos_n[i - 1]),
                         .pdf = f(path.forward[i - 1]),
                         .reverse = f(path.reverse[i - 1]),
                         .merges = path.merges[i - 1] && (i > 2 || !path.techniques.connects),
                         .coherence = f(path.coherence[i - 1])},
                        1);
    d.fly({f(path.pass[i - 1]), f(path.collision[i])}, f(path.collision[i - 1]), over_pass);
    d.arrive(f(path.distance2[i - 1]), f(path.cos_p[i]));
    r.light[i] = d;
  }
  const auto last = static_cast<unsigned>(k);
  d = SubpathDensities::from_lens(path.techniques.light_paths, f(path.lens_density * path.distance2[last]));
  d.fly({f(path.pass[last]), f(path.collision[last])}, 1, 0);
  d.arrive(f(path.distance2[last]), f(path.cos_n[last]));
  r.eye[last] = d;
  for (unsigned i = last; i > 0; --i) {
    over_pass = leave(
        d, i, path.techniques.volume, path.pass[i],
        {.cos = f(path.cos_p[i]), .pdf = f(path.reverse[i]), .reverse = f(path.forward[i]), .merges = path.merges[i]},
        coherence_before(path, static_cast<int>(i)));
    d.fly({f(path.pass[i - 1]), f(path.collision[i - 1])}, f(path.collision[i]), over_pass);
    d.arrive(f(path.distance2[i - 1]), f(path.cos_n[i - 1]));
    r.eye[i - 1] = d;
  }
  return r;
}

float volume_merging(const RandomPath& path, unsigned i) {
  const auto f = [](double x) { return static_cast<float>(x); };
  return f(coherence_before(path, static_cast<int>(i))) *
         path.techniques.volume.all(f(path.collision[i]), f(path.pass[i - 1]), f(path.pass[i]), f(path.sin[i]));
}

SubpathEnd eye_end(const RandomPath& path, const Recursion& r, unsigned i) {
  return end_of_eye_path(r.eye[i], static_cast<float>(path.forward[i]),
                         scatterings(path, static_cast<int>(i) + 1, path.last()) > 0);
}
SubpathEnd light_end(const RandomPath& path, const Recursion& r, unsigned i, float coherence) {
  return end_of_light_path(r.light[i], static_cast<float>(path.reverse[i]),
                           scatterings(path, 1, static_cast<int>(i) - 1) > 0, coherence);
}

float weight_of_connection(const RandomPath& path, const Recursion& r, int s) {
  const auto k = static_cast<unsigned>(path.last());
  const auto f = [](double x) { return static_cast<float>(x); };
  const auto merging = [&](unsigned i) {
    return !path.in_medium[i] && path.merges[i] && i > 1 ? path.techniques.merging : 0.0f;
  };
  const auto media = [&](unsigned i) { return path.in_medium[i] ? volume_merging(path, i) : 0.0f; };
  const auto flight = [&](unsigned from, unsigned to) { return path.pass[from] * path.collision[to]; };
  // If no light path can make this path, the density of its start must not matter.
  const auto start = [&](bool matters, double density) { return matters ? f(density) : 1e6f; };
  if (s == 0) {
    const float emission =
        start(has_light_paths(r.eye[0], path.techniques), path.emission_area * path.emission_direction);
    return sum_of_hit(r.eye[0], f(path.direct_area), emission, scatterings(path, 1, path.last()), path.techniques)
        .weight(path.techniques);
  }
  if (s == 1) {
    const double direct = path.direct_area * path.distance2[0] / path.cos_n[0];  // per solid angle at x_1
    const double ratio =
        path.emission_area * path.emission_direction * path.cos_p[1] * flight(0, 1) / (direct * path.cos_n[0]);
    ConnectedEnd at_eye{eye_end(path, r, 1), 0, merging(1), media(1)};
    at_eye.arrival = start(at_eye.has_other_techniques(path.techniques), ratio);
    return sum_of_next_event(at_eye, f(direct), path.can_be_hit ? f(path.reverse[1] * path.pass[0]) : 0.0f,
                             path.techniques)
        .weight(path.techniques);
  }
  if (s == path.last() + 1)
    return sum_of_lens({light_end(path, r, k, f(path.coherence[k])),
                        f(path.lens_density * path.cos_n[k] * flight(k, k)), merging(k), media(k)},
                       path.techniques)
        .weight(path.techniques);
  const auto i = static_cast<unsigned>(s);
  const double forward = path.reverse[i] * path.cos_n[i - 1] * flight(i - 1, i - 1) / path.distance2[i - 1];
  const double back = path.forward[i - 1] * path.cos_p[i] * flight(i - 1, i) / path.distance2[i - 1];
  return path.techniques.connections * sum_of_connection({eye_end(path, r, i), f(back), merging(i), media(i)},
                                                         {light_end(path, r, i - 1, f(coherence_before(path, s - 2))),
                                                          f(forward), merging(i - 1), media(i - 1)},
                                                         path.techniques)
                                           .weight(path.techniques);
}

TEST(Mis, RecursiveWeightsAreRatiosOfDensities) {
  HashRng rng(1);
  int in_media = 0;  // merges
  for (int n = 0; n < 100'000; ++n) {
    const RandomPath path = random_path(rng);
    const int k = path.last();
    std::vector<double> connections, merges;
    double total = 0;
    for (int s = 0; s <= k + 1; ++s) total += connections.emplace_back(density_of_connection(path, s));
    for (int m = 0; m <= k; ++m) total += merges.emplace_back(m == 0 ? 0 : density_of_merge(path, m));
    for (int m = 1; m <= k; ++m)
      for (const Kind kind : kinds) total += density_of_volume_merge(path, m, kind);
    const Recursion r = recursion(path);
    double sum = 0;
    for (int s = 0; s <= k + 1; ++s) {
      const double density = connections[static_cast<unsigned>(s)];
      if (density == 0) continue;
      const double weight = static_cast<double>(weight_of_connection(path, r, s));
      // If merging is the only other technique and leaves hits to the walk, the hits have the full weight.
      ASSERT_NEAR(weight, density / total, 1e-4) << "path " << n << " of " << k << ", technique " << s;
      sum += weight;
    }
    const auto f = [](double x) { return static_cast<float>(x); };
    for (int m = 1; m <= k; ++m) {
      const auto i = static_cast<unsigned>(m);
      const float before = f(coherence_before(path, m));
      const auto check = [&](double density, float own, float all) {
        if (density == 0) return;
        const SubpathEnd at_eye = eye_end(path, r, i);
        const SubpathEnd at_light = light_end(path, r, i, f(coherence_before(path, m - 1)));
        const auto weight =
            static_cast<double>((all > 0 ? sum_of_volume_merge(at_eye, at_light, own, all, path.techniques)
                                         : sum_of_merge(at_eye, at_light, path.techniques))
                                    .weight(path.techniques));
        ASSERT_NEAR(weight, density / total, 1e-4) << "path " << n << " of " << k << ", merged at " << m;
        sum += weight;
        in_media += path.in_medium[i] ? 1 : 0;
      };
      check(merges[i], 0, 0);
      if (!path.in_medium[i]) continue;
      const VolumeMerging& v = path.techniques.volume;
      const float collision = f(path.collision[i]), light = f(path.pass[i - 1]), eye = f(path.pass[i]);
      const std::array own{v.point, v.by_beam(collision, eye), v.by_photon_beam(collision, light),
                           v.by_beams(collision, light, eye, f(path.sin[i]))};
      for (const Kind kind : kinds)
        check(density_of_volume_merge(path, m, kind), before * own[static_cast<std::size_t>(kind)],
              volume_merging(path, i));
    }
    if (total > 0) {
      ASSERT_NEAR(sum, 1, 1e-3);
    }
  }
  EXPECT_GT(in_media, 50'000);
}

}  // namespace
}  // namespace lanthorn::mis_test
