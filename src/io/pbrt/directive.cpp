// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/directive.h"

#include <algorithm>

namespace lanthorn::pbrt {

namespace {

constexpr std::string_view kind_or_name = "a kind or name in quotes";
constexpr std::string_view a_name = "a name in quotes";
constexpr std::string_view coordinates = "the name of a coordinate system";

constexpr std::array<DirectiveForm, 45> forms = {{
    {"Accelerator", 0, {"the kind of accelerator in quotes"}, true},
    {"ActiveTransform"},
    {"AreaLightSource", 0, {kind_or_name}, true},
    {"Attribute", 0, {kind_or_name}, true},
    {"AttributeBegin"},
    {"AttributeEnd"},
    {"Camera", 0, {kind_or_name}, true},
    {"ColorSpace", 0, {a_name}},
    {"ConcatTransform", 16},
    {"CoordSysTransform", 0, {coordinates}},
    {"CoordinateSystem", 0, {coordinates}},
    {"Film", 0, {kind_or_name}, true},
    {"Identity"},
    {"Import", 0, {"a file name in quotes"}},
    {"Include", 0, {"a file name in quotes"}},
    {"Integrator", 0, {kind_or_name}, true},
    {"LightSource", 0, {kind_or_name}, true},
    {"LookAt", 9},
    {"MakeNamedMaterial", 0, {kind_or_name}, true},
    {"MakeNamedMedium", 0, {kind_or_name}, true},
    {"Material", 0, {kind_or_name}, true},
    {"MediumInterface", 0, {"the name of a medium in quotes"}},
    {"NamedMaterial", 0, {a_name}},
    {"ObjectBegin", 0, {a_name}},
    {"ObjectEnd"},
    {"ObjectInstance", 0, {a_name}},
    {"Option", 0, {"the name of an option"}},
    {"PixelFilter", 0, {kind_or_name}, true},
    {"Renderer", 0, {kind_or_name}, true, true},
    {"ReverseOrientation"},
    {"Rotate", 4},
    {"Sampler", 0, {kind_or_name}, true},
    {"Scale", 3},
    {"Shape", 0, {kind_or_name}, true},
    {"SurfaceIntegrator", 0, {kind_or_name}, true, true},
    {"Texture",
     0,
     {"the texture's name in quotes", "the texture's type in quotes", "the kind of texture in quotes"},
     true},
    {"Transform", 16},
    {"TransformBegin"},
    {"TransformEnd"},
    {"TransformTimes", 2},
    {"Translate", 3},
    {"Volume", 0, {kind_or_name}, true, true},
    {"VolumeIntegrator", 0, {kind_or_name}, true, true},
    {"WorldBegin"},
    {"WorldEnd"},
}};

constexpr bool is_before(const DirectiveForm& form, std::string_view name) { return form.name < name; }
static_assert(std::is_sorted(forms.begin(), forms.end(),
                             [](const DirectiveForm& a, const DirectiveForm& b) { return is_before(a, b.name); }));

}  // namespace

const DirectiveForm* find_form(std::string_view name) {
  const auto* it = std::lower_bound(forms.begin(), forms.end(), name, is_before);
  return it != forms.end() && it->name == name ? it : nullptr;
}

}  // namespace lanthorn::pbrt
