// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// pbrt-v3's materials are sums of lobes with individual weights; pbrt-v4's are whole surfaces. The sums become mixes
// with the lobes' weights as amounts, and the reflectance of a base is chosen so that the surface has the albedo of the
// lobe:
//   pbrt-v3: Pharr, Jakob & Humphreys 2016, Physically Based Rendering, 3rd ed., chapters 8 and 9 [P16]
//   substrate: Ashikhmin & Shirley 2000, An Anisotropic Phong BRDF Model [A00]
//   disney: Burley 2015, Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering [B15]
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "io/pbrt/upgrade_parts.h"
#include "surface/fresnel.h"

namespace lanthorn::pbrt {

namespace {

constexpr float middle_grey = 0.5f;

float normal_reflectance(float eta) {
  const float root = (eta - 1) / (eta + 1);
  return root * root;
}
float eta_of(float normal_reflectance) {
  constexpr float most = 0.9f;
  const float root = std::sqrt(std::min(normal_reflectance, most));
  return (1 + root) / (1 - root);
}

// Albedo, under diffuse light, of a diffuse base under a dielectric interface: transmitted r / (1 - reflected_back r),
// with the fraction of light that passes the interface in both directions, and the fraction that it reflects back onto
// the base. An interface of GGX width alpha loses light: the formula is a fit to renders at index 1.5, within 0.03 up
// to a width of 0.8.
struct Coat {
  float transmitted = 1, reflected_back = 0;

  Coat(float eta, float alpha) {
    constexpr int steps = 64;
    float outside = 0;
    for (int i = 0; i < steps; ++i) {
      const float cos = (static_cast<float>(i) + 0.5f) / steps;
      outside += 2 * cos * fresnel_dielectric(cos, eta).reflectance / steps;
    }
    const float escaping = (1 - outside) / (eta * eta);  // reciprocity
    transmitted = (1 - outside) * escaping;
    reflected_back = (1 - escaping) / (1 + std::pow(2 * alpha, 1.6f));
  }
  float albedo(float reflectance) const { return transmitted * reflectance / (1 - reflected_back * reflectance); }
  /// The base's reflectance that gives this albedo, at most 1.
  float reflectance(float albedo) const { return std::min(albedo / (transmitted + reflected_back * albedo), 1.0f); }
};

// A diffuse reflection and, on the fraction `coated` of the surface, a coat over a base; together they have a given
// albedo.
struct Shares {
  float coated = 1;
  Coat coat;

  float bare(float albedo) const { return coated < 1 ? std::min(albedo / (1 - coated), 1.0f) : 0.0f; }
  float base(float albedo) const {
    return coat.reflectance(std::max(albedo - (1 - coated) * bare(albedo), 0.0f) / coated);
  }
};

// GGX width of a roughness [P16 §8.4.2].
float width_of(float roughness) {
  const float x = std::log(std::max(roughness, 1e-3f));
  return 1.62142f + x * (0.819955f + x * (0.1734f + x * (0.0171201f + x * 0.000640711f)));
}

class MaterialUpgrade {
 public:
  MaterialUpgrade(OldParameters& old, const std::string& name, UpgradeOutput& output)
      : old_(old), place_(old.place()), name_(name), output_(output), bump_(old.take("bumpmap")) {}

  Factor opacity() const { return opacity_; }

  Upgraded matte() {
    if (const Factor sigma = old_.take_factor("sigma").value_or(Factor{0}); !sigma.is(0))
      output_.note("the roughness \"sigma\" of the material \"matte\" is left out", place_);
    return diffuse(take("Kd", 0.5f));
  }

  Upgraded plastic() {
    const Parameter kd = take("Kd", 0.25f);
    const Factor ks = weight("Ks", 0.25f);
    return glossy(kd, ks, gloss(1.5f, roughness({"roughness"}, 0.1f)));
  }

  // Diffuse and glossy reflection, a mirror Kr and clear glass Kt, all weighted by `opacity`.
  Upgraded uber() {
    const float eta = index();
    const Factor kr = weight("Kr", 0), kt = weight("Kt", 0);
    Parameter kd = take("Kd", 0.25f);
    Factor ks = weight("Ks", 0.25f);
    opacity_ = weight("opacity", 1);
    const Gloss rough = gloss(eta, roughness({"roughness", "uroughness", "vroughness"}, 0.1f));
    // A mix takes the weight of its second material from the first; pbrt-v3 adds both.
    const Factor& smooth = kt.is(0) ? kr : kt;
    if (smooth.texture.empty() && smooth.value < 1) {
      kd = output_.scaled(std::move(kd), 1 / (1 - smooth.value));
      if (ks.texture.empty()) ks.value = std::min(ks.value / (1 - smooth.value), 1.0f);
    }
    const auto body = [&] { return glossy(kd, ks, rough); };
    if (kt.is(0)) return mixed(kr, body, [&] { return interface_alone({eta, 0, {}}); });
    return mixed(kt, body, [&] { return leaf("dielectric", {number("eta", eta)}); });
  }

  Upgraded glass() {
    const float eta = index();
    Parameters parameters = roughness({"uroughness", "vroughness"}, 0);
    if (const Parameter* kt = old_.find("Kt"); kt != nullptr && constant_colour(*kt) == Rgb{0, 0, 0}) {
      for (const char* name : {"Kr", "Kt"}) old_.take(name);
      return interface_alone(gloss(eta, std::move(parameters)));
    }
    drop_tint();
    parameters.push_back(number("eta", eta));
    return leaf("dielectric", std::move(parameters));
  }

  Upgraded metal() {
    Parameters parameters = roughness({"roughness", "uroughness", "vroughness"}, 0.01f);
    for (const char* name : {"eta", "k"})
      if (auto given = old_.take(name)) parameters.push_back(std::move(*given));
    return leaf("conductor", std::move(parameters));
  }

  Upgraded mirror() {
    Parameter kr = take("Kr", 0.9f);
    return leaf("conductor", {renamed(std::move(kr), "reflectance")});
  }

  // A diffuse base of albedo Kd (1 - Ks) under a reflection that is Ks at normal incidence and 1 at grazing angles
  // [A00]. A clear coat that reflects much more than glass would trap the base's light. Therefore the coat is glass,
  // and the rest of Ks is a mirror on a fraction of the surface. Both together have Schlick's reflectance: s + (1 - s)
  // (g + (1 - g) (1 - cos)^5) equals Ks + (1 - Ks) (1 - cos)^5 for the fraction s = (Ks - g) / (1 - g), where g is the
  // reflectance of glass.
  Upgraded substrate() {
    Parameter kd = take("Kd", 0.5f), ks = take("Ks", 0.5f);
    Parameters parameters = roughness({"uroughness", "vroughness"}, 0.1f);
    const auto base = constant_colour(kd);
    if (base && constant_colour(ks) && *base == Rgb{0, 0, 0}) {
      parameters.push_back(renamed(std::move(ks), "reflectance"));
      return leaf("conductor", std::move(parameters));
    }
    const Factor normal = output_.grey(ks, old_.entity());
    if (!normal.texture.empty())
      output_.note("a texture as \"Ks\" of the material \"substrate\" is not supported: it is 0.04", place_);
    const float f0 = normal.texture.empty() ? std::clamp(normal.value, 0.001f, 1.0f) : 0.04f;
    constexpr float mean_albedo = 0.8214f;  // of Kd (1 - Ks): the integral of [A00, eq. 5] over all directions
    constexpr float glass = 0.04f;
    const float below_glass = std::min(f0, glass);
    kd = output_.scaled(std::move(kd), mean_albedo * (1 - below_glass));
    return mixed(
        {(f0 - below_glass) / (1 - below_glass)},
        [&] { return coated_all_over(kd, gloss(eta_of(below_glass), parameters)); },
        [&] {
          parameters.push_back(rgb("reflectance", 1));
          return leaf("conductor", std::move(parameters));
        });
  }

  // Reflection and transmission, both diffuse (Kd) and glossy (Ks).
  Upgraded translucent() {
    Parameter kd = take("Kd", 0.25f);
    const Factor ks = weight("Ks", 0.25f);
    const Parameter reflect = take("reflect", 0.5f), transmit = take("transmit", 0.5f);
    Parameters rough = roughness({"roughness"}, 0.1f);
    const Factor share{ks.texture.empty() ? ks.value * (mean(reflect) + mean(transmit)) / 2 : 0.0f};
    if (!ks.texture.empty()) output_.note("a texture as \"Ks\" of the material \"translucent\" is left out", place_);
    if (share.value < 1) kd = output_.scaled(std::move(kd), 1 / (1 - share.value));
    rough.push_back(number("eta", 1.5f));
    return mixed(
        share,
        [&] {
          return leaf("diffusetransmission", {reflectance("reflectance", times(kd, reflect)),
                                              reflectance("transmittance", times(kd, transmit))});
        },
        [&] { return leaf("dielectric", std::move(rough)); });
  }

  // Metal, glass, or a glossy surface, which transmits light if it is thin [B15].
  Upgraded disney() {
    const Parameter color = take("color", 0.5f);
    const Factor metallic = old_.take_factor("metallic").value_or(Factor{0});
    const Factor glass = old_.take_factor("spectrans").value_or(Factor{0});
    const Factor through = old_.take_factor("difftrans").value_or(Factor{1});
    const bool is_thin = old_.take_bool("thin").value_or(false);
    const float eta = index();
    const Parameters rough = disney_roughness();
    note_disney();
    const auto base = [&] { return is_thin ? sheet(color, through) : coated_all_over(color, gloss(eta, rough)); };
    const auto transparent = [&] {
      Parameters parameters{number("eta", eta)};
      if (!is_thin) parameters.insert(parameters.end(), rough.begin(), rough.end());
      return leaf(is_thin ? "thindielectric" : "dielectric", std::move(parameters));
    };
    const auto metal = [&] {
      Parameters parameters = rough;
      parameters.push_back(renamed(color, "reflectance"));
      return leaf("conductor", std::move(parameters));
    };
    return mixed(
        metallic, [&] { return mixed(glass, base, transparent); }, metal);
  }

  Upgraded subsurface() {
    drop_tint();
    Parameters parameters = roughness({"uroughness", "vroughness"}, 0);
    if (auto reduced = old_.take("sigma_prime_s"))
      parameters.push_back(renamed(std::move(*reduced), "sigma_s"));  // pbrt-v2
    if (const Parameter* preset = old_.find("name"); preset != nullptr) old_.take("g");
    return leaf("subsurface", std::move(parameters));
  }

  // pbrt-v3's factor scales the mean free path, pbrt-v4's the coefficients.
  Upgraded kd_subsurface() {
    drop_tint();
    Parameters parameters = roughness({"uroughness", "vroughness"}, 0);
    parameters.push_back(renamed(take("Kd", 0.5f), "reflectance"));
    const float scale = old_.take_float("scale").value_or(1);
    parameters.push_back(output_.scaled(take("mfp", 1), scale));
    return leaf("subsurface", std::move(parameters));
  }

  Upgraded hair() {
    Parameters parameters;
    if (auto color = old_.take("color")) parameters.push_back(renamed(std::move(*color), "reflectance"));
    return {"hair", std::move(parameters)};
  }

  // "amount" is the weight of the first material in pbrt-v3, and of the second in pbrt-v4.
  Upgraded mix() {
    const Factor amount = weight("amount", 0.5f);
    const auto first = old_.take_string("namedmaterial1"), second = old_.take_string("namedmaterial2");
    if (!first || !second)
      throw Error(place_.location(), old_.entity() + " needs \"namedmaterial1\" and \"namedmaterial2\"");
    Parameter materials = string_parameter("materials", {}, place_);
    materials.values = std::vector{*second, *first};
    return {"mix", {std::move(materials), factor_parameter("amount", amount, place_)}};
  }

  Upgraded fourier() { return without_data("fourier", "bsdffile"); }
  Upgraded measured() { return without_data("measured", "filename"); }  // of pbrt-v2

  Upgraded nothing() { return {"interface", {}}; }

 private:
  Upgraded without_data(const std::string& kind, const char* file) {
    output_.note("the data of materials " + in_quotes(kind) + " cannot be read: they are replaced by \"diffuse\"",
                 place_);
    old_.take(file);
    return leaf("diffuse", {});
  }

  struct Gloss {
    float eta;
    float alpha;  ///< approximate width of the highlights
    Parameters roughness;
  };

  Parameter number(std::string name, float value) const { return float_parameter(std::move(name), value, place_); }
  Parameter rgb(std::string name, float grey) const {
    return rgb_parameter(std::move(name), {grey, grey, grey}, place_);
  }

  Parameter take(const char* name, float otherwise) {
    auto given = old_.take(name);
    return given ? std::move(*given) : rgb(name, otherwise);
  }
  Factor weight(const char* name, float otherwise) {
    const auto given = old_.take(name);
    if (!given) return {otherwise};
    Factor result = output_.grey(*given, old_.entity());
    result.value = std::clamp(result.value, 0.0f, 1.0f);
    return result;
  }
  float mean(const Parameter& p) { return output_.grey(p, old_.entity()).value; }

  // "eta" or "index". pbrt-v4 does not accept a texture for it.
  float index() {
    Factor eta{1.5f};
    for (const char* name : {"index", "eta"}) eta = old_.take_factor(name).value_or(eta);
    if (eta.texture.empty()) return eta.value;
    output_.note("a texture as index of refraction is not supported: it is 1.5", place_);
    return 1.5f;
  }

  // Parameter names for both directions, or one for each: with one or three names, the first is that for both. Numbers
  // become GGX widths; textures cannot be converted.
  Parameters roughness(const std::vector<const char*>& names, float otherwise) {
    const bool is_remapped = old_.take_bool("remaproughness").value_or(true);
    Factor both{otherwise};
    if (names.size() != 2) both = old_.take_factor(names.front()).value_or(both);
    std::array<Factor, 2> uv{both, both};
    if (names.size() > 1)
      for (std::size_t i = 0; i < 2; ++i) uv[i] = old_.take_factor(names[names.size() - 2 + i]).value_or(both);
    const bool has_texture = !uv[0].texture.empty() || !uv[1].texture.empty();
    const bool is_smooth = names.size() == 2 && uv[0].is(0) && uv[1].is(0);
    for (Factor& f : uv)
      if (is_remapped && f.texture.empty() && !is_smooth) f.value = width_of(f.value);
    if (has_texture && is_remapped)
      output_.note("for textured roughness, GGX alpha is the square root of the roughness, as in pbrt-v4", place_);
    if (has_texture && is_remapped)
      for (Factor& f : uv) f.value *= f.value;
    return widths(uv[0], uv[1], has_texture && is_remapped);
  }

  Parameters widths(const Factor& u, const Factor& v, bool is_remapped) const {
    Parameters result;
    if (u.value == v.value && u.texture == v.texture) {
      result.push_back(factor_parameter("roughness", u, place_));
    } else {
      result.push_back(factor_parameter("uroughness", u, place_));
      result.push_back(factor_parameter("vroughness", v, place_));
    }
    result.push_back(bool_parameter("remaproughness", is_remapped, place_));
    return result;
  }

  Gloss gloss(float eta, Parameters roughness) const {
    float alpha = 0;
    for (const Parameter& p : roughness)
      if (p.type == ParameterType::real) alpha = std::max(alpha, std::get<std::vector<float>>(p.values).front());
    return {std::max(eta, 1.0f), std::min(alpha, 1.0f), std::move(roughness)};
  }

  // The square of the roughness, stretched by `anisotropic` [B15].
  Parameters disney_roughness() {
    const Factor rough = old_.take_factor("roughness").value_or(Factor{0.5f});
    const float anisotropic = old_.take_factor("anisotropic").value_or(Factor{0}).value;
    const float aspect = std::sqrt(1 - 0.9f * std::clamp(anisotropic, 0.0f, 1.0f));
    const Factor width = output_.product(rough, rough, place_);
    return widths(output_.product(width, {1 / aspect}, place_), output_.product(width, {aspect}, place_), false);
  }

  void drop_tint() {
    for (const char* name : {"Kr", "Kt"})
      if (const auto given = old_.take(name); given && constant_colour(*given) != Rgb{1, 1, 1})
        output_.note(in_quotes(name) + " of " + old_.entity() + " is left out: the material is clear", given->place);
  }

  void note_disney() {
    for (const char* name : {"clearcoat", "flatness", "sheen", "speculartint"})
      if (const auto factor = old_.take_factor(name); factor && !factor->is(0))
        output_.note(in_quotes(name) + " of the material \"disney\" is left out", place_);
    for (const char* name : {"clearcoatgloss", "sheentint"}) old_.take(name);
    if (const auto distance = old_.take("scatterdistance")) {
      const auto colour = constant_colour(*distance);
      if (!colour || !(*colour == Rgb{0, 0, 0}))
        output_.note("\"scatterdistance\" of the material \"disney\" is left out", place_);
    }
  }

  // A material with its bump map. Mixes have those of their parts.
  Upgraded leaf(std::string kind, Parameters parameters) {
    if (bump_) parameters.push_back(renamed(*bump_, "displacement"));
    return {std::move(kind), std::move(parameters)};
  }

  Upgraded diffuse(const Parameter& kd) { return leaf("diffuse", {reflectance("reflectance", kd)}); }

  // Clamped to 1.
  static Parameter reflectance(std::string name, Parameter given) {
    if (const auto c = constant_colour(given))
      return rgb_parameter(std::move(name), {std::min(c->r, 1.0f), std::min(c->g, 1.0f), std::min(c->b, 1.0f)},
                           given.place);
    return renamed(std::move(given), std::move(name));
  }

  // A diffuse reflection of albedo kd and a glossy one from an interface on the fraction ks of the surface.
  Upgraded glossy(const Parameter& kd, const Factor& ks, const Gloss& gloss) {
    if (ks.is(0)) return diffuse(kd);
    const Shares shares{ks.texture.empty() ? ks.value : middle_grey, Coat(gloss.eta, gloss.alpha)};
    const auto part = [&](float (Shares::*of_albedo)(float) const) {
      if (const auto c = constant_colour(kd))
        return rgb_parameter(
            "reflectance", {(shares.*of_albedo)(c->r), (shares.*of_albedo)(c->g), (shares.*of_albedo)(c->b)}, kd.place);
      return renamed(output_.scaled(kd, (shares.*of_albedo)(middle_grey) / middle_grey), "reflectance");
    };
    return mixed(
        ks, [&] { return leaf("diffuse", {part(&Shares::bare)}); }, [&] { return coated(part(&Shares::base), gloss); });
  }

  // As `glossy`, with an interface on the whole surface. A rough interface loses so much light that a bright base
  // cannot be bright enough: then it covers only a fraction, and reflects more at normal incidence.
  Upgraded coated_all_over(const Parameter& kd, Gloss gloss) {
    const auto c = constant_colour(kd);
    const float most = std::min(c ? std::max({c->r, c->g, c->b}) : middle_grey, 0.95f);
    const float at_normal = normal_reflectance(gloss.eta);
    float share = 1;
    constexpr int iterations = 10;  // the fraction determines the index, and vice versa
    for (int i = 0; i < iterations; ++i) {
      const float reached = Coat(gloss.eta, gloss.alpha).albedo(1);
      if (share == 1 && most <= reached) break;
      share = (1 - most) / (1 - reached);
      gloss.eta = eta_of(at_normal / share);
    }
    return glossy(kd, {share}, gloss);
  }

  // A coat without an absorbing layer below the interface, with as many internal reflections as matter.
  Upgraded coated(Parameter base, const Gloss& gloss) {
    constexpr int reflections = 30;
    Parameters parameters = gloss.roughness;
    parameters.push_back(number("eta", gloss.eta));
    parameters.push_back(number("thickness", 0));
    parameters.push_back(integer_parameter("maxdepth", reflections, place_));
    parameters.push_back(std::move(base));
    return leaf("coateddiffuse", std::move(parameters));
  }
  Upgraded interface_alone(const Gloss& gloss) { return coated(rgb("reflectance", 0), gloss); }

  // A thin sheet; half of `through` is the fraction of diffuse light that it transmits.
  Upgraded sheet(const Parameter& color, const Factor& through) {
    const float share = (through.texture.empty() ? through.value : middle_grey) / 2;
    if (!through.texture.empty())
      output_.note("a texture as \"difftrans\" of the material \"disney\" is not supported: it is 0.5", place_);
    return leaf("diffusetransmission", {renamed(output_.scaled(color, 1 - share), "reflectance"),
                                        renamed(output_.scaled(color, share), "transmittance")});
  }

  // The product of two spectra, at least one of which should be a colour: otherwise the second is replaced by its mean.
  Parameter times(const Parameter& a, const Parameter& b) {
    const auto x = constant_colour(a), y = constant_colour(b);
    if (x && y) return rgb_parameter(a.name, *x * *y, a.place);
    return output_.scaled(a, mean(b));
  }

  // `first` where `amount` is 0, `second` where it is 1.
  template <class First, class Second>
  Upgraded mixed(const Factor& amount, First&& first, Second&& second) {
    if (amount.is(0)) return first();
    if (amount.is(1)) return second();
    Parameter materials = string_parameter("materials", {}, place_);
    materials.values = std::vector{define(first()), define(second())};
    return {"mix", {std::move(materials), factor_parameter("amount", amount, place_)}};
  }

  // Emits a named material. Returns its name.
  std::string define(Upgraded part) {
    std::string name = output_.fresh_name(material_space, name_ + "/" + part.kind);
    part.parameters.insert(part.parameters.begin(), string_parameter("type", part.kind, place_));
    output_.emit("MakeNamedMaterial", {name}, std::move(part.parameters), place_);
    return name;
  }

  OldParameters& old_;
  Place place_;
  const std::string& name_;
  UpgradeOutput& output_;
  std::optional<Parameter> bump_;
  Factor opacity_;
};

struct Entry {
  std::string_view kind;
  Upgraded (MaterialUpgrade::*upgrade)();
};
constexpr std::array<Entry, 17> entries = {{{"", &MaterialUpgrade::nothing},
                                            {"disney", &MaterialUpgrade::disney},
                                            {"fourier", &MaterialUpgrade::fourier},
                                            {"glass", &MaterialUpgrade::glass},
                                            {"hair", &MaterialUpgrade::hair},
                                            {"kdsubsurface", &MaterialUpgrade::kd_subsurface},
                                            {"matte", &MaterialUpgrade::matte},
                                            {"measured", &MaterialUpgrade::measured},
                                            {"metal", &MaterialUpgrade::metal},
                                            {"mirror", &MaterialUpgrade::mirror},
                                            {"mix", &MaterialUpgrade::mix},
                                            {"none", &MaterialUpgrade::nothing},
                                            {"plastic", &MaterialUpgrade::plastic},
                                            {"substrate", &MaterialUpgrade::substrate},
                                            {"subsurface", &MaterialUpgrade::subsurface},
                                            {"translucent", &MaterialUpgrade::translucent},
                                            {"uber", &MaterialUpgrade::uber}}};

constexpr std::array<std::string_view, 13> spectrum_names = {
    "Kd",    "Ks",      "Kr",      "Kt",  "opacity",         "reflect", "transmit",
    "color", "sigma_a", "sigma_s", "mfp", "scatterdistance", "amount"};
constexpr std::array<std::string_view, 16> float_names = {
    "sigma",   "roughness", "uroughness", "vroughness", "remaproughness", "eta",       "k",     "index",
    "bumpmap", "metallic",  "spectrans",  "difftrans",  "anisotropic",    "clearcoat", "sheen", "thin"};

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

bool is_material_parameter(std::string_view name) {
  return contains(spectrum_names, name) || contains(float_names, name);
}

bool is_spectrum_parameter(std::string_view name, std::string_view owner) {
  if (owner == "metal" && (name == "eta" || name == "k")) return true;
  return contains(spectrum_names, name);
}

UpgradedMaterial upgrade_material(const std::string& kind, OldParameters old, const std::string& name,
                                  UpgradeOutput& output) {
  const auto* entry = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.kind == kind; });
  if (entry == entries.end()) throw output.context().unknown("material", "Material", kind, old.place());
  MaterialUpgrade upgrade(old, name, output);
  Upgraded result = (upgrade.*entry->upgrade)();
  result.parameters = old.with_rest(std::move(result.parameters));
  return {std::move(result), upgrade.opacity()};
}

}  // namespace lanthorn::pbrt
