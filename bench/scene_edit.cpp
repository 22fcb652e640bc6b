// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Time of edits of a scene of a million triangles, compared with the time to build it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "lanthorn/scene.h"

namespace {

using namespace lanthorn;

constexpr std::uint32_t side = 500;  // squares; half a million triangles each for the floor and for the object

description::TriangleMesh wavy_mesh() {
  description::TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= side; ++y)
    for (std::uint32_t x = 0; x <= side; ++x) {
      const float u = static_cast<float>(x) / side, v = static_cast<float>(y) / side;
      mesh.positions.emplace_back(u, 0.05f * std::sin(20 * u) * std::cos(20 * v), v);
    }
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t i = y * (side + 1) + x;
      mesh.triangles.push_back({i, i + 1, i + side + 2});
      mesh.triangles.push_back({i, i + side + 2, i + side + 1});
    }
  return mesh;
}

SceneDescription describe() {
  SceneDescription scene;
  scene.materials.emplace_back();
  scene.shapes.emplace_back().geometry = wavy_mesh();
  scene.objects.emplace_back().shapes.emplace_back().geometry = wavy_mesh();
  for (int i = 0; i < 100; ++i)
    scene.instances.push_back({0, AnimatedTransform(translate({static_cast<float>(i), 1, 0})), {}});
  scene.lights.push_back({description::PointLight{}, {}, {}, {}});
  return scene;
}

template <class Work>
double milliseconds(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// Prints the first time, and the least of several later ones.
template <class Work>
void report(const char* name, Work&& work) {
  const double first = milliseconds(work);
  double least = milliseconds(work);
  for (int i = 0; i < 10; ++i) least = std::min(least, milliseconds(work));
  std::printf("%-22s first %8.2f ms, then %8.2f ms\n", name, first, least);
}

}  // namespace

int main() {
  SceneDescription description = describe();
  SharedScene scene;
  std::printf("%-22s %14.2f ms\n", "build", milliseconds([&] { scene = build_scene(std::move(description)); }));
  const SceneDescription& now = description_of(*scene);
  SceneDescription material = now, light = now, instance = now;
  material.materials[0].node = description::DielectricMaterial{};
  light.lights[0] = {description::PointLight{.intensity = {2.0f, 3}, .from = {0, 5, 0}, .power = {}}, {}, {}, {}};
  instance.instances[7].object_to_world = AnimatedTransform(translate({7, 3, 0}));
  report("edit a material", [&] { build_scene(material, scene); });
  report("edit a light", [&] { build_scene(light, scene); });
  report("move an instance", [&] { build_scene(instance, scene); });
}
