// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The members of a scene description, of edits and of options, under their names in include/lanthorn.
// Excluded: locations in files (plain data have none) and measured BRDFs, which only files provide.
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>

#include "lanthorn/image_file.h"
#include "lanthorn/render_options.h"
#include "lanthorn/scene_description.h"
#include "plain/describe.h"

namespace lanthorn::plain {

using namespace description;

// Enumerations.
template <>
constexpr auto value_names<ColorSpace> = words("srgb", "dci_p3", "rec2020", "aces2065_1");
template <>
constexpr auto value_names<ColorMode> = color_mode_names;
template <>
constexpr auto value_names<ToneCurve> = words("none", "filmic", "agx", "highlights");
template <>
constexpr auto value_names<UpAxis> = words("y", "z");
template <>
constexpr auto value_names<Wrap> = words("repeat", "mirror", "black", "clamp", "octahedral_sphere");
template <>
constexpr auto value_names<Encoding> = words("automatic", "srgb", "linear", "gamma");
template <>
constexpr auto value_names<ImageFilter> = words("point", "bilinear");
template <>
constexpr auto value_names<CurveKind> = words("flat", "cylinder", "ribbon");
template <>
constexpr auto value_names<SpotFalloff> = words("smoothstep", "square");
template <>
constexpr auto value_names<SphericalMapping> = words("equirectangular", "equal_area");
template <>
constexpr auto value_names<FilterKind> = words("box", "triangle", "gaussian", "mitchell", "sinc");

// Spectra.
template <>
constexpr auto members_of<RgbSpectrum> = structure(field<&RgbSpectrum::rgb>("rgb"),
                                                   field<&RgbSpectrum::space>("space"));
template <>
constexpr auto members_of<BlackbodySpectrum> = structure(field<&BlackbodySpectrum::kelvin>("blackbody"));
template <>
constexpr auto members_of<NamedSpectrum> = structure(field<&NamedSpectrum::name>("named"));
template <>
constexpr auto members_of<SampledSpectrum> = structure(field<&SampledSpectrum::nm>("nm"),
                                                       field<&SampledSpectrum::values>("values"));

// Textures.
template <>
constexpr auto members_of<UvMapping> = alternative("uv", field<&UvMapping::linear>("linear"),
                                                   field<&UvMapping::offset>("offset"));
template <>
constexpr auto members_of<SphericalTextureMapping> =
    alternative("spherical", field<&SphericalTextureMapping::world_to_texture>("world_to_texture"));
template <>
constexpr auto members_of<CylindricalTextureMapping> =
    alternative("cylindrical", field<&CylindricalTextureMapping::world_to_texture>("world_to_texture"));
template <>
constexpr auto members_of<PlanarTextureMapping> =
    alternative("planar", field<&PlanarTextureMapping::world_to_texture>("world_to_texture"),
                field<&PlanarTextureMapping::v1>("v1"), field<&PlanarTextureMapping::v2>("v2"),
                field<&PlanarTextureMapping::offset>("offset"));
template <>
constexpr auto members_of<SolidMapping> = alternative("solid",
                                                      field<&SolidMapping::world_to_texture>("world_to_texture"));
template <>
constexpr auto members_of<ImageTexture> = alternative(
    "image", field<&ImageTexture::filename>("filename"), field<&ImageTexture::embedded>("embedded"),
    field<&ImageTexture::mapping>("mapping"), field<&ImageTexture::wrap>("wrap"),
    field<&ImageTexture::wrap_t>("wrap_t"), field<&ImageTexture::filter>("filter"),
    field<&ImageTexture::encoding>("encoding"), field<&ImageTexture::gamma>("gamma"),
    field<&ImageTexture::scale>("scale"), field<&ImageTexture::tint>("tint"), field<&ImageTexture::invert>("invert"),
    field<&ImageTexture::space>("space"), field<&ImageTexture::channel>("channel"));
template <>
constexpr auto members_of<VertexColorTexture> = alternative("vertexcolor");
template <>
constexpr auto members_of<Octaves> = structure(field<&Octaves::count>("count"),
                                               field<&Octaves::roughness>("roughness"));
template <>
constexpr auto members_of<FbmTexture> = alternative("fbm", field<&FbmTexture::mapping>("mapping"),
                                                    field<&FbmTexture::octaves>("octaves"));
template <>
constexpr auto members_of<WrinkledTexture> = alternative("wrinkled", field<&WrinkledTexture::mapping>("mapping"),
                                                         field<&WrinkledTexture::octaves>("octaves"));
template <>
constexpr auto members_of<WindyTexture> = alternative("windy", field<&WindyTexture::mapping>("mapping"));
template <>
constexpr auto members_of<MarbleTexture> = alternative("marble", field<&MarbleTexture::mapping>("mapping"),
                                                       field<&MarbleTexture::octaves>("octaves"),
                                                       field<&MarbleTexture::scale>("scale"),
                                                       field<&MarbleTexture::variation>("variation"));
template <class P>
constexpr auto members_of<Checkerboard<P>> = alternative("checkerboard", field<&Checkerboard<P>::mapping>("mapping"),
                                                         field<&Checkerboard<P>::tex1>("tex1"),
                                                         field<&Checkerboard<P>::tex2>("tex2"));
template <class P>
constexpr auto members_of<ConstantTexture<P>> = alternative("constant", field<&ConstantTexture<P>::value>("value"));
template <class P>
constexpr auto members_of<ThresholdTexture<P>> = alternative("threshold", field<&ThresholdTexture<P>::value>("value"),
                                                             field<&ThresholdTexture<P>::least>("least"));
template <class P>
constexpr auto members_of<DirectionMixTexture<P>> = alternative("directionmix",
                                                                field<&DirectionMixTexture<P>::tex1>("tex1"),
                                                                field<&DirectionMixTexture<P>::tex2>("tex2"),
                                                                field<&DirectionMixTexture<P>::direction>("direction"));
template <class P>
constexpr auto members_of<BilerpTexture<P>> = alternative("bilerp", field<&BilerpTexture<P>::mapping>("mapping"),
                                                          field<&BilerpTexture<P>::v00>("v00"),
                                                          field<&BilerpTexture<P>::v01>("v01"),
                                                          field<&BilerpTexture<P>::v10>("v10"),
                                                          field<&BilerpTexture<P>::v11>("v11"));
template <class P>
constexpr auto members_of<DotsTexture<P>> = alternative("dots", field<&DotsTexture<P>::mapping>("mapping"),
                                                        field<&DotsTexture<P>::inside>("inside"),
                                                        field<&DotsTexture<P>::outside>("outside"));
template <class Factor>
constexpr auto scale_name = "scale";
/// For spectrum textures, a factor that is a spectrum is a type of its own.
template <>
constexpr auto scale_name<SpectrumParameter> = "scalebyspectrum";
template <class P, class Q>
constexpr auto members_of<ScaleTexture<P, Q>> = alternative(scale_name<Q>, field<&ScaleTexture<P, Q>::tex>("tex"),
                                                            field<&ScaleTexture<P, Q>::scale>("scale"));
template <class P, class Q>
constexpr auto members_of<MixTexture<P, Q>> = alternative("mix", field<&MixTexture<P, Q>::tex1>("tex1"),
                                                          field<&MixTexture<P, Q>::tex2>("tex2"),
                                                          field<&MixTexture<P, Q>::amount>("amount"));
template <>
constexpr auto members_of<FloatTexture> = structure(inlined<&FloatTexture::node>());
template <>
constexpr auto members_of<SpectrumTexture> = structure(inlined<&SpectrumTexture::node>());

// Materials.
template <>
constexpr auto members_of<Roughness> = structure(field<&Roughness::u>("u"), field<&Roughness::v>("v"),
                                                 field<&Roughness::remap>("remap"));
template <>
constexpr auto members_of<DiffuseMaterial> = alternative(DiffuseMaterial::kind,
                                                         field<&DiffuseMaterial::reflectance>("reflectance"));
template <>
constexpr auto members_of<DiffuseTransmissionMaterial> =
    alternative(DiffuseTransmissionMaterial::kind, field<&DiffuseTransmissionMaterial::reflectance>("reflectance"),
                field<&DiffuseTransmissionMaterial::transmittance>("transmittance"),
                field<&DiffuseTransmissionMaterial::scale>("scale"));
template <>
constexpr auto members_of<ConductorMaterial> = alternative(ConductorMaterial::kind,
                                                           field<&ConductorMaterial::reflectance>("reflectance"),
                                                           field<&ConductorMaterial::eta>("eta"),
                                                           field<&ConductorMaterial::k>("k"),
                                                           field<&ConductorMaterial::roughness>("roughness"));
template <>
constexpr auto members_of<ThinFilm> = structure(field<&ThinFilm::thickness>("thickness"), field<&ThinFilm::eta>("eta"));
template <>
constexpr auto members_of<DielectricMaterial> = alternative(DielectricMaterial::kind,
                                                            field<&DielectricMaterial::eta>("eta"),
                                                            field<&DielectricMaterial::roughness>("roughness"),
                                                            field<&DielectricMaterial::tint>("tint"),
                                                            field<&DielectricMaterial::film>("film"));
template <>
constexpr auto members_of<ThinDielectricMaterial> = alternative(ThinDielectricMaterial::kind,
                                                                field<&ThinDielectricMaterial::eta>("eta"),
                                                                field<&ThinDielectricMaterial::roughness>("roughness"),
                                                                field<&ThinDielectricMaterial::tint>("tint"),
                                                                field<&ThinDielectricMaterial::film>("film"));
template <>
constexpr auto members_of<Coat> = structure(field<&Coat::roughness>("roughness"), field<&Coat::thickness>("thickness"),
                                            field<&Coat::eta>("eta"), field<&Coat::albedo>("albedo"),
                                            field<&Coat::g>("g"), field<&Coat::max_depth>("max_depth"),
                                            field<&Coat::samples>("samples"));
template <>
constexpr auto members_of<CoatedDiffuseMaterial> =
    alternative(CoatedDiffuseMaterial::kind, field<&CoatedDiffuseMaterial::reflectance>("reflectance"),
                field<&CoatedDiffuseMaterial::coat>("coat"));
template <>
constexpr auto members_of<CoatedConductorMaterial> =
    alternative(CoatedConductorMaterial::kind, field<&CoatedConductorMaterial::reflectance>("reflectance"),
                field<&CoatedConductorMaterial::eta>("eta"), field<&CoatedConductorMaterial::k>("k"),
                field<&CoatedConductorMaterial::conductor_roughness>("conductor_roughness"),
                field<&CoatedConductorMaterial::coat>("coat"));
template <>
constexpr auto members_of<HairMaterial> =
    alternative(HairMaterial::kind, field<&HairMaterial::sigma_a>("sigma_a"), field<&HairMaterial::color>("color"),
                field<&HairMaterial::eumelanin>("eumelanin"), field<&HairMaterial::pheomelanin>("pheomelanin"),
                field<&HairMaterial::eta>("eta"), field<&HairMaterial::beta_m>("beta_m"),
                field<&HairMaterial::beta_n>("beta_n"), field<&HairMaterial::alpha>("alpha"));
template <>
constexpr auto members_of<PlasticMaterial> = alternative(
    PlasticMaterial::kind, field<&PlasticMaterial::reflectance>("reflectance"),
    field<&PlasticMaterial::roughness>("roughness"), field<&PlasticMaterial::eta>("eta"),
    field<&PlasticMaterial::specular>("specular"), field<&PlasticMaterial::specular_color>("specular_color"),
    field<&PlasticMaterial::sheen_color>("sheen_color"), field<&PlasticMaterial::sheen_roughness>("sheen_roughness"),
    field<&PlasticMaterial::film>("film"));
template <>
constexpr auto members_of<CoatedPlasticMaterial> = alternative(CoatedPlasticMaterial::kind,
                                                               field<&CoatedPlasticMaterial::base>("base"),
                                                               field<&CoatedPlasticMaterial::coat>("coat"));
template <>
constexpr auto members_of<MeasuredMaterial> = alternative(MeasuredMaterial::kind,
                                                          field<&MeasuredMaterial::brdf>("brdf"));
template <>
constexpr auto members_of<MixMaterial> = alternative(MixMaterial::kind,
                                                     reference<&MixMaterial::materials>("materials", "materials"),
                                                     field<&MixMaterial::amount>("amount"));
template <>
constexpr auto members_of<InterfaceMaterial> = alternative(InterfaceMaterial::kind);
template <>
constexpr auto members_of<NormalMap> = structure(field<&NormalMap::image>("image"),
                                                 field<&NormalMap::strength>("strength"));
template <>
constexpr auto members_of<Material> = structure(inlined<&Material::node>(), field<&Material::normal_map>("normal_map"),
                                                field<&Material::displacement>("displacement"),
                                                reference<&Material::interior>("interior", "media"),
                                                field<&Material::name>("name"));

// Media.
template <>
constexpr auto members_of<HomogeneousDensity> = alternative("homogeneous");
template <class P>
constexpr auto members_of<MediumGrid<P>> = alternative("grid", field<&MediumGrid<P>::size>("size"),
                                                       field<&MediumGrid<P>::low>("low"),
                                                       field<&MediumGrid<P>::high>("high"),
                                                       field<&MediumGrid<P>::values>("values"));
template <>
constexpr auto members_of<VdbGrid> = alternative("vdb", field<&VdbGrid::filename>("filename"),
                                                 field<&VdbGrid::grid>("grid"));
template <>
constexpr auto members_of<TemperatureGrid> = structure(field<&TemperatureGrid::temperature>("temperature"),
                                                       field<&TemperatureGrid::offset>("offset"),
                                                       field<&TemperatureGrid::scale>("scale"));
template <>
constexpr auto members_of<GridDensity> = alternative("grid", field<&GridDensity::density>("density"),
                                                     field<&GridDensity::emission_factor>("emission_factor"),
                                                     field<&GridDensity::temperature>("temperature"));
template <>
constexpr auto members_of<CloudDensity> = alternative("cloud", field<&CloudDensity::low>("low"),
                                                      field<&CloudDensity::high>("high"),
                                                      field<&CloudDensity::density>("density"),
                                                      field<&CloudDensity::wispiness>("wispiness"),
                                                      field<&CloudDensity::frequency>("frequency"));
template <>
constexpr auto members_of<RgbGridDensity> = alternative("rgbgrid", field<&RgbGridDensity::sigma_a>("sigma_a"),
                                                        field<&RgbGridDensity::sigma_s>("sigma_s"),
                                                        field<&RgbGridDensity::emission>("emission"));
template <>
constexpr auto members_of<Medium> = structure(field<&Medium::sigma_a>("sigma_a"), field<&Medium::sigma_s>("sigma_s"),
                                              field<&Medium::scale>("scale"), field<&Medium::g>("g"),
                                              field<&Medium::emission>("emission"),
                                              field<&Medium::emission_scale>("emission_scale"),
                                              field<&Medium::density>("density"), field<&Medium::name>("name"),
                                              field<&Medium::medium_to_world>("medium_to_world"));
// description::Shapes.
template <>
constexpr auto members_of<TriangleMesh> = alternative("triangles", field<&TriangleMesh::positions>("positions"),
                                                      field<&TriangleMesh::normals>("normals"),
                                                      field<&TriangleMesh::tangents>("tangents"),
                                                      field<&TriangleMesh::uvs>("uvs"),
                                                      field<&TriangleMesh::triangles>("triangles"),
                                                      field<&TriangleMesh::colors>("colors"));
template <>
constexpr auto members_of<BilinearMesh> = alternative("patches", field<&BilinearMesh::positions>("positions"),
                                                      field<&BilinearMesh::normals>("normals"),
                                                      field<&BilinearMesh::uvs>("uvs"),
                                                      field<&BilinearMesh::patches>("patches"));
template <>
constexpr auto members_of<Sphere> = alternative("sphere", field<&Sphere::radius>("radius"),
                                                field<&Sphere::z_min>("z_min"), field<&Sphere::z_max>("z_max"),
                                                field<&Sphere::phi_max>("phi_max"));
template <>
constexpr auto members_of<Disk> = alternative("disk", field<&Disk::height>("height"), field<&Disk::radius>("radius"),
                                              field<&Disk::inner_radius>("inner_radius"),
                                              field<&Disk::phi_max>("phi_max"));
template <>
constexpr auto members_of<Cylinder> = alternative("cylinder", field<&Cylinder::radius>("radius"),
                                                  field<&Cylinder::z_min>("z_min"), field<&Cylinder::z_max>("z_max"),
                                                  field<&Cylinder::phi_max>("phi_max"));
template <>
constexpr auto members_of<Curves> = alternative("curves", field<&Curves::kind>("kind"),
                                                field<&Curves::points>("points"), field<&Curves::normals>("normals"),
                                                field<&Curves::segments>("segments"), field<&Curves::pieces>("pieces"));
template <>
constexpr auto members_of<AreaLight> = structure(field<&AreaLight::radiance>("radiance"),
                                                 field<&AreaLight::scale>("scale"), field<&AreaLight::power>("power"),
                                                 field<&AreaLight::two_sided>("two_sided"),
                                                 field<&AreaLight::spread>("spread"));
template <>
constexpr auto members_of<MeshDisplacement> = structure(field<&MeshDisplacement::height>("height"),
                                                        field<&MeshDisplacement::edge_length>("edge_length"));
template <>
constexpr auto members_of<Pane> = structure(field<&Pane::eta>("eta"), field<&Pane::thin>("thin"));
template <>
constexpr auto members_of<description::Shape> = structure(
    inlined<&description::Shape::geometry>(), field<&description::Shape::object_to_world>("object_to_world"),
    field<&description::Shape::reverse_orientation>("reverse_orientation"),
    reference<&description::Shape::material>("material", "materials"),
    reference<&description::Shape::area_light>("area_light", "area_lights"), field<&description::Shape::alpha>("alpha"),
    field<&description::Shape::pane>("pane"), field<&description::Shape::displacement>("displacement"),
    field<&description::Shape::visible_to_camera>("visible_to_camera"),
    reference<&description::Shape::inside_medium>("inside_medium", "media"),
    reference<&description::Shape::outside_medium>("outside_medium", "media"));
template <>
constexpr auto members_of<Object> = structure(field<&Object::name>("name"), field<&Object::shapes>("shapes"));
template <>
constexpr auto members_of<Instance> = structure(reference<&Instance::object>("object", "objects"),
                                                field<&Instance::object_to_world>("object_to_world"));

// Lights.
template <>
constexpr auto members_of<Emission> = structure(field<&Emission::spectrum>("spectrum"),
                                                field<&Emission::scale>("scale"));
template <>
constexpr auto members_of<PointLight> = alternative("point", field<&PointLight::intensity>("intensity"),
                                                    field<&PointLight::from>("from"),
                                                    field<&PointLight::power>("power"));
template <>
constexpr auto members_of<SpotLight> = alternative("spot", field<&SpotLight::intensity>("intensity"),
                                                   field<&SpotLight::from>("from"), field<&SpotLight::to>("to"),
                                                   field<&SpotLight::cone_angle>("cone_angle"),
                                                   field<&SpotLight::cone_delta_angle>("cone_delta_angle"),
                                                   field<&SpotLight::falloff>("falloff"),
                                                   field<&SpotLight::power>("power"));
template <>
constexpr auto members_of<DistantLight> = alternative("distant", field<&DistantLight::radiance>("radiance"),
                                                      field<&DistantLight::from>("from"),
                                                      field<&DistantLight::to>("to"),
                                                      field<&DistantLight::angle>("angle"),
                                                      field<&DistantLight::visible_to_camera>("visible_to_camera"),
                                                      field<&DistantLight::illuminance>("illuminance"));
template <>
constexpr auto members_of<InfiniteLight> = alternative("infinite", field<&InfiniteLight::radiance>("radiance"),
                                                       field<&InfiniteLight::image>("image"),
                                                       field<&InfiniteLight::texels>("texels"),
                                                       field<&InfiniteLight::image_space>("image_space"),
                                                       field<&InfiniteLight::illuminance>("illuminance"),
                                                       field<&InfiniteLight::portal>("portal"));
template <>
constexpr auto members_of<GoniometricLight> = alternative("goniometric",
                                                          field<&GoniometricLight::intensity>("intensity"),
                                                          field<&GoniometricLight::image>("image"),
                                                          field<&GoniometricLight::power>("power"));
template <>
constexpr auto members_of<ProjectionLight> = alternative("projection", field<&ProjectionLight::image>("image"),
                                                         field<&ProjectionLight::image_space>("image_space"),
                                                         field<&ProjectionLight::scale>("scale"),
                                                         field<&ProjectionLight::fov>("fov"),
                                                         field<&ProjectionLight::power>("power"));
template <>
constexpr auto members_of<Light> = structure(inlined<&Light::node>(), field<&Light::light_to_world>("light_to_world"),
                                             reference<&Light::medium>("medium", "media"));

// Cameras and film.
template <>
constexpr auto members_of<PerspectiveCamera> = alternative("perspective", field<&PerspectiveCamera::fov>("fov"),
                                                           field<&PerspectiveCamera::lens_radius>("lens_radius"),
                                                           field<&PerspectiveCamera::focal_distance>("focal_distance"));
template <>
constexpr auto members_of<OrthographicCamera> =
    alternative("orthographic", field<&OrthographicCamera::lens_radius>("lens_radius"),
                field<&OrthographicCamera::focal_distance>("focal_distance"));
template <>
constexpr auto members_of<SphericalCamera> = alternative("spherical", field<&SphericalCamera::mapping>("mapping"));
template <>
constexpr auto members_of<LensElement> = structure(field<&LensElement::curvature_radius>("curvature_radius"),
                                                   field<&LensElement::thickness>("thickness"),
                                                   field<&LensElement::eta>("eta"),
                                                   field<&LensElement::aperture_diameter>("aperture_diameter"));
template <>
constexpr auto members_of<RealisticCamera> = alternative("realistic", field<&RealisticCamera::elements>("elements"),
                                                         field<&RealisticCamera::focus_distance>("focus_distance"),
                                                         field<&RealisticCamera::film_diagonal>("film_diagonal"));
template <>
constexpr auto members_of<Bounds> = structure(field<&Bounds::min>("min"), field<&Bounds::max>("max"));
template <>
constexpr auto members_of<Camera> =
    structure(inlined<&Camera::node>(), field<&Camera::camera_to_world>("camera_to_world"),
              field<&Camera::shutter_open>("shutter_open"), field<&Camera::shutter_close>("shutter_close"),
              field<&Camera::frame_aspect_ratio>("frame_aspect_ratio"), field<&Camera::screen_window>("screen_window"),
              field<&Camera::subject>("subject"), reference<&Camera::medium>("medium", "media"));
template <>
constexpr auto members_of<Filter> = structure(field<&Filter::kind>("kind"), field<&Filter::radius>("radius"),
                                              field<&Filter::sigma>("sigma"), field<&Filter::b>("b"),
                                              field<&Filter::c>("c"), field<&Filter::tau>("tau"));
template <>
constexpr auto members_of<SpectralBuckets> = structure(field<&SpectralBuckets::count>("count"),
                                                       field<&SpectralBuckets::low>("low"),
                                                       field<&SpectralBuckets::high>("high"));
template <>
constexpr auto members_of<Film> = structure(
    field<&Film::width>("width"), field<&Film::height>("height"), field<&Film::crop>("crop"),
    field<&Film::filename>("filename"), field<&Film::measures_exposure>("measures_exposure"),
    field<&Film::display_emission>("display_emission"), field<&Film::imaging_ratio>("imaging_ratio"),
    field<&Film::white_balance>("white_balance"), field<&Film::largest_component>("largest_component"),
    field<&Film::buckets>("buckets"), field<&Film::diagonal>("diagonal"), field<&Film::color_space>("color_space"));
template <>
constexpr auto members_of<RenderHints> = structure(field<&RenderHints::integrator>("integrator"),
                                                   field<&RenderHints::max_depth>("max_depth"),
                                                   field<&RenderHints::photons_per_iteration>("photons_per_iteration"),
                                                   field<&RenderHints::pixel_samples>("pixel_samples"),
                                                   field<&RenderHints::seed>("seed"),
                                                   field<&RenderHints::regularize>("regularize"));

// Scenes, edits, options.
template <>
constexpr auto members_of<ViewDescription> = structure(field<&ViewDescription::camera>("camera"),
                                                       field<&ViewDescription::film>("film"),
                                                       field<&ViewDescription::filter>("filter"));
template <>
constexpr auto members_of<SceneDescription> = structure(
    inlined<&SceneDescription::view>(), field<&SceneDescription::hints>("hints"),
    field<&SceneDescription::color_space>("color_space"), field<&SceneDescription::float_textures>("float_textures"),
    field<&SceneDescription::spectrum_textures>("spectrum_textures"), field<&SceneDescription::media>("media"),
    field<&SceneDescription::materials>("materials"), field<&SceneDescription::area_lights>("area_lights"),
    field<&SceneDescription::shapes>("shapes"), field<&SceneDescription::objects>("objects"),
    field<&SceneDescription::instances>("instances"), field<&SceneDescription::lights>("lights"));
template <>
constexpr auto members_of<EnvironmentChoice> = structure(field<&EnvironmentChoice::source>("source"),
                                                         field<&EnvironmentChoice::rotation>("rotation"),
                                                         field<&EnvironmentChoice::scale>("scale"),
                                                         field<&EnvironmentChoice::up>("up"));
template <std::size_t i>
constexpr Member listed_option() {
  using Part = std::decay_t<decltype(std::declval<RenderOptions&>().*std::get<i>(render_option_list).value)>;
  const auto of = [](void* owner) -> void* {
    return &(static_cast<RenderOptions*>(owner)->*std::get<i>(render_option_list).value);
  };
  return {std::get<i>(render_option_list).name, &TypeOf<Part>::value, of};
}
template <std::size_t... i>
constexpr auto option_members(std::index_sequence<i...>) {
  return structure(field<&RenderOptions::pass_range>("pass_range"), listed_option<i>()...,
                   field<&RenderOptions::passes>("passes"), field<&RenderOptions::seconds>("seconds"),
                   field<&RenderOptions::noise>("noise"));
}
template <>
constexpr auto members_of<RenderOptions> =
    option_members(std::make_index_sequence<std::tuple_size_v<decltype(render_option_list)>>());

template <class T>
const Type& type_of() {
  return TypeOf<T>::value;
}
template const Type& type_of<bool>();
template const Type& type_of<float>();
template const Type& type_of<double>();
template const Type& type_of<std::uint32_t>();
template const Type& type_of<std::uint64_t>();
template const Type& type_of<std::string>();
template const Type& type_of<std::optional<std::vector<std::string>>>();
template const Type& type_of<Vec3>();
template const Type& type_of<DVec3>();
template const Type& type_of<Rgb>();
template const Type& type_of<std::vector<Vec3>>();
template const Type& type_of<std::vector<Rgb>>();
template const Type& type_of<Transform>();
template const Type& type_of<AnimatedTransform>();
template const Type& type_of<ToneCurve>();
template const Type& type_of<ColorMode>();
template const Type& type_of<FilterKind>();
template const Type& type_of<SpectrumValue>();
template const Type& type_of<RgbSpectrum>();
template const Type& type_of<BlackbodySpectrum>();
template const Type& type_of<NamedSpectrum>();
template const Type& type_of<SampledSpectrum>();
template const Type& type_of<TextureMapping>();
template const Type& type_of<std::variant<SolidMapping>>();
template const Type& type_of<Material>();
template const Type& type_of<Light>();
template const Type& type_of<AreaLight>();
template const Type& type_of<ViewDescription>();
template const Type& type_of<SceneDescription>();
template const Type& type_of<EnvironmentChoice>();
template const Type& type_of<RenderOptions>();

}  // namespace lanthorn::plain
