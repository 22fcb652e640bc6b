// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Textures, compiled from the description's graph into flat arrays. A parameter is either a constant, which costs
// nothing to look up, or the index of a node; constant nodes are folded away while building.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <tuple>
#include <variant>
#include <vector>

#include "math/vec.h"
#include "scene/description.h"
#include "scene/image_texture.h"
#include "scene/spectrum_store.h"
#include "spectrum/curve.h"
#include "spectrum/spectrum.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Where a texture is looked up.
struct TexturePoint {
  Point position{0};  ///< world space
  Vec2 uv{0};
};

/// A float parameter: `value`, unless there is a node.
struct FloatInput {
  float value = 0;
  std::optional<std::uint32_t> node;
};
/// A spectrum parameter: `curve`, unless there is a node.
struct SpectrumInput {
  SpectrumCurve curve;
  std::optional<std::uint32_t> node;
};

class TextureGraph {
 public:
  /// `spectra` keeps the tables of constant spectra.
  TextureGraph(const SceneDescription& description, SpectrumStore& spectra)
      : description_(&description), spectra_(&spectra) {}

  // Compilation: the description must still be there. Throws Error for broken references and unreadable images.
  FloatInput compile(const description::FloatParameter& parameter);
  SpectrumInput compile(const description::SpectrumParameter& parameter, description::SpectrumRole role,
                        const SourceLocation& location);

  float evaluate(const FloatInput& input, const TexturePoint& at) const {
    return input.node ? evaluate_float(*input.node, at) : input.value;
  }
  Spectrum evaluate(const SpectrumInput& input, const TexturePoint& at, const Wavelengths& w) const {
    return input.node ? evaluate_spectrum(*input.node, at, w) : input.curve.evaluate(w);
  }

  /// Texture images in memory.
  std::size_t bytes() const;
  std::size_t image_count() const { return images_.size(); }

 private:
  struct Image {
    const TextureImage* image = nullptr;
    description::UvMapping mapping;
    description::Wrap wrap{};
    description::ImageFilter filter{};
    float scale = 1;
    bool invert = false;
    description::SpectrumRole role{};  // of spectrum nodes
  };
  struct Checker {
    std::variant<description::CheckerboardTexture2d, description::CheckerboardTexture3d> mapping;
    // Is the second texture seen here?
    bool odd(const TexturePoint& at) const;
  };
  template <class Input>
  struct Checkerboard {
    Checker checker;
    Input tex1, tex2;
  };
  template <class Input>
  struct Scaled {
    Input tex;
    FloatInput scale;
  };
  template <class Input>
  struct Mixed {
    Input tex1, tex2;
    FloatInput amount;
  };
  using FloatNode = std::variant<Image, Checkerboard<FloatInput>, Scaled<FloatInput>, Mixed<FloatInput>>;
  using SpectrumNode = std::variant<Image, Checkerboard<SpectrumInput>, Scaled<SpectrumInput>, Mixed<SpectrumInput>>;

  FloatInput compile_float_texture(description::Index index);
  SpectrumInput compile_spectrum_texture(description::Index index, description::SpectrumRole role);
  Image compile_image(const description::ImageTexture& texture, const SourceLocation& location,
                      description::SpectrumRole role);
  float evaluate_float(std::uint32_t node, const TexturePoint& at) const;
  Spectrum evaluate_spectrum(std::uint32_t node, const TexturePoint& at, const Wavelengths& w) const;

  const SceneDescription* description_;
  SpectrumStore* spectra_;
  std::vector<FloatNode> float_nodes_;
  std::vector<SpectrumNode> spectrum_nodes_;
  std::map<description::Index, FloatInput> compiled_floats_;
  std::map<std::pair<description::Index, description::SpectrumRole>, SpectrumInput> compiled_spectra_;
  std::map<std::tuple<std::string, description::Encoding, float, ColorSpace>, const TextureImage*> loaded_;
  std::deque<TextureImage> images_;  // addresses stay
};

}  // namespace lanthorn
