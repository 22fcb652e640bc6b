// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Chooses the position of the default camera for a model without camera.
#pragma once

#include <optional>
#include <vector>

#include "io/model_views.h"
#include "io/view_inside.h"
#include "lanthorn/scene_description.h"

namespace lanthorn {

struct StandInView {
  ViewFrame frame;
  float field_of_view = 40;  ///< degrees
  const char* name = "";     ///< "from the front"
  Direction up{0, 1, 0};     ///< of the model, as assumed by this view
  std::optional<ViewInside> inside{};
  bool hides_lights = false;  ///< the scene's own lights, inside meshes, light nothing visible from outside
};

/// The view that shows most of the scene's triangle meshes. Backs of materials in `one_sided` should not be shown; if
/// the scene has its own lights, sides that they do not illuminate count little. Outside views are from the front, +z,
/// and 15 degrees above, unless another of a few directions shows much more.
///
/// A room that is open on some side, with at least three walls, including floor and ceiling, is viewed from the
/// direction that shows the most separate meshes, if these are many more than from the front: through an open side,
/// possibly from above or below.
///
/// Closed rooms are viewed from inside (see `view_inside`). Chests, boxes and open rooms are viewed from outside.
///
/// Outside views stay on this side of grounds, which `Grounds` has removed from the scene.
///
/// `parts`: bounding boxes of the objects of a file that does not store each as a shape. The result does not depend on
/// the model's size.
StandInView stand_in_view(const SceneDescription& scene, const OneSided& one_sided, std::vector<Bounds> parts,
                          bool has_own_light, const std::optional<Vec3>& side_of_ground = {});

}  // namespace lanthorn
