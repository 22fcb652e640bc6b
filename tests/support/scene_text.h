// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Small scenes written as pbrt text, and rays to look at them with.
#pragma once

#include <optional>
#include <string>

#include "lanthorn/scene.h"
#include "math/hash.h"
#include "math/sampling.h"
#include "scene/scene.h"

namespace lanthorn::test {

/// A scene with these directives in its world block; `head` precedes WorldBegin.
inline Scene world(const std::string& directives, const std::string& head = "", const std::string& folder = ".") {
  const std::string film = R"(Film "rgb" "integer xresolution" 64 "integer yresolution" 48
)";
  return Scene(read_pbrt_string(film + head + "\nWorldBegin\n" + directives, folder, "test scene"));
}

inline const Wavelengths white = Wavelengths::rgb(0.5f);

inline std::optional<SurfacePoint> look(const Scene& scene, const Point& origin, const Vec3& direction,
                                        float time = 0) {
  return scene.intersect({origin, normalize(direction), infinity, time}, white);
}

/// A ray from outside a ball through a random point in it.
inline Ray random_ray(HashRng& rng, const Point& centre, float radius, float time = 0) {
  const Point from = centre + 2 * radius * sample_uniform_sphere(rng.next2());
  const Vec3 inside = sample_uniform_sphere(rng.next2()) * std::cbrt(rng.next());
  return {from, normalize(centre + radius * inside - from), infinity, time};
}

}  // namespace lanthorn::test
