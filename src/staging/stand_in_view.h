// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Chooses the position of the default camera for a model without camera: around it or, if the model is recognised as a
// room, inside (view_inside.cpp).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "lanthorn/scene_description.h"
#include "staging/model_views.h"

namespace lanthorn {

/// A view from inside a closed room.
struct ViewInside {
  ViewFrame frame;
  Direction up{0, 1, 0};  ///< of the room
  Point eye{0};
  Point lamp{0};            ///< position that illuminates most of what the eye sees
  float lamp_radius = 0;    ///< metres; a sphere of three times this radius is empty
  float lamp_distance = 0;  ///< metres, typical distance to the surfaces it illuminates
};

/// The view from inside that shows most, if the space that surfaces surround is nearly as large as the model, and
/// - the model is wider than high, nearly everything visible from outside is walls or backs of surfaces, and at least a
///   twentieth of what is visible from inside is neither wall nor clearly visible from outside: a furnished room. It
///   may have z up, if its things lie near the lower side of z; or
/// - separate flat parts make the six sides of a box with the proportions of a room: a room, even if it is empty; or
/// - nearly everything visible from outside is backs that viewers cull, hardly any backs are visible from inside, and
///   the model has no opening: walls that face inwards, a sky; or
/// - `is_dark_outside`: the scene's own lights illuminate hardly anything that is visible from outside.
/// Rooms may have windows unless `has_open_side`: then the model is seen through that side. `parts`: bounding boxes of
/// the file's objects. `from_outside`: what is visible from around the model.
std::optional<ViewInside> view_inside(const ModelSamples& model, std::span<const Bounds> parts,
                                      std::span<const OutsideView* const> from_outside, bool is_dark_outside,
                                      bool has_open_side);

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
