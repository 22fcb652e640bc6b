// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/upgrade.h"

#include <algorithm>
#include <utility>

namespace lanthorn::pbrt {

namespace {

constexpr std::string_view transform_end_name = "TransformEnd";

// The coordinate system that stores the transform of the n-th open TransformBegin.
std::string saved_transform(std::size_t n) { return "TransformBegin " + std::to_string(n); }

}  // namespace

Upgrader::Upgrader(Context& context, const DirectiveSink& sink) : output_(context, sink) {
  context.warn("version", context.version->location,
               context.version->text + " belongs to pbrt-v3: the file is translated to pbrt-v4");
}

Upgrader::Handler Upgrader::handler(std::string_view directive) {
  using U = Upgrader;
  static const std::unordered_map<std::string_view, Handler> handlers = {
      {"AreaLightSource", &U::area_light_source},
      {"Attribute", &U::only_in_v4},
      {"AttributeBegin", &U::attribute_begin},
      {"AttributeEnd", &U::attribute_end},
      {"Camera", &U::camera},
      {"ColorSpace", &U::only_in_v4},
      {"Film", &U::film},
      {import_begin, &U::only_in_v4},
      {"Integrator", &U::integrator},
      {"LightSource", &U::light_source},
      {"MakeNamedMaterial", &U::make_named_material},
      {"MakeNamedMedium", &U::make_named_medium},
      {"Material", &U::material},
      {"NamedMaterial", &U::named_material},
      {"ObjectBegin", &U::object_begin},
      {"ObjectEnd", &U::attribute_end},
      {"ObjectInstance", &U::object_instance},
      {"Option", &U::only_in_v4},
      {"PixelFilter", &U::pixel_filter},
      {"Renderer", &U::only_in_v2},
      {"Sampler", &U::sampler},
      {"Shape", &U::shape},
      {"SurfaceIntegrator", &U::integrator},
      {"Texture", &U::texture},
      {"TransformBegin", &U::transform_begin},
      {"TransformEnd", &U::transform_end},
      {"Volume", &U::only_in_v2},
      {"VolumeIntegrator", &U::only_in_v2},
      {"WorldBegin", &U::world_begin},
      {"WorldEnd", &U::world_end},
  };
  const auto it = handlers.find(directive);
  return it == handlers.end() ? nullptr : it->second;
}

// Directives that are not in the table are the same in both versions.
void Upgrader::translate(Directive d) {
  if (const Handler handle = handler(d.name))
    (this->*handle)(d);
  else
    output_.emit(std::move(d));
}

void Upgrader::finish() {
  if (const auto it =
          std::find_if(blocks_.begin(), blocks_.end(), [](const Block& b) { return b.end == transform_end_name; });
      it != blocks_.end())
    throw Error(it->place.location(), "the block that begins here has no end");
  output_.finish();
}

void Upgrader::only_in_v2(Directive& d) {
  output_.note("directive " + in_quotes(d.name) + " belongs to pbrt-v2: ignored", d.place);
}

void Upgrader::only_in_v4(Directive& d) {
  throw output_.context().unknown("directive", "", std::string(d.name), d.place);
}

void Upgrader::open(std::string_view end, Place place) {
  if (blocks_.size() >= deepest_nesting)
    throw Error(place.location(), "blocks are nested more than " + std::to_string(deepest_nesting) + " levels deep");
  blocks_.push_back({end, place, material_, is_lamp_});
}

void Upgrader::check_open(bool is_transform, const Directive& end) const {
  if (blocks_.empty() || (blocks_.back().end == transform_end_name) != is_transform)
    throw Error(end.place.location(), std::string(end.name) + " has no matching begin" +
                                          (blocks_.empty() ? std::string()
                                                           : " (the innermost open block begins at line " +
                                                                 std::to_string(blocks_.back().place.line) + ")"));
}

void Upgrader::attribute_begin(Directive& d) {
  open(d.name == "ObjectBegin" ? "ObjectEnd" : "AttributeEnd", d.place);
  materials_.begin();
  float_textures_.begin();
  spectrum_textures_.begin();
  output_.emit(std::move(d));
}

// pbrt-v3 does not distinguish the ends of attributes and of objects: either one ends the innermost block.
void Upgrader::attribute_end(Directive& d) {
  check_open(false, d);
  if (d.name != blocks_.back().end)
    output_.note(std::string(d.name) + " ends a block of another kind, as in pbrt-v3", d.place);
  d.name = blocks_.back().end;
  material_ = std::move(blocks_.back().material);
  is_lamp_ = blocks_.back().is_lamp;
  blocks_.pop_back();
  materials_.end();
  float_textures_.end();
  spectrum_textures_.end();
  output_.emit(std::move(d));
}

// Unlike in pbrt-v4, only the transform is saved and restored.
void Upgrader::transform_begin(Directive& d) {
  open(transform_end_name, d.place);
  output_.emit("CoordinateSystem", {saved_transform(blocks_.size())}, {}, d.place);
}

void Upgrader::transform_end(Directive& d) {
  check_open(true, d);
  output_.emit("CoordSysTransform", {saved_transform(blocks_.size())}, {}, d.place);
  blocks_.pop_back();
}

void Upgrader::object_begin(Directive& d) {
  std::string& name = d.strings.front();
  name = objects_[name] = output_.fresh_name(object_space, name);
  attribute_begin(d);
}

void Upgrader::object_instance(Directive& d) {
  if (const auto it = objects_.find(d.strings.front()); it != objects_.end()) d.strings.front() = it->second;
  output_.emit(std::move(d));
}

// Film and sampler depend on other directives; all directives whose defaults differ from pbrt-v4's are emitted here.
void Upgrader::world_begin(Directive& d) {
  if (!film_) film_ = Directive{"Film", {}, {"image"}, {}, d.place};
  Upgraded upgraded_film = upgrade_film(film_->strings.front(), old_parameters(*film_, ""), exposure_time_, output_);
  output_.emit("Film", {upgraded_film.kind}, std::move(upgraded_film.parameters), film_->place);
  if (!filter_) filter_ = Directive{"PixelFilter", {}, {"box"}, {}, d.place};
  Upgraded upgraded_filter = upgrade_filter(filter_->strings.front(), old_parameters(*filter_, ""));
  output_.emit("PixelFilter", {upgraded_filter.kind}, std::move(upgraded_filter.parameters), filter_->place);
  if (sampler_ || passes_) {
    if (!sampler_) sampler_ = Directive{"Sampler", {}, {"halton"}, {}, d.place};
    Upgraded sampler = upgrade_sampler(sampler_->strings.front(), old_parameters(*sampler_, ""));
    if (passes_) {
      std::erase_if(sampler.parameters, [](const Parameter& p) { return p.name == "pixelsamples"; });
      sampler.parameters.push_back(integer_parameter("pixelsamples", *passes_, sampler_->place));
    }
    output_.emit("Sampler", {sampler.kind}, std::move(sampler.parameters), sampler_->place);
  }
  output_.emit(std::move(d));
}

void Upgrader::world_end(Directive&) {}

void Upgrader::film(Directive& d) { film_ = std::move(d); }
void Upgrader::pixel_filter(Directive& d) { filter_ = std::move(d); }
void Upgrader::sampler(Directive& d) { sampler_ = std::move(d); }

void Upgrader::camera(Directive& d) {
  OldParameters old = old_parameters(d, "");
  const auto time = [&](const char* name, float otherwise) {
    const Parameter* p = old.find(name);
    const auto value = p != nullptr ? constant_colour(*p) : std::nullopt;
    return value ? value->r : otherwise;
  };
  exposure_time_ = time("shutterclose", 1) - time("shutteropen", 0);
  if (!(exposure_time_ > 0)) exposure_time_ = 1;
  Upgraded result = upgrade_camera(d.strings.front(), std::move(old), output_);
  output_.emit("Camera", {result.kind}, std::move(result.parameters), d.place);
}

void Upgrader::integrator(Directive& d) {
  UpgradedIntegrator result = upgrade_integrator(d.strings.front(), old_parameters(d, ""), output_);
  passes_ = result.passes;
  output_.emit("Integrator", {result.integrator.kind}, std::move(result.integrator.parameters), d.place);
}

// Replaces textures' names by those in the output. `is_spectrum` tells, from a parameter's name, which kind of texture
// it takes.
void Upgrader::rename_textures(Parameters& parameters, const std::function<bool(const std::string&)>& is_spectrum) {
  std::erase_if(parameters, [&](const Parameter& p) {
    const std::string name = texture_of(p);
    if (name.empty() || spectrum_textures_.find(name) || float_textures_.find(name)) return false;
    output_.note("texture " + in_quotes(name) + " is not defined before it is used: " + in_quotes(p.name) +
                     " keeps its default, as in pbrt-v3",
                 p.place);
    return true;
  });
  for (Parameter& p : parameters)
    if (const std::string name = texture_of(p); !name.empty()) {
      const std::string* known = (is_spectrum(p.name) ? spectrum_textures_ : float_textures_).find(name);
      if (known != nullptr) p = texture_parameter(p.name, *known, p.place);
    }
}

// The parameters of a directive, with its textures' names in the output.
OldParameters Upgrader::old_parameters(Directive& d, std::string_view textures_of) {
  rename_textures(d.parameters, [&](const std::string& name) { return is_spectrum_parameter(name, textures_of); });
  return {std::string(d.name) + " " + in_quotes(d.strings.empty() ? std::string() : d.strings.back()), d.place,
          std::move(d.parameters)};
}

// A name may be redefined; the last definition applies from there on.
void Upgrader::texture(Directive& d) {
  const std::string name = d.strings[0], type = d.strings[1], kind = d.strings[2];
  const bool is_spectrum = type == "color" || type == "spectrum";
  if (!is_spectrum && type != "float")
    throw Error(d.place.location(), "a texture's type must be float, spectrum or color, not " + in_quotes(type));
  rename_textures(d.parameters, [&](const std::string& input) { return is_spectrum && input != "amount"; });
  OldParameters old("Texture " + in_quotes(kind), d.place, std::move(d.parameters));
  const std::string new_name = output_.fresh_name(texture_space, name);
  upgrade_texture(new_name, is_spectrum, kind, std::move(old), output_);
  (is_spectrum ? spectrum_textures_ : float_textures_).set(name, new_name);
}

std::string Upgrader::new_material(const std::string& name) const {
  const Material* known = materials_.find(name);
  return known != nullptr ? known->new_name : name;
}

UpgradedMaterial Upgrader::upgraded(const OldMaterial& material, Directive& d) {
  Directive resolved{d.name, {}, {material.kind}, material.parameters, d.place};
  for (Parameter& p : resolved.parameters)
    if (p.name == "namedmaterial1" || p.name == "namedmaterial2")
      if (auto* names = std::get_if<std::vector<std::string>>(&p.values); names != nullptr && names->size() == 1)
        names->front() = new_material(names->front());
  return upgrade_material(material.kind, old_parameters(resolved, material.kind), material.name, output_);
}

void Upgrader::material(Directive& d) {
  const std::string& kind = d.strings.front();
  auto old = std::make_shared<const OldMaterial>(OldMaterial{kind, kind, std::move(d.parameters)});
  UpgradedMaterial result = upgraded(*old, d);
  material_ = {std::move(old), "", result.opacity};
  output_.emit("Material", {result.material.kind}, std::move(result.material.parameters), d.place);
}

void Upgrader::make_named_material(Directive& d) {
  const std::string name = d.strings.front();
  OldParameters parameters("MakeNamedMaterial " + in_quotes(name), d.place, std::move(d.parameters));
  const std::string kind = parameters.take_string("type").value_or("");
  auto old = std::make_shared<const OldMaterial>(OldMaterial{kind, name, parameters.rest()});
  UpgradedMaterial result = upgraded(*old, d);
  const std::string new_name = output_.fresh_name(material_space, name);
  materials_.set(name, {std::move(old), new_name, result.opacity});
  result.material.parameters.insert(result.material.parameters.begin(),
                                    string_parameter("type", result.material.kind, d.place));
  output_.emit("MakeNamedMaterial", {new_name}, std::move(result.material.parameters), d.place);
}

void Upgrader::named_material(Directive& d) {
  const Material* known = materials_.find(d.strings.front());
  if (known == nullptr) {
    output_.note("material " + in_quotes(d.strings.front()) +
                     " is not defined before it is used: the current material does not change, as in pbrt-v3",
                 d.place);
    return;
  }
  material_ = *known;
  d.strings.front() = known->new_name;
  output_.emit(std::move(d));
}

void Upgrader::make_named_medium(Directive& d) {
  d.parameters = upgrade_medium({"MakeNamedMedium " + in_quotes(d.strings.front()), d.place, std::move(d.parameters)});
  output_.emit(std::move(d));
}

void Upgrader::light_source(Directive& d) { upgrade_light(d.strings.front(), old_parameters(d, ""), output_); }

void Upgrader::area_light_source(Directive& d) {
  is_lamp_ = true;
  Upgraded result = upgrade_area_light(d.strings.front(), old_parameters(d, ""), output_);
  output_.emit("AreaLightSource", {result.kind}, std::move(result.parameters), d.place);
}

// A shape may override parameters of its material. If so, emits a material with these values and returns true.
bool Upgrader::override_material(Directive& d) {
  if (!material_.old) return false;
  const auto is_override = [](const Parameter& p) { return is_material_parameter(p.name); };
  const auto first = std::stable_partition(d.parameters.begin(), d.parameters.end(),
                                           [&](const Parameter& p) { return !is_override(p); });
  if (first == d.parameters.end()) return false;
  OldMaterial changed = *material_.old;
  changed.parameters.insert(changed.parameters.end(), first, d.parameters.end());
  d.parameters.erase(first, d.parameters.end());
  output_.emit("AttributeBegin", {}, {}, d.place);
  UpgradedMaterial result = upgraded(changed, d);
  output_.emit("Material", {result.material.kind}, std::move(result.material.parameters), d.place);
  material_.opacity = result.opacity;
  return true;
}

// An emitter without a material, which only pbrt-v3 allows to emit, gets a black one; returns true in this case.
bool Upgrader::make_visible(Place place) {
  const bool has_surface = !material_.old || (!material_.old->kind.empty() && material_.old->kind != "none");
  if (has_surface || !is_lamp_) return false;
  output_.note("emitters without a material are black: they hide what is behind them", place);
  output_.emit("AttributeBegin", {}, {}, place);
  output_.emit("Material", {"diffuse"}, {rgb_parameter("reflectance", {0, 0, 0}, place)}, place);
  return true;
}

void Upgrader::shape(Directive& d) {
  const Factor opacity = material_.opacity;
  const bool is_override = override_material(d) || make_visible(d.place);
  OldParameters old = old_parameters(d, "");
  if (!material_.opacity.is(1)) {
    const Factor alpha = output_.product(material_.opacity, old.take_factor("alpha").value_or(Factor{1}), d.place);
    Parameters rest = old.rest();
    rest.push_back(factor_parameter("alpha", alpha, d.place));
    old = OldParameters(old.entity(), d.place, std::move(rest));
  }
  if (auto result = upgrade_shape(d.strings.front(), std::move(old), output_))
    output_.emit("Shape", {result->kind}, std::move(result->parameters), d.place);
  if (is_override) output_.emit("AttributeEnd", {}, {}, d.place);
  material_.opacity = opacity;
}

}  // namespace lanthorn::pbrt
