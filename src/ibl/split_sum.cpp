// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Split-sum shading. Its table, `brdf_table`, is the environment BRDF (Karis 2013): the reflection of a white
// environment by GGX with Schlick's Fresnel term, as F0 scale + bias.
//
// # The integral
// A surface with normal n, seen from v, reflects of a white environment of radiance 1
//
//   A(v) = ∫ F D G2 / (4 n·l n·v)  n·l dl,
//
// with the distribution D of microfacet normals h, half way between v and l, and the masking G2 of both directions.
// Light from l is reflected by facets with normal h, so integrate over h instead. Mirroring v about h turns l twice as
// fast as h: dl = 4 v·h dh, and
//
//   A(v) = ∫ F G2 D(h) v·h / n·v dh.
//
// # Its sampling
// The normals visible from v have the density D_v(h) = G1(v) D(h) v·h / n·v (Heitz 2018, eq. 3). With h sampled from
// it, everything except masking and Fresnel cancels: A is the mean of F G2 / G1. Schlick's Fresnel term splits the
// mean:
//
//   F = F0 + (1 - F0) c,     c = (1 - v·h)^5,     A = F0 scale + bias,
//   scale = mean of (1 - c) G2 / G1,     bias = mean of c G2 / G1.
//
// Both depend only on n·v and alpha: the table.
//
// Visible normals are sampled as by Dupuy & Benyoub 2023. Scaling x and y by alpha turns the distribution into the
// distribution of a hemisphere's normals, and v into v'. A parallel beam from v' hits points of the hemisphere in
// proportion to their projected areas, that is, to their visibility. A sphere mirrors a parallel beam uniformly into
// all directions; the upper hemisphere mirrors it into the cap z > -v'_z. So sample the mirrored ray u uniformly in
// that cap. The normal is half way between u and v':
//
//   h' = u + v',     h = (alpha h'_x, alpha h'_y, h'_z) / its length.
//
// The azimuth of u and its height z = height (1 + v'_z) - v'_z are uniform, since zones of a sphere of equal height
// have equal areas. With v in the plane y = 0, the sign of h_y affects neither v·h nor n·l: half a turn of azimuths
// suffices, and only the square of h_y is needed.
//
// # Its weight
// Smith's masking has G1(v) = 1 / (1 + Λ(v)), and G2 = 1 / (1 + Λ(v) + Λ(l)) where heights are correlated (Heitz 2014,
// eq. 99). For GGX, 1 + 2 Λ(v) = length(v) / n·v with length(v)² = alpha² (1 - (n·v)²) + (n·v)², the length of v in the
// scaled space. So
//
//   G2 / G1 = n·l (n·v + length(v)) / (n·l length(v) + n·v length(l)).
#include "ibl/split_sum.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "ibl/bake_plan.h"
#include "lanthorn/ibl.h"
#include "math/vec.h"
#include "surface/cloth.h"
#include "surface/microfacet.h"

namespace lanthorn {

namespace {

constexpr int table_size = split_sum_table_size;
constexpr RoughnessMapping mapping = RoughnessMapping::square;

constexpr std::size_t columns = 32;  // processed together, see point_sums.h
using Columns = std::array<float, columns>;

struct Sums {
  alignas(64) Columns scale{}, bias{};
};

// The weight of a sample for several n·v. In the scaled space v' is (vx, 0, vz) and u is (across cos φ, across sin φ,
// z).
void add_sample(const CapSample& s, float alpha, const Columns& cos_v, Sums& sums) {
  const float alpha2 = alpha * alpha;
  for (std::size_t i = 0; i < columns; ++i) {
    const float cos = cos_v[i], sin = std::sqrt(1 - cos * cos);
    const float length_v = std::sqrt(alpha2 * sin * sin + cos * cos);
    const float vx = alpha * sin / length_v, vz = cos / length_v;
    const float z = s.height * (1 + vz) - vz;
    const float across2 = 1 - z * z, across = std::sqrt(across2 > 0 ? across2 : 0.0f);
    const float hx = alpha * (across * s.cos_phi + vx), hz = z + vz;
    const float hy2 = alpha2 * across2 * (1 - s.cos_phi * s.cos_phi);
    const float per_length = 1 / std::sqrt(hx * hx + hy2 + hz * hz);
    const float v_h = (sin * hx + cos * hz) * per_length;
    const float cos_l = 2 * v_h * hz * per_length - cos;
    const float l = cos_l > 0 ? cos_l : 0.0f;
    const float length_l = std::sqrt(alpha2 * (1 - l * l) + l * l);
    const float weight = l * (cos + length_v) / (l * length_v + cos * length_l);
    const float grazing = 1 - v_h, grazing2 = grazing * grazing, schlick = grazing2 * grazing2 * grazing;
    sums.scale[i] += (1 - schlick) * weight;
    sums.bias[i] += schlick * weight;
  }
}

}  // namespace

IblSettings split_sum_settings(const Image& environment) {
  IblSettings settings;
  // The map is as fine as the environment, within these bounds of memory and time.
  constexpr unsigned least_size = 256, most_size = 1024;
  const auto texels_per_face = static_cast<unsigned>(environment.width) / 4;
  settings.specular_size = static_cast<int>(std::clamp(std::bit_ceil(texels_per_face), least_size, most_size));
  settings.sh = false;
  settings.checks = 0;
  settings.samples = 1024;
  settings.mapping = mapping;
  settings.weight = LobeWeight::masking;
  // Closely spaced roughness levels, since values between them are interpolated.
  settings.smallest_size = 4;
  return settings;
}

SplitSum::SplitSum(const Image& environment) : table_(brdf_table(table_size, false)) {
  const Ibl ibl = bake_ibl(environment, split_sum_settings(environment));
  irradiance_ = cube_of(*ibl.irradiance);
  for (const SpecularLevel& level : ibl.specular) levels_.push_back(cube_of(level.faces));
}

Spectrum SplitSum::reflection(const Direction& r, float alpha) const {
  const auto last = static_cast<float>(levels_.size() - 1);
  const float level = std::clamp(level_of_roughness(std::sqrt(alpha), mapping) * last, 0.0f, last);
  const auto lower = static_cast<std::size_t>(level), upper = std::min(lower + 1, levels_.size() - 1);
  const float t = level - static_cast<float>(lower);
  return (1 - t) * levels_[lower].lookup(r) + t * levels_[upper].lookup(r);
}

SplitSum::Brdf SplitSum::brdf(float cos, float alpha) const {
  const auto place = [](float x) { return std::clamp(x * table_size - 0.5f, 0.0f, table_size - 1.0f); };
  const float x = place(cos), y = place(std::sqrt(alpha));
  const int x0 = std::min(static_cast<int>(x), table_size - 2), y0 = std::min(static_cast<int>(y), table_size - 2);
  const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
  const auto channel = [&](std::size_t c) {
    return (1 - fy) * ((1 - fx) * table_.at(x0, y0, c) + fx * table_.at(x0 + 1, y0, c)) +
           fy * ((1 - fx) * table_.at(x0, y0 + 1, c) + fx * table_.at(x0 + 1, y0 + 1, c));
  };
  return {channel(0), channel(1)};
}

// Heights are equidistant; multiples of the golden ratio spread the azimuths of neighbouring heights over half a turn.
std::vector<CapSample> cap_samples() {
  constexpr int count = 2048;
  std::vector<CapSample> samples;
  for (int i = 0; i < count; ++i) {
    const double turns = (i + 0.5) / std::numbers::phi;
    samples.push_back({static_cast<float>(std::cos(std::numbers::pi * (turns - std::floor(turns)))),
                       1 - (static_cast<float>(i) + 0.5f) / static_cast<float>(count)});
  }
  return samples;
}

Image brdf_table(int size, bool sheen) {
  const std::vector<CapSample> cap = cap_samples();
  const auto samples = static_cast<float>(cap.size());
  Image table(size, size, {"R", "G", "B"});
  const auto centre = [&](int i) { return (static_cast<float>(i) + 0.5f) / static_cast<float>(size); };
  parallel_for(0, size, [&](int y) {
    const float roughness = centre(y), alpha = roughness * roughness;
    for (int begin = 0; begin < size; begin += static_cast<int>(columns)) {
      alignas(64) Columns cos_v{};
      for (int i = 0; i < static_cast<int>(columns); ++i)
        cos_v[static_cast<std::size_t>(i)] = centre(std::min(begin + i, size - 1));
      Sums sums;
      for (const CapSample& s : cap) add_sample(s, alpha, cos_v, sums);
      for (int x = begin; x < std::min(begin + static_cast<int>(columns), size); ++x) {
        const auto i = static_cast<std::size_t>(x - begin);
        table.at(x, y, 0) = sums.scale[i] / samples;
        table.at(x, y, 1) = sums.bias[i] / samples;
        if (sheen) table.at(x, y, 2) = sheen_albedo(std::max(alpha, Cloth::least_alpha), centre(x));
      }
    }
  });
  return table;
}

}  // namespace lanthorn
