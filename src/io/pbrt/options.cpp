// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What precedes WorldBegin: camera, film, filter, integrator and sampler.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "film/filter.h"
#include "io/pbrt/builders.h"
#include "io/pbrt/values.h"
#include "lanthorn/text.h"

namespace lanthorn::pbrt {

namespace {

using namespace description;

// The parameters that perspective and orthographic cameras share.
template <class Lens>
Lens lens(const ParameterList& list) {
  Lens result;
  result.lens_radius = list.get("lensradius", 0.0f);
  if (!(result.lens_radius >= 0)) throw list.error("lensradius", "must not be negative");
  result.focal_distance = positive(list, "focaldistance", 1e6f);
  return result;
}

PerspectiveCamera perspective(const ParameterList& list) {
  auto camera = lens<PerspectiveCamera>(list);
  camera.fov = list.get("fov", 90.0f);
  if (!(camera.fov > 0 && camera.fov < 180)) throw list.error("fov", "must be between 0 and 180 degrees");
  return camera;
}

SphericalCamera spherical(const ParameterList& list) {
  const std::string mapping = list.get("mapping", "equalarea");
  if (mapping == "equalarea") return {SphericalMapping::equal_area};
  if (mapping == "equirectangular") return {SphericalMapping::equirectangular};
  throw list.error("mapping", "must be equalarea or equirectangular, not " + in_quotes(mapping));
}

constexpr float millimetre = 1e-3f;

// Parses lines of four numbers (radius of curvature, thickness, index of refraction, diameter of the aperture, in
// millimetres), from the scene to the film; # starts a comment.
std::vector<LensElement> parse_lens(const std::string& bytes, const std::string& file) {
  constexpr std::size_t most_elements = 1000;
  Tokenizer tokens(bytes, &file);
  std::vector<LensElement> elements;
  Token token = tokens.next();
  for (; token.kind != TokenKind::end; token = tokens.next()) {
    const Place start = token.place;
    std::array<float, 4> v{};
    for (std::size_t i = 0; i < 4; ++i) {
      if (token.kind == TokenKind::end)
        throw Error(start.location(), "an element of a lens needs four numbers, this one has " + std::to_string(i));
      v[i] = float_value(token);
      if (i < 3) token = tokens.next();
    }
    if (v[1] < 0) throw Error(start.location(), "the thickness of an element of a lens must not be negative");
    if (v[0] != 0 && !(v[2] >= 1)) throw Error(start.location(), "the index of refraction must be at least 1");
    if (!(v[3] > 0)) throw Error(start.location(), "the aperture of an element of a lens must be above 0");
    elements.push_back({millimetre * v[0], millimetre * v[1], v[2], millimetre * v[3]});
    if (elements.size() > most_elements)
      throw Error(start.location(), "the lens has more than " + std::to_string(most_elements) + " elements");
  }
  if (elements.empty()) throw Error(token.place.location(), "the lens has no elements");
  return elements;
}

// Replaces a missing lens file by Tronnier's double Gauss lens (US patent 2673491, 1954), scaled from the patent's 100
// mm to 50 mm, or less if it could not otherwise focus as near as `focus_distance` (metres).
std::vector<LensElement> stand_in_lens(float focus_distance) {
  constexpr float focal_length = 100 * millimetre, wanted = 50 * millimetre;
  constexpr float nearest = 8;  // focal lengths; at least 4
  std::vector<LensElement> elements{
      {58.95f, 7.52f, 1.67f, 50.4f}, {169.66f, 0.24f, 1, 50.4f},   {38.55f, 8.05f, 1.67f, 46},
      {81.54f, 6.55f, 1.699f, 46},   {25.5f, 11.41f, 1, 36},       {0, 9, 1, 34.2f},
      {-28.99f, 2.36f, 1.603f, 34},  {81.54f, 12.13f, 1.658f, 40}, {-40.77f, 0.38f, 1, 40},
      {874.13f, 6.44f, 1.717f, 40},  {-79.46f, 72.228f, 1, 40}};
  const float scale = millimetre * std::min(wanted, focus_distance / nearest) / focal_length;
  for (LensElement& e : elements) {
    e.curvature_radius *= scale;
    e.thickness *= scale;
    e.aperture_diameter *= scale;
  }
  return elements;
}

RealisticCamera realistic(const ParameterList& list, Context& context) {
  RealisticCamera camera;
  camera.focus_distance = positive(list, "focusdistance", 10);
  const std::filesystem::path path = context.add_file(list.required_string("lensfile"), list.place());
  const auto bytes = context.read_unless_missing(path, list.find("lensfile")->place);
  camera.elements = bytes ? parse_lens(*bytes, path.string()) : stand_in_lens(camera.focus_distance);
  const float diameter = millimetre * positive(list, "aperturediameter", 1);
  for (LensElement& e : camera.elements) {
    if (e.curvature_radius != 0) continue;
    if (diameter > e.aperture_diameter && list.has("aperturediameter"))
      context.warn("aperturediameter", list.find("aperturediameter")->place,
                   "\"aperturediameter\" is wider than the aperture stop of the lens: it is reduced to the stop");
    e.aperture_diameter = std::min(e.aperture_diameter, diameter);
  }
  if (const Parameter* aperture = list.find("aperture"); aperture && list.get("aperture", "circular") != "circular")
    context.warn("aperture", aperture->place, "images of apertures are not supported: the aperture is a circle");
  return camera;
}

// Pixel bounds x0, x1, y0, y1 as crop fractions; half a pixel is subtracted because ceil(size * fraction) yields the
// bound.
std::array<float, 4> crop_of_bounds(const std::vector<std::int32_t>& bounds, int width, int height) {
  std::array<float, 4> crop{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double size = i < 2 ? width : height;
    crop[i] = static_cast<float>(std::clamp((bounds[i] - 0.5) / size, 0.0, 1.0));
  }
  return crop;
}

std::array<float, 4> crop_window(const ParameterList& list, int width, int height) {
  std::array<float, 4> crop{0, 1, 0, 1};
  std::string_view name = "pixelbounds";
  if (const auto bounds = list.integers(name); list.has(name)) {
    if (bounds.size() != 4) throw list.error(name, "needs four values, has " + std::to_string(bounds.size()));
    crop = crop_of_bounds(bounds, width, height);
  }
  if (const auto window = list.find_float4("cropwindow")) {
    name = "cropwindow";
    const auto& w = *window;
    crop = {std::min(w[0], w[1]), std::max(w[0], w[1]), std::min(w[2], w[3]), std::max(w[2], w[3])};
    for (float& edge : crop) edge = std::clamp(edge, 0.0f, 1.0f);
  }
  const auto last = [](int size, float fraction) { return std::ceil(static_cast<float>(size) * fraction); };
  if (!(last(width, crop[0]) < last(width, crop[1])) || !(last(height, crop[2]) < last(height, crop[3])))
    throw list.error(name, "leaves no pixel");
  return crop;
}

int resolution(const ParameterList& list, std::string_view name, int otherwise) {
  constexpr int largest = 65536;
  const int value = list.get(name, otherwise);
  if (value < 1 || value > largest) throw list.error(name, "must be between 1 and " + std::to_string(largest));
  return value;
}

void read_sensor(const ParameterList& list, Film& film, Context& context) {
  if (const std::string sensor = list.get("sensor", "cie1931"); sensor != "cie1931")
    context.warn("sensor", list.find("sensor")->place,
                 "the measured sensor " + in_quotes(sensor) + " is not supported: replaced by \"cie1931\"");
  if (const auto kelvin = list.find_float("whitebalance"); kelvin && *kelvin != 0) {
    if (!(*kelvin >= 1000 && *kelvin <= 25000))
      throw list.error("whitebalance", "must be 0 or from 1000 to 25000 kelvin");
    film.white_balance = *kelvin;
  }
  if (list.has("maxcomponentvalue")) {
    const float largest = positive(list, "maxcomponentvalue", infinity);
    if (largest < std::numeric_limits<float>::max()) film.largest_component = largest;
  }
  // Parameters without effect: half floats in the file, and the coordinate system of a G-buffer.
  for (const std::string_view name : {"savefp16", "coordinatesystem"}) list.find(name);
}

SpectralBuckets spectral_buckets(const ParameterList& list) {
  constexpr int most = 512;
  SpectralBuckets buckets;
  const int count = list.get("nbuckets", 16);
  if (count < 1 || count > most) throw list.error("nbuckets", "must be between 1 and " + std::to_string(most));
  buckets.count = static_cast<std::size_t>(count);
  buckets.low = list.get("lambdamin", lambda_min);
  buckets.high = list.get("lambdamax", lambda_max);
  if (!(buckets.low >= lambda_min)) throw list.error("lambdamin", "must be at least 360");
  if (!(buckets.high <= lambda_max)) throw list.error("lambdamax", "must be at most 830");
  if (!(buckets.high - buckets.low >= 1))
    throw list.error("lambdamax", "must be larger than \"lambdamin\" by 1 or more");
  return buckets;
}

struct FilterDefaults {
  std::string_view name;
  FilterKind kind;
  float radius;
};
constexpr std::array<FilterDefaults, 5> filters = {{{"box", FilterKind::box, 0.5f},
                                                    {"triangle", FilterKind::triangle, 2},
                                                    {"gaussian", FilterKind::gaussian, 1.5f},
                                                    {"mitchell", FilterKind::mitchell, 2},
                                                    {"sinc", FilterKind::sinc, 4}}};

std::optional<int> find_at_least(const ParameterList& list, std::string_view name, int least) {
  const auto value = list.find_integer(name);
  if (value && *value < least) throw list.error(name, "must be at least " + std::to_string(least));
  return value;
}

void read_seed(const ParameterList& list, RenderHints& hints) {
  if (const auto seed = list.find_integer("seed")) hints.seed = static_cast<std::uint32_t>(*seed);
}

// The value of a method's parameter in the command line's notation.
std::string setting(const Parameter& p, const ParameterList& list) {
  const auto text = [&](const auto& values) {
    if (values.size() != 1) throw list.error(p.name, "must have one value");
    return fmt::format("{}", static_cast<typename std::decay_t<decltype(values)>::value_type>(values[0]));
  };
  return std::visit(text, p.values);
}

// Reads parameters of Lanthorn's methods, under their own names.
void read_method_parameters(const KnownMethod& method, const ParameterList& list, RenderHints& hints) {
  for (const ParameterInfo& known : method.parameters)
    if (const Parameter* p = list.find(known.name)) hints.parameters[known.name] = setting(*p, list);
  try {
    method.check(hints.parameters);
  } catch (const Error& problem) {
    throw Error(list.place().location(), problem.message);
  }
}

}  // namespace

Camera make_camera(const std::string& kind, const ParameterList& list, Context& context) {
  Camera camera;
  camera.location = list.place().location();
  if (kind == "perspective")
    camera.node = perspective(list);
  else if (kind == "orthographic")
    camera.node = lens<OrthographicCamera>(list);
  else if (kind == "spherical")
    camera.node = spherical(list);
  else if (kind == "realistic")
    camera.node = realistic(list, context);
  else
    throw context.unknown("camera", "Camera", kind, list.place());
  camera.shutter_open = list.get("shutteropen", 0.0f);
  camera.shutter_close = list.get("shutterclose", 1.0f);
  if (!(camera.shutter_close > camera.shutter_open))
    throw list.error("shutterclose", "must be later than \"shutteropen\"");
  if (list.has("frameaspectratio")) camera.frame_aspect_ratio = positive(list, "frameaspectratio", 1);
  camera.screen_window = list.find_float4("screenwindow");
  if (const auto& w = camera.screen_window; w && ((*w)[0] == (*w)[1] || (*w)[2] == (*w)[3]))
    throw list.error("screenwindow", "is empty");
  report_unused(list, context);
  return camera;
}

Film make_film(const std::string& kind, const ParameterList& list, float exposure_time, Context& context) {
  // Every output file contains a G-buffer's channels as layers.
  if (kind != "rgb" && kind != "gbuffer" && kind != "spectral")
    throw context.unknown("film", "Film", kind, list.place());
  Film film;
  if (kind == "spectral") film.buckets = spectral_buckets(list);
  film.width = resolution(list, "xresolution", 1280);
  film.height = resolution(list, "yresolution", 720);
  film.crop = crop_window(list, film.width, film.height);
  film.filename = list.get("filename", "");
  film.diagonal = millimetre * positive(list, "diagonal", 35);
  film.imaging_ratio = exposure_time * positive(list, "iso", 100) / 100;
  read_sensor(list, film, context);
  report_unused(list, context);
  return film;
}

description::Filter make_filter(const std::string& kind, const ParameterList& list, Context& context) {
  const auto it = std::find_if(filters.begin(), filters.end(), [&](const FilterDefaults& f) { return f.name == kind; });
  if (it == filters.end()) throw Error(list.place().location(), "unknown pixel filter " + in_quotes(kind));
  description::Filter filter;
  filter.kind = it->kind;
  filter.radius = {positive(list, "xradius", it->radius), positive(list, "yradius", it->radius)};
  if (it->kind == FilterKind::gaussian) filter.sigma = positive(list, "sigma", filter.sigma);
  if (it->kind == FilterKind::mitchell) {
    filter.b = list.get("B", filter.b);
    filter.c = list.get("C", filter.c);
  }
  if (it->kind == FilterKind::sinc) filter.tau = positive(list, "tau", filter.tau);
  try {
    static_cast<void>(lanthorn::Filter(filter_shape(filter)));
  } catch (const Error& problem) {
    throw Error(list.place().location(), problem.message);
  }
  report_unused(list, context);
  return filter;
}

void read_integrator(const std::string& kind, const ParameterList& list, Context& context) {
  RenderHints& hints = context.scene.hints;
  hints.integrator = kind;
  hints.parameters.clear();
  hints.max_depth = find_at_least(list, "maxdepth", 0);
  hints.regularize = list.get("regularize", false);
  if (const auto photons = list.find_integer("photonsperiteration"); photons && *photons > 0)
    hints.photons_per_iteration = *photons;
  read_seed(list, hints);
  if (const std::optional<KnownMethod> method = context.methods(kind))
    read_method_parameters(*method, list, hints);
  else
    context.warn("integrator", list.place(),
                 "neither pbrt nor Lanthorn has an integrator " + in_quotes(kind) + ": the default method is used");
  report_unused(list, context);
}

void read_sampler(const std::string&, const ParameterList& list, Context& context) {
  RenderHints& hints = context.scene.hints;
  hints.pixel_samples = find_at_least(list, "pixelsamples", 1);
  const auto x = find_at_least(list, "xsamples", 1), y = find_at_least(list, "ysamples", 1);
  if (x || y) hints.pixel_samples = std::min(x.value_or(4), 65536) * std::min(y.value_or(4), 32767);
  read_seed(list, hints);
  // The kind of sampler has no effect: Lanthorn uses its own.
  for (const std::string_view name : {"randomization", "jitter"}) list.find(name);
  report_unused(list, context);
}

}  // namespace lanthorn::pbrt
