// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Chooses the position of the default camera for a model without camera.
#pragma once

#include <optional>

#include "io/model_views.h"
#include "lanthorn/scene_description.h"

namespace lanthorn {

struct StandInView {
  /// The view from inside a closed room.
  struct Inside {
    Point eye{0};
    Point lamp{0};            ///< position that illuminates most of what the eye sees
    float lamp_radius = 0;    ///< metres; a sphere of three times this radius is empty
    float lamp_distance = 0;  ///< metres, typical distance to the surfaces it illuminates
  };

  ViewFrame frame;
  float field_of_view = 40;  ///< degrees
  const char* name = "";     ///< "from the front"
  Direction up{0, 1, 0};     ///< of the model, as assumed by this view
  std::optional<Inside> inside{};
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
/// The view is from inside if the space surrounded by surfaces is nearly as large as the model, and
/// - the model is wider than high, nearly everything visible from outside is a box or backs of surfaces, and at least a
///   twentieth of what is visible from inside is neither wall nor clearly visible from outside: a room; or
/// - nearly everything visible from outside is backs that viewers cull, hardly any backs are visible from inside, and
///   the model has no opening: walls that face inwards, a sky; or
/// - the scene's own lights illuminate hardly anything that is visible from outside: lamps inside.
/// Empty rooms whose walls have outer sides, and open boxes, are viewed from outside.
///
/// Outside views stay on this side of grounds, which `Grounds` has removed from the scene.
///
/// The result does not depend on the model's size.
StandInView stand_in_view(const SceneDescription& scene, const OneSided& one_sided, bool has_own_light,
                          const std::optional<Vec3>& side_of_ground = {});

}  // namespace lanthorn
