// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/pbrt/assembler.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <exception>
#include <new>
#include <span>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "io/ply.h"
#include "lanthorn/file.h"
#include "shape/curves.h"
#include "shape/displacement.h"

namespace lanthorn::pbrt {

namespace {

using description::Index;

// Each `Attribute` copies all earlier defaults.
constexpr std::size_t most_defaults = 4096, most_bytes_of_defaults = std::size_t{1} << 18;

Index index_of_last(const auto& vector) { return static_cast<Index>(vector.size() - 1); }

ColorSpace color_space_named(const std::string& name, Place place) {
  if (name == "srgb") return ColorSpace::srgb;
  if (name == "dci-p3") return ColorSpace::dci_p3;
  if (name == "rec2020") return ColorSpace::rec2020;
  if (name == "aces2065-1") return ColorSpace::aces2065_1;
  throw Error(place.location(), "unknown color space " + in_quotes(name));
}

std::shared_ptr<const Parameters> joined(const std::shared_ptr<const Parameters>& first, Parameters second) {
  auto result = std::make_shared<Parameters>();
  if (first) *result = *first;
  std::move(second.begin(), second.end(), std::back_inserter(*result));
  return result;
}

std::size_t bytes_of(const Parameters& parameters) {
  std::size_t sum = 0;
  for (const Parameter& p : parameters) {
    sum += p.name.size();
    if (const auto* strings = std::get_if<std::vector<std::string>>(&p.values))
      for (const std::string& s : *strings) sum += sizeof(std::string) + s.size();
    else
      sum += sizeof(float) * std::visit([](const auto& values) { return values.size(); }, p.values);
  }
  return sum;
}

}  // namespace

Assembler::Assembler(Context& context, MeshObserver observer) : context_(context), observer_(std::move(observer)) {
  materials_.push_back({"diffuse", "", ParameterList("Material \"diffuse\"", {}, {})});
  material_references_.push_back({});
}

void Assembler::require_world(std::string_view directive, Place place) const {
  if (!in_world_) throw Error(place.location(), std::string(directive) + " must come after WorldBegin");
}

void Assembler::require_options(std::string_view directive, Place place) const {
  if (in_world_) throw Error(place.location(), std::string(directive) + " must come before WorldBegin");
}

ParameterList Assembler::list(std::string_view directive, const std::string& kind, Place place, Parameters parameters,
                              std::shared_ptr<const Parameters> defaults) const {
  return {std::string(directive) + " " + in_quotes(kind), place, std::move(parameters), std::move(defaults)};
}

void Assembler::change_transform(const Change& change) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (!state_.active[i]) continue;
    state_.ctm[i] = change(state_.ctm[i]);
  }
}

void Assembler::coordinate_system(const std::string& name, Place) { coordinate_systems_[name] = state_.ctm; }

void Assembler::coord_sys_transform(const std::string& name, Place place) {
  const auto it = coordinate_systems_.find(name);
  if (it != coordinate_systems_.end())
    state_.ctm = it->second;
  else
    context_.warn("coordinate system " + name, place,
                  "there is no coordinate system " + in_quotes(name) + ": the transform does not change");
}

void Assembler::active_transform(Directive& d) {
  state_.active = {d.strings.front() != "EndTime", d.strings.front() != "StartTime"};
}

void Assembler::transform_times(Directive& d) {
  const auto start = static_cast<float>(d.numbers[0]), end = static_cast<float>(d.numbers[1]);
  require_options("TransformTimes", d.place);
  if (!(start < end)) throw Error(d.place.location(), "TransformTimes needs an end time after the start time");
  state_.start_time = start;
  state_.end_time = end;
}

AnimatedTransform Assembler::object_to_world() const {
  return {state_.ctm[0], state_.ctm[1], state_.start_time, state_.end_time};
}

Transform Assembler::fixed_transform(const char* thing, Place place) {
  if (!(state_.ctm[0] == state_.ctm[1]))
    context_.warn(std::string("moving ") + thing, place,
                  std::string("a ") + thing + " cannot move: it stays where it is at the start time");
  if (state_.ctm[0].is_singular())
    throw Error(place.location(), std::string("the transform of a ") + thing + " must have an inverse");
  return state_.ctm[0];
}

void Assembler::push(Block block, Place place) {
  if (saved_.size() >= deepest_nesting)
    throw Error(place.location(), "blocks are nested more than " + std::to_string(deepest_nesting) + " levels deep");
  saved_.push_back({state_, block, place});
}

void Assembler::pop(Block block, std::string_view directive, Place place) {
  if (saved_.empty() || saved_.back().block != block) {
    std::string message = std::string(directive) + " has no matching begin";
    if (!saved_.empty()) {
      const SourceLocation open = saved_.back().place.location();
      message += " (the innermost open block begins at line " + std::to_string(open.line) + ")";
    }
    throw Error(place.location(), message);
  }
  state_ = std::move(saved_.back().state);
  saved_.pop_back();
  context_.color_space = state_.color_space;
}

void Assembler::attribute_begin(Place place) {
  require_world("AttributeBegin", place);
  push(Block::attribute, place);
}

void Assembler::attribute_end(Place place) {
  require_world("AttributeEnd", place);
  pop(Block::attribute, "AttributeEnd", place);
}

void Assembler::attribute(const std::string& target, Parameters parameters, Place place) {
  auto& d = state_.defaults;
  const std::array<std::pair<std::string_view, std::shared_ptr<const Parameters>*>, 5> targets = {
      {{"shape", &d.shape},
       {"light", &d.light},
       {"material", &d.material},
       {"medium", &d.medium},
       {"texture", &d.texture}}};
  for (const auto& [name, defaults] : targets) {
    if (name != target) continue;
    *defaults = joined(*defaults, std::move(parameters));
    if ((*defaults)->size() > most_defaults)
      throw Error(place.location(), "more than " + std::to_string(most_defaults) + " defaults are set for " + target);
    if (bytes_of(**defaults) > most_bytes_of_defaults)
      throw Error(place.location(), "the defaults that are set for " + target + " have more than " +
                                        std::to_string(most_bytes_of_defaults >> 10) + " KiB of values");
    return;
  }
  throw Error(place.location(), "unknown Attribute target " + in_quotes(target) +
                                    ": it must be shape, light, material, medium or texture");
}

void Assembler::reverse_orientation(Place place) {
  require_world("ReverseOrientation", place);
  state_.reverse_orientation = !state_.reverse_orientation;
}

void Assembler::color_space(const std::string& name, Place place) {
  context_.color_space = state_.color_space = color_space_named(name, place);
}

void Assembler::option(Directive& d) {
  const std::string &name = d.strings[0], &value = d.strings[1];
  if (name == "seed") {
    int seed = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), seed);
    if (error != std::errc{} || end != value.data() + value.size())
      throw Error(d.place.location(), "Option \"seed\" needs an integer, not " + in_quotes(value));
    context_.scene.hints.seed = static_cast<std::uint32_t>(seed);
    return;
  }
  context_.warn("option " + name, d.place, "Option " + in_quotes(name) + " is not used by Lanthorn: ignored");
}

void Assembler::world_begin(Place place) {
  if (in_world_) throw Error(place.location(), "this is the second WorldBegin");
  in_world_ = true;
  state_.ctm = {};
  state_.active = {true, true};
  coordinate_systems_["world"] = state_.ctm;
  build_film();
}

Index Assembler::object_index(const std::string& name, Place place) {
  const auto [it, is_new] = objects_.emplace(name, static_cast<Index>(context_.scene.objects.size()));
  if (is_new) {
    context_.scene.objects.push_back({name, {}});
    object_defined_.push_back(false);
    object_places_.push_back(place);
  }
  return it->second;
}

void Assembler::object_begin(const std::string& name, Place place) {
  require_world("ObjectBegin", place);
  if (current_object_) throw Error(place.location(), "ObjectBegin inside an object");
  const Index object = object_index(name, place);
  if (object_defined_[object]) throw Error(place.location(), "object " + in_quotes(name) + " is defined twice");
  push(Block::object, place);
  object_defined_[object] = true;
  current_object_ = object;
}

void Assembler::object_end(Place place) {
  require_world("ObjectEnd", place);
  pop(Block::object, "ObjectEnd", place);
  current_object_.reset();
}

// An instance applies the shapes' own transform first: the transform that was current at their definition, relative to
// world space.
void Assembler::object_instance(const std::string& name, Place place) {
  require_world("ObjectInstance", place);
  if (current_object_) throw Error(place.location(), "ObjectInstance inside an object");
  context_.scene.instances.push_back({object_index(name, place), object_to_world(), place.location()});
}

void Assembler::begin_import(Place place) {
  require_world("Import", place);
  push(Block::import, place);
}

void Assembler::end_import(Place place) { pop(Block::import, "the end of the imported file", place); }

void Assembler::camera(const std::string& kind, Parameters parameters, Place place) {
  require_options("Camera", place);
  auto& camera = context_.scene.view.camera;
  camera = make_camera(kind, list("Camera", kind, place, std::move(parameters)), context_);
  const TransformPair camera_to_world = {state_.ctm[0].inverted(), state_.ctm[1].inverted()};
  camera.medium = state_.outside_medium;
  camera.camera_to_world = {camera_to_world[0], camera_to_world[1], state_.start_time, state_.end_time};
  coordinate_systems_["camera"] = camera_to_world;
}

void Assembler::film(const std::string& kind, Parameters parameters, Place place) {
  require_options("Film", place);
  film_ = {kind, list("Film", kind, place, std::move(parameters))};
  context_.scene.color_space = state_.color_space;
}

// Called at WorldBegin, because the exposure depends on the camera's shutter, and a realistic camera on the film's
// size.
void Assembler::build_film() {
  auto& [camera, film, filter] = context_.scene.view;
  film = make_film(film_.kind, film_.parameters, camera.shutter_close - camera.shutter_open, context_);
  film.color_space = context_.scene.color_space;
  if (auto* realistic = std::get_if<description::RealisticCamera>(&camera.node))
    realistic->film_diagonal = film.diagonal;
}

void Assembler::pixel_filter(const std::string& kind, Parameters parameters, Place place) {
  require_options("PixelFilter", place);
  context_.scene.view.filter = make_filter(kind, list("PixelFilter", kind, place, std::move(parameters)), context_);
}

void Assembler::sampler(const std::string& kind, Parameters parameters, Place place) {
  require_options("Sampler", place);
  read_sampler(kind, list("Sampler", kind, place, std::move(parameters)), context_);
}

void Assembler::integrator(const std::string& kind, Parameters parameters, Place place) {
  require_options("Integrator", place);
  read_integrator(kind, list("Integrator", kind, place, std::move(parameters)), context_);
}

void Assembler::accelerator(Place place) { require_options("Accelerator", place); }

void Assembler::material(const std::string& kind, Parameters parameters, Place place) {
  require_world("Material", place);
  materials_.push_back({kind, "", list("Material", kind, place, std::move(parameters), state_.defaults.material)});
  state_.material = material_references_.size();
  material_references_.push_back({"", materials_.size() - 1, place});
}

void Assembler::make_named_material(const std::string& name, Parameters parameters, Place place) {
  require_world("MakeNamedMaterial", place);
  if (!material_names_.emplace(name, place).second)
    throw Error(place.location(), "material " + in_quotes(name) + " is defined twice");
  ParameterList list("MakeNamedMaterial " + in_quotes(name), place, std::move(parameters), state_.defaults.material);
  const std::string kind = list.required_string("type");
  materials_.push_back({kind, name, std::move(list)});
}

void Assembler::named_material(const std::string& name, Place place) {
  require_world("NamedMaterial", place);
  state_.material = material_references_.size();
  material_references_.push_back({name, 0, place});
}

void Assembler::texture(Directive& d) {
  require_world("Texture", d.place);
  const std::string &name = d.strings[0], &value_type = d.strings[1], &kind = d.strings[2];
  const ParameterList parameter_list = list("Texture", kind, d.place, std::move(d.parameters), state_.defaults.texture);
  const Transform texture_to_world = fixed_transform("texture", d.place);
  if (value_type == "float")
    add_float_texture(name, kind, parameter_list, texture_to_world, context_);
  else if (value_type == "spectrum")
    add_spectrum_texture(name, kind, parameter_list, texture_to_world, context_);
  else
    throw Error(d.place.location(), "a texture's type must be float or spectrum, not " + in_quotes(value_type));
}

void Assembler::light_source(const std::string& kind, Parameters parameters, Place place) {
  require_world("LightSource", place);
  const ParameterList parameter_list = list("LightSource", kind, place, std::move(parameters), state_.defaults.light);
  description::Light light = make_light(kind, parameter_list, fixed_transform("light", place), context_);
  light.medium = state_.outside_medium;
  context_.scene.lights.push_back(std::move(light));
}

void Assembler::area_light_source(const std::string& kind, Parameters parameters, Place place) {
  require_world("AreaLightSource", place);
  const ParameterList parameter_list =
      list("AreaLightSource", kind, place, std::move(parameters), state_.defaults.light);
  context_.scene.area_lights.push_back(make_area_light(kind, parameter_list, context_));
  state_.area_light = index_of_last(context_.scene.area_lights);
}

void Assembler::shape(const std::string& kind, Parameters parameters, Place place) {
  require_world("Shape", place);
  auto parts = make_shape(kind, list("Shape", kind, place, std::move(parameters), state_.defaults.shape), context_);
  description::Shape shape;
  shape.object_to_world = object_to_world();
  shape.reverse_orientation = state_.reverse_orientation;
  shape.material = static_cast<Index>(state_.material);
  shape.area_light = state_.area_light;
  shape.alpha = parts.alpha;
  shape.inside_medium = state_.inside_medium;
  shape.outside_medium = state_.outside_medium;
  shape.location = place.location();
  if (parts.alpha_texture) {
    shape.alpha = {1, reference_texture(std::move(*parts.alpha_texture), place)};
  }
  if (parts.displacement_texture)
    shape.displacement = {{0, reference_texture(std::move(*parts.displacement_texture), place)}, parts.edge_length};
  auto& shapes_here = shapes(current_object_);
  if (auto* geometry = std::get_if<Geometry>(&parts.geometry)) {
    shape.geometry = std::move(*geometry);
    if (std::holds_alternative<description::Curves>(shape.geometry) && add_to_last_curves(shape)) return;
  } else {
    pending_plys_.push_back({current_object_, shapes_here.size(), std::get<PlyRequest>(parts.geometry).path, place});
  }
  shapes_here.push_back(std::move(shape));
}

// Textures may be defined after the shapes that name them.
Index Assembler::reference_texture(std::string name, Place place) {
  texture_references_.push_back({std::move(name), place});
  return index_of_last(texture_references_);
}

bool Assembler::equal_attributes(const description::Shape& a, const description::Shape& b) const {
  const auto is_same_material = [&](Index i, Index j) {
    const MaterialReference &x = material_references_[i], &y = material_references_[j];
    return x.name == y.name && (!x.name.empty() || x.declaration == y.declaration);
  };
  const auto is_same_alpha = [&](const description::FloatParameter& x, const description::FloatParameter& y) {
    if (!x.texture || !y.texture) return x.texture == y.texture && x.value == y.value;
    return texture_references_[*x.texture].name == texture_references_[*y.texture].name;
  };
  return a.object_to_world.start == b.object_to_world.start && a.object_to_world.end == b.object_to_world.end &&
         a.object_to_world.start_time == b.object_to_world.start_time &&
         a.object_to_world.end_time == b.object_to_world.end_time && a.reverse_orientation == b.reverse_orientation &&
         a.area_light == b.area_light && a.inside_medium == b.inside_medium && a.outside_medium == b.outside_medium &&
         is_same_material(a.material, b.material) && is_same_alpha(a.alpha, b.alpha);
}

// Fur has one directive per hair. Consecutive hairs with equal attributes become one shape, unless each emits a given
// power.
bool Assembler::add_to_last_curves(description::Shape& shape) {
  constexpr std::size_t most_points = std::size_t{1} << 30;
  auto& curves = std::get<description::Curves>(shape.geometry);
  const AnimatedTransform& place = shape.object_to_world;
  if (!place.is_moving() && even_scale(place.start)) {
    curves = transformed(std::move(curves), place.start);
    shape.object_to_world = {};
  }
  if (shape.area_light && context_.scene.area_lights[*shape.area_light].power) return false;
  auto& list = shapes(current_object_);
  auto* last = list.empty() ? nullptr : std::get_if<description::Curves>(&list.back().geometry);
  if (!last || last->kind != curves.kind || last->points.size() > most_points || !equal_attributes(list.back(), shape))
    return false;
  append(*last, curves);
  return true;
}

void Assembler::make_named_medium(const std::string& name, Parameters parameters, Place place) {
  if (name.empty()) throw Error(place.location(), "a medium needs a name");
  const Index index = *medium_index(name, place);
  if (medium_defined_[index]) throw Error(place.location(), "medium " + in_quotes(name) + " is defined twice");
  medium_defined_[index] = true;
  const ParameterList medium("MakeNamedMedium " + in_quotes(name), place, std::move(parameters),
                             state_.defaults.medium);
  const std::string kind = medium.required_string("type");
  context_.scene.media[index] = make_medium(kind, medium, fixed_transform("medium", place), context_);
  context_.scene.media[index].name = name;
}

std::optional<Index> Assembler::medium_index(const std::string& name, Place place) {
  if (name.empty()) return {};
  const auto [it, is_new] = media_.emplace(name, static_cast<Index>(context_.scene.media.size()));
  if (is_new) {
    context_.scene.media.emplace_back();
    context_.scene.media.back().name = name;
    medium_defined_.push_back(false);
    medium_places_.push_back(place);
  }
  return it->second;
}

void Assembler::medium_interface(Directive& d) {
  state_.inside_medium = medium_index(d.strings[0], d.place);
  state_.outside_medium = medium_index(d.strings[1], d.place);
}

std::vector<description::Shape>& Assembler::shapes(std::optional<Index> object) {
  return object ? context_.scene.objects[*object].shapes : context_.scene.shapes.edit();
}

void Assembler::check_names_used() const {
  for (std::size_t i = 0; i < object_places_.size(); ++i)
    if (!object_defined_[i])
      throw Error(object_places_[i].location(),
                  "object " + in_quotes(context_.scene.objects[i].name) + " is not defined");
  for (std::size_t i = 0; i < medium_places_.size(); ++i)
    if (!medium_defined_[i])
      throw Error(medium_places_[i].location(),
                  "medium " + in_quotes(context_.scene.media[i].name) + " is not defined");
}

// Named materials come first so that anonymous mixes find them all; named mixes find only earlier ones.
void Assembler::build_materials() {
  std::vector<Index> index_of_declaration(materials_.size());
  const auto build = [&](std::size_t i) {
    const MaterialDeclaration& declaration = materials_[i];
    context_.scene.materials.push_back(make_material(declaration.kind, declaration.parameters, context_));
    context_.scene.materials.back().name = declaration.name;
    index_of_declaration[i] = index_of_last(context_.scene.materials);
  };
  build(0);
  for (std::size_t i = 1; i < materials_.size(); ++i) {
    if (materials_[i].name.empty()) continue;
    build(i);
    context_.named_materials.emplace(materials_[i].name, index_of_declaration[i]);
  }
  for (std::size_t i = 1; i < materials_.size(); ++i)
    if (materials_[i].name.empty()) build(i);
  for (const MaterialReference& reference : material_references_) {
    if (reference.name.empty()) {
      material_of_reference_.push_back(index_of_declaration[reference.declaration]);
      continue;
    }
    const auto it = context_.named_materials.find(reference.name);
    if (it == context_.named_materials.end())
      throw Error(reference.place.location(), "material " + in_quotes(reference.name) + " is not defined");
    material_of_reference_.push_back(it->second);
  }
}

void Assembler::resolve_references(description::Shape& shape) {
  shape.material = material_of_reference_[shape.material];
  const auto resolve = [&](std::optional<Index>& texture) {
    if (!texture) return;
    const TextureReference& reference = texture_references_[*texture];
    const auto it = context_.float_textures.find(reference.name);
    if (it == context_.float_textures.end())
      throw Error(reference.place.location(), "float texture " + in_quotes(reference.name) + " is not defined");
    texture = it->second;
  };
  const auto is_lost = [&](const std::optional<Index>& texture) {
    return texture && context_.lost_float_textures.count(*texture) > 0;
  };
  resolve(shape.alpha.texture);
  if (is_lost(shape.alpha.texture)) shape.alpha = {1, {}};
  if (shape.displacement) resolve(shape.displacement->height.texture);
  if (shape.displacement && is_lost(shape.displacement->height.texture)) shape.displacement.reset();
  const auto& material = context_.scene.materials[shape.material].node;
  if (shape.area_light && std::holds_alternative<description::InterfaceMaterial>(material)) {
    context_.warn("interface emitter", shape.location,
                  "a shape of material \"interface\" cannot emit light: its emission is ignored");
    shape.area_light.reset();
  }
}

void Assembler::resolve_shapes() {
  for (description::Shape& shape : context_.scene.shapes) resolve_references(shape);
  for (description::Object& object : context_.scene.objects)
    for (description::Shape& shape : object.shapes) resolve_references(shape);
}

// Reports missing files among those read from here on or when the scene is built (meshes, images, grids), together with
// those found missing before.
void Assembler::report_missing_files() {
  if (context_.access == nullptr) return;
  context_.report_missing();
  std::erase_if(pending_plys_, [&](const PendingPly& ply) {
    return context_.access->skip_missing && context_.access->is_missing(ply.path);
  });
}

// Rejects meshes that together are too large, before any of them is read. Unreadable files are reported when they are
// read.
void Assembler::expect_ply_files() const {
  if (context_.access == nullptr || pending_plys_.empty()) return;
  constexpr std::uint64_t largest_header = 1u << 16;
  ExpectedMeshes meshes;
  for (const PendingPly& ply : pending_plys_) {
    try {
      const PartlyReadFile file(context_.access->checked(ply.path));
      std::string start(std::min(file.size(), largest_header), '\0');
      file.read(0, std::as_writable_bytes(std::span(start)));
      const auto need = need_of_ply(start);
      if (!need) continue;
      ++meshes.files;
      meshes.faces += need->faces;
      meshes.bytes += need->bytes;
    } catch (const Error&) {
    }
  }
  if (observer_) observer_(meshes);
  if (meshes.files > 1)
    require_memory(
        meshes.bytes, {context_.scene.filename},
        fmt::format("the geometry of {} meshes ({:.0f} faces) with its search trees", meshes.files, meshes.faces));
}

void Assembler::read_ply_files() {
  struct Result {
    PlyMesh mesh;
    std::exception_ptr problem;
  };
  std::vector<Result> results(pending_plys_.size());
  parallel_for(std::size_t{0}, results.size(), [&](std::size_t i) {
    try {
      results[i].mesh =
          parse_ply(context_.read(pending_plys_[i].path, pending_plys_[i].place), pending_plys_[i].path.string());
    } catch (const std::bad_alloc&) {
      results[i].problem = std::make_exception_ptr(
          Error(pending_plys_[i].place.location(),
                "mesh \"" + printable(pending_plys_[i].path.string()) + "\" needs more memory than is available"));
    } catch (...) {
      results[i].problem = std::current_exception();
    }
  });
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].problem) std::rethrow_exception(results[i].problem);
    place_ply(pending_plys_[i], std::move(results[i].mesh));
  }
  const auto is_empty = [](const description::Shape& shape) {
    const auto* mesh = std::get_if<description::TriangleMesh>(&shape.geometry);
    return mesh && mesh->triangles.empty();
  };
  std::erase_if(context_.scene.shapes.edit(), is_empty);
  for (description::Object& object : context_.scene.objects) std::erase_if(object.shapes, is_empty);
}

// If a mesh has both triangles and quads, its quads become a separate shape. It is appended, so that other shapes keep
// their indices. A lamp of a given power must be one shape, so its quads become triangles.
void Assembler::place_ply(const PendingPly& pending, PlyMesh&& mesh) {
  for (const std::string& warning : mesh.warnings) {
    const std::size_t kind = warning.find_first_not_of("0123456789");  // ignore leading counts, which differ
    context_.warn(std::string_view(warning).substr(kind), pending.place, pending.path.string() + ": " + warning);
  }
  auto& list = shapes(pending.object);
  const std::optional<Index>& lamp = list[pending.shape].area_light;
  if (lamp && context_.scene.area_lights[*lamp].power && !mesh.triangles.triangles.empty()) {
    const auto halves = triangulated(std::exchange(mesh.quads, {})).triangles;
    mesh.triangles.triangles.insert(mesh.triangles.triangles.end(), halves.begin(), halves.end());  // same vertices
  }
  if (mesh.triangles.triangles.empty() && !mesh.quads.patches.empty()) {
    list[pending.shape].geometry = std::move(mesh.quads);
    return;
  }
  if (!mesh.quads.patches.empty()) {
    description::Shape quads = list[pending.shape];
    quads.geometry = std::move(mesh.quads);
    list.push_back(std::move(quads));
  }
  list[pending.shape].geometry = std::move(mesh.triangles);
}

void Assembler::finish(Place place) {
  if (!saved_.empty()) throw Error(saved_.back().place.location(), "the block that begins here has no end");
  if (!in_world_) throw Error(place.location(), "the scene has no WorldBegin");
  check_names_used();
  build_materials();
  resolve_shapes();
  report_missing_files();
  expect_ply_files();
  read_ply_files();
}

}  // namespace lanthorn::pbrt
