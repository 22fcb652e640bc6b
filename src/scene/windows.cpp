// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/windows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "surface/thin_dielectric.h"

namespace lanthorn {

namespace {

// Relative to coordinates: single precision rounds them, and walks move the origins of rays off surfaces.
constexpr double rounding = 0x1p-18;

struct Facet {
  std::array<DVec3, 3> at;
  DVec3 area_vector() const { return 0.5 * glm::cross(at[1] - at[0], at[2] - at[0]); }
};

std::vector<Facet> facets_of(const ShapeStore& shape) {
  std::vector<Facet> result;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const GeometryRecord& r = shape.record;
    result.push_back({DVec3(r.position(a)), DVec3(r.position(b)), DVec3(r.position(c))});
  };
  if (shape.record.kind == GeometryRecord::Kind::triangles)
    for (const auto& [a, b, c] : shape.triangles) add(a, b, c);
  if (shape.record.kind == GeometryRecord::Kind::patches)
    for (const auto& [a, b, c, d] : shape.patches) {
      add(a, b, c);
      add(b, d, c);
    }
  return result;
}

// A pane whose faces lie in parallel planes.
struct FlatPane {
  ShapeStore* shape = nullptr;
  DVec3 centre{0.0};
  double area = 0;  // of one face, m²
  std::vector<PaneFace> faces;

  double reach2() const { return 0.01 * area; }
  bool belongs_with(const FlatPane& other) const {
    const DVec3 way = other.centre - centre;
    return std::fabs(area - other.area) <= 0.1 * area && glm::dot(way, way) <= reach2() &&
           std::fabs(glm::dot(faces[0].normal, other.faces[0].normal)) > 1 - 1e-6;
  }
};

// Nullopt if less than nine tenths of the pane's area are parallel.
std::optional<FlatPane> flat_pane(ShapeStore& shape) {
  const std::vector<Facet> triangles = facets_of(shape);
  const auto area_of = [](const Facet& t) { return glm::length(t.area_vector()); };
  const auto largest = std::max_element(triangles.begin(), triangles.end(),
                                        [&](const Facet& a, const Facet& b) { return area_of(a) < area_of(b); });
  if (largest == triangles.end() || !(area_of(*largest) > 0)) return {};
  const DVec3 axis = largest->area_vector() / area_of(*largest);
  struct Part {
    double offset;
    const Facet* triangle;
  };
  std::vector<Part> parts;
  double all = 0, parallel = 0;
  for (const Facet& t : triangles) {
    all += area_of(t);
    if (std::fabs(glm::dot(t.area_vector(), axis)) < 0.999 * area_of(t)) continue;
    parallel += area_of(t);
    parts.push_back({glm::dot((t.at[0] + t.at[1] + t.at[2]) / 3.0, axis), &t});
  }
  if (!(parallel > 0.9 * all)) return {};
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.offset < b.offset; });
  const Bounds box = shape.bounds();
  const double margin =
      rounding * static_cast<double>(max_component(glm::max(abs(box.min), abs(box.max)) + box.extent()));
  FlatPane pane{&shape, DVec3(box.centre()), 0, {}};
  for (const Part& part : parts) {
    if (pane.faces.empty() || part.offset > pane.faces.back().offset + margin)
      pane.faces.push_back({axis, part.offset, margin, {}, *shape.pane});
    for (const DVec3& p : part.triangle->at) pane.faces.back().box.extend(Point(p));
  }
  for (PaneFace& face : pane.faces) {
    face.box.min -= Vec3(static_cast<float>(margin));
    face.box.max += Vec3(static_cast<float>(margin));
  }
  pane.area = parallel / static_cast<double>(pane.faces.size());
  return pane;
}

// Sets of panes, each of which knows the first of its window: union-find.
class Windows {
 public:
  explicit Windows(std::size_t panes) : first_(panes) { std::iota(first_.begin(), first_.end(), std::size_t{0}); }
  std::size_t of(std::size_t pane) {
    while (first_[pane] != pane) pane = first_[pane] = first_[first_[pane]];
    return pane;
  }
  void join(std::size_t a, std::size_t b) { first_[of(a)] = of(b); }

 private:
  std::vector<std::size_t> first_;
};

// Reflectance of one face of a pane, or of both of a thin one, for rays that are not refracted between them.
double reflectance(const description::Pane& pane, double cos) {
  const auto c = static_cast<float>(std::min(1.0, cos));
  return static_cast<double>(pane.thin ? thin_reflectance({pane.eta}, c)[0]
                                       : fresnel_dielectric(c, pane.eta).reflectance);
}

bool is_inside(const Bounds& box, const DVec3& p) {
  const Point q(p);
  return glm::all(glm::greaterThanEqual(q, box.min)) && glm::all(glm::lessThanEqual(q, box.max));
}

}  // namespace

void join_windows(std::span<const std::unique_ptr<ShapeStore>> shapes) {
  std::vector<FlatPane> panes;
  for (const std::unique_ptr<ShapeStore>& shape : shapes)
    if (shape->pane)
      if (std::optional<FlatPane> pane = flat_pane(*shape)) panes.push_back(std::move(*pane));
  // Sorted by centre, so that only neighbours are compared.
  std::sort(panes.begin(), panes.end(), [](const FlatPane& a, const FlatPane& b) { return a.centre.x < b.centre.x; });
  Windows windows(panes.size());
  for (std::size_t a = 0; a < panes.size(); ++a) {
    const double reach = std::sqrt(panes[a].reach2());
    for (std::size_t b = a + 1; b < panes.size() && panes[b].centre.x - panes[a].centre.x <= reach; ++b)
      if (panes[a].belongs_with(panes[b])) windows.join(a, b);
  }
  std::vector<std::shared_ptr<std::vector<PaneFace>>> faces(panes.size());
  for (std::size_t i = 0; i < panes.size(); ++i) {
    std::shared_ptr<std::vector<PaneFace>>& all = faces[windows.of(i)];
    if (!all) all = std::make_shared<std::vector<PaneFace>>();
    all->insert(all->end(), panes[i].faces.begin(), panes[i].faces.end());
    panes[i].shape->window = all;
  }
}

float reflectance_of_pane(const ShapeStore& pane, const Point& origin, const Vec3& direction,
                          const SurfaceGeometry& hit) {
  const DVec3 o(origin), d(glm::normalize(DVec3(direction))), p(hit.position);
  const double own = reflectance(*pane.pane, std::fabs(glm::dot(DVec3(hit.normal), d)));
  if (!(own < 1)) return 1;
  if (!pane.window) return static_cast<float>(own);
  double before = 0;  // Σ R / (1 - R) of the faces that the ray has passed
  bool is_on_face = false;
  for (const PaneFace& face : *pane.window) {
    const double height = glm::dot(o, face.normal) - face.offset, end = glm::dot(p, face.normal) - face.offset;
    if (std::fabs(height) <= face.margin && is_inside(face.box, o)) return 0;
    if (std::fabs(end) <= face.margin) {
      is_on_face = is_on_face || is_inside(face.box, p);
      continue;
    }
    if (height * end > 0 || !is_inside(face.box, o + height / (height - end) * (p - o))) continue;
    const double r = reflectance(face.glass, std::fabs(glm::dot(face.normal, d)));
    before += r / (1 - r);
  }
  if (!is_on_face) return static_cast<float>(own);  // the edge of a pane
  const double here = own / (1 - own);
  return static_cast<float>(here / (1 + before + here));
}

}  // namespace lanthorn
