// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "io/gltf/document.h"

namespace lanthorn::gltf {

/// The local transformations and morph weights of a file's nodes: at rest, or at a time of its first animation.
class Pose {
 public:
  /// At rest without `seconds`. Outside of a channel's keys, its first or last value holds. Throws Error.
  Pose(Document& document, std::optional<double> seconds);

  glm::dmat4 local_transform(std::size_t node) const;
  /// Weights of the targets of the node's mesh, one for each target; those that the file does not give are 0.
  std::vector<float> morph_weights(std::size_t node) const;

 private:
  /// Values that replace those of the node.
  struct Animated {
    std::optional<std::vector<double>> translation, rotation, scale, weights;
  };
  void animate(const Value& animation, double seconds);
  void animate_channel(const Value& animation, const Value& channel, double seconds);

  Document& document_;
  std::map<std::size_t, Animated> animated_;
};

/// The matrix of a rotation quaternion (x, y, z, w) of any length, between scale and translation.
glm::dmat4 from_parts(const glm::dvec3& translation, const std::vector<double>& rotation, const glm::dvec3& scale);

}  // namespace lanthorn::gltf
