// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// From a file, or a description that a program makes, to a scene that can be rendered.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lanthorn/file_access.h"
#include "lanthorn/render_options.h"
#include "lanthorn/scene_description.h"

namespace lanthorn {

/// How a scene is read, and how far its file is trusted.
struct ReadOptions {
  /// Reads only files in the tree of the scene file's folder; error messages show no content of files.
  bool sandbox = false;
  std::uint64_t max_pixels = FileAccess::default_max_pixels;  ///< of each image that the scene names
  /// Goes on without missing files: meshes and media are left out, textures have the neutral value of their use
  /// (colours are grey, emission and transmission 0, metalness and roughness as their factors say), measured materials
  /// are grey, spectra 1, included files empty, lenses of 50 mm; a warning names each.
  bool skip_missing = false;
  /// Bytes for the textures' images; half of the free memory if not given. What does not fit is kept in tiles on disk
  /// and read as it is looked at. The picture is the same.
  std::optional<std::uint64_t> texture_memory{};
  bool window_glass = false;        ///< calls `replace_window_glass`
  std::optional<double> at{};       ///< seconds into the first animation of a glTF file; none: everything is at rest
  std::string camera{};             ///< of a glTF file: name, or number from 1 on; empty: the first one
  EnvironmentChoice environment{};  ///< calls `replace_environment`, unless it is the scene's own
};

/// Reads a scene file by its extension: .pbrt (pbrt-v4 and v3), .gltf and .glb (glTF 2.0), .obj (Wavefront), each also
/// gzipped (.gz). The description's `warnings` list what is ignored or replaced, `hash` and `files` what was read.
/// Throws Error with its place (file, line and column; in glTF files file and JSON pointer) if the file, or one that it
/// names, is wrong.
SceneDescription read_scene(const std::filesystem::path& path, const ReadOptions& options = {});

/// A scene file of which several moments are wanted: it is read once.
class SceneFile {
 public:
  /// Throws Error as `read_scene`. `ReadOptions::at` is not looked at.
  explicit SceneFile(const std::filesystem::path& path, const ReadOptions& options = {});
  ~SceneFile();
  SceneFile(const SceneFile&) = delete;
  SceneFile& operator=(const SceneFile&) = delete;

  /// The scene at this time in its animation, as `ReadOptions::at` says it. Throws Error as `read_scene`.
  SceneDescription at(const std::optional<double>& seconds);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// True if the name ends as those of files that `read_scene` reads.
bool is_scene_file(const std::filesystem::path& path);

/// The mesh of a PLY file (.ply, .ply.gz) as shapes with the default material: one of its triangles, one of its quads,
/// which are bilinear patches; without those that it has not. Larger polygons become triangles. For the shapes of OBJ
/// and glTF files, `read_scene`. Throws Error with its place if the file is wrong.
std::vector<description::Shape> read_mesh(const std::filesystem::path& path);

/// Lets all rays pass straight through clear panes, so that next-event estimation finds the light behind them: shapes
/// of thin dielectric, exactly, and flat slabs of smooth dielectric, closed or as two faces, whose small displacement
/// of rays is left out. They reflect as before. Glass with dispersion stays as it is. Returns the number of shapes.
std::size_t replace_window_glass(SceneDescription& scene);

/// Moves the origin of the coordinates near the camera, along each axis on which it is at least 1024 m away, and adds
/// the way to `SceneDescription::origin`. Rays are traced in single precision, whose steps grow with the coordinates:
/// .5 mm at 5 km. `read_scene` and `read_pbrt_string` call this. `LookAt` and `Photons` keep the file's coordinates.
void move_origin(SceneDescription& scene);
/// Names of environments that need no file.
std::vector<std::string> environment_names();
/// Puts an environment in the place of all infinite lights of a scene, or of the environment that an earlier call put
/// there. +y of a picture is up; the middle of an equirectangular one is in the direction +x, and what is to its right
/// in +z. The scene's camera sees it as it is, not mirrored. Without `EnvironmentChoice::source`, the scene gets back
/// the lights that it had before the first call. A source is read once: calls that turn or scale it share its picture.
/// Throws Error if the file cannot be read, or has another shape or more pixels than the scene's `access` allows.
void replace_environment(SceneDescription& scene, const EnvironmentChoice& choice);

/// Reads the text of a pbrt file. Relative file names start in `folder`; messages call the text `name`.
SceneDescription read_pbrt_string(std::string_view text, const std::filesystem::path& folder, const std::string& name);

/// A pbrt-v3 file translated to pbrt-v4.
struct UpgradedScene {
  std::string text;
  std::map<std::string, description::File>
      files;                                   ///< that were read for it besides the scene file: included ones, spectra
  std::vector<description::Warning> warnings;  ///< what is only approximated, once for each kind
};
/// Translates a pbrt-v3 file. Relative file names in the text start in the folder `target`; what the file includes is
/// part of the text. Throws Error with its place if the file is wrong, or is of pbrt-v4.
UpgradedScene upgrade_pbrt(const std::filesystem::path& path, const std::filesystem::path& target,
                           const ReadOptions& options = {});

/// An immutable scene, ready to be rendered: geometry in a ray tracer, materials, textures, media, lights. Its members
/// are internal; the functions below tell about it.
class Scene;
using SharedScene = std::shared_ptr<const Scene>;

/// A camera at `eye` that looks at `target`; metres, in the coordinates of the scene's file. `up` is upwards in the
/// picture, of any length.
struct LookAt {
  DVec3 eye{0.0}, target{0, 0, 1}, up{0, 1, 0};
  friend bool operator==(const LookAt&, const LookAt&) = default;
};

/// `like`: a scene from the same `SceneFile`. The new one shares its images and does not read them again. Throws Error
/// at the location of an error in the description.
SharedScene build_scene(SceneDescription description, const SharedScene& like = {});

/// Replacements, by index into the vectors of the same names of a scene's description (`description_of`).
struct SceneEdits {
  std::map<description::Index, description::Material> materials{};
  std::map<description::Index, description::AreaLight> area_lights{};
  std::map<description::Index, description::Light> lights{};
  std::map<description::Index, AnimatedTransform> instances{};  ///< object to world
  /// As `replace_environment`; `lights` are those after it.
  std::optional<EnvironmentChoice> environment{};
  /// A number of your own for these edits of this scene, if states of the edited scene shall be resumed by another
  /// process.
  std::optional<std::uint64_t> hash{};
};

/// What users call a description's lights and area lights: light1, light2 ..., area1, area2 ...
std::string name_of_light(description::Index index);
std::string name_of_area_light(description::Index index);
/// Multiplies the light that they emit.
void scale_light(description::Light& light, float factor);
void scale_light(description::AreaLight& light, float factor);

/// The scene with replacements. It shares geometry, acceleration structures, images and media with the old one, which
/// stays as it is: the time depends on the numbers of materials, lights and instances, not on those of triangles. The
/// first edit of an instance also builds an acceleration structure for the shapes that are not instanced.
///
/// Throws Error for indices out of range, and for what needs the scene to be built again: a material that becomes or
/// was an interface or hair, or gets another medium inside; a new place for an instance that emits or was not visible.
/// Without `SceneEdits::hash`, states of an edited scene belong to this very scene: they cannot be resumed by another
/// process.
SharedScene edit_scene(const Scene& scene, const SceneEdits& edits);

/// The description that the scene was built from, without its meshes, and with the warnings of building.
const SceneDescription& description_of(const Scene& scene);

/// Triangles of one shape, in the space of its instances. Counter-clockwise as seen from outside.
struct SceneMesh {
  std::vector<Point> positions;
  std::vector<Normal> normals;  ///< empty or one per position; not normalised
  std::vector<Vec2> uvs;        ///< empty or one per position
  std::vector<std::array<std::uint32_t, 3>> triangles;
  description::Index material = 0;  ///< into the description's materials, which have names
  bool emits = false;
  SourceLocation location;  ///< of the shape in the scene file
};
/// A scene as a rasteriser or an exporter wants it.
struct SceneModel {
  struct Instance {
    std::size_t first_mesh = 0, mesh_count = 0;
    Transform to_world;                          ///< when the shutter opens
    std::string object;                          ///< the object's name; empty for shapes that are not instanced
    std::optional<description::Index> instance;  ///< into the description's instances
  };
  std::vector<SceneMesh> meshes;
  std::vector<Instance> instances;
};
/// All surfaces of a scene. Meshes are exact. Quadrics have 64 segments around, patches that are not flat 8 x 8
/// squares; curves become tubes. Displacement is applied. Does not need the scene's file.
SceneModel model_of(const Scene& scene);

/// How far before the camera, along its axis, the nearest surface lies that a pixel of the whole picture sees; none:
/// the picture's middle. In the units of the camera's space, for `focal_distance`. nullopt if it sees none. Throws
/// Error as `check_view` does.
std::optional<float> depth_at(const Scene& scene, const ViewDescription& view, const ViewOptions& options = {},
                              const std::optional<Vec2>& pixel = {});

/// What a scene, seen like this, asks for and does not get: warnings of reading and of building, and media that
/// contradict each other along rays from the camera and to the lights.
std::vector<description::Warning> warnings_of(const Scene& scene, const ViewDescription& view);

/// Why a picture of this view shows nothing but black, as the end of a message: the scene has no light, its lights have
/// no power, the camera sees no surface, what it sees is closed off from all lights ...
std::string reason_for_black(const Scene& scene, const ViewDescription& view);

/// What is in a scene.
struct SceneSummary {
  std::uint64_t triangles = 0, patches = 0, quadrics = 0, curves = 0;  ///< each once, however often it is instanced
  std::uint64_t instances = 0, textures = 0;
  std::map<std::string, int> lights, materials;  ///< numbers by kind
  Bounds bounds;                                 ///< in the coordinates of the file
  std::uint64_t geometry_bytes = 0, bvh_bytes = 0, texture_bytes = 0;
  std::uint64_t texture_disk_bytes = 0;  ///< of textures that do not fit into memory
  std::uint64_t texture_tiles_read = 0;  ///< of these, so far
  double build_seconds = 0;
  bool has_dispersion = false;        ///< an index of refraction depends on the wavelength
  bool has_measured_spectra = false;  ///< materials other than metals have tabulated spectra
  bool has_motion = false;            ///< something moves while the shutter is open, or the file's camera does
};
SceneSummary summarize(const Scene& scene);

}  // namespace lanthorn
