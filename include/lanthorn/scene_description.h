// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A scene as plain data, made by a reader (pbrt, glTF, OBJ) or by a program; `build_scene` turns it into a Scene. It
// has no behaviour and no pointers: parts refer to each other by index. Copies of a description share their tables
// until they change. Every part that can be invalid stores its location in the file.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "lanthorn/color.h"
#include "lanthorn/error.h"
#include "lanthorn/file_access.h"
#include "lanthorn/measured_data.h"
#include "lanthorn/table.h"
#include "lanthorn/transform.h"
#include "lanthorn/vec.h"

namespace lanthorn::description {

/// Index into one of SceneDescription's vectors.
using Index = std::uint32_t;

/// Piecewise-linear samples.
struct SampledSpectrum {
  std::vector<float> nm;
  std::vector<float> values;
  friend bool operator==(const SampledSpectrum&, const SampledSpectrum&) = default;
};
/// RGB as given, in a colour space. Its use decides its meaning (albedo, light, plain numbers).
struct RgbSpectrum {
  Rgb rgb;
  ColorSpace space = ColorSpace::srgb;
  friend bool operator==(const RgbSpectrum&, const RgbSpectrum&) = default;
};
struct BlackbodySpectrum {
  float kelvin = 6500;
  friend bool operator==(const BlackbodySpectrum&, const BlackbodySpectrum&) = default;
};
struct NamedSpectrum {
  std::string name;  ///< a name known to `named_spectrum`
  friend bool operator==(const NamedSpectrum&, const NamedSpectrum&) = default;
};
/// A spectrum parameter: constant, RGB, blackbody, named or sampled (the reader turns spectrum files into samples).
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
  friend bool operator==(const SpectrumParameter&, const SpectrumParameter&) = default;
};

// Textures. `FloatParameter`s and `SpectrumParameter`s inside them may refer only to earlier textures.

// Texture mappings from a surface point to texture coordinates. Transforms map world to texture space.

/// (s, t) = linear * (u, v) + offset.
struct UvMapping {
  Mat2 linear{1.0f};
  Vec2 offset{0, 0};
};
/// (s, t) = (theta / pi, phi / 2 pi) of the direction from the origin, with theta measured from +z.
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
/// Maps points to texture space for solid textures.
struct SolidMapping {
  Transform world_to_texture;
};

// Texture nodes. Their inputs are `Parameter`s here and compiled inputs in the texture graph. `Factor` is the type of
// an input that is a float in most textures.

enum class Wrap : std::uint8_t { repeat, mirror, black, clamp, octahedral_sphere };
enum class Encoding : std::uint8_t { automatic, srgb, linear, gamma };
enum class ImageFilter : std::uint8_t { point, bilinear };
/// An image file embedded in another file.
struct EmbeddedImage {
  std::string name;   ///< for messages
  std::string bytes;  ///< content of the whole image file (PNG, JPEG, WebP)
};
struct ImageTexture {
  std::string filename;           ///< absolute, or relative to the working folder
  std::optional<Index> embedded;  ///< into SceneDescription::embedded_images, instead of `filename`
  TextureMapping mapping;
  Wrap wrap = Wrap::repeat;    ///< along both axes, or along s only if `wrap_t` is given
  std::optional<Wrap> wrap_t;  ///< along t; then neither may be octahedral_sphere
  ImageFilter filter = ImageFilter::bilinear;
  Encoding encoding = Encoding::automatic;  ///< automatic: sRGB for 8-bit and PNG files, linear otherwise
  float gamma = 1;                          ///< for Encoding::gamma
  float scale = 1;
  Rgb tint{1, 1, 1};  ///< additional factor of spectrum textures, linear sRGB
  bool invert = false;
  ColorSpace space = ColorSpace::srgb;  ///< of colours in files that do not state their chromaticities
  /// Channel that a float texture reads (0 is red; a grey image has its value in 0 to 2; a missing alpha is 1).
  /// nullopt: see TextureImage::scalar.
  std::optional<int> channel;
};
/// tex1 where the sum of the floors of the coordinates is even, else tex2; "dimension" 3 has a SolidMapping.
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
  Factor amount;  ///< weight of tex2
};
/// The interpolated colours of a mesh's vertices; a float texture reads their alpha. 1 on surfaces without colours.
struct VertexColorTexture {};
/// 1 where `value` is at least `least`, else 0.
template <class Parameter>
struct ThresholdTexture {
  Parameter value;
  float least = 0.5f;
};
template <class Parameter>
struct ConstantTexture {
  Parameter value;
};
/// tex1 where the geometric normal is parallel to `direction` (either sign), tex2 where it is perpendicular; linear in
/// the cosine.
template <class Parameter>
struct DirectionMixTexture {
  Parameter tex1, tex2;
  Direction direction{0, 1, 0};  ///< world
};
/// Value vij at (s, t) = (i, j), with bilinear interpolation and extrapolation.
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
/// Octave i of a noise sum has 1.99^i times the frequency and roughness^i times the amplitude of the first.
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
/// Use of a spectrum, which decides how RGB is upsampled.
enum class SpectrumRole : std::uint8_t { albedo, unbounded, illuminant };
struct FloatTexture {
  std::variant<ConstantTexture<FloatParameter>, ImageTexture, Checkerboard<FloatParameter>,
               ScaleTexture<FloatParameter>, MixTexture<FloatParameter>, DirectionMixTexture<FloatParameter>,
               BilerpTexture<FloatParameter>, DotsTexture<FloatParameter>, FbmTexture, WrinkledTexture, WindyTexture,
               VertexColorTexture, ThresholdTexture<FloatParameter>>
      node;
  SourceLocation location;
};
struct SpectrumTexture {
  std::variant<ConstantTexture<SpectrumParameter>, ImageTexture, Checkerboard<SpectrumParameter>,
               ScaleTexture<SpectrumParameter>, MixTexture<SpectrumParameter>, DirectionMixTexture<SpectrumParameter>,
               BilerpTexture<SpectrumParameter>, DotsTexture<SpectrumParameter>, MarbleTexture,
               ScaleTexture<SpectrumParameter, SpectrumParameter>, VertexColorTexture>
      node;
  SourceLocation location;
};

// Materials. Default parameters are pbrt-v4's. `kind` is the name in pbrt-v4 if the material exists there.

struct Roughness {
  FloatParameter u, v;  ///< user roughness in [0,1] or GGX alpha
  bool remap = true;    ///< alpha = sqrt(roughness)
};
struct DiffuseMaterial {
  static constexpr const char* kind = "diffuse";

  SpectrumParameter reflectance{0.5f, {}};
};
struct DiffuseTransmissionMaterial {
  static constexpr const char* kind = "diffusetransmission";

  SpectrumParameter reflectance{0.25f, {}}, transmittance{0.25f, {}};
  float scale = 1;
};
/// Given by either (eta, k) or a reflectance.
struct ConductorMaterial {
  static constexpr const char* kind = "conductor";

  std::optional<SpectrumParameter> reflectance;
  SpectrumParameter eta{NamedSpectrum{"metal-Cu-eta"}, {}}, k{NamedSpectrum{"metal-Cu-k"}, {}};
  Roughness roughness;
};
/// A transparent layer about as thick as a wavelength, whose interference colours the reflection.
struct ThinFilm {
  FloatParameter thickness{400, {}};  ///< nm; 0: no film
  float eta = 1.3f;                   ///< index of refraction, at least 1
};
struct DielectricMaterial {
  static constexpr const char* kind = "dielectric";

  SpectrumValue eta = 1.5f;
  Roughness roughness;
  SpectrumParameter tint{1.0f, {}};  ///< transmission factor for entering plus leaving; its square root per interface
  std::optional<ThinFilm> film{};    ///< on the outside
};
struct ThinDielectricMaterial {
  static constexpr const char* kind = "thindielectric";

  SpectrumValue eta = 1.5f;
  Roughness roughness{};
  SpectrumParameter tint{1.0f, {}};  ///< factor of light that passes through the sheet
  std::optional<ThinFilm> film{};    ///< on both faces
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
  static constexpr const char* kind = "coateddiffuse";

  SpectrumParameter reflectance{0.5f, {}};
  Coat coat;
};
struct CoatedConductorMaterial {
  static constexpr const char* kind = "coatedconductor";

  std::optional<SpectrumParameter> reflectance;
  SpectrumParameter eta{NamedSpectrum{"metal-Cu-eta"}, {}}, k{NamedSpectrum{"metal-Cu-k"}, {}};
  Roughness conductor_roughness;
  Coat coat;
};
/// Absorption coefficient for a hair of radius 1: `sigma_a` if given, else the one that yields `color`, else from
/// melanin (default: 1.3 of eumelanin).
struct HairMaterial {
  static constexpr const char* kind = "hair";

  std::optional<SpectrumParameter> sigma_a, color;
  FloatParameter eumelanin{0, {}}, pheomelanin{0, {}};
  FloatParameter eta{1.55f, {}}, beta_m{0.3f, {}}, beta_n{0.3f, {}};
  FloatParameter alpha{2, {}};  ///< degrees
};
/// A diffuse base under a dielectric surface, in closed form (glTF's dielectric; see surface/plastic.h).
struct PlasticMaterial {
  static constexpr const char* kind = "plastic";

  SpectrumParameter reflectance{0.5f, {}};
  Roughness roughness;  ///< the same along u and v
  SpectrumValue eta = 1.5f;
  FloatParameter specular{1, {}};              ///< factor of the reflection at every angle, in [0,1]
  SpectrumParameter specular_color{1.0f, {}};  ///< factor of the reflection at normal incidence only
  SpectrumParameter sheen_color{0.0f, {}};     ///< of fibres on the surface (glTF's sheen; see surface/cloth.h)
  FloatParameter sheen_roughness{0, {}};       ///< square root of the sheen lobe's width
  std::optional<ThinFilm> film{};              ///< on the surface whose reflectance at normal incidence is given above
};
struct CoatedPlasticMaterial {
  static constexpr const char* kind = "coatedplastic";

  PlasticMaterial base;  ///< reflects under the coat as it does in air; without sheen
  Coat coat;
};
struct MeasuredMaterial {
  static constexpr const char* kind = "measured";

  Index brdf = 0;  ///< into SceneDescription::measured_brdfs
};
/// A blend of two materials: materials[0] where `amount` is 0, materials[1] where it is 1.
struct MixMaterial {
  static constexpr const char* kind = "mix";

  std::array<Index, 2> materials{};
  FloatParameter amount{0.5f, {}};
};
/// An interface between media without a surface: light passes undeflected.
struct InterfaceMaterial {
  static constexpr const char* kind = "interface";
};
/// Shading normals from an image: r, g, b are (x + 1) / 2 of the normal's coordinates along dp/du, dp/dv and the smooth
/// normal. The image should be encoded linearly.
struct NormalMap {
  ImageTexture image;
  float strength = 1;  ///< multiplies x and y
};
struct Material {
  std::variant<DiffuseMaterial, DiffuseTransmissionMaterial, ConductorMaterial, DielectricMaterial,
               ThinDielectricMaterial, CoatedDiffuseMaterial, CoatedConductorMaterial, HairMaterial, PlasticMaterial,
               CoatedPlasticMaterial, MeasuredMaterial, MixMaterial, InterfaceMaterial>
      node;
  std::optional<NormalMap> normal_map;         ///< beside `displacement` only if it looks like normals; never of a mix
  std::optional<FloatParameter> displacement;  ///< metres along the normal; affects shading normals only
  std::optional<Index> interior;               ///< medium inside shapes (subsurface scattering); overrides the shape's
  std::string name;                            ///< empty if anonymous
  SourceLocation location;
};

// Participating media.

/// Constant density.
struct HomogeneousDensity {};
/// Values on a regular grid over a box in the medium's space, x running fastest.
template <class T>
struct MediumGrid {
  std::array<int, 3> size{};
  Point low{0}, high{1};
  std::vector<T> values;
};
/// A grid in a NanoVDB file.
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
  std::optional<TemperatureGrid> temperature;  ///< if given, replaces the medium's emission spectrum
};
/// A procedural cloud made of noise.
struct CloudDensity {
  Point low{0}, high{1};
  float density = 1, wispiness = 1, frequency = 5;
};
/// RGB coefficients on grids, instead of the medium's spectra.
struct RgbGridDensity {
  std::optional<MediumGrid<Rgb>> sigma_a, sigma_s, emission;
};
/// Absorption and scattering coefficients per metre, multiplied by `scale` and the density.
struct Medium {
  SpectrumValue sigma_a = 0.0f, sigma_s = 0.0f;
  float scale = 1;
  float g = 0;                            ///< mean cosine of scattering (Henyey & Greenstein)
  std::optional<SpectrumValue> emission;  ///< volumetric emission as the spectrum of a light; nullopt: none
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
  /// Linear sRGB and alpha, for VertexColorTexture; empty or one per position.
  std::vector<glm::vec4> colors{};
};
/// Bilinear patches with corners p00, p10, p01, p11 (pbrt's order). Quads of a PLY file become patches.
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
/// Flat curves face every ray. Cylinders are tubes. Ribbons are oriented by given normals.
enum class CurveKind : std::uint8_t { flat, cylinder, ribbon };
/// Cubic Bézier segments of varying width.
struct Curves {
  CurveKind kind = CurveKind::flat;
  std::vector<glm::vec4> points;        ///< control points; w: half the width there, metres, >= 0
  std::vector<Normal> normals;          ///< for ribbons: one per control point, interpolated by the same Bézier basis
  std::vector<std::uint32_t> segments;  ///< each the index of the first of its four control points
  std::uint32_t pieces = 1;             ///< number of consecutive segments that share one range of u
};
/// Diffuse emission of a shape's surface.
struct AreaLight {
  SpectrumParameter radiance{1.0f, {}};
  /// Degrees, in (0, 180]: full angle of the cone around the normal that receives all light. Below 180, the surface
  /// lies behind a grid of deep slats, as in a soft box: it emits the same power, brightest along the normal.
  float spread = 180;
  float scale = 1;
  /// Watts; rescales the emission so that each shape (in each instance) emits this power, as one lamp, whatever the
  /// number of its triangles or patches.
  std::optional<float> power;
  bool two_sided = false;
  SourceLocation location;
  friend bool operator==(const AreaLight&, const AreaLight&) = default;
};
/// Displaces a mesh: triangles and quads are split until no edge is longer than `edge_length` (metres, world space);
/// then each vertex moves along its normal by `height` (in the mesh's space).
struct MeshDisplacement {
  FloatParameter height;
  float edge_length = 1;
};
/// Clear glass that all rays, including shadow rays, pass straight: approximates windows (see `replace_window_glass`).
struct Pane {
  float eta = 1.5f;
  bool thin = true;  ///< the shape is the whole pane; otherwise it is one or both of the pane's faces
};
struct Shape {
  std::variant<TriangleMesh, BilinearMesh, Sphere, Disk, Cylinder, Curves> geometry;
  AnimatedTransform object_to_world;  ///< shapes of an object: to the object's space
  bool reverse_orientation = false;
  Index material = 0;
  std::optional<Index> area_light;
  FloatParameter alpha{1, {}};
  std::optional<Pane> pane{};  ///< rays hit the shape only with the probability of reflection; `material` is a mirror
  std::optional<MeshDisplacement> displacement;  ///< of meshes
  /// False: rays from the camera pass through the shape until a surface or a medium scatters them. The shape casts
  /// shadows, emits, and is seen in mirrors. Shapes that bound media are always visible.
  bool visible_to_camera = true;
  std::optional<Index> inside_medium, outside_medium;  ///< into SceneDescription::media; none: vacuum
  SourceLocation location;
};
/// A named group of shapes, placed by instances.
struct Object {
  std::string name;
  std::vector<Shape> shapes;
};
struct Instance {
  Index object = 0;
  AnimatedTransform object_to_world;
  SourceLocation location;
};

// Lights without a surface.

/// Emission strength, as in pbrt-v4: every spectrum is scaled to luminance 1 (RGB: (1,1,1) has luminance 1), then
/// multiplied by `scale`. `power` or `illuminance`, if given, then determine the magnitude.
struct Emission {
  SpectrumValue spectrum = 1.0f;
  float scale = 1;
  friend bool operator==(const Emission&, const Emission&) = default;
};
/// How a kind of light is presented to users.
struct LightKind {
  const char* label;
  bool has_place;  ///< at `from`, or else at the origin, of the light's space
};
struct PointLight {
  static constexpr LightKind kind{.label = "Point light", .has_place = true};

  Emission intensity;
  Point from{0};
  std::optional<float> power;
  friend bool operator==(const PointLight&, const PointLight&) = default;
};
/// Falloff of a spot light between its cones. x in [0,1] is the fraction of the cosine's way from the outer to the
/// inner cone: pbrt's smoothstep 3x^2 - 2x^3, or glTF's x^2.
enum class SpotFalloff : std::uint8_t { smoothstep, square };
struct SpotLight {
  static constexpr LightKind kind{.label = "Spot light", .has_place = true};

  Emission intensity;
  Point from{0};
  Point to{0, 0, 1};
  float cone_angle = 30, cone_delta_angle = 5;  ///< degrees
  SpotFalloff falloff = SpotFalloff::smoothstep;
  std::optional<float> power;
  friend bool operator==(const SpotLight&, const SpotLight&) = default;
};
/// Parallel light, or a round light infinitely far away that rays can meet, such as the sun (.53 degrees).
struct DistantLight {
  static constexpr LightKind kind{.label = "Distant light", .has_place = false};

  Emission radiance;  ///< pbrt's L: W/m² on a plane that faces the light
  Point from{0, 0, 0};
  Point to{0, 0, 1};
  float angle = 0;                ///< under which the light's diameter is seen, degrees, in [0, 180); 0: parallel light
  bool visible_to_camera = true;  ///< false: camera rays do not see the round light; all other rays do
  std::optional<float> illuminance;
  friend bool operator==(const DistantLight&, const DistantLight&) = default;
};
/// Colours over the sphere, row by row from the top.
struct SphericalTexels {
  int width = 0, height = 0;
  std::vector<Rgb> rows;
};
/// Constant, or an image with z up in light space: square images in the equal-area octahedral layout (Clarberg 2008),
/// images twice as wide as high in the equirectangular layout.
struct InfiniteLight {
  static constexpr LightKind kind{.label = "Environment", .has_place = false};

  Emission radiance;
  std::optional<std::string> image;
  /// An image in memory, in linear sRGB, used instead of `image`. Shared by copies of the scene.
  std::shared_ptr<const SphericalTexels> texels;
  ColorSpace image_space = ColorSpace::srgb;
  std::optional<float> illuminance;
  /// Corners of a rectangle, in order around it, in world space regardless of the light's transform. Light passes only
  /// through it, in the direction opposite to (p3 - p0) x (p1 - p0).
  std::optional<std::array<Point, 4>> portal;
  friend bool operator==(const InfiniteLight&, const InfiniteLight&) = default;
};
/// A point light whose intensity is multiplied by a grey image in one of the layouts of an infinite light.
struct GoniometricLight {
  static constexpr LightKind kind{.label = "Goniometric light", .has_place = true};

  Emission intensity;
  std::string image;
  std::optional<float> power;
  friend bool operator==(const GoniometricLight&, const GoniometricLight&) = default;
};
/// A point light that projects an image along z, with x to the right and y up.
struct ProjectionLight {
  static constexpr LightKind kind{.label = "Projector", .has_place = true};

  std::string image;
  ColorSpace image_space = ColorSpace::srgb;
  float scale = 1;
  float fov = 90;  ///< degrees, over the shorter side
  std::optional<float> power;
  friend bool operator==(const ProjectionLight&, const ProjectionLight&) = default;
};
struct Light {
  std::variant<PointLight, SpotLight, DistantLight, InfiniteLight, GoniometricLight, ProjectionLight> node;
  Transform light_to_world;
  std::optional<Index> medium;  ///< medium around the light, into SceneDescription::media; none: vacuum
  SourceLocation location;
  friend bool operator==(const Light&, const Light&) = default;
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
/// A spherical surface of a lens, or an aperture stop if the radius is 0.
struct LensElement {
  float curvature_radius = 0;  ///< metres; > 0: convex as seen from the scene
  float thickness = 0;         ///< metres along the axis to the next element (the last element's is adjusted for focus)
  float eta = 1;               ///< index of refraction behind the element, on the film's side
  float aperture_diameter = 0;  ///< metres
};
/// A lens system in front of a film, which lies in the plane z = 0 of camera space.
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
  /// A box in camera space to be framed by a perspective camera: without turning, the camera moves in front of the
  /// box's centre, then backwards until the whole box is visible, whatever the picture's aspect ratio.
  std::optional<Bounds> subject;
  std::optional<Index> medium;  ///< medium around the camera; none: vacuum
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
  std::string filename;                   ///< output file name in the scene file, may be empty
  bool measures_exposure = false;         ///< the scene file format has no exposure: measure one for display
  bool display_emission = false;          ///< visible emitters (unlit surfaces) have display colours, without exposure
  float imaging_ratio = 1;  ///< factor from radiance to pixel value (pbrt's iso * exposure / 100 ... = 1 by default)
  std::optional<float> white_balance;         ///< colour temperature in kelvin that becomes white
  std::optional<float> largest_component;     ///< samples are scaled down so that no CIE XYZ component exceeds this
  std::optional<SpectralBuckets> buckets;     ///< spectral buckets, stored beside the colours
  float diagonal = 0.035f;                    ///< metres; diagonal of a realistic camera's film
  ColorSpace color_space = ColorSpace::srgb;  ///< `white_balance` adapts to its white point
};

/// The scene file's own Integrator and Sampler settings; options override them.
struct RenderHints {
  std::string integrator;  ///< pbrt's name, e.g. "sppm", or the name of one of Lanthorn's methods; empty if none
  std::map<std::string, std::string> parameters;  ///< of the method that replaces it, as in `RenderOptions::set`
  std::optional<int> max_depth;                   ///< pbrt's maxdepth: scattering events per path
  std::optional<int> photons_per_iteration;
  std::optional<int> pixel_samples;  ///< from Sampler
  std::optional<std::uint64_t> seed;
  bool regularize = false;
};

/// A file that the scene refers to: an included file, a mesh, an image, a spectrum.
struct File {
  std::filesystem::path path;
  std::optional<std::uint64_t> hash;  ///< hash of its bytes; nullopt if it could not be read
  SourceLocation location;            ///< where the scene names it first, if known
};

/// A part of the file that Lanthorn ignores or replaces; reported once per kind.
struct Warning {
  SourceLocation location;
  std::string message;  ///< the problem and its substitute
};

}  // namespace lanthorn::description

namespace lanthorn {

/// The camera, and how the picture is taken.
struct ViewDescription {
  description::Camera camera;
  description::Film film;
  description::Filter filter;
};

enum class UpAxis : std::uint8_t { y, z };

/// An environment that replaces the scene's own.
struct EnvironmentChoice {
  /// One of `environment_names`, or the path of an image file in any layout that `read_environment` (ibl.h) supports,
  /// in any folder. Empty: the scene's own environment.
  std::string source{};
  float rotation = 0;  ///< degrees around the up axis, counter-clockwise as seen from above
  float scale = 1;     ///< factor of radiance
  /// nullopt: +y; for pbrt files, whose worlds have no up direction, +y or +z, whichever is nearer to the camera's up
  /// vector (a warning says which).
  std::optional<UpAxis> up{};
  friend bool operator==(const EnvironmentChoice&, const EnvironmentChoice&) = default;
};

struct SceneDescription {
  std::string filename;
  std::uint64_t hash = 0;                          ///< hash of the scene file's text
  std::map<std::string, description::File> files;  ///< the scene's other files, by the names it gives them
  FileAccess access;                               ///< for files read while the scene is built
  ViewDescription view;                            ///< the file's own
  description::RenderHints hints;
  description::Table<description::EmbeddedImage> embedded_images;
  description::Table<description::FloatTexture> float_textures;
  description::Table<description::SpectrumTexture> spectrum_textures;
  description::Table<std::shared_ptr<const MeasuredData>> measured_brdfs;  ///< none is null
  description::Table<description::Material> materials;                     ///< [0] is the default material
  description::Table<description::Medium> media;
  description::Table<description::AreaLight> area_lights;
  description::Table<description::Shape> shapes;
  description::Table<description::Object> objects;
  description::Table<description::Instance> instances;
  description::Table<description::Light> lights;
  EnvironmentChoice environment;                      ///< the choice that `replace_environment` applied
  description::Table<description::Light> own_lights;  ///< `lights` before `replace_environment`; else empty
  std::vector<description::Warning> warnings;
  ColorSpace color_space = ColorSpace::srgb;  ///< of the film; its white point is the colour of lights given as numbers
  /// Position of this description's origin in the coordinates of the file, metres: see `move_origin`.
  DVec3 origin{0.0};
};

}  // namespace lanthorn
