// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/metallic_roughness.h"

#include <utility>

#include "math/vec.h"

namespace lanthorn {

namespace {

using namespace description;

bool is_white(const SpectrumParameter& p) {
  const auto* colour = std::get_if<RgbSpectrum>(&p.value);
  return !p.texture && colour != nullptr && colour->rgb == Rgb{1, 1, 1};
}

bool is(const FloatParameter& p, float value) { return !p.texture && p.value == value; }

class Builder {
 public:
  Builder(SceneDescription& scene, const MetallicRoughness& source, const SourceLocation& location)
      : scene_(scene), source_(source), location_(location) {}

  Index build(const std::string& name) {
    const Index result = with_metal();
    scene_.materials[result].name = name;
    return result;
  }

 private:
  Index add(decltype(Material::node) node) {
    Material& material = scene_.materials.emplace_back();
    if (!std::holds_alternative<MixMaterial>(node)) {
      material.normal_map = source_.normal_map;
      material.displacement = source_.displacement;
    }
    material.node = std::move(node);
    material.location = location_;
    return static_cast<Index>(scene_.materials.size() - 1);
  }

  FloatParameter add_texture(decltype(FloatTexture::node) node) {
    scene_.float_textures.push_back({std::move(node), location_});
    return {0, static_cast<Index>(scene_.float_textures.size() - 1)};
  }

  FloatParameter squared(const FloatParameter& x) {
    if (!x.texture) return {sqr(x.value), {}};
    return add_texture(ScaleTexture<FloatParameter>{x, x});
  }

  // GGX alpha: the square of the roughness.
  Roughness width(const FloatParameter& roughness) {
    const FloatParameter alpha = squared(roughness);
    return {alpha, alpha, false};
  }

  // KHR_materials_anisotropy: along the tangent, alpha grows to 1 with the square of the strength.
  Roughness stretched_width() {
    Roughness result = width(source_.roughness);
    if (is(source_.anisotropy, 0)) return result;
    result.u = add_texture(MixTexture<FloatParameter>{result.v, {1, {}}, squared(source_.anisotropy)});
    return result;
  }

  // White is returned as the number 1, which is exact in spectral rendering, too.
  SpectrumParameter tint() const {
    return is_white(source_.base_color) ? SpectrumParameter{1.0f, {}} : source_.base_color;
  }

  // `first` where `amount` is 0, `second` where it is 1. Builds only the materials that are needed.
  template <class First, class Second>
  Index mixed(const FloatParameter& amount, const First& first, const Second& second) {
    if (is(amount, 0)) return first();
    if (is(amount, 1)) return second();
    const std::array<Index, 2> parts{first(), second()};
    return add(MixMaterial{parts, amount});
  }

  Index with_metal() {
    return mixed(
        source_.metallic, [&] { return dielectric(); }, [&] { return metal(); });
  }

  Index metal() {
    return mixed(
        source_.iridescence,
        [&] {
          return mixed(
              source_.clearcoat,
              [&] { return add(ConductorMaterial{.reflectance = source_.base_color, .roughness = stretched_width()}); },
              [&] {
                return add(CoatedConductorMaterial{
                    .reflectance = source_.base_color, .conductor_roughness = stretched_width(), .coat = coat()});
              });
        },
        [&] { return with_coat(filmed_metal()); });
  }

  // Under a film, a metal is modelled as a dielectric of the same reflectance at normal incidence, as in
  // KHR_materials_iridescence.
  PlasticMaterial filmed_metal() {
    return {.reflectance = {0.0f, {}},
            .roughness = width(source_.roughness),
            .eta = total_reflection,
            .specular_color = source_.base_color,
            .film = source_.film};
  }

  Index dielectric() {
    return mixed(
        source_.transmission, [&] { return translucent(); }, [&] { return transparent(); });
  }

  Index translucent() {
    return mixed(
        source_.diffuse_transmission, [&] { return opaque(); },
        [&] {
          return add(DiffuseTransmissionMaterial{.reflectance = {0.0f, {}},
                                                 .transmittance = source_.diffuse_transmission_color});
        });
  }

  Index opaque() {
    return with_film([&](const std::optional<ThinFilm>& film) { return with_coat(plastic(film)); });
  }

  Index with_coat(const PlasticMaterial& base) {
    return mixed(
        source_.clearcoat, [&] { return add(base); },
        [&] {
          return add(CoatedPlasticMaterial{base, coat()});
        });
  }

  PlasticMaterial plastic(const std::optional<ThinFilm>& film) {
    PlasticMaterial result = source_.dielectric;
    result.reflectance = source_.base_color;
    result.roughness = width(source_.roughness);
    result.film = film;
    return result;
  }

  Index transparent() {
    return with_film([&](const std::optional<ThinFilm>& film) {
      if (source_.thin) return add(ThinDielectricMaterial{source_.dielectric.eta, stretched_width(), tint(), film});
      return add(DielectricMaterial{source_.dielectric.eta, stretched_width(), tint(), film});
    });
  }

  // Mixes the surfaces that `make` builds without and with the film.
  template <class Make>
  Index with_film(const Make& make) {
    return mixed(
        source_.iridescence, [&] { return make(std::nullopt); }, [&] { return make(source_.film); });
  }

  Coat coat() { return {.roughness = width(source_.clearcoat_roughness)}; }

  SceneDescription& scene_;
  const MetallicRoughness& source_;
  const SourceLocation& location_;
};

}  // namespace

Index add_material(SceneDescription& scene, const MetallicRoughness& source, const std::string& name,
                   const SourceLocation& location) {
  return Builder(scene, source, location).build(name);
}

}  // namespace lanthorn
