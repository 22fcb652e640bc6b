// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A scene's triangles are where rays hit its surfaces, and face the same way.
#include <gtest/gtest.h>

#include <string>

#include "lanthorn/scene.h"
#include "scene/scene.h"
#include "support/edited.h"

namespace lanthorn::model_test {
namespace {

SharedScene scene_of(const std::string& text) {
  return build_scene(read_pbrt_string(R"(Camera "perspective"
WorldBegin
)" + text,
                                      ".", "model.pbrt"));
}

// For each triangle, a ray from outside towards its centroid hits the scene within `tolerance` of it, on the outside.
void expect_on_surface(const Scene& scene, float tolerance) {
  const SceneModel model = model_of(scene);
  std::size_t checked = 0;
  for (const SceneModel::Instance& instance : model.instances)
    for (std::size_t m = 0; m < instance.mesh_count; ++m) {
      const SceneMesh& mesh = model.meshes[instance.first_mesh + m];
      EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
      EXPECT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
      for (const auto& triangle : mesh.triangles) {
        const auto corner = [&](std::size_t i) { return instance.to_world.point(mesh.positions.at(triangle[i])); };
        const Vec3 scaled = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
        if (length_squared(scaled) < 1e-12f) continue;  // degenerate, at the poles
        const Normal outside = glm::normalize(instance.to_world.swaps_handedness() ? -scaled : scaled);
        const Point middle = (corner(0) + corner(1) + corner(2)) / 3.0f;
        const auto hit = scene.intersect({middle + 0.05f * outside, -outside, 0.1f, 0}, Wavelengths::rgb(0.5f));
        ASSERT_TRUE(hit) << mesh.location.line;
        ASSERT_LT(glm::distance(hit->position, middle), tolerance) << mesh.location.line;
        ASSERT_GT(glm::dot(hit->normal, outside), 0.9f) << mesh.location.line;
        ++checked;
      }
    }
  EXPECT_GT(checked, 0u);
}

TEST(SceneModel, MeshesAreExact) {
  expect_on_surface(*scene_of(R"(Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0] "integer indices" [0 1 2]
ReverseOrientation
Translate 3 0 0
Scale 1 1 -2
Shape "trianglemesh" "point3 P" [0 0 0  1 0 .5  0 1 0] "integer indices" [0 1 2] "point2 uv" [0 0 1 0 0 1]
)"),
                    1e-6f);
}

TEST(SceneModel, QuadricsPatchesAndCurvesAreClose) {
  expect_on_surface(*scene_of(R"(Shape "sphere"
Translate 4 0 0
ReverseOrientation
Shape "sphere" "float zmin" -.5
Translate 4 0 0
Shape "cylinder" "float phimax" 200
Translate 4 0 0
Shape "disk" "float innerradius" .3
Translate 4 0 0
Shape "bilinearmesh" "point3 P" [0 0 0  1 0 0  0 1 0  1 1 .4]
)"),
                    4e-3f);
}

TEST(SceneModel, MirroredQuadricsFaceTheSideThatRaysCallOutside) {
  for (const char* emission : {"", R"(AreaLightSource "diffuse"
)"})
    for (const char* reverse : {"", "ReverseOrientation\n"})
      expect_on_surface(*scene_of(std::string(emission) + reverse +
                                  R"(Scale -1 1 1
Shape "sphere" "float zmin" -.5
Translate 4 0 0
Shape "cylinder" "float phimax" 200
Translate 4 0 0
Shape "disk" "float innerradius" .3
)"),
                        4e-3f);
}

TEST(SceneModel, InstancesKnowTheirPlaceAndName) {
  const SharedScene scene = scene_of(
      R"(MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [.8 .1 .1]
ObjectBegin "ball"
NamedMaterial "red"
Shape "sphere"
ObjectEnd
Translate 0 0 5
ObjectInstance "ball"
Scale -2 2 2
ObjectInstance "ball"
)");
  const SceneModel model = model_of(*scene);
  ASSERT_EQ(model.meshes.size(), 1u);
  ASSERT_EQ(model.instances.size(), 2u);
  EXPECT_EQ(model.instances[1].object, "ball");
  EXPECT_EQ(model.instances[1].instance, 1u);
  EXPECT_EQ(model.instances[1].to_world.point({1, 0, 0}), Point(-2, 0, 5));
  EXPECT_EQ(description_of(*scene).materials.at(model.meshes[0].material).name, "red");
  expect_on_surface(*scene, 1e-2f);

  const SharedScene moved = test::edited(*scene, [](SceneDescription& description) {
    description.instances[0].object_to_world = AnimatedTransform(translate({7, 0, 0}));
  });
  EXPECT_EQ(model_of(*moved).instances[0].to_world.point({0, 0, 0}), Point(7, 0, 0));
  expect_on_surface(*moved, 1e-2f);
}

}  // namespace
}  // namespace lanthorn::model_test
