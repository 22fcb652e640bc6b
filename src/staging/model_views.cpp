// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "staging/model_views.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "math/vec.h"

namespace lanthorn {

namespace {

using namespace description;

bool is_clear(const Material& material) {
  return std::holds_alternative<DielectricMaterial>(material.node) ||
         std::holds_alternative<ThinDielectricMaterial>(material.node) ||
         std::holds_alternative<InterfaceMaterial>(material.node);
}

// Nearest distances around a point, in the cells of a cube map.
class DistanceCube {
 public:
  static constexpr int cells = 24;  // along an edge of the cube's faces

  // A sample at position `p` relative to the centre, covering a square of this size.
  struct Square {
    Vec3 p{0};
    int axis = 0;
    float depth = 0;

    Square(const Vec3& from_centre, float least_depth) : p(from_centre) {
      const Vec3 size = abs(p);
      axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
      depth = std::max(size[axis], least_depth);
    }
    std::size_t at(int other, float offset) const {
      const float x = (p[(axis + other) % 3] / depth + 1) * 0.5f * cells + offset;
      return static_cast<std::size_t>(std::clamp(x, 0.0f, cells - 1.0f));
    }
    std::size_t cell(std::size_t row, std::size_t column) const {
      const std::size_t face = static_cast<std::size_t>(2 * axis) + (p[axis] < 0 ? 1 : 0);
      return (face * cells + row) * cells + column;
    }
  };

  void draw(const Square& square, float size) {
    const float half = size / square.depth * 0.5f * cells, distance = length(square.p);
    for (std::size_t row = square.at(1, -half); row <= square.at(1, half); ++row)
      for (std::size_t column = square.at(2, -half); column <= square.at(2, half); ++column) {
        float& nearest = nearest_[square.cell(row, column)];
        nearest = std::min(nearest, distance);
      }
  }
  float nearest(const Square& square) const { return nearest_[square.cell(square.at(1, 0), square.at(2, 0))]; }
  float closed() const {
    const auto open = std::count(nearest_.begin(), nearest_.end(), infinity);
    return 1 - static_cast<float>(open) / static_cast<float>(nearest_.size());
  }

 private:
  std::vector<float> nearest_ = std::vector<float>(6 * cells * cells, infinity);
};

}  // namespace

ViewFrame view_from(float azimuth, float elevation, bool is_z_up) {
  const float a = to_radians(azimuth), e = to_radians(elevation);
  ViewFrame frame;
  frame.towards_eye = {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
  frame.right = {std::cos(a), 0, -std::sin(a)};
  frame.up = cross(frame.towards_eye, frame.right);
  if (is_z_up)
    for (Direction* axis : {&frame.right, &frame.up, &frame.towards_eye}) *axis = {axis->x, -axis->z, axis->y};
  return frame;
}

ModelSamples::ModelSamples(const SceneDescription& scene, const OneSided& of_one_side) : one_sided(of_one_side) {
  constexpr std::size_t count = std::size_t{1} << 15;
  const Surfaces surfaces(scene);
  samples = surfaces.samples(count);
  spacing = static_cast<float>(std::sqrt(surfaces.area() / count));
  for (const Surfaces::Sample& s : samples) bounds.extend(s.position);
  radius = 0.5f * std::sqrt(length_squared(bounds.extent()));
  for (Index i = 0; i < scene.materials.size(); ++i)
    if (lanthorn::is_clear(scene.materials[i])) clear_materials_.insert(i);
}

bool ModelSamples::is_back(std::size_t i, const Point& eye) const {
  const Surfaces::Sample& s = samples[i];
  return dot(eye - s.position, s.normal) < 0 && one_sided.materials.count(s.material) > 0;
}

bool ModelSamples::is_lit(std::size_t i, const Point& eye) const {
  if (lit.empty()) return true;
  return dot(eye - samples[i].position, samples[i].normal) < 0 ? lit[i].back : lit[i].front;
}

double ModelSamples::weight(std::size_t i, const Point& eye) const {
  constexpr float back_weight = 0.25f, dark_weight = 0.1f;
  const float cosine = std::fabs(dot(normalize(eye - samples[i].position), samples[i].normal));
  return static_cast<double>(std::min(1.0f, 2 * cosine) * (is_back(i, eye) ? back_weight : 1) *
                             (is_lit(i, eye) ? 1 : dark_weight));
}

bool ModelSamples::is_on_box(std::size_t i, float tolerance) const {
  const Surfaces::Sample& s = samples[i];
  for (int k = 0; k < 3; ++k) {
    const float depth = std::min(s.position[k] - bounds.min[k], bounds.max[k] - s.position[k]);
    if (std::fabs(s.normal[k]) > 0.9f && depth < tolerance * bounds.extent()[k]) return true;
  }
  return false;
}

OutsideView::OutsideView(const ModelSamples& model, const ViewFrame& frame) : model_(model) {
  constexpr int cells = 48;
  const float half_angle = to_radians(view_outside / 2);
  const float distance = model.radius / std::sin(half_angle);
  eye_ = model.bounds.centre() + distance * frame.towards_eye;
  const float cell = 2 * distance * std::tan(half_angle) / cells;  // at the centre's distance
  struct Projected {
    std::size_t cell = 0;
    float depth = 0;
  };
  std::vector<Projected> projected(model.samples.size());
  std::vector<float> nearest(cells * cells, infinity);
  for (std::size_t i = 0; i < projected.size(); ++i) {
    const Vec3 p = model.samples[i].position - eye_;
    const float depth = std::max(-dot(p, frame.towards_eye), 1e-3f * distance);
    const auto column = [&](const Direction& axis) {
      const float x = dot(p, axis) * distance / depth / cell + 0.5f * cells;
      return static_cast<std::size_t>(std::clamp(x, 0.0f, cells - 1.0f));
    };
    projected[i] = {column(frame.up) * cells + column(frame.right), depth};
    nearest[projected[i].cell] = std::min(nearest[projected[i].cell], depth);
  }
  for (std::size_t i = 0; i < projected.size(); ++i) {
    const float behind = projected[i].depth - nearest[projected[i].cell];
    if (behind <= 1.5f * cell) seen_.push_back(i);
    if (behind <= 0.5f * cell) in_front_.push_back(i);
  }
}

double OutsideView::amount() const {
  double sum = 0;
  for (const std::size_t i : seen_) sum += model_.weight(i, eye_);
  const auto lit = std::count_if(in_front_.begin(), in_front_.end(), [&](std::size_t i) { return is_lit(i); });
  return in_front_.empty() ? 0 : sum * static_cast<double>(lit) / static_cast<double>(in_front_.size());
}

Panorama::Panorama(const ModelSamples& model, const Point& eye, Sight sight) : eye_(eye) {
  DistanceCube cube;
  std::vector<DistanceCube::Square> squares;
  squares.reserve(model.samples.size());
  for (std::size_t i = 0; i < model.samples.size(); ++i) {
    squares.emplace_back(model.samples[i].position - eye, 1e-6f * model.radius);
    if (sight == Sight::ends_at_glass || !model.is_clear(i)) cube.draw(squares[i], model.spacing);
  }
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const float distance = length(squares[i].p);
    clearance_ = std::min(clearance_, distance);
    if (distance <= cube.nearest(squares[i]) + 4 * distance / DistanceCube::cells + model.spacing) seen_.push_back(i);
  }
  closed_ = cube.closed();
}

}  // namespace lanthorn
