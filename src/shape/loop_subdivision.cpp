// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// References:
//   Loop 1987, "Smooth Subdivision Surfaces Based on Triangles", MSc thesis, University of Utah.
//   Hoppe et al. 1994, "Piecewise Smooth Surface Reconstruction", §4 and appendix A (boundaries, limit masks).
//   Warren 1995, "Subdivision Methods for Geometric Design" (the weight of extraordinary vertices that pbrt-v4 uses).
#include "shape/loop_subdivision.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "base/parallel_sort.h"
#include "math/affine.h"

namespace lanthorn {

namespace {

using Index = std::uint32_t;
using Face = std::array<Index, 3>;

struct Edge {
  Index a = 0, b = 0;
  Index faces = 0;
  std::array<Index, 2> opposite{};  // of the first two faces

  bool is_smooth() const { return faces == 2; }
};

struct ControlMesh {
  std::vector<DVec3> positions;
  std::vector<Face> faces;
};

struct Edges {
  std::vector<Edge> edges;
  std::vector<Face> of_face;  // edge k joins corners k and k + 1
};

Index corner(const Face& face, Index k) { return face[k % 3]; }

Edges find_edges(const std::vector<Face>& faces) {
  struct HalfEdge {
    std::uint64_t ends = 0;
    Index face = 0, k = 0;
    // clang-tidy 14 mistakes the comparison's 0 for a pointer.
    auto operator<=>(const HalfEdge&) const = default;  // NOLINT(modernize-use-nullptr)
  };
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(3 * faces.size());
  for (Index f = 0; f < faces.size(); ++f)
    for (Index k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({faces[f][k], corner(faces[f], k + 1)});
      half_edges.push_back({(std::uint64_t{low} << 32) | high, f, k});
    }
  parallel_sort(half_edges);

  Edges result;
  result.of_face.resize(faces.size());
  result.edges.reserve(half_edges.size() / 2);
  std::uint64_t current = 0;
  for (const HalfEdge& h : half_edges) {
    if (result.edges.empty() || h.ends != current) {
      current = h.ends;
      result.edges.push_back({static_cast<Index>(h.ends >> 32), static_cast<Index>(h.ends)});
    }
    Edge& edge = result.edges.back();
    if (edge.faces < 2) edge.opposite[edge.faces] = corner(faces[h.face], h.k + 2);
    ++edge.faces;
    result.of_face[h.face][h.k] = static_cast<Index>(result.edges.size() - 1);
  }
  return result;
}

// Sums over the vertices that share an edge with this one.
struct Neighbourhood {
  DVec3 sum{0.0};
  DVec3 boundary_sum{0.0};
  Index valence = 0, boundaries = 0;
};

std::vector<Neighbourhood> neighbourhoods(const ControlMesh& mesh, const std::vector<Edge>& edges) {
  std::vector<Neighbourhood> result(mesh.positions.size());
  for (const Edge& edge : edges)
    for (const auto& [at, other] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
      Neighbourhood& n = result[at];
      n.sum += mesh.positions[other];
      ++n.valence;
      if (edge.is_smooth()) continue;
      n.boundary_sum += mesh.positions[other];
      ++n.boundaries;
    }
  return result;
}

double interior_weight(Index valence) { return valence == 3 ? 3.0 / 16 : 3.0 / (8.0 * valence); }

// Weighs a vertex with its neighbours: gives its position after one more subdivision or its limit, by the weights.
DVec3 weigh(const DVec3& p, const Neighbourhood& n, double interior, double boundary) {
  if (n.valence == 0) return p;
  if (n.boundaries == 0) return (1 - n.valence * interior) * p + interior * n.sum;
  if (n.boundaries == 2) return (1 - 2 * boundary) * p + boundary * n.boundary_sum;
  return p;
}
DVec3 subdivided(const DVec3& p, const Neighbourhood& n) { return weigh(p, n, interior_weight(n.valence), 1.0 / 8); }
DVec3 limit(const DVec3& p, const Neighbourhood& n) {
  return weigh(p, n, 1 / (n.valence + 3 / (8 * interior_weight(n.valence))), 1.0 / 6);
}

ControlMesh subdivide(const ControlMesh& mesh) {
  const Edges edges = find_edges(mesh.faces);
  const std::vector<Neighbourhood> around = neighbourhoods(mesh, edges.edges);
  ControlMesh result;
  result.positions.reserve(mesh.positions.size() + edges.edges.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    result.positions.push_back(subdivided(mesh.positions[i], around[i]));
  for (const Edge& e : edges.edges) {
    const DVec3 ends = mesh.positions[e.a] + mesh.positions[e.b];
    result.positions.push_back(
        e.is_smooth() ? 0.375 * ends + 0.125 * (mesh.positions[e.opposite[0]] + mesh.positions[e.opposite[1]])
                      : 0.5 * ends);
  }
  const auto first = static_cast<Index>(mesh.positions.size());
  result.faces.reserve(4 * mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face& v = mesh.faces[f];
    const Face e{first + edges.of_face[f][0], first + edges.of_face[f][1], first + edges.of_face[f][2]};
    result.faces.push_back({v[0], e[0], e[2]});
    result.faces.push_back({e[0], v[1], e[1]});
    result.faces.push_back({e[2], e[1], v[2]});
    result.faces.push_back({e[0], e[1], e[2]});
  }
  return result;
}

// The edge of a triangle opposite a vertex, in the triangle's winding direction.
struct RimEdge {
  Index from = 0, to = 0;
  auto operator<=>(const RimEdge&) const = default;  // NOLINT(modernize-use-nullptr)
};

// The rim edges around every vertex; vertex v has [first[v], first[v + 1]).
struct Rims {
  std::vector<Index> first;
  std::vector<RimEdge> edges;

  std::span<RimEdge> of(std::size_t v) { return std::span(edges).subspan(first[v], first[v + 1] - first[v]); }
};

Rims find_rims(const ControlMesh& mesh) {
  Rims rims;
  rims.first.resize(mesh.positions.size() + 1);
  for (const Face& f : mesh.faces)
    for (const Index v : f) ++rims.first[v + 1];
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) rims.first[v + 1] += rims.first[v];
  rims.edges.resize(3 * mesh.faces.size());
  std::vector<Index> next(rims.first.begin(), rims.first.end() - 1);
  for (const Face& f : mesh.faces)
    for (Index k = 0; k < 3; ++k) rims.edges[next[f[k]]++] = {corner(f, k + 1), corner(f, k + 2)};
  return rims;
}

// The vertices around a vertex, in winding order; a closed ring ends with its first vertex. Empty if the faces around
// the vertex do not form a single fan of consistent winding.
std::vector<Index> ring(std::span<RimEdge> rim) {
  std::sort(rim.begin(), rim.end());
  const auto leaving = [&](Index v) { return std::lower_bound(rim.begin(), rim.end(), RimEdge{v, 0}); };
  const auto leaves = [&](Index v) {
    const auto it = leaving(v);
    return it != rim.end() && it->from == v;
  };
  std::vector<Index> arrivals;
  for (const RimEdge& e : rim) arrivals.push_back(e.to);
  std::sort(arrivals.begin(), arrivals.end());
  Index start = rim.empty() ? 0 : rim.front().from;
  for (const RimEdge& e : rim)
    if (!std::binary_search(arrivals.begin(), arrivals.end(), e.from)) start = e.from;

  std::vector<Index> result{start};
  while (result.size() <= rim.size() && leaves(result.back())) result.push_back(leaving(result.back())->to);
  if (result.size() != rim.size() + 1) return {};
  return result;
}

// Normal of the limit surface on the side from which the triangles wind counter-clockwise, by the tangent masks of
// Hoppe et al. 1994, appendix A; not normalised. Returns nullopt if the tangents are degenerate.
std::optional<DVec3> limit_normal(const ControlMesh& mesh, Index v, const Neighbourhood& n, std::span<RimEdge> rim) {
  const std::vector<Index> around = ring(rim);
  if (around.size() < 2 || (n.boundaries != 0 && n.boundaries != 2)) return {};
  const auto p = [&](std::size_t i) { return mesh.positions[around[i]]; };
  DVec3 s(0.0), t(0.0);
  if (n.boundaries == 0) {
    const std::size_t count = around.size() - 1;
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
      s += std::cos(angle) * p(i);
      t += std::sin(angle) * p(i);
    }
  } else {
    const std::size_t last = around.size() - 1;
    s = p(0) - p(last);
    if (last == 1) {
      t = p(0) + p(1) - 2.0 * mesh.positions[v];
    } else if (last == 2) {
      t = p(1) - mesh.positions[v];
    } else {
      const double angle = std::numbers::pi / static_cast<double>(last);
      t = -std::sin(angle) * (p(0) + p(last));
      for (std::size_t i = 1; i < last; ++i)
        t += (2 - 2 * std::cos(angle)) * std::sin(angle * static_cast<double>(i)) * p(i);
    }
  }
  const DVec3 normal = glm::cross(s, t);
  if (!(glm::dot(normal, normal) > 0)) return {};
  return normal;
}

// Area-weighted mean of the faces' normals; not normalised.
DVec3 face_normal(const ControlMesh& mesh, Index v, std::span<const RimEdge> rim) {
  DVec3 sum(0.0);
  for (const RimEdge& e : rim)
    sum += glm::cross(mesh.positions[e.from] - mesh.positions[v], mesh.positions[e.to] - mesh.positions[v]);
  return sum;
}

}  // namespace

description::TriangleMesh loop_subdivide(const description::TriangleMesh& control, int levels) {
  ControlMesh mesh;
  for (const Point& p : control.positions) mesh.positions.emplace_back(p);
  for (const Face& f : control.triangles)
    if (f[0] != f[1] && f[1] != f[2] && f[2] != f[0]) mesh.faces.push_back(f);
  for (int level = 0; level < levels; ++level) mesh = subdivide(mesh);

  const std::vector<Neighbourhood> around = neighbourhoods(mesh, find_edges(mesh.faces).edges);
  Rims rims = find_rims(mesh);
  description::TriangleMesh result;
  result.positions.resize(mesh.positions.size());
  result.normals.resize(mesh.positions.size());
  parallel_for(std::size_t{0}, mesh.positions.size(), [&](std::size_t i) {
    const auto v = static_cast<Index>(i);
    result.positions[i] = Point(limit(mesh.positions[i], around[i]));
    const DVec3 normal = limit_normal(mesh, v, around[i], rims.of(i)).value_or(face_normal(mesh, v, rims.of(i)));
    const double length = glm::length(normal);
    if (length > 0) result.normals[i] = Normal(-normal / length);
  });
  result.triangles = std::move(mesh.faces);
  return result;
}

}  // namespace lanthorn
