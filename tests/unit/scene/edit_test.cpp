// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// An edited scene equals the scene built from the edited description, bit for bit.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <variant>

#include "lanthorn/scene.h"
#include "math/hash.h"
#include "scene/scene.h"
#include "support/error_text.h"
#include "support/temporary_dir.h"

namespace lanthorn::edit_test {
namespace {

using description::DiffuseMaterial;

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

// The scene built from the edited description.
SharedScene rebuilt(const SceneEdits& edits) {
  SceneDescription d = describe();
  for (const auto& [i, m] : edits.materials) d.materials.at(i) = m;
  for (const auto& [i, l] : edits.area_lights) d.area_lights.at(i) = l;
  for (const auto& [i, l] : edits.lights) d.lights.at(i) = l;
  for (const auto& [i, t] : edits.instances) d.instances.at(i).object_to_world = t;
  return build_scene(std::move(d));
}

description::Index material_named(const std::string& name) {
  const SceneDescription d = describe();
  for (std::size_t i = 0; i < d.materials.size(); ++i)
    if (d.materials[i].name == name) return static_cast<description::Index>(i);
  ADD_FAILURE() << name;
  return 0;
}

SceneEdits material_edit() {
  SceneEdits edits;
  const SceneDescription d = describe();
  const description::Index wall = material_named("wall"), brass = material_named("brass");
  edits.materials[wall] = d.materials[brass];
  edits.materials[brass] = d.materials[wall];
  return edits;
}
// The shading frame depends on the surface's parametrisation.
SceneEdits brushed_edit() {
  description::ConductorMaterial brushed;
  brushed.roughness = {{0.1f, {}}, {0.5f, {}}, true};
  SceneEdits edits;
  edits.materials[material_named("wall")].node = brushed;
  return edits;
}
SceneEdits light_edit() {
  SceneEdits edits;
  const SceneDescription d = describe();
  edits.lights[0] = d.lights[0];
  std::get<description::PointLight>(edits.lights[0].node).from = {1, 2, 1};
  edits.area_lights[0] = d.area_lights[0];
  edits.area_lights[0].scale = 3;
  return edits;
}
SceneEdits instance_edit() {
  SceneEdits edits;
  edits.instances[0] = AnimatedTransform(translate({2, 5, 0}) * rotate(40, {1, 1, 0}));
  edits.instances[2] = AnimatedTransform(translate({-0.5f, 1, 1}));
  return edits;
}

TEST(SceneEdit, EachEditIsLikeBuildingAnew) {
  const SharedScene scene = build_scene(describe());
  for (const auto& edits : {SceneEdits{}, material_edit(), brushed_edit(), light_edit(), instance_edit()})
    expect_equal(*edit_scene(*scene, edits), *rebuilt(edits));
  expect_equal(*scene, *rebuilt({}));  // the original is unchanged
}

TEST(SceneEdit, EditsOfEditsOutliveWhatTheyComeFrom) {
  SharedScene scene = build_scene(describe());
  SceneEdits all = material_edit();
  scene = edit_scene(*scene, all);
  scene = edit_scene(*scene, light_edit());
  scene = edit_scene(*scene, instance_edit());
  all.lights = light_edit().lights;
  all.area_lights = light_edit().area_lights;
  all.instances = instance_edit().instances;
  expect_equal(*scene, *rebuilt(all));
}

// A ball of fog with one light inside and one beside it. Edits move the other light into the fog, or the fog from one
// light to the other.
TEST(SceneEdit, LightsStayInTheMediumAroundThem) {
  const SharedScene scene = build_scene(read_pbrt_string(
      "Camera \"perspective\"\nWorldBegin\nMakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
      "LightSource \"point\"\nLightSource \"point\" \"point3 from\" [3 0 0]\nObjectBegin \"ball\"\n"
      "MediumInterface \"fog\" \"\" Material \"interface\" Shape \"sphere\"\nObjectEnd\nObjectInstance \"ball\"\n",
      ".", "fog.pbrt"));
  const auto in_fog = [](const Scene& s) {
    return std::pair(s.light_media(0).outside == MediumId(1), s.light_media(1).outside == MediumId(1));
  };
  EXPECT_EQ(in_fog(*scene), std::pair(true, false));
  SceneEdits light, fog;
  light.lights[1] = scene->description().lights[1];
  std::get<description::PointLight>(light.lights[1].node).from = {0.5f, 0, 0};
  fog.instances[0] = AnimatedTransform(translate({3, 0, 0}));
  EXPECT_EQ(in_fog(*edit_scene(*scene, light)), std::pair(true, true));
  EXPECT_EQ(in_fog(*edit_scene(*scene, fog)), std::pair(false, true));
}

TEST(SceneEdit, ImagesAreNotReadAgain) {
  const test::TemporaryDir dir;
  const std::string image = dir.write("a.pfm", std::string("PF\n1 1\n-1\n") + std::string(12, '\0'));
  const SharedScene scene = build_scene(
      read_pbrt_string("WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + image +
                           "\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n",
                       ".", "image.pbrt"));
  std::filesystem::remove(image);
  EXPECT_NO_THROW(edit_scene(*scene, {}));
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
    SharedScene edited = scene;
    for (const EnvironmentChoice& choice :
         {EnvironmentChoice{.source = "studio"}, EnvironmentChoice{.source = "studio", .rotation = 70, .scale = 3},
          EnvironmentChoice{.source = "overcast", .up = UpAxis::z}, EnvironmentChoice{}}) {
      edited = edit_scene(*edited, {.environment = choice});
      expect_like_built(*edited, choice);
      expect_like_built(*edit_scene(*scene, {.environment = choice}), choice);
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
  const SharedScene first = edit_scene(*scene, {.environment = EnvironmentChoice{.source = sky}});
  std::filesystem::remove(sky);
  const SharedScene turned = edit_scene(*first, {.environment = EnvironmentChoice{.source = sky, .rotation = 90}});
  ASSERT_NE(image_of(first), nullptr);
  EXPECT_EQ(image_of(turned), image_of(first));
  EXPECT_THROW(edit_scene(*scene, {.environment = EnvironmentChoice{.source = sky}}), Error);
}

TEST(SceneEdit, WhatNeedsANewSceneIsRefused) {
  const SharedScene scene = build_scene(describe());
  const auto error_of = [&](const SceneEdits& edits) { return test::error_text([&] { edit_scene(*scene, edits); }); };
  SceneEdits edits;
  edits.materials[100] = {};
  EXPECT_EQ(error_of(edits), "the scene has no material with index 100");
  edits = {};
  edits.materials[material_named("wall")].node = description::InterfaceMaterial{};
  EXPECT_NE(error_of(edits).find("build the scene again"), std::string::npos);
  edits = {};
  edits.instances[1] = AnimatedTransform(scale({0, 1, 1}));
  EXPECT_NE(error_of(edits).find("is singular"), std::string::npos);
}

TEST(SceneEdit, StatesOfEditedScenesAreNotThoseOfTheFile) {
  const SharedScene scene = build_scene(describe());
  const std::uint64_t own = description_of(*scene).hash;
  const SharedScene a = edit_scene(*scene, light_edit()), b = edit_scene(*scene, light_edit());
  EXPECT_NE(description_of(*a).hash, own);
  EXPECT_NE(description_of(*a).hash, description_of(*b).hash);
}

}  // namespace
}  // namespace lanthorn::edit_test
