// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// pbrt-v3 uses a light's spectrum as given: a black body, normalised to a maximum of 1, or samples. pbrt-v4 normalises
// it to luminance 1 and multiplies by a scale.
#include <cmath>
#include <utility>
#include <vector>

#include "io/pbrt/upgrade_parts.h"
#include "spectrum/curve.h"

namespace lanthorn::pbrt {

namespace {

// Luminance of Planck's law scaled to a maximum of 1.
float blackbody_luminance(float kelvin) {
  constexpr double wien_nm_kelvin = 2.897771955e6, second_radiation_nm_kelvin = 1.438776877e7;
  const auto planck = [&](double nm) {
    return std::pow(nm, -5) / std::expm1(second_radiation_nm_kelvin / (nm * static_cast<double>(kelvin)));
  };
  const double most = planck(wien_nm_kelvin / static_cast<double>(kelvin));
  DenseSpectrum relative;
  for (std::size_t i = 0; i < relative.values.size(); ++i)
    relative.values[i] = static_cast<float>(planck(360.0 + static_cast<double>(i)) / most);
  return luminance_of(relative);
}

float upgrade_blackbody(Parameter& p) {
  auto& values = std::get<std::vector<float>>(p.values);
  if (values.empty() || values.size() > 2 || !(values[0] > 0))
    throw Error(p.place.location(),
                "blackbody " + in_quotes(p.name) + " needs a temperature above 0 kelvin and a factor");
  const float factor = values.size() == 2 ? values[1] : 1.0f;
  if (values.size() == 2) values.pop_back();
  return factor * blackbody_luminance(values[0]);
}

// The emission of a light: the spectrum `name` and the factor "scale". Both are spectra in pbrt-v3.
class Emission {
 public:
  Emission(OldParameters& old, const char* name, UpgradeOutput& output) : spectrum_(old.take(name)) {
    if (spectrum_ && spectrum_->type == ParameterType::blackbody)
      scale_ = upgrade_blackbody(*spectrum_);
    else if (spectrum_ && spectrum_->type == ParameterType::spectrum)
      scale_ = output.luminance(*spectrum_);
    if (auto factor = old.take("scale")) multiply(*factor, name, old, output);
    for (const char* ignored : {"samples", "nsamples"}) old.take(ignored);
  }

  // If an image replaces the spectrum, the factor cannot have a colour.
  void into_scale(OldParameters& old, UpgradeOutput& output) {
    if (!spectrum_) return;
    scale_ *= output.grey(*spectrum_, old.entity()).value;
    spectrum_.reset();
  }

  Parameters parameters(Place place) {
    Parameters result;
    if (spectrum_) result.push_back(std::move(*spectrum_));
    if (scale_ != 1) result.push_back(float_parameter("scale", scale_, place));
    return result;
  }

 private:
  void multiply(Parameter& factor, const char* name, OldParameters& old, UpgradeOutput& output) {
    if (factor.type == ParameterType::real) {
      output.note("\"float scale\" of " + old.entity() + " has no effect in pbrt-v3, which expects a colour: ignored",
                  factor.place);
      return;
    }
    const auto colour = constant_colour(factor);
    const bool is_grey = colour && colour->r == colour->g && colour->g == colour->b;
    if (!colour || is_grey) {
      scale_ *= colour ? colour->r : output.luminance(factor);
      return;
    }
    const auto own = spectrum_ ? constant_colour(*spectrum_) : Rgb{1, 1, 1};
    if (own)
      spectrum_ = rgb_parameter(name, *own * *colour, factor.place);
    else
      scale_ *= output.grey(factor, old.entity()).value;
  }

  std::optional<Parameter> spectrum_;
  float scale_ = 1;
};

void emit_light(const std::string& kind, OldParameters& old, Emission emission, std::optional<Parameter> image,
                UpgradeOutput& output) {
  Parameters parameters = emission.parameters(old.place());
  if (image) parameters.push_back(renamed(std::move(*image), "filename"));
  output.emit("LightSource", {kind}, old.with_rest(std::move(parameters)), old.place());
}

void infinite(OldParameters& old, UpgradeOutput& output) {
  Emission emission(old, "L", output);
  auto image = old.take("mapname");
  if (image) emission.into_scale(old, output);
  emit_light("infinite", old, std::move(emission), std::move(image), output);
}

// pbrt-v3 projects the image upside down.
void projection(OldParameters& old, UpgradeOutput& output) {
  Emission emission(old, "I", output);
  emission.into_scale(old, output);
  auto image = old.take("mapname");
  const Place place = old.place();
  Parameters fov;
  if (!old.has("fov")) fov.push_back(float_parameter("fov", 45, place));
  OldParameters rest(old.entity(), place, old.with_rest(std::move(fov)));
  output.emit("AttributeBegin", {}, {}, place);
  output.emit({"Scale", {1, -1, 1}, {}, {}, place});
  emit_light("projection", rest, std::move(emission), std::move(image), output);
  output.emit("AttributeEnd", {}, {}, place);
}

void note_edge(const OldParameters& old, UpgradeOutput& output) {
  const Parameter* width = old.find("conedeltaangle");
  const auto angle = width != nullptr ? constant_colour(*width) : std::nullopt;
  if (!angle || angle->r != 0) output.note("spot lights have pbrt-v4's edge, which falls off more slowly", old.place());
}

}  // namespace

void upgrade_light(const std::string& kind, OldParameters old, UpgradeOutput& output) {
  if (kind == "infinite" || kind == "exinfinite") return infinite(old, output);
  if (kind == "projection") return projection(old, output);
  if (kind == "spot") note_edge(old, output);
  if (kind != "point" && kind != "spot" && kind != "distant" && kind != "goniometric")
    throw Error(old.place().location(), "unknown light " + in_quotes(kind));
  Emission emission(old, kind == "distant" ? "L" : "I", output);
  auto image = kind == "goniometric" ? old.take("mapname") : std::nullopt;
  emit_light(kind, old, std::move(emission), std::move(image), output);
}

Upgraded upgrade_area_light(const std::string& kind, OldParameters old, UpgradeOutput& output) {
  if (kind != "diffuse" && kind != "area")
    throw output.context().unknown("area light", "AreaLightSource", kind, old.place());
  return {"diffuse", old.with_rest(Emission(old, "L", output).parameters(old.place()))};
}

}  // namespace lanthorn::pbrt
