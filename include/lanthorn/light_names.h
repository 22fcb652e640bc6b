// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What people call the lights of a scene.
#pragma once

#include <string>
#include <vector>

#include "lanthorn/scene.h"

namespace lanthorn {

struct NamedLight {
  std::string id;  ///< `name_of_light` or `name_of_area_light`, as options have it
  std::string
      words;  ///< kind or material and place, as the scene's camera sees it: "Lamp 2, ceiling", "Point light, left"
};

/// The area lights that shapes have, then the lights, in the order of the description. Those that would have the same
/// words are numbered.
std::vector<NamedLight> lights_of(const Scene& scene);

}  // namespace lanthorn
