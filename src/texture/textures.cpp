// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The procedural textures follow pbrt-v4's file format; see also Pharr, Jakob, Humphreys 2023, "Physically Based
// Rendering" 4e, §10.3 to §10.5, and 3e, §10.6.
#include "texture/textures.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "base/parallel.h"
#include "lanthorn/text.h"
#include "math/noise.h"

namespace lanthorn {

namespace {

using namespace description;

bool is_odd(float x) { return std::fmod(std::floor(x), 2.0f) != 0; }

// True where the checkerboard shows its second texture.
bool is_second(const std::variant<TextureMapping, SolidMapping>& mapping, const TexturePoint& at) {
  if (const auto* plane = std::get_if<TextureMapping>(&mapping)) {
    const Vec2 st = plane_point(*plane, at);
    return is_odd(st.x) != is_odd(st.y);
  }
  const Point p = solid_point(std::get<SolidMapping>(mapping), at);
  return (is_odd(p.x) != is_odd(p.y)) != is_odd(p.z);
}

constexpr float dot_radius = 0.35f;

bool is_inside_dot(const Vec2& st) {
  const auto noise = [](float x, float y) { return perlin_noise({x, y, 0.5f}); };
  const Vec2 cell = floor(st + 0.5f);
  if (!(noise(cell.x + 0.5f, cell.y + 0.5f) > 0)) return false;
  const Vec2 shift(noise(cell.x + 1.5f, cell.y + 2.8f), noise(cell.x + 4.5f, cell.y + 9.8f));
  const Vec2 from_centre = st - (cell + (0.5f - dot_radius) * shift);
  return dot(from_centre, from_centre) < dot_radius * dot_radius;
}

float windy(const Point& p) { return std::fabs(fbm(0.1f * p, 0.5f, 3)) * fbm(p, 0.5f, 6); }

// Colours along a cubic spline of Bézier control points; each four consecutive points are one segment.
Rgb marble_colour(float t) {
  constexpr Rgb light{0.58f, 0.58f, 0.6f};
  constexpr std::array<Rgb, 9> control = {
      light, light, light, {0.5f, 0.5f, 0.5f}, {0.6f, 0.59f, 0.58f}, light, light, {0.2f, 0.2f, 0.33f}, light};
  constexpr std::size_t segments = control.size() - 3;
  const float x = std::clamp(t, 0.0f, 1.0f) * static_cast<float>(segments);
  const std::size_t first = std::min(static_cast<std::size_t>(x), segments - 1);
  const float b = x - static_cast<float>(first), a = 1 - b;
  return 1.5f * (a * a * a * control[first] + 3 * a * a * b * control[first + 1] + 3 * a * b * b * control[first + 2] +
                 b * b * b * control[first + 3]);
}

Rgb marble(const MarbleTexture& texture, const TexturePoint& at) {
  const Point p = texture.scale * solid_point(texture.mapping, at);
  const float veins = p.y + texture.variation * fbm(p, texture.octaves.roughness, texture.octaves.count);
  return marble_colour(0.5f + 0.5f * std::sin(veins));
}

Spectrum spectrum_of(const Rgb& colour, SpectrumRole role, const Wavelengths& w) {
  const Rgb c{std::fmax(0.0f, colour.r), std::fmax(0.0f, colour.g), std::fmax(0.0f, colour.b)};
  switch (role) {
    case SpectrumRole::albedo:
      return evaluate_albedo({std::fmin(c.r, 1.0f), std::fmin(c.g, 1.0f), std::fmin(c.b, 1.0f)}, w);
    case SpectrumRole::unbounded:
      return SpectrumCurve::unbounded(c).evaluate(w);
    case SpectrumRole::illuminant:
      return evaluate_illuminant(c, w);
  }
  return Spectrum(0);
}

// A small fraction of the wavelength of the finest octave.
float noise_detail(int octaves) { return 0x1p-4f / std::pow(1.99f, static_cast<float>(octaves - 1)); }

Error too_deep(const SourceLocation& location) {
  return {location, "textures are nested more than " + std::to_string(TextureGraph::most.depth) + " deep"};
}

// Lookups of a node itself, without its inputs.
template <class Node>
std::size_t own_lookups(const Node& node) {
  if constexpr (requires { node.octaves; }) return static_cast<std::size_t>(std::max(node.octaves.count, 1));
  if constexpr (requires { node.texture; }) return own_lookups(node.texture);
  return 1;
}

// Values of the nodes that combine other nodes. `get` evaluates an input: a float or a spectrum.
template <class Input, class Get>
auto combined(const Checkerboard<Input>& t, const TexturePoint& at, const Get& get) {
  return get(is_second(t.mapping, at) ? t.tex2 : t.tex1);
}
template <class Input, class Factor, class Get>
auto combined(const ScaleTexture<Input, Factor>& t, const TexturePoint&, const Get& get) {
  return get(t.tex) * get(t.scale);
}
template <class Input, class Get>
auto mixed(const Input& first, const Input& second, float amount, const Get& get) {
  return (1 - amount) * get(first) + amount * get(second);
}
template <class Input, class Get>
auto combined(const MixTexture<Input, FloatInput>& t, const TexturePoint&, const Get& get) {
  return mixed(t.tex1, t.tex2, get(t.amount), get);
}
template <class Input, class Get>
auto combined(const DirectionMixTexture<Input>& t, const TexturePoint& at, const Get& get) {
  return mixed(t.tex2, t.tex1, std::fabs(dot(at.normal, t.direction)), get);
}
template <class Input, class Get>
float combined(const ThresholdTexture<Input>& t, const TexturePoint&, const Get& get) {
  return get(t.value) >= t.least ? 1.0f : 0.0f;
}
template <class Input, class Get>
auto combined(const BilerpTexture<Input>& t, const TexturePoint& at, const Get& get) {
  const Vec2 st = plane_point(t.mapping, at);
  return (1 - st.y) * mixed(t.v00, t.v10, st.x, get) + st.y * mixed(t.v01, t.v11, st.x, get);
}
template <class Input, class Get>
auto combined(const DotsTexture<Input>& t, const TexturePoint& at, const Get& get) {
  return get(is_inside_dot(plane_point(t.mapping, at)) ? t.inside : t.outside);
}

}  // namespace

Rgb ImageInput::samples(const TexturePoint& at, int level) const {
  return image->rgb(plane_point(mapping, at), wrap, filter, level);
}

Rgb ImageInput::changed(const Rgb& samples) const {
  const Rgb c = scale * tint * samples;
  return invert ? Rgb{1, 1, 1} + -1.0f * c : c;
}

Rgb ImageInput::rgb(const TexturePoint& at, int level) const { return changed(image->colour(samples(at, level))); }

int ImageInput::level(const Footprint& footprint) const {
  if (image->levels() == 1 || !(footprint.uv.x > 0)) return 0;
  constexpr float texels_in_footprint = 4;
  const float texels = multiples_within(footprint, mapping, 1.0f / Vec2(image->width(), image->height()));
  if (!(texels >= 2 * texels_in_footprint)) return 0;
  return std::min(image->levels() - 1, std::ilogb(texels / texels_in_footprint));
}

// Counts the depth of recursion while a texture compiles the textures that it names. Throws if the depth is exceeded,
// because descriptions made by programs may contain cycles.
class TextureGraph::Descent {
 public:
  Descent(std::size_t& depth, const SourceLocation& location) : depth_(depth) {
    if (depth_ >= most.depth) throw too_deep(location);
    ++depth_;
  }
  Descent(const Descent&) = delete;
  Descent& operator=(const Descent&) = delete;
  ~Descent() { --depth_; }

 private:
  std::size_t& depth_;
};

// Compiles nodes of the description into nodes of the graph with compiled parameters.
template <class Input, class Node>
struct TextureGraph::Compiler {
  TextureGraph& graph;
  std::vector<Node>& nodes;
  std::vector<Cost>& costs;
  const SourceLocation& location;
  SpectrumRole role = SpectrumRole::unbounded;
  Cost inputs{};  // the deepest one, and the lookups of all

  FloatInput input(const FloatParameter& p) { return counted(graph.compile(p)); }
  SpectrumInput input(const SpectrumParameter& p) { return counted(graph.compile(p, role, location)); }
  template <class Any>
  Any counted(Any compiled) {
    const Cost cost = graph.cost(compiled);
    inputs.depth = std::max(inputs.depth, cost.depth);
    inputs.lookups += cost.lookups;
    return compiled;
  }

  ImageInput node(const ImageTexture& t) const { return graph.compile_image(t, location, role); }
  template <class P>
  Checkerboard<Input> node(const Checkerboard<P>& t) {
    return {t.mapping, input(t.tex1), input(t.tex2)};
  }
  template <class P>
  Scale<Input> node(const ScaleTexture<P>& t) {
    return {input(t.tex), input(t.scale)};
  }
  template <class P>
  Mix<Input> node(const MixTexture<P>& t) {
    return {input(t.tex1), input(t.tex2), input(t.amount)};
  }
  template <class P>
  DirectionMixTexture<Input> node(const DirectionMixTexture<P>& t) {
    return {input(t.tex1), input(t.tex2), t.direction};
  }
  template <class P>
  BilerpTexture<Input> node(const BilerpTexture<P>& t) {
    return {t.mapping, input(t.v00), input(t.v01), input(t.v10), input(t.v11)};
  }
  template <class P>
  DotsTexture<Input> node(const DotsTexture<P>& t) {
    return {t.mapping, input(t.inside), input(t.outside)};
  }
  ThresholdTexture<Input> node(const ThresholdTexture<FloatParameter>& t) { return {input(t.value), t.least}; }
  FbmTexture node(const FbmTexture& t) const { return t; }
  WrinkledTexture node(const WrinkledTexture& t) const { return t; }
  WindyTexture node(const WindyTexture& t) const { return t; }
  MarbleNode node(const MarbleTexture& t) const { return {t, role}; }
  Product node(const ScaleTexture<SpectrumParameter, SpectrumParameter>& t) { return {input(t.tex), input(t.scale)}; }
  Node node(const VertexColorTexture& t) const {
    if constexpr (std::is_same_v<Input, FloatInput>)
      return t;
    else
      return VertexColorNode{role};
  }

  Input added(Node node) {
    const Cost cost{inputs.depth + 1, inputs.lookups + std::visit([](const auto& n) { return own_lookups(n); }, node)};
    if (cost.depth > most.depth) throw too_deep(location);
    if (cost.lookups > most.lookups)
      throw Error(location, "a value of this texture takes more than " + std::to_string(most.lookups) +
                                " lookups: a texture counts once for each reference to it");
    Input result;
    result.node = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back(std::move(node));
    costs.push_back(cost);
    return result;
  }

  // Compiles a whole texture as an input. Constants stay constants.
  template <class P>
  Input operator()(const ConstantTexture<P>& t) {
    return input(t.value);
  }
  Input operator()(const ScaleTexture<FloatParameter>& t) {
    const Scale<FloatInput> scaled = node(t);
    if (scaled.tex.node || scaled.scale.node) return added(scaled);
    return {scaled.tex.value * scaled.scale.value, {}};
  }
  Input operator()(const ScaleTexture<SpectrumParameter>& t) {
    const Scale<SpectrumInput> scaled = node(t);
    if (scaled.tex.node || scaled.scale.node) return added(scaled);
    return {scaled.tex.curve.scaled(scaled.scale.value), {}};
  }
  Input operator()(const MixTexture<FloatParameter>& t) {
    const Mix<FloatInput> mix = node(t);
    if (mix.tex1.node || mix.tex2.node || mix.amount.node) return added(mix);
    return {lerp(mix.amount.value, mix.tex1.value, mix.tex2.value), {}};
  }
  template <class Texture>
  Input operator()(const Texture& t) {
    return added(node(t));
  }
};

std::size_t TextureGraph::bytes() const {
  std::size_t sum = 0;
  for (const ImageFile& image : images_) sum += image.texels->bytes();
  return sum + (cache() != nullptr ? cache()->bytes() : 0);
}

void TextureGraph::require_readable() const {
  if (cache() == nullptr) return;
  if (const std::optional<Error> problem = cache()->problem()) throw Error(*problem);
}

FloatInput TextureGraph::compile(const FloatParameter& parameter) {
  if (parameter.texture) return compile_float_texture(*parameter.texture);
  return {parameter.value, {}};
}

SpectrumInput TextureGraph::compile(const SpectrumParameter& parameter, SpectrumRole role,
                                    const SourceLocation& location) {
  if (parameter.texture) return compile_spectrum_texture(*parameter.texture, role);
  return {spectra_->curve(parameter.value, role, description_->color_space, location), {}};
}

NormalMapInput TextureGraph::compile(const NormalMap& map, const SourceLocation& location, bool needs_colour) {
  if (needs_colour) image_file(map.image, location).needs_colour = true;
  return {compile_image(map.image, location, SpectrumRole::unbounded), map.strength};
}

TextureGraph::ImageFile& TextureGraph::image_file(const ImageTexture& texture, const SourceLocation& location) {
  const ImageKey key{texture.filename, texture.embedded, texture.encoding, texture.gamma, texture.space};
  ImageFile*& file = known_images_[key];
  if (file == nullptr) {
    file = &images_.emplace_back();
    file->filename = texture.filename;
    if (texture.embedded) file->embedded = &description_->embedded_images.at(*texture.embedded);
    file->encoding = texture.encoding;
    file->gamma = texture.gamma;
    file->space = texture.space;
    file->location = location;
    const auto shared = shared_images_.find(key);
    file->is_loaded = shared != shared_images_.end();
    file->texels = file->is_loaded ? shared->second : std::make_shared<TextureImage>();
  }
  return *file;
}

TextureGraph::Images TextureGraph::all_images() const {
  Images all = shared_images_;
  for (const auto& [key, file] : known_images_) all.insert_or_assign(key, file->texels);
  return all;
}

ImageInput TextureGraph::compile_image(const ImageTexture& texture, const SourceLocation& location, SpectrumRole role) {
  return {image_file(texture, location).texels.get(),
          texture.mapping,
          {texture.wrap, texture.wrap_t.value_or(texture.wrap)},
          texture.filter,
          texture.scale,
          texture.tint,
          texture.invert,
          role,
          texture.channel};
}

FloatInput TextureGraph::without_opaque_image(const FloatInput& alpha) const {
  const FloatNode* node = alpha.node ? &float_nodes_[*alpha.node] : nullptr;
  if (const auto* mask = node != nullptr ? std::get_if<ThresholdTexture<FloatInput>>(node) : nullptr)
    node = mask->value.node ? &float_nodes_[*mask->value.node] : nullptr;
  const auto* image = node != nullptr ? std::get_if<ImageInput>(node) : nullptr;
  const bool is_alpha = image != nullptr && image->channel == alpha_channel && !image->image->has_alpha();
  const auto shows_nothing = [](Wrap wrap) { return wrap == Wrap::black; };
  if (!is_alpha || shows_nothing(image->wrap.s) || shows_nothing(image->wrap.t)) return alpha;
  return evaluate(alpha, {}) >= 1 ? FloatInput{1, {}} : alpha;
}

bool TextureGraph::is_left_out(const ImageFile& file) const {
  const FileAccess& access = description_->access;
  return file.embedded == nullptr && access.skip_missing && access.is_missing(file.filename);
}

// Which of the images from `first` on go through the cache. Images that cannot be read count nothing here.
std::vector<bool> TextureGraph::plan_memory(std::size_t first) const {
  std::vector<TextureImage::Need> needs(images_.size() - first);
  parallel_for(std::size_t{0}, needs.size(), [&](std::size_t i) {
    const ImageFile& file = images_[first + i];
    if (file.is_loaded || is_left_out(file)) return;
    try {
      needs[i] = TextureImage::need(file.source(), description_->access, file.wish(), file.location);
    } catch (const Error&) {  // thrown again when it is read
    }
  });
  return memory_->plan(needs);
}

void TextureGraph::load_images() {
  const std::size_t first = loaded_, count = images_.size() - first;
  loaded_ = images_.size();
  const std::vector<bool> is_cached = plan_memory(first);
  std::vector<std::exception_ptr> problems(count);
  parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    ImageFile& file = images_[first + i];
    try {
      const FileAccess& access = description_->access;
      if (is_left_out(file))  // grey, or no relief
        *file.texels = TextureImage(file.needs_colour ? Rgb{0.5f, 0.5f, 1} : Rgb{0.5f, 0.5f, 0.5f});
      else if (!file.is_loaded && is_cached[i])
        *file.texels = TextureImage(file.source(), access, file.wish(), file.location, memory_->cache());
      else if (!file.is_loaded)
        *file.texels = TextureImage(file.source(), access, file.wish(), file.location);
      file.is_loaded = true;
      if (file.needs_colour && !file.texels->has_colour())
        throw Error(file.location, "the normal map " + in_quotes(file.source().name()) + " must have three channels");
    } catch (...) {
      problems[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& problem : problems)
    if (problem) std::rethrow_exception(problem);
}

FloatInput TextureGraph::compile_float_texture(Index index) {
  if (const auto found = compiled_floats_.find(index); found != compiled_floats_.end()) return found->second;
  const FloatTexture& texture = description_->float_textures.at(index);
  const Descent descent(descent_, texture.location);
  Compiler<FloatInput, FloatNode> compiler{*this, float_nodes_, float_costs_, texture.location};
  return compiled_floats_[index] = std::visit(compiler, texture.node);
}

SpectrumInput TextureGraph::compile_spectrum_texture(Index index, SpectrumRole role) {
  const auto key = std::make_pair(index, role);
  if (const auto found = compiled_spectra_.find(key); found != compiled_spectra_.end()) return found->second;
  const SpectrumTexture& texture = description_->spectrum_textures.at(index);
  const Descent descent(descent_, texture.location);
  Compiler<SpectrumInput, SpectrumNode> compiler{*this, spectrum_nodes_, spectrum_costs_, texture.location, role};
  return compiled_spectra_[key] = std::visit(compiler, texture.node);
}

struct TextureGraph::FloatLookup {
  const TextureGraph& graph;
  const TexturePoint& at;

  float operator()(const FloatInput& input) const { return graph.evaluate(input, at); }

  float value(const ImageInput& t) const {
    const float v = t.scale * t.image->scalar(plane_point(t.mapping, at), t.wrap, t.filter, t.channel);
    return t.invert ? std::fmax(0.0f, 1 - v) : v;
  }
  float value(const FbmTexture& t) const {
    return fbm(solid_point(t.mapping, at), t.octaves.roughness, t.octaves.count);
  }
  float value(const WrinkledTexture& t) const {
    return turbulence(solid_point(t.mapping, at), t.octaves.roughness, t.octaves.count);
  }
  float value(const WindyTexture& t) const { return windy(solid_point(t.mapping, at)); }
  float value(const VertexColorTexture&) const { return at.color.w; }
  template <class Node>
  float value(const Node& t) const {
    return combined(t, at, *this);
  }
};

float TextureGraph::evaluate_float(std::uint32_t node, const TexturePoint& at) const {
  const FloatLookup lookup{*this, at};
  return std::visit([&](const auto& n) { return lookup.value(n); }, float_nodes_[node]);
}

struct TextureGraph::SpectrumLookup {
  const TextureGraph& graph;
  const TexturePoint& at;
  const Wavelengths& w;

  float operator()(const FloatInput& input) const { return graph.evaluate(input, at); }
  Spectrum operator()(const SpectrumInput& input) const { return graph.evaluate(input, at, w); }

  Spectrum value(const ImageInput& t) const { return spectrum_of(t.rgb(at), t.role, w); }
  Spectrum value(const VertexColorNode& t) const {
    return spectrum_of({at.color.x, at.color.y, at.color.z}, t.role, w);
  }
  Spectrum value(const MarbleNode& t) const { return spectrum_of(marble(t.texture, at), t.role, w); }
  template <class Node>
  Spectrum value(const Node& t) const {
    return combined(t, at, *this);
  }
};

Spectrum TextureGraph::evaluate_spectrum(std::uint32_t node, const TexturePoint& at, const Wavelengths& w) const {
  const SpectrumLookup lookup{*this, at, w};
  return std::visit([&](const auto& n) { return lookup.value(n); }, spectrum_nodes_[node]);
}

struct TextureGraph::FilteredLookup : SpectrumLookup {
  Spectrum operator()(const SpectrumInput& input) const {
    if (!input.node) return input.curve.evaluate(w);
    return std::visit([&](const auto& n) { return filtered(n); }, graph.spectrum_nodes_[*input.node]);
  }

  Spectrum filtered(const ImageInput& t) const { return spectrum_of(t.rgb(at, t.level(at.footprint)), t.role, w); }
  Spectrum filtered(const Scale<SpectrumInput>& t) const {
    return t.scale.node ? value(t) : (*this)(t.tex) * t.scale.value;
  }
  Spectrum filtered(const Mix<SpectrumInput>& t) const {
    return t.amount.node ? value(t) : mixed(t.tex1, t.tex2, t.amount.value, *this);
  }
  template <class Node>
  Spectrum filtered(const Node& t) const {
    return value(t);
  }
};

Spectrum TextureGraph::evaluate_filtered(const SpectrumInput& input, const TexturePoint& at,
                                         const Wavelengths& w) const {
  return FilteredLookup{{*this, at, w}}(input);
}

template <class Graph, class Visit>
void TextureGraph::for_filtered_images(Graph& graph, const SpectrumInput& input, const Visit& visit) {
  if (!input.node) return;
  auto& node = graph.spectrum_nodes_[*input.node];
  if (auto* image = std::get_if<ImageInput>(&node)) visit(*image);
  if (auto* scaled = std::get_if<Scale<SpectrumInput>>(&node); scaled && !scaled->scale.node)
    for_filtered_images(graph, scaled->tex, visit);
  if (auto* mix = std::get_if<Mix<SpectrumInput>>(&node); mix && !mix->amount.node) {
    for_filtered_images(graph, mix->tex1, visit);
    for_filtered_images(graph, mix->tex2, visit);
  }
}

void TextureGraph::want_levels(const SpectrumInput& input) {
  for_filtered_images(*this, input, [this](ImageInput& input_image) {
    for (ImageFile& file : images_) {
      if (file.texels.get() != input_image.image) continue;
      file.wants_levels = true;
      // A shared image of another graph may have been read without levels. It stays for the lookups of that graph.
      const bool lacks_levels =
          file.is_loaded && file.texels->levels() == 1 &&
          static_cast<std::size_t>(file.texels->width()) * static_cast<std::size_t>(file.texels->height()) >=
              least_texels_with_levels;
      if (!lacks_levels) return;
      file.texels = std::make_shared<TextureImage>();
      file.is_loaded = false;
      input_image.image = file.texels.get();
      return;
    }
  });
}

bool TextureGraph::has_levels(const SpectrumInput& input) const {
  bool any = false;
  for_filtered_images(*this, input, [&](const ImageInput& image) { any = any || image.image->levels() > 1; });
  return any;
}

Normal TextureGraph::evaluate(const NormalMapInput& map, const TexturePoint& at) {
  const Rgb c = map.image.vector(at);
  const Vec3 n(map.strength * (2 * c.r - 1), map.strength * (2 * c.g - 1), 2 * c.b - 1);
  const float length = std::sqrt(length_squared(n));
  return length > 0 ? n / length : Normal(0, 0, 1);
}

struct TextureGraph::DetailLookup {
  const TextureGraph& graph;

  TextureDetail operator()(const FloatInput& input) const {
    if (!input.node) return {};
    return std::visit([&](const auto& n) { return value(n); }, graph.float_nodes_[*input.node]);
  }
  template <class... Inputs>
  TextureDetail finest(const Inputs&... inputs) const {
    TextureDetail detail;
    (detail.refine((*this)(inputs)), ...);
    return detail;
  }

  // Half of a texel, because a difference over a whole texel is continuous if texels are interpolated.
  TextureDetail value(const ImageInput& t) const {
    return detail_of(t.mapping, 0.5f / Vec2(t.image->width(), t.image->height()));
  }
  TextureDetail value(const FbmTexture& t) const { return detail_of(t.mapping, noise_detail(t.octaves.count)); }
  TextureDetail value(const WrinkledTexture& t) const { return detail_of(t.mapping, noise_detail(t.octaves.count)); }
  TextureDetail value(const WindyTexture& t) const { return detail_of(t.mapping, noise_detail(6)); }
  TextureDetail value(const VertexColorTexture&) const { return {}; }
  TextureDetail value(const Checkerboard<FloatInput>& t) const { return finest(t.tex1, t.tex2); }
  TextureDetail value(const Scale<FloatInput>& t) const { return finest(t.tex, t.scale); }
  TextureDetail value(const Mix<FloatInput>& t) const { return finest(t.tex1, t.tex2, t.amount); }
  TextureDetail value(const DirectionMixTexture<FloatInput>& t) const { return finest(t.tex1, t.tex2); }
  TextureDetail value(const ThresholdTexture<FloatInput>& t) const { return finest(t.value); }
  TextureDetail value(const BilerpTexture<FloatInput>& t) const { return finest(t.v00, t.v01, t.v10, t.v11); }
  TextureDetail value(const DotsTexture<FloatInput>& t) const { return finest(t.inside, t.outside); }
};

TextureDetail TextureGraph::detail(const FloatInput& input) const { return DetailLookup{*this}(input); }

}  // namespace lanthorn
