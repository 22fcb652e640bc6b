// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/textures.h"

#include <cmath>

namespace lanthorn {

namespace {

using description::SpectrumRole;

Vec2 map_uv(const description::UvMapping& mapping, const Vec2& uv) { return mapping.scale * uv + mapping.offset; }

bool is_odd(float x) { return std::fmod(std::floor(x), 2.0f) != 0; }

template <class Input>
std::uint32_t append(std::vector<Input>& nodes, Input node) {
  nodes.push_back(std::move(node));
  return static_cast<std::uint32_t>(nodes.size() - 1);
}

}  // namespace

bool TextureGraph::Checker::odd(const TexturePoint& at) const {
  if (const auto* plane = std::get_if<description::CheckerboardTexture2d>(&mapping)) {
    const Vec2 st = map_uv(plane->mapping, at.uv);
    return is_odd(st.x) != is_odd(st.y);
  }
  const Point p = std::get<description::CheckerboardTexture3d>(mapping).world_to_texture.point(at.position);
  return (is_odd(p.x) != is_odd(p.y)) != is_odd(p.z);
}

std::size_t TextureGraph::bytes() const {
  std::size_t sum = 0;
  for (const TextureImage& image : images_) sum += image.bytes();
  return sum;
}

FloatInput TextureGraph::compile(const description::FloatParameter& parameter) {
  if (parameter.texture) return compile_float_texture(*parameter.texture);
  return {parameter.value, {}};
}

SpectrumInput TextureGraph::compile(const description::SpectrumParameter& parameter, SpectrumRole role,
                                    const SourceLocation& location) {
  if (parameter.texture) return compile_spectrum_texture(*parameter.texture, role);
  return {spectra_->curve(parameter.value, role, description_->color_space, location), {}};
}

TextureGraph::Image TextureGraph::compile_image(const description::ImageTexture& texture,
                                                const SourceLocation& location, SpectrumRole role) {
  const auto key = std::make_tuple(texture.filename, texture.encoding, texture.gamma, texture.space);
  const TextureImage*& image = loaded_[key];
  if (image == nullptr)
    image = &images_.emplace_back(texture.filename, texture.encoding, texture.gamma, texture.space, location);
  return {image, texture.mapping, texture.wrap, texture.filter, texture.scale, texture.invert, role};
}

FloatInput TextureGraph::compile_float_texture(description::Index index) {
  if (const auto found = compiled_floats_.find(index); found != compiled_floats_.end()) return found->second;
  const description::FloatTexture& texture = description_->float_textures.at(index);
  FloatInput result;
  if (const auto* constant = std::get_if<description::ConstantTexture<description::FloatParameter>>(&texture.node)) {
    result = compile(constant->value);
  } else if (const auto* image = std::get_if<description::ImageTexture>(&texture.node)) {
    result.node = append(float_nodes_, FloatNode(compile_image(*image, texture.location, SpectrumRole::unbounded)));
  } else if (const auto* checks = std::get_if<description::Checkerboard<description::FloatParameter>>(&texture.node)) {
    Checkerboard<FloatInput> node{{checks->mapping}, compile(checks->tex1), compile(checks->tex2)};
    result.node = append(float_nodes_, FloatNode(node));
  } else if (const auto* scaled = std::get_if<description::ScaleTexture<description::FloatParameter>>(&texture.node)) {
    const Scaled<FloatInput> node{compile(scaled->tex), compile(scaled->scale)};
    if (!node.tex.node && !node.scale.node)
      result.value = node.tex.value * node.scale.value;
    else
      result.node = append(float_nodes_, FloatNode(node));
  } else {
    const auto& mix = std::get<description::MixTexture<description::FloatParameter>>(texture.node);
    const Mixed<FloatInput> node{compile(mix.tex1), compile(mix.tex2), compile(mix.amount)};
    if (!node.tex1.node && !node.tex2.node && !node.amount.node)
      result.value = lerp(node.amount.value, node.tex1.value, node.tex2.value);
    else
      result.node = append(float_nodes_, FloatNode(node));
  }
  compiled_floats_[index] = result;
  return result;
}

SpectrumInput TextureGraph::compile_spectrum_texture(description::Index index, SpectrumRole role) {
  const auto key = std::make_pair(index, role);
  if (const auto found = compiled_spectra_.find(key); found != compiled_spectra_.end()) return found->second;
  const description::SpectrumTexture& texture = description_->spectrum_textures.at(index);
  using Parameter = description::SpectrumParameter;
  SpectrumInput result;
  if (const auto* constant = std::get_if<description::ConstantTexture<Parameter>>(&texture.node)) {
    result = compile(constant->value, role, texture.location);
  } else if (const auto* image = std::get_if<description::ImageTexture>(&texture.node)) {
    result.node = append(spectrum_nodes_, SpectrumNode(compile_image(*image, texture.location, role)));
  } else if (const auto* checks = std::get_if<description::Checkerboard<Parameter>>(&texture.node)) {
    Checkerboard<SpectrumInput> node{{checks->mapping},
                                     compile(checks->tex1, role, texture.location),
                                     compile(checks->tex2, role, texture.location)};
    result.node = append(spectrum_nodes_, SpectrumNode(node));
  } else if (const auto* scaled = std::get_if<description::ScaleTexture<Parameter>>(&texture.node)) {
    const Scaled<SpectrumInput> node{compile(scaled->tex, role, texture.location), compile(scaled->scale)};
    if (!node.tex.node && !node.scale.node)
      result.curve = node.tex.curve.scaled(node.scale.value);
    else
      result.node = append(spectrum_nodes_, SpectrumNode(node));
  } else {
    const auto& mix = std::get<description::MixTexture<Parameter>>(texture.node);
    const Mixed<SpectrumInput> node{compile(mix.tex1, role, texture.location),
                                    compile(mix.tex2, role, texture.location), compile(mix.amount)};
    result.node = append(spectrum_nodes_, SpectrumNode(node));
  }
  compiled_spectra_[key] = result;
  return result;
}

float TextureGraph::evaluate_float(std::uint32_t index, const TexturePoint& at) const {
  const FloatNode& node = float_nodes_[index];
  if (const auto* image = std::get_if<Image>(&node)) {
    const float v = image->scale * image->image->scalar(map_uv(image->mapping, at.uv), image->wrap, image->filter);
    return image->invert ? std::fmax(0.0f, 1 - v) : v;
  }
  if (const auto* checks = std::get_if<Checkerboard<FloatInput>>(&node))
    return evaluate(checks->checker.odd(at) ? checks->tex2 : checks->tex1, at);
  if (const auto* scaled = std::get_if<Scaled<FloatInput>>(&node))
    return evaluate(scaled->tex, at) * evaluate(scaled->scale, at);
  const auto& mix = std::get<Mixed<FloatInput>>(node);
  return lerp(evaluate(mix.amount, at), evaluate(mix.tex1, at), evaluate(mix.tex2, at));
}

Spectrum TextureGraph::evaluate_spectrum(std::uint32_t index, const TexturePoint& at, const Wavelengths& w) const {
  const SpectrumNode& node = spectrum_nodes_[index];
  if (const auto* image = std::get_if<Image>(&node)) {
    Rgb c = image->scale * image->image->rgb(map_uv(image->mapping, at.uv), image->wrap, image->filter);
    if (image->invert) c = Rgb{1, 1, 1} + -1.0f * c;
    c = {std::fmax(0.0f, c.r), std::fmax(0.0f, c.g), std::fmax(0.0f, c.b)};
    switch (image->role) {
      case SpectrumRole::albedo:
        return evaluate_albedo({std::fmin(c.r, 1.0f), std::fmin(c.g, 1.0f), std::fmin(c.b, 1.0f)}, w);
      case SpectrumRole::unbounded:
        return SpectrumCurve::unbounded(c).evaluate(w);
      case SpectrumRole::illuminant:
        return evaluate_illuminant(c, w);
    }
  }
  if (const auto* checks = std::get_if<Checkerboard<SpectrumInput>>(&node))
    return evaluate(checks->checker.odd(at) ? checks->tex2 : checks->tex1, at, w);
  if (const auto* scaled = std::get_if<Scaled<SpectrumInput>>(&node))
    return evaluate(scaled->tex, at, w) * evaluate(scaled->scale, at);
  const auto& mix = std::get<Mixed<SpectrumInput>>(node);
  const float amount = evaluate(mix.amount, at);
  return (1 - amount) * evaluate(mix.tex1, at, w) + amount * evaluate(mix.tex2, at, w);
}

}  // namespace lanthorn
