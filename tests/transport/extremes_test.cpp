// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Closures, phase functions, lights and cameras with extreme but valid parameters: no method loses a sample
// (`test::render_state` counts non-finite samples).
#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "integrators/integrator.h"
#include "support/render_scene.h"

namespace lanthorn::extremes_test {
namespace {

using Texts = std::vector<std::string>;

// All concatenations of one text from each of `parts`.
Texts combined(std::initializer_list<Texts> parts) {
  Texts all{""};
  for (const Texts& part : parts) {
    Texts longer;
    for (const std::string& beginning : all)
      for (const std::string& end : part) longer.push_back(beginning + end);
    all = std::move(longer);
  }
  return all;
}

// ` "TYPE NAME" [VALUE]` for each value; the empty value omits the parameter.
Texts values(const std::string& type_and_name, const Texts& all) {
  Texts result;
  for (const std::string& value : all)
    result.push_back(value.empty() ? "" : " \"" + type_and_name + "\" [" + value + "]");
  return result;
}

const std::string white = "1 1 1", black = "0 0 0";

Texts materials() {
  Texts all;
  const auto add = [&](const Texts& more) { all.insert(all.end(), more.begin(), more.end()); };
  const Texts widths = combined({values("float uroughness", {"0", ".001", ".46", "10"}),
                                 values("float vroughness", {"0", ".857"}),
                                 {R"( "bool remaproughness" [false])"}});
  const Texts indices = values("float eta", {"1", "1.0000001", "8.6", "1e10", "1e-10"});
  add(combined({{R"("diffuse")"}, values("rgb reflectance", {white, black})}));
  add(combined({{R"("diffusetransmission" "float scale" [.5])"}, values("rgb transmittance", {white, black})}));
  add(combined({{R"("conductor")"}, widths, values("rgb reflectance", {white, black, "1 0 .999999"})}));
  add(combined({{R"("conductor")"},
                widths,
                values("rgb eta", {black, "1e-10 1e-10 1e-10", "1e10 1 1e30"}),
                values("rgb k", {black, "1e10 1e30 0"})}));
  add(combined({{R"("dielectric")"}, widths, indices}));
  add(combined({{R"("thindielectric")"}, indices}));
  add(combined({{R"("coateddiffuse")"},
                widths,
                values("float eta", {"1", "1.5", "8.6", "1e6"}),
                values("float thickness", {"0", "1e10"}),
                values("rgb reflectance", {white, black})}));
  add(combined({{R"("coateddiffuse" "float uroughness" .1 "float vroughness" .3)"},
                values("float thickness", {".1", "1e6"}),
                values("rgb albedo", {white, ".5 .5 .5"}),
                values("float g", {"-1", ".5", ".9999999"}),
                values("integer maxdepth", {"1", "100"})}));
  add(combined({{R"("coatedconductor" "float interface.vroughness" .3)"},
                values("float interface.uroughness", {"0", "1"}),
                values("float interface.eta", {"1", "8.6"}),
                values("float conductor.uroughness", {"0", "1"}),
                values("rgb reflectance", {"", white, black})}));
  add(combined({{R"("hair")"},
                values("rgb sigma_a", {black, "1e10 1 1e-10"}),
                values("float beta_m", {"0", "1"}),
                values("float beta_n", {"0", "1"}),
                values("float alpha", {"-90", "2", "90"}),
                values("float eta", {"1", "10"})}));
  return all;
}

Texts media() {
  return combined({{R"("string type" "homogeneous")"},
                   values("float g", {"-.9999999", "-.99999", "1e-10", ".9999", ".99999", ".9999999"}),
                   values("rgb sigma_s", {"3 3 3", "1e-10 1000 0"}),
                   values("rgb sigma_a", {black, "1e6 0 1"})});
}

Texts lights() {
  Texts all;
  const auto add = [&](const Texts& more) { all.insert(all.end(), more.begin(), more.end()); };
  const Texts strengths{"1e-30 1e-30 1e-30", "1 0 1", "1e12 0 1"};
  add(combined({{R"(LightSource "point")"}, values("rgb I", strengths), values("point3 from", {"0 2 0", "0 0 0"})}));
  add(combined({{R"(LightSource "distant" "point3 from" [0 1 0])"}, values("rgb L", strengths)}));
  add(combined({{R"(LightSource "infinite")"}, values("rgb L", strengths)}));
  add(combined({{R"(LightSource "spot" "point3 from" [0 2 0] "point3 to" [0 0 0])"},
                values("rgb I", {white}),
                values("float coneangle", {".001", "90", "179.9"}),
                values("float conedeltaangle", {"0", ".001"})}));
  const Texts sizes = values("float radius", {"1e-10", ".0001", "10000", "1e7"});
  for (const char* shape :
       {R"(Shape "sphere")", R"(Shape "disk")", R"(Shape "cylinder")", R"(Scale 1 .001 1000 Shape "sphere")",
        R"(Shape "sphere" "float zmax" 0 "float phimax" .001)"})
    add(combined({{std::string(R"(Translate 0 1.8 0 AreaLightSource "diffuse" )") + shape}, sizes}));
  for (const char* shape : {R"("bilinearmesh")", R"("trianglemesh" "integer indices" [0 1 2 1 3 2])"})
    add(combined(
        {{std::string(R"(AreaLightSource "diffuse" Shape )") + shape},
         values("point3 P",
                {"-1e-9 1.9 -.4 1e-9 1.9 -.4 -.4 1.9 .4 .4 1.9 .4", "-.4 1.9 -.4 .4 1.9 -.4 .4 1.9 .4 -.4 1.9 .4",
                 "-.4 1.9 -.4 .4 1 -.4 -.4 1.5 .4 .4 3 .4", "0 1.9 0 0 1.9 0 0 1.9 0 .4 1.9 .4"})}));
  return all;
}

const std::string look = "LookAt 0 1 4.4  0 1 0  0 1 0 ";

Texts cameras() {
  const std::string perspective = look + R"(Camera "perspective")";
  Texts all;
  const auto add = [&](const Texts& more) { all.insert(all.end(), more.begin(), more.end()); };
  add(combined({{perspective}, values("float fov", {"1e-6", ".001", "179.9", "179.99999"})}));
  add(combined({{perspective},
                values("float lensradius", {"1e-10", "1", "10000"}),
                values("float focaldistance", {"1e-6", "4", "1e12"})}));
  add(combined({{perspective}, values("float frameaspectratio", {"1e-6", "1e6"})}));
  add(combined(
      {{look + R"(Camera "spherical")"}, values("string mapping", {R"("equalarea")", R"("equirectangular")"})}));
  add(combined({{"Scale 1e-6 1e-6 1e-6 ", "Scale 1e6 1e6 1e6 "}, {look + R"(Camera "orthographic")"}}));
  add({R"(LookAt .2 .6 .2  0 1 0  0 1 0 Camera "perspective")", R"(LookAt 0 0 0  0 1 0  1 0 0 Camera "perspective")",
       R"(LookAt 0 1.9 0  0 0 0  1 0 0 Camera "perspective" "float lensradius" .5 "float focaldistance" 1.9)"});
  return all;
}

const std::string film = R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 12
)";
const std::string camera = look + R"(Camera "perspective" "float fov" 40
)";
const std::string lamps =
    R"(AttributeBegin AreaLightSource "diffuse" "rgb L" [17 12 4] Shape "bilinearmesh" "point3 P" [-.4 1.9 -.4 .4 1.9 -.4 -.4 1.9 .4 .4 1.9 .4] AttributeEnd
LightSource "infinite" "rgb L" [.1 .2 .3]
LightSource "spot" "rgb I" [1 2 3] "point3 from" [0 1.8 .9] "point3 to" [0 0 0]
)";
const std::string floor = R"(Material "diffuse" Shape "bilinearmesh" "point3 P" [-1 0 1 1 0 1 -1 0 -1 1 0 -1]
)";

std::string things_of(const std::string& material) {
  return "Material " + material +
         R"(
AttributeBegin Translate .2 .6 .2 Shape "sphere" "float radius" .5 AttributeEnd
)" +
         R"(AttributeBegin Translate -.5 .5 0 Scale .4 .4 .4 Shape "bilinearmesh" "point3 P" [-1 -1 0 1 -1 0 -1 1 0 1 1 .5] AttributeEnd
)";
}

Texts scenes() {
  Texts all;
  for (const std::string& m : materials()) all.push_back(film + camera + "WorldBegin\n" + lamps + floor + things_of(m));
  for (const std::string& m : media())
    for (const char* boundary : {R"("interface")", R"("dielectric")"})
      all.push_back(film + camera + R"(WorldBegin
MakeNamedMedium "m" )" +
                    m + "\n" + lamps + floor + R"(MediumInterface "m" "" Material )" + boundary +
                    R"( Translate 0 .7 0 Shape "sphere" "float radius" .6
)");
  for (const std::string& light : lights())
    all.push_back(film + camera + "WorldBegin\n" + floor + things_of(R"("dielectric")") + light + "\n");
  for (const std::string& c : cameras())
    all.push_back(film + c + "\nWorldBegin\n" + lamps + floor + things_of(R"("dielectric")"));
  return all;
}

// The value that reading back the scene gives is the one that fails.
void render_by(const std::string& integrator, const std::string& text, ColorMode color) {
  SCOPED_TRACE(integrator + ":\n" + text);
  RenderOptions options = test::options_for(integrator, 2);
  options.photons = 500;
  options.color = color;
  if (test::has_parameter(integrator, "gather")) options.set["gather"] = "2";
  test::render_state(test::scene_from_text(text), options);
}

Texts methods() {
  Texts names;
  for (const IntegratorInfo& info : integrator_registry()) names.emplace_back(info.name);
  return names;
}

// The scenes are distributed over the methods: with many scenes of each kind, each method meets all kinds.
TEST(Extremes, LoseNoSamples) {
  const Texts all = methods();
  std::size_t number = 0;
  for (const std::string& text : scenes()) {
    render_by(all[number % all.size()], text, number % 3 == 0 ? ColorMode::spectral : ColorMode::rgb);
    ++number;
  }
}

class EveryExtreme : public testing::TestWithParam<std::string> {};

TEST_P(EveryExtreme, LosesNoSamples) {
  for (const std::string& text : scenes())
    for (const ColorMode color : {ColorMode::rgb, ColorMode::spectral}) render_by(GetParam(), text, color);
}

INSTANTIATE_TEST_SUITE_P(Nightly, EveryExtreme, testing::ValuesIn(methods()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace lanthorn::extremes_test
