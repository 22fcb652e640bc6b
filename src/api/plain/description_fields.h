// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The members of a scene description in plain data, under their names in include/lanthorn/scene_description.h.
// Excluded: locations in files (plain data have none) and measured BRDFs, which only files provide.
#pragma once

#include "lanthorn/plain_data.h"

namespace lanthorn::plain {

template <>
struct Names<ColorSpace> {
  static constexpr std::array<std::pair<std::string_view, ColorSpace>, 4> list{
      {{"srgb", ColorSpace::srgb},
       {"dci_p3", ColorSpace::dci_p3},
       {"rec2020", ColorSpace::rec2020},
       {"aces2065_1", ColorSpace::aces2065_1}}};
};
template <>
struct Names<description::Wrap> {
  using enum description::Wrap;
  static constexpr std::array<std::pair<std::string_view, description::Wrap>, 5> list{
      {{"repeat", repeat},
       {"mirror", mirror},
       {"black", black},
       {"clamp", clamp},
       {"octahedral_sphere", octahedral_sphere}}};
};
template <>
struct Names<description::Encoding> {
  using enum description::Encoding;
  static constexpr std::array<std::pair<std::string_view, description::Encoding>, 4> list{
      {{"automatic", automatic}, {"srgb", srgb}, {"linear", linear}, {"gamma", gamma}}};
};
template <>
struct Names<description::ImageFilter> {
  using enum description::ImageFilter;
  static constexpr std::array<std::pair<std::string_view, description::ImageFilter>, 2> list{
      {{"point", point}, {"bilinear", bilinear}}};
};
template <>
struct Names<description::CurveKind> {
  using enum description::CurveKind;
  static constexpr std::array<std::pair<std::string_view, description::CurveKind>, 3> list{
      {{"flat", flat}, {"cylinder", cylinder}, {"ribbon", ribbon}}};
};
template <>
struct Names<description::SpotFalloff> {
  using enum description::SpotFalloff;
  static constexpr std::array<std::pair<std::string_view, description::SpotFalloff>, 2> list{
      {{"smoothstep", smoothstep}, {"square", square}}};
};
template <>
struct Names<description::SphericalMapping> {
  using enum description::SphericalMapping;
  static constexpr std::array<std::pair<std::string_view, description::SphericalMapping>, 2> list{
      {{"equirectangular", equirectangular}, {"equal_area", equal_area}}};
};
template <>
struct Names<description::FilterKind> {
  using enum description::FilterKind;
  static constexpr std::array<std::pair<std::string_view, description::FilterKind>, 5> list{
      {{"box", box}, {"triangle", triangle}, {"gaussian", gaussian}, {"mitchell", mitchell}, {"sinc", sinc}}};
};

// Spectra.

/// A number; three numbers, which are R, G, B; or a dict: {"rgb": ..., "space": ...}, {"blackbody": kelvin},
/// {"named": name}, {"nm": ..., "values": ...}.
template <>
struct Convert<description::SpectrumValue> {
  static void read(Reader& reader, const Value& data, description::SpectrumValue& out);
  static Value write(const description::SpectrumValue& value);
};
/// The value, or {"texture": index or name, "value": ...}.
template <>
struct Convert<description::FloatParameter> {
  static void read(Reader& reader, const Value& data, description::FloatParameter& out);
  static Value write(const description::FloatParameter& value);
};
template <>
struct Convert<description::SpectrumParameter> {
  static void read(Reader& reader, const Value& data, description::SpectrumParameter& out);
  static Value write(const description::SpectrumParameter& value);
};

/// An environment's colours as an array (height, width, 3).
template <>
struct Convert<std::shared_ptr<const description::SphericalTexels>> {
  using Texels = std::shared_ptr<const description::SphericalTexels>;
  static void read(Reader& reader, const Value& data, Texels& out);
  static Value write(const Texels& texels);
};

template <>
struct Fields<description::SampledSpectrum> {
  using T = description::SampledSpectrum;
  static constexpr auto list = std::tuple(field("nm", &T::nm), field("values", &T::values));
};
// Textures.
template <>
struct Fields<description::UvMapping> {
  using T = description::UvMapping;
  static constexpr const char* type = "uv";
  static constexpr auto list = std::tuple(field("linear", &T::linear), field("offset", &T::offset));
};
template <>
struct Fields<description::SphericalTextureMapping> {
  using T = description::SphericalTextureMapping;
  static constexpr const char* type = "spherical";
  static constexpr auto list = std::tuple(field("world_to_texture", &T::world_to_texture));
};
template <>
struct Fields<description::CylindricalTextureMapping> {
  using T = description::CylindricalTextureMapping;
  static constexpr const char* type = "cylindrical";
  static constexpr auto list = std::tuple(field("world_to_texture", &T::world_to_texture));
};
template <>
struct Fields<description::PlanarTextureMapping> {
  using T = description::PlanarTextureMapping;
  static constexpr const char* type = "planar";
  static constexpr auto list = std::tuple(field("world_to_texture", &T::world_to_texture), field("v1", &T::v1),
                                          field("v2", &T::v2), field("offset", &T::offset));
};
template <>
struct Fields<description::SolidMapping> {
  using T = description::SolidMapping;
  static constexpr const char* type = "solid";
  static constexpr auto list = std::tuple(field("world_to_texture", &T::world_to_texture));
};
template <>
struct Fields<description::ImageTexture> {
  using T = description::ImageTexture;
  static constexpr const char* type = "image";
  static constexpr auto list = std::tuple(
      field("filename", &T::filename), field("embedded", &T::embedded), field("mapping", &T::mapping),
      field("wrap", &T::wrap), field("wrap_t", &T::wrap_t), field("filter", &T::filter),
      field("encoding", &T::encoding), field("gamma", &T::gamma), field("scale", &T::scale), field("tint", &T::tint),
      field("invert", &T::invert), field("space", &T::space), field("channel", &T::channel));
};
template <>
struct Fields<description::VertexColorTexture> {
  using T = description::VertexColorTexture;
  static constexpr const char* type = "vertexcolor";
  static constexpr auto list = std::tuple();
};
template <>
struct Fields<description::Octaves> {
  using T = description::Octaves;
  static constexpr auto list = std::tuple(field("count", &T::count), field("roughness", &T::roughness));
};
template <>
struct Fields<description::FbmTexture> {
  using T = description::FbmTexture;
  static constexpr const char* type = "fbm";
  static constexpr auto list = std::tuple(field("mapping", &T::mapping), field("octaves", &T::octaves));
};
template <>
struct Fields<description::WrinkledTexture> {
  using T = description::WrinkledTexture;
  static constexpr const char* type = "wrinkled";
  static constexpr auto list = std::tuple(field("mapping", &T::mapping), field("octaves", &T::octaves));
};
template <>
struct Fields<description::WindyTexture> {
  using T = description::WindyTexture;
  static constexpr const char* type = "windy";
  static constexpr auto list = std::tuple(field("mapping", &T::mapping));
};
template <>
struct Fields<description::MarbleTexture> {
  using T = description::MarbleTexture;
  static constexpr const char* type = "marble";
  static constexpr auto list = std::tuple(field("mapping", &T::mapping), field("octaves", &T::octaves),
                                          field("scale", &T::scale), field("variation", &T::variation));
};
template <class P>
struct Fields<description::Checkerboard<P>> {
  using T = description::Checkerboard<P>;
  static constexpr const char* type = "checkerboard";
  static constexpr auto list =
      std::tuple(field("mapping", &T::mapping), field("tex1", &T::tex1), field("tex2", &T::tex2));
};
template <class P>
struct Fields<description::ConstantTexture<P>> {
  using T = description::ConstantTexture<P>;
  static constexpr const char* type = "constant";
  static constexpr auto list = std::tuple(field("value", &T::value));
};
template <class P>
struct Fields<description::ThresholdTexture<P>> {
  using T = description::ThresholdTexture<P>;
  static constexpr const char* type = "threshold";
  static constexpr auto list = std::tuple(field("value", &T::value), field("least", &T::least));
};
template <class P>
struct Fields<description::DirectionMixTexture<P>> {
  using T = description::DirectionMixTexture<P>;
  static constexpr const char* type = "directionmix";
  static constexpr auto list =
      std::tuple(field("tex1", &T::tex1), field("tex2", &T::tex2), field("direction", &T::direction));
};
template <class P>
struct Fields<description::BilerpTexture<P>> {
  using T = description::BilerpTexture<P>;
  static constexpr const char* type = "bilerp";
  static constexpr auto list = std::tuple(field("mapping", &T::mapping), field("v00", &T::v00), field("v01", &T::v01),
                                          field("v10", &T::v10), field("v11", &T::v11));
};
template <class P>
struct Fields<description::DotsTexture<P>> {
  using T = description::DotsTexture<P>;
  static constexpr const char* type = "dots";
  static constexpr auto list =
      std::tuple(field("mapping", &T::mapping), field("inside", &T::inside), field("outside", &T::outside));
};
template <class P, class Q>
struct Fields<description::ScaleTexture<P, Q>> {
  using T = description::ScaleTexture<P, Q>;
  /// For spectrum textures, a factor that is a spectrum is a type of its own.
  static constexpr const char* type = std::is_same_v<Q, description::SpectrumParameter> ? "scalebyspectrum" : "scale";
  static constexpr auto list = std::tuple(field("tex", &T::tex), field("scale", &T::scale));
};
template <class P, class Q>
struct Fields<description::MixTexture<P, Q>> {
  using T = description::MixTexture<P, Q>;
  static constexpr const char* type = "mix";
  static constexpr auto list =
      std::tuple(field("tex1", &T::tex1), field("tex2", &T::tex2), field("amount", &T::amount));
};
template <>
struct Fields<description::FloatTexture> {
  using T = description::FloatTexture;
  static constexpr auto list = std::tuple(node(&T::node));
};
template <>
struct Fields<description::SpectrumTexture> {
  using T = description::SpectrumTexture;
  static constexpr auto list = std::tuple(node(&T::node));
};
// Materials.
template <>
struct Fields<description::Roughness> {
  using T = description::Roughness;
  static constexpr auto list = std::tuple(field("u", &T::u), field("v", &T::v), field("remap", &T::remap));
};
template <>
struct Fields<description::DiffuseMaterial> {
  using T = description::DiffuseMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list = std::tuple(field("reflectance", &T::reflectance));
};
template <>
struct Fields<description::DiffuseTransmissionMaterial> {
  using T = description::DiffuseTransmissionMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list = std::tuple(field("reflectance", &T::reflectance),
                                          field("transmittance", &T::transmittance), field("scale", &T::scale));
};
template <>
struct Fields<description::ConductorMaterial> {
  using T = description::ConductorMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list = std::tuple(field("reflectance", &T::reflectance), field("eta", &T::eta),
                                          field("k", &T::k), field("roughness", &T::roughness));
};
template <>
struct Fields<description::ThinFilm> {
  using T = description::ThinFilm;
  static constexpr auto list = std::tuple(field("thickness", &T::thickness), field("eta", &T::eta));
};
template <>
struct Fields<description::DielectricMaterial> {
  using T = description::DielectricMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list = std::tuple(field("eta", &T::eta), field("roughness", &T::roughness),
                                          field("tint", &T::tint), field("film", &T::film));
};
template <>
struct Fields<description::ThinDielectricMaterial> {
  using T = description::ThinDielectricMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list = std::tuple(field("eta", &T::eta), field("roughness", &T::roughness),
                                          field("tint", &T::tint), field("film", &T::film));
};
template <>
struct Fields<description::Coat> {
  using T = description::Coat;
  static constexpr auto list = std::tuple(field("roughness", &T::roughness), field("thickness", &T::thickness),
                                          field("eta", &T::eta), field("albedo", &T::albedo), field("g", &T::g),
                                          field("max_depth", &T::max_depth), field("samples", &T::samples));
};
template <>
struct Fields<description::CoatedDiffuseMaterial> {
  using T = description::CoatedDiffuseMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list = std::tuple(field("reflectance", &T::reflectance), field("coat", &T::coat));
};
template <>
struct Fields<description::CoatedConductorMaterial> {
  using T = description::CoatedConductorMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list =
      std::tuple(field("reflectance", &T::reflectance), field("eta", &T::eta), field("k", &T::k),
                 field("conductor_roughness", &T::conductor_roughness), field("coat", &T::coat));
};
template <>
struct Fields<description::HairMaterial> {
  using T = description::HairMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list =
      std::tuple(field("sigma_a", &T::sigma_a), field("color", &T::color), field("eumelanin", &T::eumelanin),
                 field("pheomelanin", &T::pheomelanin), field("eta", &T::eta), field("beta_m", &T::beta_m),
                 field("beta_n", &T::beta_n), field("alpha", &T::alpha));
};
template <>
struct Fields<description::PlasticMaterial> {
  using T = description::PlasticMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list = std::tuple(
      field("reflectance", &T::reflectance), field("roughness", &T::roughness), field("eta", &T::eta),
      field("specular", &T::specular), field("specular_color", &T::specular_color),
      field("sheen_color", &T::sheen_color), field("sheen_roughness", &T::sheen_roughness), field("film", &T::film));
};
template <>
struct Fields<description::CoatedPlasticMaterial> {
  using T = description::CoatedPlasticMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list = std::tuple(field("base", &T::base), field("coat", &T::coat));
};
template <>
struct Fields<description::MeasuredMaterial> {
  using T = description::MeasuredMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list = std::tuple(field("brdf", &T::brdf));
};
template <>
struct Fields<description::MixMaterial> {
  using T = description::MixMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list =
      std::tuple(reference("materials", "materials", &T::materials), field("amount", &T::amount));
};
template <>
struct Fields<description::InterfaceMaterial> {
  using T = description::InterfaceMaterial;
  static constexpr const char* type = T::kind;
  static constexpr auto list = std::tuple();
};
template <>
struct Fields<description::NormalMap> {
  using T = description::NormalMap;
  static constexpr auto list = std::tuple(field("image", &T::image), field("strength", &T::strength));
};
template <>
struct Fields<description::Material> {
  using T = description::Material;
  static constexpr auto list =
      std::tuple(node(&T::node), field("normal_map", &T::normal_map), field("displacement", &T::displacement),
                 reference("interior", "media", &T::interior), field("name", &T::name));
};
// Media.
template <>
struct Fields<description::HomogeneousDensity> {
  using T = description::HomogeneousDensity;
  static constexpr const char* type = "homogeneous";
  static constexpr auto list = std::tuple();
};
template <class P>
struct Fields<description::MediumGrid<P>> {
  using T = description::MediumGrid<P>;
  static constexpr const char* type = "grid";
  static constexpr auto list =
      std::tuple(field("size", &T::size), field("low", &T::low), field("high", &T::high), field("values", &T::values));
};
template <>
struct Fields<description::VdbGrid> {
  using T = description::VdbGrid;
  static constexpr const char* type = "vdb";
  static constexpr auto list = std::tuple(field("filename", &T::filename), field("grid", &T::grid));
};
template <>
struct Fields<description::TemperatureGrid> {
  using T = description::TemperatureGrid;
  static constexpr auto list =
      std::tuple(field("temperature", &T::temperature), field("offset", &T::offset), field("scale", &T::scale));
};
template <>
struct Fields<description::GridDensity> {
  using T = description::GridDensity;
  static constexpr const char* type = "grid";
  static constexpr auto list = std::tuple(field("density", &T::density), field("emission_factor", &T::emission_factor),
                                          field("temperature", &T::temperature));
};
template <>
struct Fields<description::CloudDensity> {
  using T = description::CloudDensity;
  static constexpr const char* type = "cloud";
  static constexpr auto list = std::tuple(field("low", &T::low), field("high", &T::high), field("density", &T::density),
                                          field("wispiness", &T::wispiness), field("frequency", &T::frequency));
};
template <>
struct Fields<description::RgbGridDensity> {
  using T = description::RgbGridDensity;
  static constexpr const char* type = "rgbgrid";
  static constexpr auto list =
      std::tuple(field("sigma_a", &T::sigma_a), field("sigma_s", &T::sigma_s), field("emission", &T::emission));
};
template <>
struct Fields<description::Medium> {
  using T = description::Medium;
  static constexpr auto list =
      std::tuple(field("sigma_a", &T::sigma_a), field("sigma_s", &T::sigma_s), field("scale", &T::scale),
                 field("g", &T::g), field("emission", &T::emission), field("emission_scale", &T::emission_scale),
                 field("density", &T::density), field("name", &T::name), field("medium_to_world", &T::medium_to_world));
};
// Shapes.
template <>
struct Fields<description::TriangleMesh> {
  using T = description::TriangleMesh;
  static constexpr const char* type = "triangles";
  static constexpr auto list =
      std::tuple(field("positions", &T::positions), field("normals", &T::normals), field("tangents", &T::tangents),
                 field("uvs", &T::uvs), field("triangles", &T::triangles), field("colors", &T::colors));
};
template <>
struct Fields<description::BilinearMesh> {
  using T = description::BilinearMesh;
  static constexpr const char* type = "patches";
  static constexpr auto list = std::tuple(field("positions", &T::positions), field("normals", &T::normals),
                                          field("uvs", &T::uvs), field("patches", &T::patches));
};
template <>
struct Fields<description::Sphere> {
  using T = description::Sphere;
  static constexpr const char* type = "sphere";
  static constexpr auto list = std::tuple(field("radius", &T::radius), field("z_min", &T::z_min),
                                          field("z_max", &T::z_max), field("phi_max", &T::phi_max));
};
template <>
struct Fields<description::Disk> {
  using T = description::Disk;
  static constexpr const char* type = "disk";
  static constexpr auto list = std::tuple(field("height", &T::height), field("radius", &T::radius),
                                          field("inner_radius", &T::inner_radius), field("phi_max", &T::phi_max));
};
template <>
struct Fields<description::Cylinder> {
  using T = description::Cylinder;
  static constexpr const char* type = "cylinder";
  static constexpr auto list = std::tuple(field("radius", &T::radius), field("z_min", &T::z_min),
                                          field("z_max", &T::z_max), field("phi_max", &T::phi_max));
};
template <>
struct Fields<description::Curves> {
  using T = description::Curves;
  static constexpr const char* type = "curves";
  static constexpr auto list =
      std::tuple(field("kind", &T::kind), field("points", &T::points), field("normals", &T::normals),
                 field("segments", &T::segments), field("pieces", &T::pieces));
};
template <>
struct Fields<description::AreaLight> {
  using T = description::AreaLight;
  static constexpr auto list =
      std::tuple(field("radiance", &T::radiance), field("scale", &T::scale), field("power", &T::power),
                 field("two_sided", &T::two_sided), field("spread", &T::spread));
};
template <>
struct Fields<description::MeshDisplacement> {
  using T = description::MeshDisplacement;
  static constexpr auto list = std::tuple(field("height", &T::height), field("edge_length", &T::edge_length));
};
template <>
struct Fields<description::Pane> {
  using T = description::Pane;
  static constexpr auto list = std::tuple(field("eta", &T::eta), field("thin", &T::thin));
};
template <>
struct Fields<description::Shape> {
  using T = description::Shape;
  static constexpr auto list = std::tuple(
      node(&T::geometry), field("object_to_world", &T::object_to_world),
      field("reverse_orientation", &T::reverse_orientation), reference("material", "materials", &T::material),
      reference("area_light", "area_lights", &T::area_light), field("alpha", &T::alpha), field("pane", &T::pane),
      field("displacement", &T::displacement), field("visible_to_camera", &T::visible_to_camera),
      reference("inside_medium", "media", &T::inside_medium), reference("outside_medium", "media", &T::outside_medium));
};
template <>
struct Fields<description::Object> {
  using T = description::Object;
  static constexpr auto list = std::tuple(field("name", &T::name), field("shapes", &T::shapes));
};
template <>
struct Fields<description::Instance> {
  using T = description::Instance;
  static constexpr auto list =
      std::tuple(reference("object", "objects", &T::object), field("object_to_world", &T::object_to_world));
};
// Lights.
template <>
struct Fields<description::Emission> {
  using T = description::Emission;
  static constexpr auto list = std::tuple(field("spectrum", &T::spectrum), field("scale", &T::scale));
};
template <>
struct Fields<description::PointLight> {
  using T = description::PointLight;
  static constexpr const char* type = "point";
  static constexpr auto list =
      std::tuple(field("intensity", &T::intensity), field("from", &T::from), field("power", &T::power));
};
template <>
struct Fields<description::SpotLight> {
  using T = description::SpotLight;
  static constexpr const char* type = "spot";
  static constexpr auto list =
      std::tuple(field("intensity", &T::intensity), field("from", &T::from), field("to", &T::to),
                 field("cone_angle", &T::cone_angle), field("cone_delta_angle", &T::cone_delta_angle),
                 field("falloff", &T::falloff), field("power", &T::power));
};
template <>
struct Fields<description::DistantLight> {
  using T = description::DistantLight;
  static constexpr const char* type = "distant";
  static constexpr auto list = std::tuple(field("radiance", &T::radiance), field("from", &T::from), field("to", &T::to),
                                          field("angle", &T::angle), field("visible_to_camera", &T::visible_to_camera),
                                          field("illuminance", &T::illuminance));
};
template <>
struct Fields<description::InfiniteLight> {
  using T = description::InfiniteLight;
  static constexpr const char* type = "infinite";
  static constexpr auto list = std::tuple(field("radiance", &T::radiance), field("image", &T::image),
                                          field("texels", &T::texels), field("image_space", &T::image_space),
                                          field("illuminance", &T::illuminance), field("portal", &T::portal));
};
template <>
struct Fields<description::GoniometricLight> {
  using T = description::GoniometricLight;
  static constexpr const char* type = "goniometric";
  static constexpr auto list =
      std::tuple(field("intensity", &T::intensity), field("image", &T::image), field("power", &T::power));
};
template <>
struct Fields<description::ProjectionLight> {
  using T = description::ProjectionLight;
  static constexpr const char* type = "projection";
  static constexpr auto list = std::tuple(field("image", &T::image), field("image_space", &T::image_space),
                                          field("scale", &T::scale), field("fov", &T::fov), field("power", &T::power));
};
template <>
struct Fields<description::Light> {
  using T = description::Light;
  static constexpr auto list =
      std::tuple(node(&T::node), field("light_to_world", &T::light_to_world), reference("medium", "media", &T::medium));
};
// Cameras and film.
template <>
struct Fields<description::PerspectiveCamera> {
  using T = description::PerspectiveCamera;
  static constexpr const char* type = "perspective";
  static constexpr auto list = std::tuple(field("fov", &T::fov), field("lens_radius", &T::lens_radius),
                                          field("focal_distance", &T::focal_distance));
};
template <>
struct Fields<description::OrthographicCamera> {
  using T = description::OrthographicCamera;
  static constexpr const char* type = "orthographic";
  static constexpr auto list =
      std::tuple(field("lens_radius", &T::lens_radius), field("focal_distance", &T::focal_distance));
};
template <>
struct Fields<description::SphericalCamera> {
  using T = description::SphericalCamera;
  static constexpr const char* type = "spherical";
  static constexpr auto list = std::tuple(field("mapping", &T::mapping));
};
template <>
struct Fields<description::LensElement> {
  using T = description::LensElement;
  static constexpr auto list =
      std::tuple(field("curvature_radius", &T::curvature_radius), field("thickness", &T::thickness),
                 field("eta", &T::eta), field("aperture_diameter", &T::aperture_diameter));
};
template <>
struct Fields<description::RealisticCamera> {
  using T = description::RealisticCamera;
  static constexpr const char* type = "realistic";
  static constexpr auto list = std::tuple(field("elements", &T::elements), field("focus_distance", &T::focus_distance),
                                          field("film_diagonal", &T::film_diagonal));
};
template <>
struct Fields<Bounds> {
  using T = Bounds;
  static constexpr auto list = std::tuple(field("min", &T::min), field("max", &T::max));
};
template <>
struct Fields<description::Camera> {
  using T = description::Camera;
  static constexpr auto list =
      std::tuple(node(&T::node), field("camera_to_world", &T::camera_to_world), field("shutter_open", &T::shutter_open),
                 field("shutter_close", &T::shutter_close), field("frame_aspect_ratio", &T::frame_aspect_ratio),
                 field("screen_window", &T::screen_window), field("subject", &T::subject),
                 reference("medium", "media", &T::medium));
};
template <>
struct Fields<description::Filter> {
  using T = description::Filter;
  static constexpr auto list =
      std::tuple(field("kind", &T::kind), field("radius", &T::radius), field("sigma", &T::sigma), field("b", &T::b),
                 field("c", &T::c), field("tau", &T::tau));
};
template <>
struct Fields<SpectralBuckets> {
  using T = SpectralBuckets;
  static constexpr auto list = std::tuple(field("count", &T::count), field("low", &T::low), field("high", &T::high));
};
template <>
struct Fields<description::Film> {
  using T = description::Film;
  static constexpr auto list =
      std::tuple(field("width", &T::width), field("height", &T::height), field("crop", &T::crop),
                 field("filename", &T::filename), field("measures_exposure", &T::measures_exposure),
                 field("display_emission", &T::display_emission), field("imaging_ratio", &T::imaging_ratio),
                 field("white_balance", &T::white_balance), field("largest_component", &T::largest_component),
                 field("buckets", &T::buckets), field("diagonal", &T::diagonal), field("color_space", &T::color_space));
};
template <>
struct Fields<description::RenderHints> {
  using T = description::RenderHints;
  static constexpr auto list =
      std::tuple(field("integrator", &T::integrator), field("max_depth", &T::max_depth),
                 field("photons_per_iteration", &T::photons_per_iteration), field("pixel_samples", &T::pixel_samples),
                 field("seed", &T::seed), field("regularize", &T::regularize));
};

/// A surface mapping, or a solid texture's mapping.
template <>
struct Convert<std::variant<description::TextureMapping, description::SolidMapping>> {
  using Mapping = std::variant<description::TextureMapping, description::SolidMapping>;
  static void read(Reader& reader, const Value& data, Mapping& out) {
    const Value* type = dict_of(reader, data).find("type");
    const bool is_solid = type != nullptr && type->as<std::string>() != nullptr &&
                          *type->as<std::string>() == Fields<description::SolidMapping>::type;
    if (is_solid) {
      std::variant<description::SolidMapping> solid;
      plain::read(reader, data, solid);
      out = std::get<0>(solid);
    } else
      plain::read(reader, data, out.emplace<0>());
  }
  static Value write(const Mapping& mapping) {
    if (const auto* surface = std::get_if<description::TextureMapping>(&mapping)) return plain::write(*surface);
    return plain::write(std::variant<description::SolidMapping>(std::get<description::SolidMapping>(mapping)));
  }
};

}  // namespace lanthorn::plain
