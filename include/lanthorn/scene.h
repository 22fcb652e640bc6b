// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes: reads a file or takes a description that a program makes, and builds a scene that can be rendered.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
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
  /// Reads only files below the scene file's folder; error messages reveal no content of files.
  bool sandbox = false;
  std::uint64_t max_pixels = FileAccess::default_max_pixels;  ///< of each image that the scene names
  /// Continues without missing files: omits meshes and media, gives textures the neutral value of their use (colours
  /// grey, emission and transmission 0, metalness and roughness their factors), makes measured materials grey and
  /// spectra 1, treats included files as empty, and replaces lenses by 50 mm ones; a warning names each file.
  bool skip_missing = false;
  /// Memory for the textures' images, in bytes; default: half of the free memory. Images that do not fit are stored in
  /// tiles on disk and read on demand. The picture is the same.
  std::optional<std::uint64_t> texture_memory{};
  bool window_glass = false;        ///< calls `replace_window_glass`
  std::optional<double> at{};       ///< seconds into the first animation of a glTF file; nullopt: the rest pose
  std::string camera{};             ///< of a glTF file: name, or number starting at 1; empty: the first one
  std::string variant{};            ///< of a glTF file's materials: name, or number starting at 1; empty: the default
  EnvironmentChoice environment{};  ///< calls `replace_environment`, unless it is the scene's own
};

/// Reads a scene file, chosen by its extension: .pbrt (pbrt-v4 and v3), .gltf and .glb (glTF 2.0), .obj (Wavefront),
/// each also gzipped (.gz). The description's `warnings` list the features that are ignored or replaced; `hash` and
/// `files` identify the files read. Throws Error with its location (file, line and column; in glTF files file and JSON
/// pointer) if the file, or one that it names, is invalid.
SceneDescription read_scene(const std::filesystem::path& path, const ReadOptions& options = {});

/// The PLY files of a pbrt scene, according to their headers. Gzipped files are not counted.
struct ExpectedMeshes {
  std::size_t files = 0;  ///< references from shapes to files
  double faces = 0;
  double bytes = 0;  ///< of memory, including acceleration structures
};

/// Called before any of the files is read.
using MeshObserver = std::function<void(const ExpectedMeshes&)>;

/// `read_scene` for callers that want to report the size of the scene before it is loaded.
SceneDescription read_scene(const std::filesystem::path& path, const ReadOptions& options,
                            const MeshObserver& observer);

/// A scene file that is read once and yields the scene at several times of its animation.
class SceneFile {
 public:
  /// Throws Error as `read_scene` does. `ReadOptions::at` is ignored.
  explicit SceneFile(const std::filesystem::path& path, const ReadOptions& options = {});
  ~SceneFile();
  SceneFile(const SceneFile&) = delete;
  SceneFile& operator=(const SceneFile&) = delete;

  /// The scene at a time of its animation, see `ReadOptions::at`. Throws Error as `read_scene` does.
  SceneDescription at(const std::optional<double>& seconds);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// True if the name has an extension that `read_scene` supports.
bool is_scene_file(const std::filesystem::path& path);

/// The mesh of a PLY file (.ply, .ply.gz) as shapes with the default material: one of its triangles and one of its
/// quads, as bilinear patches; a shape without faces is omitted. Larger polygons are triangulated. For OBJ and glTF
/// files, use `read_scene`. Throws Error with its location if the file is invalid.
std::vector<description::Shape> read_mesh(const std::filesystem::path& path);

/// Lets all rays pass straight through clear panes, so that next-event estimation finds the light behind them. Panes
/// are shapes of thin dielectric, for which this is exact, and flat slabs of smooth dielectric, closed or as two faces,
/// for which it ignores the small displacement of rays. Light that is reflected to and fro between the faces of a pane,
/// and between parallel panes of one size that are closer to each other than a tenth of their extent, passes or is
/// reflected with the rest. Panes of other glass (tinted, absorbing, rough, dispersive …) stay as they are; a warning
/// for each reason counts them. Returns the number of shapes replaced.
std::size_t replace_window_glass(SceneDescription& scene);

/// Moves the origin near the camera, along each axis on which the camera is at least 1024 m away, and adds the offset
/// to `SceneDescription::origin`. Rays are traced in single precision, whose spacing grows with the coordinates: 0.5 mm
/// at 5 km. `read_scene` and `read_pbrt_string` call this function. `LookAt` and `Photons` use the file's coordinates.
void move_origin(SceneDescription& scene);
/// Names of the built-in environments, which need no file.
std::vector<std::string> environment_names();
/// Replaces all infinite lights of a scene, or the environment of an earlier call, with an environment. +y of a picture
/// is up; the centre of an equirectangular picture is in direction +x, and a quarter of its width further right is +z.
/// The scene's camera sees it unmirrored. Without `EnvironmentChoice::source`, restores the lights that the scene had
/// before the first call. Each source is read once: calls that only rotate or scale it share its picture. Throws Error
/// if the file cannot be read, or has an unknown shape or more pixels than the scene's `access` allows.
void replace_environment(SceneDescription& scene, const EnvironmentChoice& choice);

/// Reads pbrt text. Relative file names are resolved in `folder`; messages call the text `name`.
SceneDescription read_pbrt_string(std::string_view text, const std::filesystem::path& folder, const std::string& name);

/// A pbrt-v3 file translated to pbrt-v4.
struct UpgradedScene {
  std::string text;
  std::map<std::string, description::File> files;  ///< other files that were read for it: included files, spectra
  std::vector<description::Warning> warnings;      ///< what is only approximated, once for each kind
};
/// Translates a pbrt-v3 file. Relative file names in the text are relative to the folder `target`; included files
/// become part of the text. Throws Error with its location if the file is invalid, or already in pbrt-v4.
UpgradedScene upgrade_pbrt(const std::filesystem::path& path, const std::filesystem::path& target,
                           const ReadOptions& options = {});

/// An immutable scene, ready to be rendered: geometry in a ray tracer, materials, textures, media, lights. Its members
/// are internal; query it with the functions below.
class Scene;
using SharedScene = std::shared_ptr<const Scene>;

/// A camera at `eye` that looks at `target`, in metres, in the coordinates of the scene's file. `up`, of any length,
/// points up in the picture.
struct LookAt {
  DVec3 eye{0.0}, target{0, 0, 1}, up{0, 1, 0};
  friend bool operator==(const LookAt&, const LookAt&) = default;
};

/// Builds the parts whose descriptions differ from those of `previous`, and shares the others with it. To change a
/// scene, change a copy of its description (`description_of`) and build that:
///
///     SceneDescription description = description_of(*scene);
///     scale_light(description.lights[0], 0.5f);
///     scene = build_scene(std::move(description), scene);
///
/// The old scene stays as it is. Changes of materials, lights, media and places of instances take time that depends on
/// their numbers, not on the number of triangles. The first move of an instance also builds an acceleration structure
/// for the shapes that are not instanced. Images that `previous` has read are not read again.
///
/// Shapes, objects, float textures and the shutter interval need new geometry. So do a material that becomes or was an
/// interface or hair, or gets another interior medium, and a new transform for an instance that emits or was not
/// visible. New geometry needs the meshes: a copy of `description_of` lacks them, and such changes to it throw Error.
///
/// States belong to a description's `hash`. If the changed description still has the hash of the old one, it gets a
/// number that no other scene has: another process then cannot resume states of the scene.
///
/// Throws Error at the location of an error in the description.
SharedScene build_scene(SceneDescription description, const SharedScene& previous = {});

/// Names of a description's lights and area lights in options: light1, light2, ..., area1, area2, ...
std::string name_of_light(description::Index index);
std::string name_of_area_light(description::Index index);
/// Multiplies the light's emission by `factor`.
void scale_light(description::Light& light, float factor);
void scale_light(description::AreaLight& light, float factor);

/// The description that the scene was built from, without its meshes, and including warnings from building.
const SceneDescription& description_of(const Scene& scene);

/// A light with a descriptive name, for user interfaces.
struct NamedLight {
  std::string id;  ///< `name_of_light` or `name_of_area_light`, as options use it
  /// Kind or material, and place in the view of the scene's camera: "Lamp 2, ceiling", "Point light, left".
  std::string words;
};

/// All lights in the order of the description: first the area lights that shapes use, then the others. Lights that
/// would have equal words are numbered.
std::vector<NamedLight> lights_of(const Scene& scene);

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
/// A scene as triangles, for rasterisers and exporters.
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
/// All surfaces of a scene as triangles. Meshes are exact, with displacement applied. Quadrics get 64 segments around
/// their axis, curved patches 8 x 8 squares; curves become tubes. Does not need the scene's file.
SceneModel model_of(const Scene& scene);

/// Depth, along the camera's axis, of the nearest surface that a pixel of the whole picture sees; default: the centre
/// of the picture. In the units of camera space, as for `focal_distance`. nullopt if the pixel sees no surface. Throws
/// Error as `check_view` does.
std::optional<float> depth_at(const Scene& scene, const ViewDescription& view, const ViewOptions& options = {},
                              const std::optional<Vec2>& pixel = {});

/// Warnings about a scene with this view: unsupported features found while reading and building, and media that are
/// inconsistent along rays from the camera and to the lights.
std::vector<description::Warning> warnings_of(const Scene& scene, const ViewDescription& view);

/// Why a picture of this view is entirely black, as the end of a message: the scene has no light, its lights have no
/// power, the camera sees no surface, all visible surfaces are sealed off from the lights, ...
std::string reason_for_black(const Scene& scene, const ViewDescription& view);
/// Why hardly any light arrives in a picture of this view that is not black, likewise: the camera sees no surface or is
/// enclosed, no light is in sight of what it sees, or the lights are faint.
std::string reason_for_faint(const Scene& scene, const ViewDescription& view);

/// What is in a scene.
struct SceneSummary {
  std::uint64_t triangles = 0, patches = 0, quadrics = 0, curves = 0;  ///< counted once per object, not per instance
  std::uint64_t instances = 0, textures = 0;
  std::map<std::string, int> lights, materials;  ///< counts by kind
  Bounds bounds;                                 ///< in the coordinates of the file
  std::uint64_t geometry_bytes = 0, bvh_bytes = 0, texture_bytes = 0;
  std::uint64_t texture_disk_bytes = 0;  ///< of textures that do not fit into memory
  std::uint64_t texture_tiles_read = 0;  ///< from disk, so far
  double build_seconds = 0;
  bool has_dispersion = false;        ///< an index of refraction depends on the wavelength
  bool has_measured_spectra = false;  ///< materials other than metals have tabulated spectra
  bool has_motion = false;            ///< something moves while the shutter is open, or the file's camera does
};
SceneSummary summarize(const Scene& scene);

}  // namespace lanthorn
