// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "io/pbrt/builders.h"
#include "io/pbrt/context.h"
#include "io/pbrt/directive.h"
#include "io/ply.h"
#include "lanthorn/scene.h"
#include "lanthorn/transform.h"

namespace lanthorn::pbrt {

/// The current transforms at the start and the end of TransformTimes.
using TransformPair = std::array<Transform, 2>;

/// The state that AttributeBegin saves and AttributeEnd restores.
struct GraphicsState {
  TransformPair ctm;
  std::array<bool, 2> active{true, true};
  float start_time = 0, end_time = 1;
  bool reverse_orientation = false;
  std::size_t material = 0;  ///< into the assembler's material references
  std::optional<description::Index> area_light;
  std::optional<description::Index> inside_medium, outside_medium;
  ColorSpace color_space = ColorSpace::srgb;
  /// Defaults by `Attribute` target. Shared, because states are copied often and the defaults rarely change.
  struct Defaults {
    std::shared_ptr<const Parameters> shape, light, material, medium, texture;
  } defaults;
};

/// Builds the scene from a pbrt-v4 file's directives: call `execute` for each, in file order, then `finish`. Holds the
/// state that directives change. Throws Error at a directive that is invalid or in the wrong block.
class Assembler {
 public:
  explicit Assembler(Context& context, MeshObserver observer = {});

  void execute(Directive directive);
  /// Call after the last directive, with its `place`: resolves names that may be defined after their use, and reads the
  /// PLY files.
  void finish(Place place);

 private:
  using Handler = void (Assembler::*)(Directive&);
  static Handler handler(std::string_view directive);
  /// Handlers for directives of the form `Directive "kind" parameters…`, `Directive "name"` and `Directive`.
  template <void (Assembler::*call)(const std::string&, Parameters, Place)>
  void with_parameters(Directive& d);
  template <void (Assembler::*call)(const std::string&, Place)>
  void with_name(Directive& d);
  template <void (Assembler::*call)(Place)>
  void alone(Directive& d);

  using Change = std::function<Transform(const Transform&)>;
  /// Changes the active transforms. Singular transforms are allowed here; the directives that use them check.
  void change_transform(const Change& change);
  void look_at(Directive& d);
  void translate_by(Directive& d);
  void rotate_by(Directive& d);
  void scale_by(Directive& d);
  void set_transform(Directive& d);
  void concat_transform(Directive& d);
  void identity(Place place);
  void coordinate_system(const std::string& name, Place place);
  void coord_sys_transform(const std::string& name, Place place);
  void active_transform(Directive& d);
  void transform_times(Directive& d);
  void transform_begin(Place place);

  void attribute_begin(Place place);
  void attribute_end(Place place);
  void attribute(const std::string& target, Parameters parameters, Place place);
  void reverse_orientation(Place place);
  void color_space(const std::string& name, Place place);
  void option(Directive& d);

  void world_begin(Place place);
  void object_begin(const std::string& name, Place place);
  void object_end(Place place);
  void object_instance(const std::string& name, Place place);
  /// Bracket an imported file, whose changes of the state do not affect the importing file.
  void begin_import(Place place);
  void end_import(Place place);
  void world_end(Place place);

  void camera(const std::string& kind, Parameters parameters, Place place);
  void film(const std::string& kind, Parameters parameters, Place place);
  void pixel_filter(const std::string& kind, Parameters parameters, Place place);
  void sampler(const std::string& kind, Parameters parameters, Place place);
  void integrator(const std::string& kind, Parameters parameters, Place place);
  void accelerator(Place place);  ///< checks only its block

  void material(const std::string& kind, Parameters parameters, Place place);
  void make_named_material(const std::string& name, Parameters parameters, Place place);
  void named_material(const std::string& name, Place place);
  void texture(Directive& d);
  void light_source(const std::string& kind, Parameters parameters, Place place);
  void area_light_source(const std::string& kind, Parameters parameters, Place place);
  void shape(const std::string& kind, Parameters parameters, Place place);
  void make_named_medium(const std::string& name, Parameters parameters, Place place);
  void medium_interface(Directive& d);

  enum class Block { attribute, object, import };
  struct Saved {
    GraphicsState state;
    Block block;
    Place place;
  };
  struct MaterialDeclaration {
    std::string kind, name;  ///< name: empty if anonymous
    ParameterList parameters;
  };
  /// The material of a shape: a named one, which may be defined later, or an anonymous one by its declaration's number.
  struct MaterialReference {
    std::string name;
    std::size_t declaration = 0;
    Place place;
  };
  struct TextureReference {
    std::string name;
    Place place;
  };
  struct FilmDirective {
    std::string kind = "rgb";
    ParameterList parameters;
  };
  /// A shape whose geometry has not been read from its file yet: `shapes(object)[shape]`.
  struct PendingPly {
    std::optional<description::Index> object;
    std::size_t shape = 0;
    std::filesystem::path path;
    Place place;
  };

  void require_world(std::string_view directive, Place place) const;
  void require_options(std::string_view directive, Place place) const;
  void push(Block block, Place place);
  void pop(Block block, std::string_view directive, Place place);
  std::vector<description::Shape>& shapes(std::optional<description::Index> object);
  description::Index object_index(const std::string& name, Place place);
  /// Index of a medium, which may be defined later; nullopt for the empty name.
  std::optional<description::Index> medium_index(const std::string& name, Place place);
  AnimatedTransform object_to_world() const;
  description::Index reference_texture(std::string name, Place place);
  bool equal_attributes(const description::Shape& a, const description::Shape& b) const;
  /// Transforms the curves to the space of their world or object, if the transform scales uniformly. Returns true if
  /// they were merged into the last shape.
  bool add_to_last_curves(description::Shape& shape);
  /// The start transform, for objects that cannot move.
  Transform fixed_transform(const char* thing, Place place);
  ParameterList list(std::string_view directive, const std::string& kind, Place place, Parameters parameters,
                     std::shared_ptr<const Parameters> defaults = nullptr) const;

  void build_film();
  void build_materials();
  void resolve_shapes();
  void resolve_references(description::Shape& shape);
  void report_missing_files();
  void expect_ply_files() const;
  void read_ply_files();
  void place_ply(const PendingPly& pending, PlyMesh&& mesh);
  void check_names_used() const;

  Context& context_;
  MeshObserver observer_;
  GraphicsState state_;
  std::vector<Saved> saved_;
  std::map<std::string, TransformPair> coordinate_systems_;
  bool in_world_ = false;
  std::optional<description::Index> current_object_;
  FilmDirective film_;

  std::vector<MaterialDeclaration> materials_;
  std::vector<MaterialReference> material_references_;
  std::unordered_map<std::string, Place> material_names_;
  std::vector<description::Index> material_of_reference_;
  std::vector<TextureReference> texture_references_;
  std::unordered_map<std::string, description::Index> objects_;
  std::vector<bool> object_defined_;
  std::vector<Place> object_places_;
  std::unordered_map<std::string, description::Index> media_;
  std::vector<bool> medium_defined_;
  std::vector<Place> medium_places_;
  std::vector<PendingPly> pending_plys_;
};

}  // namespace lanthorn::pbrt
