// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Descriptive names for the lights of a scene, for user interfaces.
#pragma once

#include <string>
#include <vector>

#include "lanthorn/scene.h"

namespace lanthorn {

struct NamedLight {
  std::string id;  ///< `name_of_light` or `name_of_area_light`, as options use it
  std::string
      words;  ///< kind or material, and place in the view of the scene's camera: "Lamp 2, ceiling", "Point light, left"
};

/// All lights in the order of the description: first the area lights that shapes use, then the others. Lights that
/// would have equal words are numbered.
std::vector<NamedLight> lights_of(const Scene& scene);

}  // namespace lanthorn
