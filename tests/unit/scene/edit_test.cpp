// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A scene that shares parts with another one equals the scene built from its description alone, bit for bit.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <utility>
#include <variant>

#include "lanthorn/scene.h"
#include "math/hash.h"
#include "scene/scene.h"
#include "scene/scene_data.h"
#include "support/edited.h"
#include "support/error_text.h"
#include "support/temporary_dir.h"

namespace lanthorn::edit_test {
namespace {

// A floor, a textured wall, an emitting triangle, and two kinds of instances: of static shapes and of moving ones.
const std::string text = R"(
Camera "perspective"
WorldBegin
LightSource "point" "point3 from" [0 3 0] "rgb I" [1 2 3]
LightSource "distant" "point3 from" [0 1 0.5] "point3 to" [0 0 0] "rgb L" [1 1 1]
LightSource "infinite" "rgb L" [.1 .2 .3]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [4 3 2]
  Shape "trianglemesh" "point3 P" [-1 2 -1  1 2 -1  0 2 1] "integer indices" [0 1 2]
AttributeEnd
Texture "checks" "spectrum" "checkerboard" "rgb tex1" [.9 .1 .1] "rgb tex2" [.1 .1 .9]
MakeNamedMaterial "wall" "string type" "diffuse" "texture reflectance" "checks"
MakeNamedMaterial "brass" "string type" "conductor" "spectrum eta" "metal-CuZn-eta" "spectrum k" "metal-CuZn-k"
  "float roughness" [.3]
Material "diffuse" "rgb reflectance" [.5 .5 .5]
Shape "trianglemesh" "point3 P" [-4 0 -4  4 0 -4  4 0 4  -4 0 4] "integer indices" [0 1 2 0 2 3]
NamedMaterial "wall"
Shape "trianglemesh" "point3 P" [-4 0 -4  4 0 -4  4 4 -4  -4 4 -4] "point2 uv" [0 0 4 0 4 4 0 4] "integer indices" [0 1 2 0 2 3]
ObjectBegin "thing"
  NamedMaterial "brass"
  Shape "sphere" "float radius" [.5]
  Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0] "integer indices" [0 1 2]
ObjectEnd
ObjectBegin "mover"
  NamedMaterial "wall"
  ActiveTransform EndTime
  Translate 0 .5 0
  ActiveTransform All
  Shape "sphere" "float radius" [.25]
ObjectEnd
AttributeBegin
  Translate 1 .5 0
  ObjectInstance "thing"
AttributeEnd
AttributeBegin
  Translate -1.5 .5 0
  Rotate 30 0 1 0
  ObjectInstance "thing"
AttributeEnd
AttributeBegin
  Translate 0 1 1
  ObjectInstance "mover"
AttributeEnd
)";

SceneDescription describe() { return read_pbrt_string(text, ".", "edit.pbrt"); }

// Two scenes are equal in everything that rays and lights can tell.
void expect_equal(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.bounds().min, b.bounds().min);
  EXPECT_EQ(a.bounds().max, b.bounds().max);
  EXPECT_EQ(a.bounding_sphere().radius, b.bounding_sphere().radius);
  EXPECT_EQ(a.largest_radiance(), b.largest_radiance());
  EXPECT_EQ(a.has_measured_spectra(), b.has_measured_spectra());
  EXPECT_EQ(a.has_dispersion(), b.has_dispersion());
  ASSERT_EQ(a.lights().size(), b.lights().size());
  const Wavelengths w = Wavelengths::rgb(0.5f);
  HashRng rng(7);
  for (std::uint32_t i = 0; i < a.lights().size(); ++i) {
    EXPECT_EQ(power(a.lights()[i]), power(b.lights()[i])) << i;
    EXPECT_EQ(a.light_media(i).inside, b.light_media(i).inside) << i;
    EXPECT_EQ(a.light_location(i).line, b.light_location(i).line);
    const auto from = [&](const Scene& scene) {
      return sample_direct(scene.lights()[i], {0.3f, 0.2f, 0.1f}, {0.3f, 0.6f}, w);
    };
    ASSERT_EQ(from(a).has_value(), from(b).has_value());
    if (from(a)) {
      EXPECT_EQ(from(a)->radiance.v, from(b)->radiance.v) << i;
    }
    const Vec2 u = rng.next2();
    const auto pick = [&](const Scene& scene) {
      return scene.light_bvh().sample({0.3f, 0.2f, 0.1f}, {0, 1, 0}, u.x)->light;
    };
    EXPECT_EQ(pick(a), pick(b));
  }
  for (int i = 0; i < 2000; ++i) {
    const Point o(6 * rng.next() - 3, 3 * rng.next() + 0.1f, 6 * rng.next() - 3);
    const Vec3 d(rng.next() - 0.5f, rng.next() - 0.5f, rng.next() - 0.5f);
    const Ray ray{o, glm::normalize(d), infinity, rng.next()};
    const auto p = a.intersect(ray, w), q = b.intersect(ray, w);
    ASSERT_EQ(p.has_value(), q.has_value());
    ASSERT_EQ(a.visible(ray), b.visible(ray));
    if (!p) continue;
    ASSERT_EQ(p->position, q->position);
    ASSERT_EQ(p->normal, q->normal);
    ASSERT_EQ(p->light, q->light);
    ASSERT_EQ(p->shading.n, q->shading.n);
    ASSERT_EQ(p->shading.s, q->shading.s);
    ASSERT_EQ(albedo(p->bsdf, {0, 0, 1}).v, albedo(q->bsdf, {0, 0, 1}).v);
  }
}

using Edit = void (*)(SceneDescription&);

description::Material& material_named(SceneDescription& scene, const std::string& name) {
  for (description::Material& material : scene.materials)
    if (material.name == name) return material;
  throw Error("there is no material " + name);
}

void leave(SceneDescription&) {}
void swap_materials(SceneDescription& scene) {
  std::swap(material_named(scene, "wall"), material_named(scene, "brass"));
}
// The shading frame depends on the surface's parametrisation.
void brush_wall(SceneDescription& scene) {
  description::ConductorMaterial brushed;
  brushed.roughness = {{0.1f, {}}, {0.5f, {}}, true};
  description::Material& wall = material_named(scene, "wall");
  wall = {};
  wall.node = brushed;
}
void change_lights(SceneDescription& scene) {
  std::get<description::PointLight>(scene.lights[0].node).from = {1, 2, 1};
  scene.area_lights[0].scale = 3;
}
// The lamp is not the last light: the others get another index.
void add_lamp(SceneDescription& scene) {
  description::Light lamp = scene.lights[0];
  std::get<description::PointLight>(lamp.node).from = {-1, 1, 1};
  scene.lights.edit().insert(scene.lights.begin() + 1, lamp);
}
void move_instances(SceneDescription& scene) {
  scene.instances[0].object_to_world = AnimatedTransform(translate({2, 5, 0}) * rotate(40, {1, 1, 0}));
  scene.instances[2].object_to_world = AnimatedTransform(translate({-0.5f, 1, 1}));
}

SharedScene rebuilt(std::initializer_list<Edit> edits) {
  SceneDescription description = describe();
  for (const Edit edit : edits) edit(description);
  return build_scene(std::move(description));
}

TEST(SceneEdit, EachEditIsLikeBuildingAnew) {
  const SharedScene scene = build_scene(describe());
  for (const Edit edit : {&leave, &swap_materials, &brush_wall, &change_lights, &add_lamp, &move_instances})
    expect_equal(*test::edited(*scene, edit), *rebuilt({edit}));
  expect_equal(*scene, *rebuilt({}));  // the original is unchanged
}

TEST(SceneEdit, EditsOfEditsOutliveWhatTheyComeFrom) {
  SharedScene scene = build_scene(describe());
  for (const Edit edit : {&swap_materials, &change_lights, &add_lamp, &move_instances})
    scene = test::edited(*scene, edit);
  expect_equal(*scene, *rebuilt({&swap_materials, &change_lights, &add_lamp, &move_instances}));
}

TEST(SceneEdit, PartsThatDidNotChangeAreShared) {
  const SharedScene scene = build_scene(describe());
  const SceneData& old = *scene->data();
  const auto data_after = [&](Edit edit) { return test::edited(*scene, edit)->data(); };
  for (const Edit edit : {&leave, Edit([](SceneDescription& d) { d.view.camera.camera_to_world = {}; })}) {
    const auto data = data_after(edit);
    EXPECT_EQ(data->materials, old.materials);
    EXPECT_EQ(data->media, old.media);
    EXPECT_EQ(data->shapes, old.shapes);
    EXPECT_EQ(data->placed, old.placed);
    EXPECT_EQ(data->geometry, old.geometry);
    EXPECT_EQ(data->lights, old.lights);
  }
  const auto lit = data_after(&add_lamp);
  EXPECT_EQ(lit->materials, old.materials);
  EXPECT_EQ(lit->media, old.media);
  EXPECT_EQ(lit->shapes, old.shapes);
  EXPECT_EQ(lit->geometry, old.geometry);
  EXPECT_NE(lit->lights, old.lights);
  const auto painted = data_after(&swap_materials);
  EXPECT_EQ(painted->shapes, old.shapes);
  EXPECT_EQ(painted->placed, old.placed);
  EXPECT_EQ(painted->lights, old.lights);
  EXPECT_NE(painted->materials, old.materials);
  const auto moved = data_after(&move_instances);
  EXPECT_EQ(moved->shapes, old.shapes);
  EXPECT_EQ(moved->materials, old.materials);
  EXPECT_NE(moved->geometry, old.geometry);
}

// The description that was built first keeps its meshes if it has a copy.
TEST(SceneEdit, MeshesOfACopyServeForNewGeometry) {
  const SceneDescription all = describe();
  const SharedScene scene = build_scene(all);
  SceneDescription changed = all;
  material_named(changed, "wall").node = description::InterfaceMaterial{};
  SceneDescription expected = changed;
  expect_equal(*build_scene(std::move(changed), scene), *build_scene(std::move(expected)));
  EXPECT_EQ(build_scene(all, scene)->data()->geometry, scene->data()->geometry);
}

// An interface between equal media has no surface.
TEST(SceneEdit, AnInterfaceThatBecomesASurfaceIsSeen) {
  const SceneDescription all =
      read_pbrt_string("WorldBegin\nMaterial \"interface\"\nShape \"sphere\"\n", ".", "s.pbrt");
  const SharedScene scene = build_scene(all);
  const Ray ray{{0, 0, -5}, {0, 0, 1}, infinity, 0};
  EXPECT_TRUE(scene->visible(ray));
  SceneDescription painted = all;
  painted.materials.back().node = description::DiffuseMaterial{};
  EXPECT_FALSE(build_scene(std::move(painted), scene)->visible(ray));
}

// Whether a light inside a shape is in its medium depends on whether the surface lets light pass.
TEST(SceneEdit, MaterialsDecideInWhichMediumALightIs) {
  const SharedScene scene = build_scene(read_pbrt_string(R"(WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous"
LightSource "point"
MediumInterface "fog" ""
Material "diffuse"
Shape "sphere"
)",
                                                         ".", "s.pbrt"));
  const auto glass = [](SceneDescription& description) {
    description.materials.back().node = description::DielectricMaterial{};
  };
  const SharedScene edited = test::edited(*scene, glass);
  EXPECT_NE(edited->light_media(0).outside, scene->light_media(0).outside);
  EXPECT_EQ(edited->light_media(0).outside, MediumId(1));
}

TEST(SceneEdit, MediaInsideMaterialsMustExist) {
  SceneDescription description = describe();
  description.materials[0].interior = 5;
  EXPECT_THROW(build_scene(std::move(description)), Error);
}

// A ball of fog with one light inside and one beside it. Edits move the other light into the fog, or the fog from one
// light to the other.
TEST(SceneEdit, LightsStayInTheMediumAroundThem) {
  const SharedScene scene = build_scene(read_pbrt_string(
      R"(Camera "perspective"
WorldBegin
MakeNamedMedium "fog" "string type" "homogeneous"
LightSource "point"
LightSource "point" "point3 from" [3 0 0]
ObjectBegin "ball"
MediumInterface "fog" "" Material "interface" Shape "sphere"
ObjectEnd
ObjectInstance "ball"
)",
      ".", "fog.pbrt"));
  const auto in_fog = [](const Scene& s) {
    return std::pair(s.light_media(0).outside == MediumId(1), s.light_media(1).outside == MediumId(1));
  };
  EXPECT_EQ(in_fog(*scene), std::pair(true, false));
  const SharedScene light = test::edited(*scene, [](SceneDescription& description) {
    std::get<description::PointLight>(description.lights[1].node).from = {0.5f, 0, 0};
  });
  const SharedScene fog = test::edited(*scene, [](SceneDescription& description) {
    description.instances[0].object_to_world = AnimatedTransform(translate({3, 0, 0}));
  });
  EXPECT_EQ(in_fog(*light), std::pair(true, true));
  EXPECT_EQ(in_fog(*fog), std::pair(false, true));
}

TEST(SceneEdit, ImagesAreNotReadAgain) {
  const test::TemporaryDir dir;
  const std::string image = dir.write("a.pfm", std::string("PF\n1 1\n-1\n") + std::string(12, '\0'));
  const SharedScene scene = build_scene(read_pbrt_string(R"(WorldBegin
Texture "t" "spectrum" "imagemap" "string filename" ")" + image +
                                                             R"("
Material "diffuse" "texture reflectance" "t"
Shape "sphere"
)",
                                                         ".", "image.pbrt"));
  std::filesystem::remove(image);
  // New materials look their images up.
  EXPECT_NO_THROW(test::edited(*scene, [](SceneDescription& description) { description.materials.edit(); }));
}

// Three environments between other lights, and a medium that emits. Environments keep their order, and the medium comes
// last.
SceneDescription under_many_skies() {
  return read_pbrt_string(R"(
Camera "perspective"
MakeNamedMedium "flame" "string type" "homogeneous" "rgb Le" [2 1 .5] "rgb sigma_a" [1 1 1] "rgb sigma_s" [.1 .1 .1]
WorldBegin
LightSource "point" "point3 from" [0 3 0] "rgb I" [1 2 3]
LightSource "infinite" "rgb L" [.1 .2 .3]
LightSource "distant" "rgb L" [3 2 1]
LightSource "infinite" "rgb L" [.3 .2 .1]
LightSource "spot" "rgb I" [1 1 4]
LightSource "infinite" "rgb L" [0 0 .1]
Shape "trianglemesh" "point3 P" [-4 0 -4  4 0 -4  4 0 4  -4 0 4] "integer indices" [0 1 2 0 2 3]
MediumInterface "flame" ""
Material "interface"
Shape "sphere"
)",
                          ".", "skies.pbrt");
}

TEST(SceneEdit, AnEnvironmentIsLikeThatOfTheDescription) {
  for (SceneDescription (*describe_scene)() : {&describe, &under_many_skies}) {
    const SharedScene scene = build_scene(describe_scene());
    const auto expect_like_built = [&](const Scene& edited, const EnvironmentChoice& choice) {
      SceneDescription wanted = describe_scene();
      replace_environment(wanted, choice);
      expect_equal(edited, *build_scene(std::move(wanted)));
    };
    const auto in = [](const Scene& s, const EnvironmentChoice& choice) {
      return test::edited(s, [&](SceneDescription& description) { replace_environment(description, choice); });
    };
    SharedScene edited = scene;
    for (const EnvironmentChoice& choice :
         {EnvironmentChoice{.source = "studio"}, EnvironmentChoice{.source = "studio", .rotation = 70, .scale = 3},
          EnvironmentChoice{.source = "overcast", .up = UpAxis::z}, EnvironmentChoice{}}) {
      edited = in(*edited, choice);
      expect_like_built(*edited, choice);
      expect_like_built(*in(*scene, choice), choice);
    }
    expect_equal(*edited, *scene);
  }
}

TEST(SceneEdit, AnEnvironmentIsReadOnce) {
  const test::TemporaryDir dir;
  const std::string sky = dir.write("sky.pfm", "PF\n2 1\n-1\n" + std::string(24, '\x3f'));
  const SharedScene scene = build_scene(describe());
  const auto image_of = [](const SharedScene& s) {
    for (const Light& light : s->lights())
      if (const auto* environment = std::get_if<ImageSky>(&light)) return environment->profile.image;
    return static_cast<const SphericalImage*>(nullptr);
  };
  const auto in = [](const Scene& s, const EnvironmentChoice& choice) {
    return test::edited(s, [&](SceneDescription& description) { replace_environment(description, choice); });
  };
  const SharedScene first = in(*scene, {.source = sky});
  std::filesystem::remove(sky);
  const SharedScene turned = in(*first, {.source = sky, .rotation = 90});
  ASSERT_NE(image_of(first), nullptr);
  EXPECT_EQ(image_of(turned), image_of(first));
  EXPECT_THROW(in(*scene, {.source = sky}), Error);
}

TEST(SceneEdit, WhatNeedsNewGeometryIsRefusedWithoutMeshes) {
  const SharedScene scene = build_scene(describe());
  const auto error_of = [&](Edit edit) { return test::error_text([&] { test::edited(*scene, edit); }); };
  EXPECT_NE(error_of([](SceneDescription& description) {
              material_named(description, "wall").node = description::InterfaceMaterial{};
            }).find("build the scene again"),
            std::string::npos);
  EXPECT_NE(error_of([](SceneDescription& description) {
              description.instances[1].object_to_world = AnimatedTransform(scale({0, 1, 1}));
            }).find("is singular"),
            std::string::npos);
  const auto read_again = "read the scene's file again";
  EXPECT_NE(error_of([](SceneDescription& description) { description.shapes.edit(); }).find(read_again),
            std::string::npos);
  EXPECT_NE(test::error_text([&] { build_scene(scene->description()); }).find(read_again), std::string::npos);
}

TEST(SceneEdit, StatesOfEditedScenesAreNotThoseOfTheFile) {
  const SharedScene scene = build_scene(describe());
  const std::uint64_t own = description_of(*scene).hash;
  const SharedScene a = test::edited(*scene, &change_lights), b = test::edited(*scene, &change_lights);
  EXPECT_NE(description_of(*a).hash, own);
  EXPECT_NE(description_of(*a).hash, description_of(*b).hash);
  // The same for an edited description of the file, after another edit.
  SceneDescription moved = description_of(*scene);
  move_instances(moved);
  EXPECT_NE(description_of(*build_scene(std::move(moved), a)).hash, own);
  EXPECT_EQ(description_of(*test::edited(*scene, &leave)).hash, own);
  EXPECT_EQ(description_of(*test::edited(*a, &leave)).hash, description_of(*a).hash);
}

// Each of these changes the picture, and nothing in the identity of its states but the hash says so.
TEST(SceneEdit, AChangeThatKeepsTheHashOfItsCopyGetsANumberOfItsOwn) {
  const SceneDescription all = describe();
  const SharedScene scene = build_scene(all);
  const auto look_elsewhere = [](SceneDescription& d) {
    d.view.camera.camera_to_world = AnimatedTransform(translate({1, 0, 0}));
  };
  const auto dim_in_studio = [](SceneDescription& d) {
    replace_environment(d, {.source = "studio"});
    scale_light(d.lights[0], 0.5f);
  };
  const auto widen_colours = [](SceneDescription& d) { d.color_space = ColorSpace::rec2020; };
  const auto move_shape = [](SceneDescription& d) {
    d.shapes[0].object_to_world = AnimatedTransform(translate({1, 0, 0}));
  };
  for (const Edit edit : {Edit(look_elsewhere), Edit(dim_in_studio), Edit(widen_colours), Edit(move_shape)}) {
    SceneDescription changed = all;
    edit(changed);
    EXPECT_NE(description_of(*build_scene(std::move(changed), scene)).hash, all.hash);
  }
  EXPECT_EQ(description_of(*build_scene(all, scene)).hash, all.hash);
}

// The environment is a part of the states' identity besides the hash.
TEST(SceneEdit, AnEnvironmentKeepsTheHash) {
  const SharedScene scene = build_scene(describe());
  SharedScene edited = scene;
  for (const char* source : {"studio", "overcast", ""}) {
    edited = test::edited(*edited, [&](SceneDescription& d) { replace_environment(d, {.source = source}); });
    EXPECT_EQ(description_of(*edited).hash, description_of(*scene).hash) << source;
  }
}

}  // namespace
}  // namespace lanthorn::edit_test
