// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 §3.10 (cameras), KHR_lights_punctual.
#include "io/gltf/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/memory.h"
#include "io/gltf/accessor.h"
#include "io/gltf/materials.h"
#include "io/gltf/meshes.h"
#include "io/gltf/nodes.h"
#include "io/missing_files.h"
#include "lanthorn/text.h"
#include "math/vec.h"
#include "staging/surfaces.h"

namespace lanthorn::gltf {

namespace {

using namespace description;

constexpr std::size_t most_shapes = std::size_t{1} << 22, most_triangles = std::size_t{1} << 29,
                      instance_limit = std::size_t{1} << 24;
constexpr double bytes_of_instance = 2048;  // in the built scene, including its acceleration structures
// Limit for geometry that small files could multiply: meshes copied for every node, and points and lines.
constexpr std::size_t most_made_triangles = std::size_t{1} << 25;

// Beside those of materials.
constexpr std::array<std::string_view, 9> extensions_read = {
    "EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "EXT_texture_webp", "KHR_draco_mesh_compression",
    "KHR_lights_punctual", "KHR_mesh_quantization", "KHR_meshopt_compression", "KHR_texture_transform",
    // A warning follows where it is used.
    "KHR_texture_basisu"};

bool is_known(std::string_view extension) {
  return Materials::reads_extension(extension) ||
         std::find(extensions_read.begin(), extensions_read.end(), extension) != extensions_read.end();
}

void check_version(const Document& document) {
  const Value asset = document.root().at("asset");
  const std::string version = asset.at("version").text();
  if (!version.starts_with("2."))
    throw asset.at("version").error("only glTF 2 is supported, not " + in_quotes(version));
  if (const auto least = asset.find("minVersion"); least && least->text() != "2.0")
    throw least->error("only glTF 2.0 is supported, not " + in_quotes(least->text()));
}

void check_extensions(Document& document) {
  const auto unknown = [&](const char* list) {
    std::vector<Value> result;
    const auto names = document.root().find_array(list);
    for (std::size_t i = 0; names && i < names->size(); ++i)
      if (!is_known(names->element(i).text())) result.push_back(names->element(i));
    return result;
  };
  for (const Value& name : unknown("extensionsRequired"))
    throw name.error("the file cannot be read without extension " + in_quotes(name.text()) +
                     ", which is not supported");
  const std::vector<Value> ignored = unknown("extensionsUsed");
  if (ignored.empty()) return;
  std::vector<std::string> names(ignored.size());
  std::transform(ignored.begin(), ignored.end(), names.begin(), [](const Value& name) { return name.text(); });
  document.warn("extensions", ignored.front(),
                names.size() > 1 ? "extensions " + quoted_list(names) + " are not supported: ignored"
                                 : "extension " + quoted_list(names) + " is not supported: ignored");
}

class SceneReader {
 public:
  explicit SceneReader(Document& document) : document_(document), materials_(document) {}

  /// Reads the scene and returns what it lacks.
  StandIns read(const Choice& choice) {
    SceneDescription& scene = document_.scene;
    choose_variant(choice.variant);
    const Pose pose(document_, choice.seconds);
    const std::vector<PlacedNode> nodes = placed_nodes(document_, pose);
    for (const PlacedNode& placed : nodes) to_world_[placed.node] = placed.to_world;
    for (const PlacedNode& placed : nodes) {
      const Value node = document_.element("nodes", placed.node);
      if (node.find("mesh")) use_mesh(node, placed, pose);
      if (const auto camera = node.find("camera"))
        cameras_.push_back({node, document_.follow("cameras", *camera), placed.to_world});
      if (const auto light = node.extension("KHR_lights_punctual")) add_light(light->at("light"), placed.to_world);
    }
    for (const auto& [mesh, places] : mesh_uses_) add_mesh(document_.element("meshes", mesh), places, {});
    add_strokes();
    choose_camera(choice.camera);
    const bool is_lit_by_area = is_lit_by(scene, materials_.lamps());
    const bool has_light = !scene.lights.empty() || is_lit_by_area;
    const bool has_blind_camera = !cameras_.empty() && choice.camera.empty() && is_blind(scene.view.camera);
    return {.camera = cameras_.empty() || has_blind_camera,
            .light = !has_light,
            .one_sided = {materials_.one_sided(), true},
            .has_blind_camera = has_blind_camera,
            .reflects_darkness = !is_lit_by_area && materials_.reflect_surroundings()};
  }

 private:
  // True if the whole scene is behind the camera or in front of its near plane, as when an exporter has left the camera
  // at the origin, inside the model; or if it is entirely outside one side of the view.
  bool is_blind(const Camera& camera) const {
    const SceneDescription& scene = document_.scene;
    const Transform to_camera = camera.camera_to_world.start.inverted();
    const auto* lens = std::get_if<PerspectiveCamera>(&camera.node);
    const Vec2 size(scene.view.film.width, scene.view.film.height);
    const Vec2 half = (lens != nullptr ? std::tan(to_radians(lens->fov / 2)) : 1.0f) / std::min(size.x, size.y) * size;
    // Maps to side * x + half * z and side * y + half * z (orthographic: + half), which is negative beyond that side.
    std::vector<Transform> to_sides;
    for (const float side : {-1.0f, 1.0f}) {
      Mat4 to_side(1);
      for (const int axis : {0, 1}) {
        to_side[axis][axis] = side;
        to_side[lens != nullptr ? 2 : 3][axis] = half[axis];
      }
      to_sides.push_back(Transform(to_side) * to_camera);
    }
    const std::vector<Bounds> seen = bounds_of(scene, to_sides);
    return !seen[0].empty() && (seen[0].max.z < near_ || std::any_of(seen.begin(), seen.end(), [](const Bounds& b) {
                                  return b.max.x < 0 || b.max.y < 0;
                                }));
  }

  struct PlacedCamera {
    Value node, source;
    glm::dmat4 to_world;
  };

  /// Points and lines, kept until the size of the scene is known.
  struct PendingStrokes {
    Shape shape;
    Primitive primitive;
    std::vector<Transform> places;
  };

  // Undeformed meshes are stored once, however many nodes use them.
  void use_mesh(const Value& node, const PlacedNode& placed, const Pose& pose) {
    const std::size_t mesh = document_.index("meshes", node.at("mesh"));
    Deformation deformation{pose.morph_weights(placed.node), {}};
    std::vector<Transform> places;
    if (!document_.reads([&] {
          deformation.joints = joints_of(node);
          places = mesh_places(document_, placed);
        }))
      return;
    instances_ += places.size();
    if (instances_ > instance_limit)
      throw node.error("the file has more than " + std::to_string(instance_limit) + " instances");
    require_memory(bytes_of_instance * static_cast<double>(instances_), node.location(),
                   "the scene of " + std::to_string(instances_) + " instances");
    if (!deformation.joints.empty()) places = {Transform()};
    std::vector<Transform>& uses = mesh_uses_[mesh];
    if (deformation.is_none())
      uses.insert(uses.end(), places.begin(), places.end());
    else
      add_mesh(document_.element("meshes", mesh), places, deformation);
  }

  // Joint matrices of the node's skin: from the mesh's bind pose to the world.
  std::span<const glm::dmat4> joints_of(const Value& node) {
    const auto reference = node.find("skin");
    if (!reference) return {};
    const auto [skin, is_new] = skins_.try_emplace(document_.index("skins", *reference));
    if (is_new) skin->second = read_joints(document_.element("skins", skin->first));
    return skin->second;
  }

  std::vector<glm::dmat4> read_joints(const Value& skin) {
    const Value joints = skin.at("joints");
    const auto inverse = skin.find("inverseBindMatrices");
    const auto matrices = inverse ? std::optional(Accessor(document_, *inverse, 16)) : std::nullopt;
    if (matrices && matrices->count() < joints.size())
      throw inverse->error("has " + std::to_string(matrices->count()) + " matrices, but the skin has " +
                           std::to_string(joints.size()) + " joints");
    std::vector<glm::dmat4> result;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const auto found = to_world_.find(document_.index("nodes", joints.element(i)));
      if (found == to_world_.end()) {
        document_.warn("joint", joints.element(i), "the joint is not in the scene: the mesh keeps its bind pose");
        return {};
      }
      glm::dmat4 from_bind(1.0);
      for (int k = 0; matrices && k < 16; ++k)
        from_bind[k / 4][k % 4] = static_cast<double>(matrices->finite_number(i, static_cast<std::size_t>(k)));
      result.push_back(found->second * from_bind);
    }
    return result;
  }

  void add_mesh(const Value& mesh, const std::vector<Transform>& places, const Deformation& deformation) {
    if (places.empty()) return;
    const Value primitives = mesh.at("primitives");
    Object object{mesh.text("name", ""), {}};
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      const Value source = primitives.element(i);
      const Surface& surface = materials_.of(source);
      std::optional<Primitive> primitive;
      if (!document_.reads([&] { primitive = read_primitive(document_, source, surface, deformation); })) continue;
      if (!primitive) continue;
      Shape shape;
      shape.material = surface.material;
      shape.area_light = surface.area_light;
      shape.alpha = surface.alpha;
      shape.inside_medium = surface.inside_medium;
      shape.location = source.location();
      if (!primitive->strokes.empty()) {
        count_made_triangles(source, triangles_of_stroke * primitive->strokes.size() * places.size());
        strokes_.push_back({std::move(shape), std::move(*primitive), places});
        continue;
      }
      const std::size_t count = primitive->mesh.triangles.size();
      shape.geometry = std::move(primitive->mesh);
      const bool shared = places.size() > 1;
      if (!deformation.is_none()) count_made_triangles(source, count);
      count_triangles(source, count, shared ? 1 : places.size());
      if (shared)
        object.shapes.push_back(std::move(shape));
      else
        add_shape(std::move(shape), places.front());
    }
    if (object.shapes.empty()) return;
    const auto index = static_cast<Index>(document_.scene.objects.size());
    document_.scene.objects.push_back(std::move(object));
    for (const Transform& place : places)
      document_.scene.instances.push_back({index, AnimatedTransform(place), mesh.location()});
  }

  // Viewers draw points and lines about a pixel wide; here their radius is a fixed fraction of the scene's size.
  void add_strokes() {
    constexpr float thickness = 1e-3f;  // radius, as a fraction of the scene's diagonal
    Bounds bounds = bounds_of(document_.scene);
    for (const PendingStrokes& pending : strokes_)
      for (const Transform& place : pending.places)
        for (const Point& p : pending.primitive.mesh.positions) bounds.extend(place.point(p));
    const float diagonal = bounds.empty() ? 0 : std::sqrt(length_squared(bounds.extent()));
    const float radius = thickness * (diagonal > 0 && std::isfinite(diagonal) ? diagonal : 1);
    for (const PendingStrokes& pending : strokes_)
      for (const Transform& place : pending.places) {
        Shape shape = pending.shape;
        shape.geometry = thickened(pending.primitive.mesh, pending.primitive.strokes, place, radius);
        add_shape(std::move(shape), {});
      }
    if (!strokes_.empty())
      document_.warn("strokes", document_.root(),
                     "points and lines have no size in the file: their radius is a thousandth of the scene's size");
  }

  void add_shape(Shape shape, const Transform& place) {
    shape.object_to_world = AnimatedTransform(place);
    document_.scene.shapes.push_back(std::move(shape));
  }

  void count_triangles(const Value& primitive, std::size_t triangles, std::size_t copies) {
    triangles_ += triangles * copies;
    shapes_ += copies;
    if (triangles_ > most_triangles || shapes_ > most_shapes)
      throw primitive.error("the file has more than " + std::to_string(most_triangles) + " triangles or " +
                            std::to_string(most_shapes) + " primitives");
  }

  void count_made_triangles(const Value& primitive, std::size_t triangles) {
    made_triangles_ += triangles;
    if (made_triangles_ > most_made_triangles)
      throw primitive.error("deformed meshes, points and lines have more than " + std::to_string(most_made_triangles) +
                            " triangles");
  }

  // Names of the cameras for users: those of their nodes, or else their own, or else their numbers.
  std::vector<std::string> camera_names() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < cameras_.size(); ++i)
      names.push_back(cameras_[i].node.text("name", cameras_[i].source.text("name", std::to_string(i + 1))));
    return names;
  }
  const PlacedCamera& find_camera(const std::string& wanted) const {
    for (std::size_t i = 0; i < cameras_.size(); ++i)
      if (wanted == cameras_[i].node.text("name", "") || wanted == cameras_[i].source.text("name", "") ||
          wanted == std::to_string(i + 1))
        return cameras_[i];
    if (cameras_.empty()) throw Error({document_.name()}, "--camera " + printable(wanted) + ": the file has no camera");
    throw Error({document_.name()},
                fmt::format("--camera {}: the file has {}{}", printable(wanted), quoted_list(camera_names()),
                            printable(did_you_mean(wanted, camera_names()))));
  }
  void choose_camera(const std::string& wanted) {
    if (!wanted.empty()) return use_camera(find_camera(wanted));
    if (cameras_.empty()) return;
    use_camera(cameras_.front());
    if (cameras_.size() > 1)
      document_.warn("cameras", cameras_[1].source,
                     "the file has several cameras: the first one is used; --camera takes another of " +
                         quoted_list(camera_names()));
  }

  // KHR_materials_variants.
  void choose_variant(const std::string& wanted) {
    const auto extension = document_.root().extension("KHR_materials_variants");
    const auto variants = extension ? extension->find_array("variants") : std::nullopt;
    std::vector<std::string> names;
    for (std::size_t i = 0; variants && i < variants->size(); ++i)
      names.push_back(variants->element(i).text("name", std::to_string(i + 1)));
    if (wanted.empty()) {
      if (!names.empty())
        document_.warn("variants", *extension,
                       "the file has variants of its materials: --variant takes one of " + quoted_list(names));
      return;
    }
    for (std::size_t i = 0; i < names.size(); ++i)
      if (wanted == names[i]) return materials_.choose_variant(i);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (wanted == std::to_string(i + 1)) return materials_.choose_variant(i);
    throw Error({document_.name()},
                names.empty() ? "--variant " + printable(wanted) + ": the file has no variants of its materials"
                              : fmt::format("--variant {}: the file has {}{}", printable(wanted), quoted_list(names),
                                            printable(did_you_mean(wanted, names))));
  }

  void use_camera(const PlacedCamera& placed) {
    const auto& [node, source, to_world] = placed;
    Camera& camera = document_.scene.view.camera;
    camera.location = source.location();
    const auto type = source.at("type").name_among({"perspective", "orthographic"});
    if (!type)
      throw source.at("type").error("must be perspective or orthographic, not " + in_quotes(source.at("type").text()));
    float across = 1;  // half the film's shorter side, in the units of the camera's node
    if (*type == "perspective") {
      const Value lens = source.at("perspective");
      near_ = lens.number("znear", 0);
      camera.node = perspective(lens);
    } else {
      const Value lens = source.at("orthographic");
      const float x = half_size(lens, "xmag"), y = half_size(lens, "ymag");
      near_ = lens.number("znear", 0);
      set_aspect(std::clamp(x / y, aspects.least, aspects.most));
      across = std::min(x, y);
      camera.node = OrthographicCamera{};
    }
    // glTF's cameras look along -z, ours along z. The scale of a camera's node is ignored.
    glm::dmat4 rigid = to_world;
    for (int i = 0; i < 3; ++i) {
      const double length = glm::length(glm::dvec3(rigid[i]));
      rigid[i] /= length > 0 ? length : 1;
    }
    const Transform place = Transform(rigid) * scale({across, across, -1});
    if (place.is_singular()) throw source.error("the camera's node has a singular transformation");
    camera.camera_to_world = AnimatedTransform(place);
  }

  PerspectiveCamera perspective(const Value& lens) {
    lens.at("yfov");
    const float yfov = lens.number("yfov", pi / 4, {0, pi, false, false});
    const Film& film = document_.scene.view.film;
    float aspect = static_cast<float>(film.width) / static_cast<float>(film.height);
    if (lens.find("aspectRatio")) {
      aspect = lens.number("aspectRatio", aspect, aspects);
      set_aspect(aspect);
    }
    const float shorter = 2 * std::atan(std::tan(yfov / 2) * std::min(aspect, 1.0f));
    return {.fov = shorter * 180 / pi};
  }

  // Half the width or the height of an orthographic camera's view. Exporters may write a negative one.
  static float half_size(const Value& lens, const char* key) {
    lens.at(key);
    const float size = std::fabs(lens.number(key, 1));
    if (size > 0) return size;
    lens.at(key).warn(key, fmt::format("{} must not be 0: 1 is used", key));
    return 1;
  }

  static constexpr Range aspects{1e-3f, 1e3f, false, false};
  // Sets the film's aspect ratio; its longer side keeps its number of pixels.
  void set_aspect(float aspect) {
    Film& film = document_.scene.view.film;
    const int longer = film.width;
    const auto pixels = [&](float fraction) {
      return std::max(1, static_cast<int>(std::lround(static_cast<float>(longer) * fraction)));
    };
    film.width = pixels(std::min(aspect, 1.0f));
    film.height = pixels(std::min(1 / aspect, 1.0f));
  }

  void add_light(const Value& reference, const glm::dmat4& to_world) {
    const Value lights = document_.root().at("extensions").at("KHR_lights_punctual").at("lights");
    const std::uint64_t i = reference.integer();
    if (i >= lights.size())
      throw reference.error("is " + std::to_string(i) + ", but there are " + std::to_string(lights.size()) + " lights");
    const Value source = lights.element(static_cast<std::size_t>(i));
    const Vec3 colour = source.colour("color", Vec3(1));
    const float intensity = source.number("intensity", 1, Range::at_least(0));
    if (!(intensity * max_component(colour) > 0)) return;                             // the light is off
    const Emission emission{RgbSpectrum{{colour.x, colour.y, colour.z}}, intensity};  // lm/sr or lx
    Light light;
    light.location = source.location();
    const Value kind = source.at("type");
    const auto type = kind.name_among({"point", "spot", "directional"});
    if (type == "point") {
      PointLight point;
      point.intensity = emission;
      light.node = point;
    } else if (type == "directional") {
      DistantLight distant;
      distant.radiance = emission;
      distant.to = {0, 0, -1};
      light.node = distant;
    } else if (type == "spot") {
      light.node = spot(source, emission);
    } else {
      return kind.warn("light type", fmt::format("must be point, spot or directional, not {}: the light is left out",
                                                 in_quotes(kind.text())));
    }
    if (source.find("range"))
      document_.warn("range", source, "the range of lights is ignored: they reach any distance");
    light.light_to_world = Transform(to_world);
    if (light.light_to_world.is_singular())
      return reference.warn("singular light", "the light's node has a singular transformation: the light is left out");
    document_.scene.lights.push_back(std::move(light));
  }

  // Equal cones, which many programs write, make a hard edge.
  static SpotLight spot(const Value& source, const Emission& emission) {
    const auto cone = source.find("spot");
    constexpr float otherwise = pi / 4, widest = pi / 2 + 1e-4f;  // pi / 2, however it is rounded
    float outer = otherwise, inner = 0;
    if (cone) {
      outer = cone->number("outerConeAngle", otherwise, {0, widest, false});
      inner = cone->number("innerConeAngle", 0, {0, outer});
    }
    const float to_degrees = 180 / pi;
    SpotLight light;
    light.intensity = emission;
    light.to = {0, 0, -1};
    light.cone_angle = outer * to_degrees;
    light.cone_delta_angle = (outer - inner) * to_degrees;
    light.falloff = SpotFalloff::square;
    return light;
  }

  Document& document_;
  Materials materials_;
  std::map<std::size_t, glm::dmat4> to_world_;  // for the nodes in the scene
  std::map<std::size_t, std::vector<Transform>> mesh_uses_;
  std::vector<PendingStrokes> strokes_;
  std::vector<PlacedCamera> cameras_;
  float near_ = 0;  ///< near plane of the camera, metres
  std::map<std::size_t, std::vector<glm::dmat4>> skins_;
  std::size_t triangles_ = 0, made_triangles_ = 0, shapes_ = 0, instances_ = 0;
};

}  // namespace

File::File(std::string_view bytes, std::filesystem::path folder, const std::string& name, FileReader read_file,
           const FileAccess* access)
    : document_(std::make_unique<Document>(bytes, std::move(folder), name, std::move(read_file), access)),
      access_(access) {
  check_version(*document_);
}
File::~File() = default;

ModelFile File::read(const Choice& choice) {
  const bool is_first = !std::exchange(has_been_read_, true);
  if (!is_first) document_->start_again();
  check_extensions(*document_);
  StandIns lacking = SceneReader(*document_).read(choice);
  if (access_ != nullptr && (is_first || access_->skip_missing)) report_missing_files(document_->scene, *access_);
  return {std::move(document_->scene), std::move(lacking)};
}

ModelFile read(std::string_view bytes, std::filesystem::path folder, const std::string& name, FileReader read_file,
               const Choice& choice, const FileAccess* access) {
  return File(bytes, std::move(folder), name, std::move(read_file), access).read(choice);
}

}  // namespace lanthorn::gltf
