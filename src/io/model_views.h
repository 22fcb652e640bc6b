// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What is seen of a model from outside and from inside, by depth buffers of points on its surfaces: no ray tracer has
// to be built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "io/surfaces.h"
#include "lanthorn/scene_description.h"

namespace lanthorn {

/// Axes of a view in world space.
struct ViewFrame {
  Direction right{1, 0, 0}, up{0, 1, 0}, towards_eye{0, 0, 1};
};
/// Degrees: from +z towards +x, and above the horizon.
ViewFrame view_from(float azimuth, float elevation);

/// Materials of surfaces of which the back should not be shown.
struct OneSided {
  std::set<description::Index> materials = {};
  bool is_certain = false;  ///< viewers do not draw it; else files often have faces that are wound the wrong way
};

/// Which sides of a surface get light.
struct LitSides {
  bool front = true, back = true;
};

/// Points on all triangle meshes of a scene, evenly distributed.
struct ModelSamples {
  std::vector<Surfaces::Sample> samples;
  std::vector<LitSides> lit;  ///< of each sample; empty: all on both sides
  float spacing = 0;          ///< of samples on surfaces, metres
  Bounds bounds;
  float radius = 0;  ///< half the diagonal of `bounds`, metres
  const OneSided& one_sided;

  ModelSamples(const SceneDescription& scene, const OneSided& of_one_side);

  bool is_back(std::size_t i, const Point& eye) const;
  bool is_lit(std::size_t i, const Point& eye) const;
  /// Of the sample in a sum over what an eye sees. A surface that is seen at a slant counts less, and so do the back of
  /// a one-sided one, and a side without light.
  double weight(std::size_t i, const Point& eye) const;
  /// Whether the sample lies on a face of the bounding box, up to this part of its extent.
  bool is_on_box(std::size_t i, float tolerance) const;
  /// Whether the sample is of clear glass or of an interface.
  bool is_clear(std::size_t i) const { return clear_materials_.count(samples[i].material) > 0; }

 private:
  std::set<description::Index> clear_materials_;
};

constexpr float view_outside = 40, view_inside = 60;  ///< fields of view, degrees

/// The samples that an eye outside sees, which looks at the whole model.
class OutsideView {
 public:
  OutsideView(const ModelSamples& model, const ViewFrame& frame);

  const std::vector<std::size_t>& seen() const { return seen_; }
  /// Those which nothing thin can hide: walls do not let things near them through, but surfaces at a slant are missing.
  const std::vector<std::size_t>& in_front() const { return in_front_; }
  /// Sum of weights times the share of what is seen in which there is light.
  double amount() const;
  bool is_back(std::size_t i) const { return model_.is_back(i, eye_); }
  bool is_lit(std::size_t i) const { return model_.is_lit(i, eye_); }

 private:
  const ModelSamples& model_;
  Point eye_{0};
  std::vector<std::size_t> seen_, in_front_;
};

/// The samples that are seen from a point inside, in all directions. Samples cover squares as large as their part of
/// the surface, so that walls close although they are near.
class Panorama {
 public:
  enum class Sight : std::uint8_t { ends_at_glass, through_glass };

  Panorama(const ModelSamples& model, const Point& eye, Sight sight = Sight::ends_at_glass);

  const Point& eye() const { return eye_; }
  const std::vector<std::size_t>& seen() const { return seen_; }
  float closed() const { return closed_; }        ///< share of directions in which there is something
  float clearance() const { return clearance_; }  ///< metres to the nearest sample

 private:
  Point eye_;
  std::vector<std::size_t> seen_;
  float closed_ = 0, clearance_ = infinity;
};

}  // namespace lanthorn
