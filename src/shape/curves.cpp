// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// References:
//   Pharr, Jakob, Humphreys 2023, "Physically Based Rendering" 4e, §6.7 (kinds of curves and their parameters).
//   Farin 2002, "Curves and Surfaces for CAGD", 5e, ch. 5 (Bézier curves and their derivatives).
#include "shape/curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace lanthorn {

namespace {

using description::CurveKind;
using description::Curves;

template <class T>
struct Jet {
  T value, first, second;  // value of a cubic at u, with its derivatives
};

template <class T>
Jet<T> bezier(const std::array<T, 4>& p, double u) {
  const double v = 1 - u;
  const T a = p[1] - p[0], b = p[2] - p[1], c = p[3] - p[2];
  return {v * v * v * p[0] + 3 * v * v * u * p[1] + 3 * v * u * u * p[2] + u * u * u * p[3],
          3.0 * (v * v * a + 2 * v * u * b + u * u * c), 6.0 * (v * (b - a) + u * (c - b))};
}

template <class T>
T blossom(const std::array<T, 4>& p, const std::array<double, 3>& u) {
  const auto mix = [](double t, const T& a, const T& b) { return (1 - t) * a + t * b; };
  const T a = mix(u[0], p[0], p[1]), b = mix(u[0], p[1], p[2]), c = mix(u[0], p[2], p[3]);
  return mix(u[2], mix(u[1], a, b), mix(u[1], b, c));
}

struct CurveSegment {
  std::array<DVec3, 4> points;
  std::array<double, 4> radii;
};

CurveSegment segment_of(const Curves& curves, std::uint32_t segment) {
  CurveSegment s;
  for (unsigned k = 0; k < 4; ++k) {
    const glm::dvec4 p(curves.points[curves.segments[segment] + k]);
    s.points[k] = DVec3(p);
    s.radii[k] = p.w;
  }
  return s;
}

std::array<DVec3, 4> normals_of(const Curves& curves, std::uint32_t segment) {
  std::array<DVec3, 4> normals;
  for (unsigned k = 0; k < 4; ++k) normals[k] = DVec3(curves.normals[curves.segments[segment] + k]);
  return normals;
}

DVec3 any_orthogonal(const DVec3& v) {
  return std::fabs(v.x) > std::fabs(v.z) ? DVec3(-v.y, v.x, 0) : DVec3(0, -v.z, v.y);
}

// v normalised; if v is 0, `otherwise` normalised, which must not be 0.
DVec3 unit(const DVec3& v, const DVec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 ? v / length : glm::normalize(otherwise);
}

// Unit tangent. Coinciding control points may make the derivative 0; then the chord is used.
DVec3 tangent_at(const CurveSegment& s, const Jet<DVec3>& c) {
  const DVec3 chord = s.points[3] - s.points[0];
  return unit(c.first, glm::dot(chord, chord) > 0 ? chord : DVec3(1, 0, 0));
}

// Parameter of the curve's point whose cross-section contains `p`: Newton's method on (p - c) . c' = 0.
double closest_parameter(const CurveSegment& s, double u, const DVec3& p) {
  for (int i = 0; i < 3; ++i) {
    const Jet<DVec3> c = bezier(s.points, u);
    const DVec3 way = p - c.value;
    const double slope = glm::dot(way, c.second) - glm::dot(c.first, c.first);
    if (!(slope < 0)) break;
    u = std::clamp(u - glm::dot(way, c.first) / slope, 0.0, 1.0);
  }
  return u;
}

// Error bound of Embree's hits. Embree computes in single precision; errors grow with the size of the segment and its
// distance from the origin. Measured on hairs of 8 to 1000 times their width, near the origin and far from it: from
// this distance on, none of 60000 rays that leave the surface hits it again.
double embree_error(const CurveSegment& s, double radius) {
  double reach = 0, size = 0;
  for (const DVec3& p : s.points)
    for (int i = 0; i < 3; ++i) {
      reach = std::max(reach, std::fabs(p[i]));
      size = std::max(size, std::fabs(p[i] - s.points[0][i]));
    }
  return 0x1p-20 * reach + 0x1p-16 * size + 0x1p-12 * radius;
}

// Normal of the tube c + r e(phi), with e = `out`: e (|c'| - r e . c'' / |c'|) - r' t, because e stays perpendicular to
// the tangent t.
DVec3 tube_normal(const Jet<DVec3>& c, const Jet<double>& r, const DVec3& tangent, const DVec3& out) {
  const double speed = glm::length(c.first);
  const double around = speed > 0 ? speed - r.value * glm::dot(out, c.second) / speed : 0;
  return around > 0 ? glm::normalize(out * around - tangent * r.first) : out;
}

// Surface point of a tube: circles of radius r perpendicular to the curve.
CurvePoint evaluate_cylinder(const CurveSegment& s, float u, const DVec3& near, const DVec3& along) {
  CurvePoint result;
  const double at = closest_parameter(s, static_cast<double>(u), near);
  const Jet<DVec3> c = bezier(s.points, at);
  const Jet<double> r = bezier(s.radii, at);
  const DVec3 tangent = tangent_at(s, c);
  const DVec3 way = near - c.value;
  const DVec3 out = unit(way - tangent * glm::dot(way, tangent), any_orthogonal(tangent));
  result.position = c.value + r.value * out;
  result.normal = tube_normal(c, r, tangent, out);
  const DVec3 across = unit(glm::cross(along, tangent), any_orthogonal(tangent));
  result.uv = {static_cast<float>(at), static_cast<float>(0.5 + 0.5 * glm::dot(out, across))};
  result.dpdv = 2 * r.value * unit(across - out * glm::dot(out, across), glm::cross(tangent, out));
  result.dpdu = glm::length(c.first) > 0 ? c.first : tangent;
  result.error = embree_error(s, r.value);
  return result;
}

float across_of(const DVec3& way, const DVec3& across, double radius) {
  return radius > 0 ? static_cast<float>(std::clamp(0.5 + 0.5 * glm::dot(way, across) / radius, 0.0, 1.0)) : 0.5f;
}

CurvePoint evaluate_flat(const CurveSegment& s, float u, const DVec3& near, const DVec3& along) {
  CurvePoint result;
  const Jet<DVec3> c = bezier(s.points, static_cast<double>(u));
  const double radius = bezier(s.radii, static_cast<double>(u)).value;
  const DVec3 tangent = tangent_at(s, c);
  const DVec3 across = unit(glm::cross(along, tangent), any_orthogonal(tangent));
  result.position = near;
  result.normal = glm::cross(across, tangent);
  if (glm::dot(result.normal, along) > 0) result.normal = -result.normal;
  result.uv = {u, across_of(near - c.value, across, radius)};
  result.dpdv = 2 * radius * across;
  result.dpdu = glm::length(c.first) > 0 ? c.first : tangent;
  // Every ray sees its own ribbon. All ribbons lie in a tube about the curve; Embree's few quads widen it at bends.
  constexpr double tube = 1.1;
  result.error = tube * radius + embree_error(s, radius);
  return result;
}

// Unit vector across a ribbon: perpendicular to the curve and to the given normal.
DVec3 ribbon_across(const CurveSegment& s, const std::array<DVec3, 4>& normals, double u) {
  const DVec3 tangent = tangent_at(s, bezier(s.points, u));
  return unit(glm::cross(bezier(normals, u).value, tangent), any_orthogonal(tangent));
}

CurvePoint evaluate_ribbon(const CurveSegment& s, const std::array<DVec3, 4>& normals, float u, const DVec3& near) {
  CurvePoint result;
  const auto at = static_cast<double>(u);
  const Jet<DVec3> c = bezier(s.points, at);
  const Jet<double> r = bezier(s.radii, at);
  const DVec3 across = ribbon_across(s, normals, at);
  result.position = near;
  result.uv = {u, across_of(near - c.value, across, r.value)};
  result.dpdv = 2 * r.value * across;
  // The surface is c + y r a(u), y in [-1, 1]. a turns with the normals; its derivative has no short closed form.
  constexpr double step = 1e-4;
  const double before = std::max(0.0, at - step), after = std::min(1.0, at + step);
  const DVec3 turn = (ribbon_across(s, normals, after) - ribbon_across(s, normals, before)) / (after - before);
  const double y = 2 * static_cast<double>(result.uv.y) - 1;
  const DVec3 tangent = tangent_at(s, c);
  result.dpdu = glm::length(c.first) > 0 ? c.first : tangent;
  result.normal = unit(glm::cross(result.dpdu + y * r.value * turn, across), any_orthogonal(tangent));
  result.error = embree_error(s, r.value);
  return result;
}

// The two inner control points of a turn from n0 to n1: those of the cubic closest to the arc.
std::array<Normal, 2> turning(const Normal& n0, const Normal& n1) {
  const float cos = std::clamp(dot(n0, n1), -1.0f, 1.0f);
  const float sin = safe_sqrt(1 - cos * cos);
  if (sin < 1e-4f) return {n0 + (n1 - n0) / 3.0f, n1 - (n1 - n0) / 3.0f};
  const float handle = 4 * std::tan(std::acos(cos) / 4) / 3;
  return {n0 + handle * (n1 - cos * n0) / sin, n1 - handle * (cos * n1 - n0) / sin};
}

}  // namespace

void append_curve(Curves& curves, std::span<const DVec3> points, float width0, float width1,
                  std::span<const Normal> normals) {
  const auto first = static_cast<std::uint32_t>(curves.points.size());
  const std::size_t last = points.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const float width = lerp(static_cast<float>(i) / static_cast<float>(last), width0, width1);
    curves.points.emplace_back(Point(points[i]), 0.5f * width);
    if (i % 3 == 0 && i < last) curves.segments.push_back(first + static_cast<std::uint32_t>(i));
  }
  if (normals.empty()) return;
  curves.normals.push_back(normals[0]);
  for (std::size_t i = 1; i < normals.size(); ++i) {
    const std::array<Normal, 2> inner = turning(normals[i - 1], normals[i]);
    curves.normals.insert(curves.normals.end(), {inner[0], inner[1], normals[i]});
  }
}

void append(Curves& curves, const Curves& more) {
  const auto first = static_cast<std::uint32_t>(curves.points.size());
  curves.points.insert(curves.points.end(), more.points.begin(), more.points.end());
  curves.normals.insert(curves.normals.end(), more.normals.begin(), more.normals.end());
  for (const std::uint32_t segment : more.segments) curves.segments.push_back(first + segment);
}

std::optional<float> even_scale(const Transform& t) {
  const DMat3 m(t.matrix);
  const DMat3 gram = glm::transpose(m) * m;
  const double scale2 = (gram[0][0] + gram[1][1] + gram[2][2]) / 3;
  if (!(scale2 > 0)) return {};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::fabs(gram[i][j] - (i == j ? scale2 : 0)) <= 1e-5 * scale2)) return {};
  return static_cast<float>(std::sqrt(scale2));
}

Curves transformed(Curves curves, const Transform& t) {
  if (t.is_identity()) return curves;
  const Affine map(t);
  const float scale = even_scale(t).value_or(1);
  for (glm::vec4& p : curves.points) p = glm::vec4(Point(map.point(DVec3(Vec3(p)))), scale * p.w);
  for (Normal& n : curves.normals) n = Normal(map.vector(DVec3(n)) / static_cast<double>(scale));
  return curves;
}

namespace {

// Appends the control points (or normals) of one segment cut into pieces. The control points of a piece are the
// blossoms at its two end parameters (Farin 2002, ch. 5); neighbouring pieces share end points.
template <class Control, class Stored>
void append_cut(const std::array<Control, 4>& controls, std::uint32_t pieces, std::vector<Stored>& out) {
  for (std::uint32_t i = 0; i < pieces; ++i) {
    const double a = static_cast<double>(i) / pieces, b = static_cast<double>(i + 1) / pieces;
    for (unsigned k = i == 0 ? 0 : 1; k < 4; ++k) {
      const std::array<double, 3> at{k < 3 ? a : b, k < 2 ? a : b, k < 1 ? a : b};
      out.emplace_back(blossom(controls, at));
    }
  }
}

}  // namespace

Curves cut(const Curves& curves, std::uint32_t pieces) {
  Curves result;
  result.kind = curves.kind;
  result.pieces = curves.pieces * pieces;
  for (const std::uint32_t first : curves.segments) {
    const auto start = static_cast<std::uint32_t>(result.points.size());
    for (std::uint32_t i = 0; i < pieces; ++i) result.segments.push_back(start + 3 * i);
    std::array<glm::dvec4, 4> points;
    std::array<DVec3, 4> normals{};
    for (unsigned k = 0; k < 4; ++k) {
      points[k] = glm::dvec4(curves.points[first + k]);
      if (!curves.normals.empty()) normals[k] = DVec3(curves.normals[first + k]);
    }
    append_cut(points, pieces, result.points);
    if (!curves.normals.empty()) append_cut(normals, pieces, result.normals);
  }
  return result;
}

void check_curves(const Curves& curves, const SourceLocation& location) {
  for (const std::uint32_t first : curves.segments)
    if (curves.points.size() < 4 || first > curves.points.size() - 4)
      throw Error(location, "the curve has a segment beyond its last point");
  if (curves.normals.size() != (curves.kind == CurveKind::ribbon ? curves.points.size() : 0))
    throw Error(location, "a ribbon needs as many normals as points, other curves have none");
}

namespace {

// Converts a parameter of a piece to the parameter of the whole curve.
float along_pieces(const Curves& curves, std::uint32_t segment, float u) {
  return (static_cast<float>(segment % curves.pieces) + u) / static_cast<float>(curves.pieces);
}

}  // namespace

CurvePoint evaluate(const Curves& curves, std::uint32_t segment, float u, const DVec3& near, const DVec3& along) {
  const CurveSegment s = segment_of(curves, segment);
  const auto evaluate_segment = [&] {
    if (curves.kind == CurveKind::flat) return evaluate_flat(s, u, near, along);
    if (curves.kind == CurveKind::cylinder) return evaluate_cylinder(s, u, near, along);
    return evaluate_ribbon(s, normals_of(curves, segment), u, near);
  };
  CurvePoint result = evaluate_segment();
  result.uv.x = along_pieces(curves, segment, result.uv.x);
  return result;
}

namespace {

// Total angle by which the unit vector `direction(u)` turns along a segment, radians.
template <class Direction>
double turn(const Direction& direction) {
  constexpr int steps = 64;
  double sum = 0;
  DVec3 last = direction(0.0);
  for (int i = 1; i <= steps; ++i) {
    const DVec3 next = direction(static_cast<double>(i) / steps);
    sum += std::acos(std::clamp(glm::dot(last, next), -1.0, 1.0));
    last = next;
  }
  return sum;
}

// Writes the meshes of consecutive segments, cross-section by cross-section.
class CurveMesh {
 public:
  explicit CurveMesh(const Curves& curves) : curves_(curves) {}

  void append_segment(std::uint32_t segment) {
    const CurveSegment s = segment_of(curves_, segment);
    const bool is_ribbon = curves_.kind == CurveKind::ribbon;
    const std::array<DVec3, 4> normals = is_ribbon ? normals_of(curves_, segment) : std::array<DVec3, 4>{};
    double bend = turn([&](double u) { return tangent_at(s, bezier(s.points, u)); });
    if (is_ribbon) bend += turn([&](double u) { return ribbon_across(s, normals, u); });
    constexpr double steps_per_turn = 64, fewest = 4, most = 64;
    const double steps = std::clamp(std::ceil(bend * steps_per_turn / (2 * std::numbers::pi)), fewest, most);
    for (double i = 0; i <= steps; ++i) {
      const auto before = static_cast<std::uint32_t>(mesh_.positions.size());
      if (is_ribbon)
        append_line(s, normals, i / steps, segment);
      else
        append_circle(s, i / steps, segment);
      if (i > 0) join(2 * before - static_cast<std::uint32_t>(mesh_.positions.size()), before);
    }
  }
  description::TriangleMesh take() { return std::move(mesh_); }

 private:
  static constexpr int sides = 16;

  void append_vertex(const DVec3& position, const DVec3& normal, std::uint32_t segment, double u, double v) {
    mesh_.positions.emplace_back(position);
    mesh_.normals.emplace_back(normal);
    mesh_.uvs.emplace_back(along_pieces(curves_, segment, static_cast<float>(u)), static_cast<float>(v));
  }

  void append_circle(const CurveSegment& s, double u, std::uint32_t segment) {
    const Jet<DVec3> c = bezier(s.points, u);
    const Jet<double> r = bezier(s.radii, u);
    const DVec3 tangent = tangent_at(s, c);
    start_ = unit(start_ - tangent * glm::dot(start_, tangent), any_orthogonal(tangent));
    const DVec3 side = glm::cross(tangent, start_);
    const double radius = r.value * (std::numbers::pi / sides) / std::sin(std::numbers::pi / sides);
    for (int i = 0; i <= sides; ++i) {
      const double phi = i < sides ? 2 * std::numbers::pi * i / sides : 0;
      const DVec3 out = std::cos(phi) * start_ + std::sin(phi) * side;
      append_vertex(c.value + radius * out, tube_normal(c, r, tangent, out), segment, u,
                    static_cast<double>(i) / sides);
    }
  }

  void append_line(const CurveSegment& s, const std::array<DVec3, 4>& normals, double u, std::uint32_t segment) {
    const DVec3 half = bezier(s.radii, u).value * ribbon_across(s, normals, u);
    for (const double y : {-1.0, 1.0}) {
      const DVec3 p = bezier(s.points, u).value + y * half;
      append_vertex(p, evaluate_ribbon(s, normals, static_cast<float>(u), p).normal, segment, u, 0.5 + 0.5 * y);
    }
  }

  // Adds triangles between two cross-sections that start at these vertices; none where the curve has no width.
  void join(std::uint32_t first, std::uint32_t second) {
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      const std::vector<Point>& p = mesh_.positions;
      if (p[a] != p[b] && p[b] != p[c] && p[c] != p[a]) mesh_.triangles.push_back({a, b, c});
    };
    for (std::uint32_t i = 0; first + i + 1 < second; ++i) {
      add(first + i, second + i, second + i + 1);
      add(first + i, second + i + 1, first + i + 1);
    }
  }

  const Curves& curves_;
  description::TriangleMesh mesh_;
  DVec3 start_{0.0, 0.0, 1.0};  // direction in which v is 0 around a tube: transported with the tangent, without twist
};

}  // namespace

description::TriangleMesh triangulated(const Curves& curves) {
  CurveMesh mesh(curves);
  for (std::uint32_t i = 0; i < curves.segments.size(); ++i) mesh.append_segment(i);
  return mesh.take();
}

}  // namespace lanthorn
