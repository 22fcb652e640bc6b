// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A scene as plain data: what a reader (pbrt, glTF, OBJ) writes and `build_scene` reads. No behaviour, no
// pointers; parts refer to each other by index. Every part that can be wrong keeps its place in the file.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/file_access.h"
#include "lanthorn/error.h"
#include "math/transform.h"
#include "math/vec.h"
#include "spectrum/buckets.h"
#include "spectrum/curve.h"
#include "surface/measured_data.h"

namespace lanthorn::description {

/// Index into one of SceneDescription's vectors.
using Index = std::uint32_t;

/// Piecewise-linear samples.
struct SampledSpectrum {
  std::vector<float> nm;
  std::vector<float> values;
};
/// RGB as given, in a colour space; what it means (albedo, light, plain numbers) is decided by where it is used.
struct RgbSpectrum {
  Rgb rgb;
  ColorSpace space = ColorSpace::srgb;
};
struct BlackbodySpectrum {
  float kelvin = 6500;
};
struct NamedSpectrum {
  std::string name;  ///< known to `named_spectrum`
};
/// A spectrum parameter: constant, RGB, blackbody, named or sampled (spectrum files are read into samples by the
/// reader).
using SpectrumValue = std::variant<float, RgbSpectrum, BlackbodySpectrum, NamedSpectrum, SampledSpectrum>;

/// A float that a texture may vary.
struct FloatParameter {
  float value = 0;
  std::optional<Index> texture;  ///< into SceneDescription::float_textures
};
/// A spectrum that a texture may vary.
struct SpectrumParameter {
  SpectrumValue value = 0.0f;
  std::optional<Index> texture;  ///< into SceneDescription::spectrum_textures
};

// Textures. `FloatParameter`s and `SpectrumParameter`s inside them refer to textures defined before.

// How a texture's place follows from a surface point. Transforms lead from world to texture space.

/// (s, t) = linear * (u, v) + offset.
struct UvMapping {
  Mat2 linear{1.0f};
  Vec2 offset{0, 0};
};
/// (s, t) = (theta / pi, phi / 2 pi) of the direction from the origin, theta from +z.
struct SphericalTextureMapping {
  Transform world_to_texture;
};
/// (s, t) = (1/2 + phi / 2 pi, z), phi in (-pi, pi].
struct CylindricalTextureMapping {
  Transform world_to_texture;
};
/// (s, t) = (p . v1, p . v2) + offset.
struct PlanarTextureMapping {
  Transform world_to_texture;
  Vec3 v1{1, 0, 0}, v2{0, 1, 0};
  Vec2 offset{0, 0};
};
using TextureMapping =
    std::variant<UvMapping, SphericalTextureMapping, CylindricalTextureMapping, PlanarTextureMapping>;
/// Of textures that fill space.
struct SolidMapping {
  Transform world_to_texture;
};

// Texture nodes: of `Parameter`s here, of compiled inputs in the texture graph. `Factor` is what stands for a float.

enum class Wrap : std::uint8_t { repeat, mirror, black, clamp, octahedral_sphere };
enum class Encoding : std::uint8_t { automatic, srgb, linear, gamma };
enum class ImageFilter : std::uint8_t { point, bilinear };
/// An image file that came inside another file.
struct EmbeddedImage {
  std::string name;   ///< for messages
  std::string bytes;  ///< of the whole image file (PNG, JPEG, WebP)
};
struct ImageTexture {
  std::string filename;           ///< absolute, or relative to the working folder
  std::optional<Index> embedded;  ///< into SceneDescription::embedded_images, instead of `filename`
  TextureMapping mapping;
  Wrap wrap = Wrap::repeat;
  ImageFilter filter = ImageFilter::bilinear;
  Encoding encoding = Encoding::automatic;  ///< automatic: sRGB for 8-bit and PNG files, linear otherwise
  float gamma = 1;                          ///< for Encoding::gamma
  float scale = 1;
  Rgb tint{1, 1, 1};  ///< of spectrum textures: a further factor, linear sRGB
  bool invert = false;
  ColorSpace space = ColorSpace::srgb;
  /// Of float textures: which channel to read (0 is red; a grey image has its value in 0 to 2; a missing alpha is 1).
  /// Without: see TextureImage::scalar.
  std::optional<int> channel;
  std::optional<float> threshold;  ///< of float textures: the result is 1 from here on and 0 below
};
/// tex1 where the sum of the floors of the coordinates is even; "dimension" 3 has a SolidMapping.
template <class Parameter>
struct Checkerboard {
  std::variant<TextureMapping, SolidMapping> mapping;
  Parameter tex1, tex2;
};
template <class Parameter, class Factor = FloatParameter>
struct ScaleTexture {
  Parameter tex;
  Factor scale;
};
template <class Parameter, class Factor = FloatParameter>
struct MixTexture {
  Parameter tex1, tex2;
  Factor amount;  ///< of tex2
};
template <class Parameter>
struct ConstantTexture {
  Parameter value;
};
/// tex1 where the geometric normal is along `direction` (either way), tex2 across it, linear in the cosine.
template <class Parameter>
struct DirectionMixTexture {
  Parameter tex1, tex2;
  Direction direction{0, 1, 0};  ///< world
};
/// Value vij at (s, t) = (i, j), bilinear in between and beyond.
template <class Parameter>
struct BilerpTexture {
  TextureMapping mapping;
  Parameter v00, v01, v10, v11;
};
/// A dot of radius 0.35 in about 40 % of the unit cells of (s, t).
template <class Parameter>
struct DotsTexture {
  TextureMapping mapping;
  Parameter inside, outside;
};
/// Octave i of a sum of noise has 1.99^i times the frequency and roughness^i times the amplitude of the first.
struct Octaves {
  int count = 8;
  float roughness = 0.5f;
};
struct FbmTexture {
  SolidMapping mapping;
  Octaves octaves;
};
struct WrinkledTexture {
  SolidMapping mapping;
  Octaves octaves;
};
struct WindyTexture {
  SolidMapping mapping;
};
struct MarbleTexture {
  SolidMapping mapping;
  Octaves octaves;
  float scale = 1;
  float variation = 0.2f;
};
/// Reflectances and lights are upsampled from RGB differently.
enum class SpectrumRole : std::uint8_t { albedo, unbounded, illuminant };
struct FloatTexture {
  std::variant<ConstantTexture<FloatParameter>, ImageTexture, Checkerboard<FloatParameter>,
               ScaleTexture<FloatParameter>, MixTexture<FloatParameter>, DirectionMixTexture<FloatParameter>,
               BilerpTexture<FloatParameter>, DotsTexture<FloatParameter>, FbmTexture, WrinkledTexture, WindyTexture>
      node;
  SourceLocation location;
};
struct SpectrumTexture {
  std::variant<ConstantTexture<SpectrumParameter>, ImageTexture, Checkerboard<SpectrumParameter>,
               ScaleTexture<SpectrumParameter>, MixTexture<SpectrumParameter>, DirectionMixTexture<SpectrumParameter>,
               BilerpTexture<SpectrumParameter>, DotsTexture<SpectrumParameter>, MarbleTexture>
      node;
  SourceLocation location;
};

// Materials. Parameters carry pbrt-v4's defaults.

struct Roughness {
  FloatParameter u, v;  ///< user roughness in [0,1] or GGX alpha
  bool remap = true;    ///< alpha = sqrt(roughness)
};
struct DiffuseMaterial {
  SpectrumParameter reflectance{0.5f, {}};
};
struct DiffuseTransmissionMaterial {
  SpectrumParameter reflectance{0.25f, {}}, transmittance{0.25f, {}};
  float scale = 1;
};
/// Either (eta, k) or a reflectance.
struct ConductorMaterial {
  std::optional<SpectrumParameter> reflectance;
  SpectrumParameter eta{NamedSpectrum{"metal-Cu-eta"}, {}}, k{NamedSpectrum{"metal-Cu-k"}, {}};
  Roughness roughness;
};
struct DielectricMaterial {
  SpectrumValue eta = 1.5f;
  Roughness roughness;
};
struct ThinDielectricMaterial {
  SpectrumValue eta = 1.5f;
};
struct Coat {
  Roughness roughness;
  FloatParameter thickness{0.01f, {}};
  SpectrumValue eta = 1.5f;
  SpectrumParameter albedo{0.0f, {}};
  FloatParameter g{0, {}};
  int max_depth = 10;
  int samples = 1;
};
struct CoatedDiffuseMaterial {
  SpectrumParameter reflectance{0.5f, {}};
  Coat coat;
};
struct CoatedConductorMaterial {
  std::optional<SpectrumParameter> reflectance;
  SpectrumParameter eta{NamedSpectrum{"metal-Cu-eta"}, {}}, k{NamedSpectrum{"metal-Cu-k"}, {}};
  Roughness conductor_roughness;
  Coat coat;
};
/// Absorption per radius of the hair: `sigma_a`, or else what gives it this `color`, or else melanin, 1.3 of eumelanin
/// if nothing is given.
struct HairMaterial {
  std::optional<SpectrumParameter> sigma_a, color;
  FloatParameter eumelanin{0, {}}, pheomelanin{0, {}};
  FloatParameter eta{1.55f, {}}, beta_m{0.3f, {}}, beta_n{0.3f, {}};
  FloatParameter alpha{2, {}};  ///< degrees
};
/// A diffuse base under a dielectric surface, in closed form (glTF's dielectric; see surface/plastic.h).
struct PlasticMaterial {
  SpectrumParameter reflectance{0.5f, {}};
  Roughness roughness;  ///< the same along u and v
  SpectrumValue eta = 1.5f;
  FloatParameter specular{1, {}};              ///< factor of the reflection at every angle, in [0,1]
  SpectrumParameter specular_color{1.0f, {}};  ///< factor of the reflection at normal incidence alone
};
struct MeasuredMaterial {
  Index brdf = 0;  ///< into SceneDescription::measured_brdfs
};
/// materials[0] where `amount` is 0, materials[1] where it is 1.
struct MixMaterial {
  std::array<Index, 2> materials{};
  FloatParameter amount{0.5f, {}};
};
/// No surface: light passes, media change.
struct InterfaceMaterial {};
/// Shading normals from an image: r, g, b are (x + 1) / 2 of their coordinates along dp/du, dp/dv and the smooth
/// normal. Encoding should be linear.
struct NormalMap {
  ImageTexture image;
  float strength = 1;  ///< multiplies x and y
};
struct Material {
  std::variant<DiffuseMaterial, DiffuseTransmissionMaterial, ConductorMaterial, DielectricMaterial,
               ThinDielectricMaterial, CoatedDiffuseMaterial, CoatedConductorMaterial, HairMaterial, PlasticMaterial,
               MeasuredMaterial, MixMaterial, InterfaceMaterial>
      node;
  std::optional<NormalMap> normal_map;         ///< wins over `displacement`; a mix has neither, its parts may
  std::optional<FloatParameter> displacement;  ///< metres along the normal; changes shading normals alone
  std::optional<Index> interior;  ///< medium inside shapes of this material, instead of theirs (subsurface scattering)
  std::string name;               ///< empty if anonymous
  SourceLocation location;
};

// Participating media.

/// The same everywhere.
struct HomogeneousDensity {};
/// Values on a regular grid over a box in the medium's space, x running fastest.
template <class T>
struct MediumGrid {
  std::array<int, 3> size{};
  Point low{0}, high{1};
  std::vector<T> values;
};
/// A grid of a NanoVDB file.
struct VdbGrid {
  std::string filename, grid;
};
using ScalarGrid = std::variant<MediumGrid<float>, VdbGrid>;
/// Emission as a black body: T = (temperature - offset) * scale kelvin.
struct TemperatureGrid {
  ScalarGrid temperature;
  float offset = 0, scale = 1;
};
struct GridDensity {
  ScalarGrid density;
  std::optional<MediumGrid<float>> emission_factor;
  std::optional<TemperatureGrid> temperature;  ///< instead of the medium's emission spectrum
};
/// Noise in the shape of a cloud.
struct CloudDensity {
  Point low{0}, high{1};
  float density = 1, wispiness = 1, frequency = 5;
};
/// Colours instead of the medium's spectra.
struct RgbGridDensity {
  std::optional<MediumGrid<Rgb>> sigma_a, sigma_s, emission;
};
/// Absorption and scattering per metre, times `scale` and what the density adds.
struct Medium {
  SpectrumValue sigma_a = 0.0f, sigma_s = 0.0f;
  float scale = 1;
  float g = 0;                            ///< mean cosine of scattering (Henyey & Greenstein)
  std::optional<SpectrumValue> emission;  ///< a light's spectrum
  float emission_scale = 1;
  std::variant<HomogeneousDensity, GridDensity, CloudDensity, RgbGridDensity> density;
  std::string name;
  Transform medium_to_world;
  SourceLocation location;
};

// Shapes.

struct TriangleMesh {
  std::vector<Point> positions;
  std::vector<Normal> normals;  ///< empty or one per position; need not be unit length
  std::vector<Vec3> tangents;   ///< empty or one per position
  std::vector<Vec2> uvs;        ///< empty or one per position
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
/// Patches of four corners p00, p10, p01, p11 (pbrt's order), bilinear in between. Quads of a PLY file become patches.
struct BilinearMesh {
  std::vector<Point> positions;
  std::vector<Normal> normals;
  std::vector<Vec2> uvs;
  std::vector<std::array<std::uint32_t, 4>> patches;
};
struct Sphere {
  float radius = 1;
  float z_min = -infinity, z_max = infinity;  ///< object space; clamped to the radius
  float phi_max = 360;                        ///< degrees
};
struct Disk {
  float height = 0, radius = 1, inner_radius = 0;
  float phi_max = 360;  ///< degrees
};
struct Cylinder {
  float radius = 1, z_min = -1, z_max = 1;
  float phi_max = 360;  ///< degrees
};
/// Flat: turned towards every ray. Cylinder: a tube. Ribbon: turned by the normals that it is given.
enum class CurveKind : std::uint8_t { flat, cylinder, ribbon };
/// Cubic Bézier segments of varying width.
struct Curves {
  CurveKind kind = CurveKind::flat;
  std::vector<glm::vec4> points;        ///< control points; w: half the width there, metres, not negative
  std::vector<Normal> normals;          ///< of ribbons: one per control point, which the same Bézier basis joins
  std::vector<std::uint32_t> segments;  ///< each the index of the first of its four control points
  std::uint32_t pieces = 1;             ///< so many segments that follow each other share one range of u
};
/// Diffuse emission of a shape.
struct AreaLight {
  SpectrumParameter radiance{1.0f, {}};
  float scale = 1;
  std::optional<float> power;  ///< watts; overrides the scale so that the emitted power is this
  bool two_sided = false;
  SourceLocation location;
};
/// Triangles and quads are split until no edge is longer than `edge_length` (metres, world space) and their vertices
/// moved along the normals by `height` (in the mesh's space).
struct MeshDisplacement {
  FloatParameter height;
  float edge_length = 1;
};
struct Shape {
  std::variant<TriangleMesh, BilinearMesh, Sphere, Disk, Cylinder, Curves> geometry;
  AnimatedTransform object_to_world;  ///< inside an instanced object: to the object's space
  bool reverse_orientation = false;
  Index material = 0;
  std::optional<Index> area_light;
  bool shares_power = false;  ///< the area light's power is that of the whole shape, not of each of its primitives
  FloatParameter alpha{1, {}};
  std::optional<MeshDisplacement> displacement;        ///< of meshes
  std::optional<Index> inside_medium, outside_medium;  ///< into SceneDescription::media; none: vacuum
  SourceLocation location;
};
/// A named group of shapes that instances place.
struct Object {
  std::string name;
  std::vector<Shape> shapes;
};
struct Instance {
  Index object = 0;
  AnimatedTransform object_to_world;
  SourceLocation location;
};

// Lights without surface.

/// Emission strength, as pbrt-v4: every spectrum is scaled to luminance 1 (RGB: (1,1,1) has luminance 1), times scale;
/// `power` or `illuminance`, where given, then decide the magnitude.
struct Emission {
  SpectrumValue spectrum = 1.0f;
  float scale = 1;
};
struct PointLight {
  Emission intensity;
  Point from{0};
  std::optional<float> power;
};
struct SpotLight {
  Emission intensity;
  Point from{0};
  Point to{0, 0, 1};
  float cone_angle = 30, cone_delta_angle = 5;  ///< degrees
  std::optional<float> power;
};
struct DistantLight {
  Emission radiance;
  Point from{0, 0, 0};
  Point to{0, 0, 1};
  std::optional<float> illuminance;
};
/// Constant, or an image, z up in light space: square images in the equal-area octahedral layout (Clarberg 2008),
/// images twice as wide as high in the equirectangular one.
struct InfiniteLight {
  Emission radiance;
  std::optional<std::string> image;
  ColorSpace image_space = ColorSpace::srgb;
  std::optional<float> illuminance;
  /// Corners of a rectangle, in order around it, in the world whatever the light's transformation: light comes through
  /// it alone, in the direction of (p3 - p0) x (p1 - p0) reversed.
  std::optional<std::array<Point, 4>> portal;
};
/// A point whose intensity is multiplied by an image, as that of an infinite light but grey.
struct GoniometricLight {
  Emission intensity;
  std::string image;
  std::optional<float> power;
};
/// A point that projects an image along z, x to its right and y to its top.
struct ProjectionLight {
  std::string image;
  ColorSpace image_space = ColorSpace::srgb;
  float scale = 1;
  float fov = 90;  ///< degrees, over the shorter side
  std::optional<float> power;
};
struct Light {
  std::variant<PointLight, SpotLight, DistantLight, InfiniteLight, GoniometricLight, ProjectionLight> node;
  Transform light_to_world;
  std::optional<Index> medium;  ///< that it stands in, into SceneDescription::media; none: vacuum
  SourceLocation location;
};

// Cameras and film.

struct PerspectiveCamera {
  float fov = 90;  ///< degrees over the shorter side (or as given by screen_window)
  float lens_radius = 0;
  float focal_distance = 1e6f;
};
struct OrthographicCamera {
  float lens_radius = 0;
  float focal_distance = 1e6f;
};
enum class SphericalMapping : std::uint8_t { equirectangular, equal_area };
struct SphericalCamera {
  SphericalMapping mapping = SphericalMapping::equal_area;
};
/// A spherical surface of a lens, or, with radius 0, a stop.
struct LensElement {
  float curvature_radius = 0;   ///< metres; above 0: convex as seen from the scene
  float thickness = 0;          ///< metres along the axis to the next element (of the last: it is moved to focus)
  float eta = 1;                ///< index of refraction behind it, on the film's side
  float aperture_diameter = 0;  ///< metres
};
/// A lens in front of a film, which lies in the plane z = 0 of camera space.
struct RealisticCamera {
  std::vector<LensElement> elements;  ///< from the scene to the film
  float focus_distance = 10;          ///< metres from the film
  float film_diagonal = 0.035f;       ///< metres
};
struct Camera {
  std::variant<PerspectiveCamera, OrthographicCamera, SphericalCamera, RealisticCamera> node = PerspectiveCamera{};
  AnimatedTransform camera_to_world;
  float shutter_open = 0, shutter_close = 1;
  std::optional<float> frame_aspect_ratio;
  std::optional<std::array<float, 4>> screen_window;  ///< x0, x1, y0, y1
  std::optional<Index> medium;                        ///< that it stands in; none: vacuum
  SourceLocation location;
};
enum class FilterKind : std::uint8_t { box, triangle, gaussian, mitchell, sinc };
struct Filter {
  FilterKind kind = FilterKind::gaussian;
  Vec2 radius{1.5f, 1.5f};
  float sigma = 0.5f;                ///< gaussian
  float b = 1.0f / 3, c = 1.0f / 3;  ///< mitchell
  float tau = 3;                     ///< sinc
};
struct Film {
  int width = 1280, height = 720;
  std::array<float, 4> crop{0, 1, 0, 1};  ///< x0, x1, y0, y1 as fractions
  std::string filename;                   ///< the scene's own choice of output, may be empty
  float imaging_ratio = 1;  ///< factor of radiance to pixel value (pbrt's iso * exposure / 100 ... = 1 by default)
  std::optional<float> white_balance;      ///< kelvin of the light that is to become white
  std::optional<float> largest_component;  ///< to which samples are scaled down, in CIE XYZ
  std::optional<SpectralBuckets> buckets;  ///< in which to hold spectra beside the colours
  float diagonal = 0.035f;                 ///< metres; what a realistic camera's lens throws its picture on
};

/// The scene file's own Integrator and Sampler choices; options override them.
struct RenderHints {
  std::string integrator;        ///< pbrt's name, e.g. "sppm"; empty if none
  std::optional<int> max_depth;  ///< pbrt's maxdepth: scattering events per path
  std::optional<int> photons_per_iteration;
  std::optional<float> radius;
  std::optional<int> pixel_samples;  ///< from Sampler
  std::optional<std::uint64_t> seed;
  bool regularize = false;
};

/// A file that the scene names: one that it includes, a mesh, an image, a spectrum.
struct File {
  std::filesystem::path path;
  std::optional<std::uint64_t> hash;  ///< of its bytes; none if it could not be read
};

/// Something in the file that Lanthorn reads over or replaces: said once per kind.
struct Warning {
  SourceLocation location;
  std::string message;  ///< what, and its substitute
};

}  // namespace lanthorn::description

namespace lanthorn {

struct SceneDescription {
  std::string filename;
  std::uint64_t hash = 0;                          ///< of that file's text
  std::map<std::string, description::File> files;  ///< the others that the scene is made of, by the names it gives them
  FileAccess access;                               ///< for those that are read when the scene is built
  description::Camera camera;
  description::Film film;
  description::Filter filter;
  description::RenderHints hints;
  std::vector<description::EmbeddedImage> embedded_images;
  std::vector<description::FloatTexture> float_textures;
  std::vector<description::SpectrumTexture> spectrum_textures;
  std::vector<MeasuredData> measured_brdfs;
  std::vector<description::Material> materials;  ///< [0] is the default material
  std::vector<description::Medium> media;
  std::vector<description::AreaLight> area_lights;
  std::vector<description::Shape> shapes;
  std::vector<description::Object> objects;
  std::vector<description::Instance> instances;
  std::vector<description::Light> lights;
  std::vector<description::Warning> warnings;
  ColorSpace color_space = ColorSpace::srgb;  ///< of the film
};

}  // namespace lanthorn
