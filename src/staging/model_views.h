// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Determines which parts of a model are visible from outside and from inside, with depth buffers of points on its
// surfaces, so that no acceleration structure has to be built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "lanthorn/scene_description.h"
#include "staging/surfaces.h"

namespace lanthorn {

/// Axes of a view in world space.
struct ViewFrame {
  Direction right{1, 0, 0}, up{0, 1, 0}, towards_eye{0, 0, 1};
};
/// Angles in degrees: azimuth from +z towards +x, elevation above the horizon. With `is_z_up`, -y takes the place of
/// +z.
ViewFrame view_from(float azimuth, float elevation, bool is_z_up = false);

/// Materials of surfaces whose back should not be shown.
struct OneSided {
  std::set<description::Index> materials = {};
  bool is_certain = false;  ///< viewers cull back faces; else faces may be wound wrongly
};

/// Sides of a surface that receive light.
struct LitSides {
  bool front = true, back = true;
};

/// Points on all triangle meshes of a scene, evenly distributed.
struct ModelSamples {
  std::vector<Surfaces::Sample> samples;
  std::vector<LitSides> lit;  ///< for each sample; empty: both sides of all samples are lit
  float spacing = 0;          ///< between samples on surfaces, metres
  Bounds bounds;
  float radius = 0;  ///< half the diagonal of `bounds`, metres
  const OneSided& one_sided;

  ModelSamples(const SceneDescription& scene, const OneSided& of_one_side);

  bool is_back(std::size_t i, const Point& eye) const;
  bool is_lit(std::size_t i, const Point& eye) const;
  /// Weight of the sample in a sum over the surfaces that an eye sees. Surfaces seen at grazing angles, backs of
  /// one-sided surfaces and unlit sides count less.
  double weight(std::size_t i, const Point& eye) const;
  /// True if the sample lies on a face of the bounding box, within this fraction of the box's extent.
  bool is_on_box(std::size_t i, float tolerance) const;
  /// True if the sample lies on clear glass or a medium interface.
  bool is_clear(std::size_t i) const { return clear_materials_.count(samples[i].material) > 0; }

 private:
  std::set<description::Index> clear_materials_;
};

constexpr float view_outside = 40, view_inside_angle = 60;  ///< fields of view, degrees

/// The samples visible to an eye outside that looks at the whole model.
class OutsideView {
 public:
  OutsideView(const ModelSamples& model, const ViewFrame& frame);

  const std::vector<std::size_t>& seen() const { return seen_; }
  /// Samples that nothing, however thin, can occlude: no sample behind a nearby wall, but surfaces at grazing angles
  /// are also missing.
  const std::vector<std::size_t>& in_front() const { return in_front_; }
  /// Sum of weights times the fraction of visible samples that are lit.
  double amount() const;
  bool is_back(std::size_t i) const { return model_.is_back(i, eye_); }
  bool is_lit(std::size_t i) const { return model_.is_lit(i, eye_); }

 private:
  const ModelSamples& model_;
  Point eye_{0};
  std::vector<std::size_t> seen_, in_front_;
};

/// The samples visible from a point inside, in all directions. Each sample covers a square of its share of the
/// surface's area, so that nearby walls have no gaps.
class Panorama {
 public:
  enum class Sight : std::uint8_t { ends_at_glass, through_glass };

  Panorama(const ModelSamples& model, const Point& eye, Sight sight = Sight::ends_at_glass);

  const Point& eye() const { return eye_; }
  const std::vector<std::size_t>& seen() const { return seen_; }
  float closed() const { return closed_; }        ///< fraction of directions in which there is a surface
  float clearance() const { return clearance_; }  ///< metres to the nearest sample

 private:
  Point eye_;
  std::vector<std::size_t> seen_;
  float closed_ = 0, clearance_ = infinity;
};

}  // namespace lanthorn
