// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Where the stand-in camera of a model stands.
#pragma once

#include <optional>

#include "io/model_views.h"
#include "lanthorn/scene_description.h"

namespace lanthorn {

struct StandInView {
  /// In a closed room.
  struct Inside {
    Point eye{0};
    Point lamp{0};            ///< from where most of what the eye sees can be lit
    float lamp_radius = 0;    ///< metres; nothing is in a sphere of three times this radius
    float lamp_distance = 0;  ///< metres, typical, to what it lights
  };

  ViewFrame frame;
  float field_of_view = 40;  ///< degrees
  const char* name = "";     ///< "from the front"
  Direction up{0, 1, 0};     ///< of the model, as this view takes it
  std::optional<Inside> inside{};
  bool hides_lights = false;  ///< the scene's own lights, inside of its meshes, reach nothing that is seen from outside
};

/// The view that shows most of the scene's triangle meshes. Of the materials in `one_sided` the back should not be
/// shown, and if the scene has lights of its own, sides that they do not reach count little. From outside, it is the
/// front, +z, and 15 degrees above, unless another of a few directions shows much more.
///
/// A room that is open on some side, with at least three walls, floor and ceiling included, is seen from where the most
/// separate meshes are seen, if they are many more than from the front: through an open side, also from above or below.
///
/// From inside, if the places in the model that are surrounded by surfaces are nearly as large as the model, and
/// - the model is wider than high, nearly all that is seen from outside is a box or the back of things, and from such
///   places at least a twentieth of what is seen are not walls and are hardly seen from outside: a room; or
/// - nearly all that is seen from outside are backs that viewers do not draw, from such places hardly any are seen, and
///   the model is open nowhere: walls that face inwards, a sky; or
/// - the scene's own lights reach hardly anything that is seen from outside: lamps inside.
/// Empty rooms whose walls have outsides, and open boxes, are seen from outside.
///
/// From outside, the camera stands on this side of grounds that are not part of the scene (see `Grounds`).
///
/// Nothing depends on the model's size.
StandInView stand_in_view(const SceneDescription& scene, const OneSided& one_sided, bool has_own_light,
                          const std::optional<Vec3>& side_of_ground = {});

}  // namespace lanthorn
