// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "support/scene_text.h"

namespace lanthorn::obstacles_test {
namespace {

bool contains(const Bounds& box, const Point& p) {
  for (int axis = 0; axis < 3; ++axis)
    if (p[axis] < box.min[axis] || p[axis] > box.max[axis]) return false;
  return true;
}

// A row of six matte spheres and one of glass, at a large number of places.
TEST(Obstacles, CoverGroupsInManyPlaces) {
  constexpr int places = 60'000, columns = 200;
  std::string text = R"(LightSource "infinite"
ObjectBegin "row"
)";
  for (int i = 0; i < 7; ++i)
    text += std::string("Material \"") + (i == 3 ? "dielectric" : "diffuse") +
            R"(" Translate .1 0 0 Shape "sphere" "float radius" [.01]
)";
  text += "ObjectEnd\n";
  const auto corner = [](int place) { return Point(place % columns, place / columns, 0); };
  for (int place = 0; place < places; ++place)
    text += "AttributeBegin Translate " + std::to_string(place % columns) + ' ' + std::to_string(place / columns) +
            R"( 0 ObjectInstance "row" AttributeEnd
)";
  const Scene scene = test::world(text);

  const std::vector<Obstacle> obstacles = scene.obstacles();
  EXPECT_LE(obstacles.size(), 4096u);
  for (int place = 0; place < places; place += 97)
    for (int i = 0; i < 7; ++i) {
      const Point centre = corner(place) + Vec3(0.1f * static_cast<float>(i + 1), 0, 0);
      EXPECT_TRUE(std::any_of(obstacles.begin(), obstacles.end(),
                              [&](const Obstacle& o) { return o.is_specular == (i == 3) && contains(o.box, centre); }))
          << place << " " << i;
    }
}

}  // namespace
}  // namespace lanthorn::obstacles_test
