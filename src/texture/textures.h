// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Textures, compiled from the description's graph into flat arrays. A parameter is either a constant, which costs
// nothing to look up, or the index of a node. Constant nodes are folded during compilation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "lanthorn/scene_description.h"
#include "math/vec.h"
#include "spectrum/curve.h"
#include "spectrum/spectrum.h"
#include "spectrum/wavelengths.h"
#include "texture/image_texture.h"
#include "texture/spectrum_store.h"
#include "texture/texture_mapping.h"
#include "texture/texture_memory.h"

namespace lanthorn {

/// A float parameter: `value`, unless it has a node.
struct FloatInput {
  float value = 0;
  std::optional<std::uint32_t> node;
};
/// A spectrum parameter: `curve`, unless it has a node.
struct SpectrumInput {
  SpectrumCurve curve;
  std::optional<std::uint32_t> node;
};

/// An image and the way in which it is looked up.
struct ImageInput {
  const TextureImage* image = nullptr;
  description::TextureMapping mapping;
  WrapModes wrap;
  description::ImageFilter filter{};
  float scale = 1;
  Rgb tint{1, 1, 1};
  bool invert = false;
  description::SpectrumRole role{};  ///< of spectrum nodes
  std::optional<int> channel;        ///< of float nodes

  /// Colour (linear Rec.709) times `scale` and `tint`, then inverted if requested.
  Rgb rgb(const TexturePoint& at, int level = 0) const;
  /// The same of samples that are not a colour.
  Rgb vector(const TexturePoint& at) const { return changed(samples(at, 0)); }
  /// The coarsest level at which a square of 4 x 4 texels still lies within the footprint: finer than a picture can
  /// show.
  int level(const Footprint& footprint) const;

 private:
  Rgb samples(const TexturePoint& at, int level) const;
  Rgb changed(const Rgb& samples) const;
};
struct NormalMapInput {
  ImageInput image;
  float strength = 1;
};

class TextureGraph {
 public:
  /// `spectra` stores the tables of constant spectra. `loaded`: shares its images, so that they are not read again.
  TextureGraph(const SceneDescription& description, SpectrumStore& spectra, const TextureGraph* loaded = nullptr)
      : description_(&description),
        spectra_(&spectra),
        memory_(loaded != nullptr ? loaded->memory_
                                  : std::make_shared<TextureMemory>(description.access.texture_memory)) {
    if (loaded != nullptr) shared_images_ = loaded->all_images();
  }

  // Compilation. The description must still exist. Throws Error for broken references and for textures that cost more
  // than `most`. Images are recorded, each once; `load_images` must be called before anything is evaluated.
  FloatInput compile(const description::FloatParameter& parameter);
  SpectrumInput compile(const description::SpectrumParameter& parameter, description::SpectrumRole role,
                        const SourceLocation& location);
  NormalMapInput compile(const description::NormalMap& map, const SourceLocation& location, bool needs_colour = true);
  /// Reads the images recorded since the last call, in parallel. Throws Error for the first image, in the order of
  /// compilation, that cannot be read or is a normal map without colours.
  void load_images();

  float evaluate(const FloatInput& input, const TexturePoint& at) const {
    return input.node ? evaluate_float(*input.node, at) : input.value;
  }
  Spectrum evaluate(const SpectrumInput& input, const TexturePoint& at, const Wavelengths& w) const {
    return input.node ? evaluate_spectrum(*input.node, at, w) : input.curve.evaluate(w);
  }
  /// The same, averaged over a part of the footprint if the input is an image, or a multiple or constant mix of images;
  /// the mean of other inputs may differ from their value at the images' means. For uses in which light is linear in
  /// the input.
  Spectrum evaluate_filtered(const SpectrumInput& input, const TexturePoint& at, const Wavelengths& w) const;
  /// To be called before `load_images`: requests coarser levels of the images that `evaluate_filtered` averages.
  void want_levels(const SpectrumInput& input);
  /// After `load_images`: true if some of these images have coarser levels.
  bool has_levels(const SpectrumInput& input) const;
  /// The mapped normal in the frame of dp/du, dp/dv and the smooth normal; unit.
  static Normal evaluate(const NormalMapInput& map, const TexturePoint& at);
  /// 1 if `alpha` reads the alpha of an image without alpha and is 1, so that rays need not evaluate it; else `alpha`.
  FloatInput without_opaque_image(const FloatInput& alpha) const;
  /// The finest detail of all textures behind an input.
  TextureDetail detail(const FloatInput& input) const;

  /// Cost of one evaluation of an input.
  struct Cost {
    std::size_t depth = 0;    ///< of the chain of nodes
    std::size_t lookups = 0;  ///< nodes, each as often as it is evaluated; noise counts once for each octave
  };
  /// The largest cost. Chains are evaluated recursively, and nodes that share inputs evaluate them anew.
  static constexpr Cost most{256, 1'000};
  Cost cost(const FloatInput& input) const { return input.node ? float_costs_[*input.node] : Cost{}; }
  Cost cost(const SpectrumInput& input) const { return input.node ? spectrum_costs_[*input.node] : Cost{}; }

  /// Memory of texture images, bytes: those in memory, and the tiles that the cache may hold.
  std::size_t bytes() const;
  /// Bytes on disk: tiles of images that do not fit into memory.
  std::uint64_t disk_bytes() const { return cache() != nullptr ? cache()->bytes_on_disk() : 0; }
  /// Throws Error if a tile could not be read so far.
  void require_readable() const;
  TileCacheCounts reads() const { return cache() != nullptr ? cache()->counts() : TileCacheCounts{}; }
  std::size_t image_count() const { return images_.size(); }

 private:
  template <class Input>
  using Scale = description::ScaleTexture<Input, FloatInput>;
  template <class Input>
  using Mix = description::MixTexture<Input, FloatInput>;
  using FloatNode = std::variant<ImageInput, description::Checkerboard<FloatInput>, Scale<FloatInput>, Mix<FloatInput>,
                                 description::DirectionMixTexture<FloatInput>, description::BilerpTexture<FloatInput>,
                                 description::DotsTexture<FloatInput>, description::FbmTexture,
                                 description::WrinkledTexture, description::WindyTexture,
                                 description::VertexColorTexture, description::ThresholdTexture<FloatInput>>;
  struct MarbleNode {
    description::MarbleTexture texture;
    description::SpectrumRole role{};
  };
  struct VertexColorNode {
    description::SpectrumRole role{};
  };
  using Product = description::ScaleTexture<SpectrumInput, SpectrumInput>;
  using SpectrumNode =
      std::variant<ImageInput, description::Checkerboard<SpectrumInput>, Scale<SpectrumInput>, Mix<SpectrumInput>,
                   description::DirectionMixTexture<SpectrumInput>, description::BilerpTexture<SpectrumInput>,
                   description::DotsTexture<SpectrumInput>, MarbleNode, Product, VertexColorNode>;
  struct ImageFile {
    std::string filename;
    const description::EmbeddedImage* embedded = nullptr;  ///< replaces the file, if not null
    description::Encoding encoding{};
    float gamma = 1;
    ColorSpace space{};
    SourceLocation location;
    bool needs_colour = false, wants_levels = false;
    std::shared_ptr<TextureImage> texels;
    bool is_loaded = false;

    ImageSource source() const { return embedded != nullptr ? ImageSource(*embedded) : ImageSource(filename); }
    ImageWish wish() const { return {{encoding, gamma, space}, wants_levels}; }
  };
  using ImageKey = std::tuple<std::string, std::optional<description::Index>, description::Encoding, float, ColorSpace>;
  using Images = std::map<ImageKey, std::shared_ptr<TextureImage>>;
  template <class Input, class Node>
  struct Compiler;
  class Descent;
  struct FloatLookup;
  struct SpectrumLookup;
  struct FilteredLookup;
  struct DetailLookup;

  FloatInput compile_float_texture(description::Index index);
  SpectrumInput compile_spectrum_texture(description::Index index, description::SpectrumRole role);
  ImageInput compile_image(const description::ImageTexture& texture, const SourceLocation& location,
                           description::SpectrumRole role);
  ImageFile& image_file(const description::ImageTexture& texture, const SourceLocation& location);
  // Calls `visit(ImageInput&)` for the images that `evaluate_filtered` averages.
  template <class Graph, class Visit>
  static void for_filtered_images(Graph& graph, const SpectrumInput& input, const Visit& visit);
  // Null if all images are in memory.
  const TextureCache* cache() const { return memory_->cache().get(); }
  bool is_left_out(const ImageFile& file) const;
  std::vector<bool> plan_memory(std::size_t first) const;
  // The images of this graph, and the shared images of other graphs.
  Images all_images() const;
  float evaluate_float(std::uint32_t node, const TexturePoint& at) const;
  Spectrum evaluate_spectrum(std::uint32_t node, const TexturePoint& at, const Wavelengths& w) const;

  const SceneDescription* description_;
  SpectrumStore* spectra_;
  std::shared_ptr<TextureMemory> memory_;
  std::vector<FloatNode> float_nodes_;
  std::vector<SpectrumNode> spectrum_nodes_;
  std::vector<Cost> float_costs_, spectrum_costs_;  // of the nodes
  std::size_t descent_ = 0;                         // depth of the textures being compiled
  std::map<description::Index, FloatInput> compiled_floats_;
  std::map<std::pair<description::Index, description::SpectrumRole>, SpectrumInput> compiled_spectra_;
  std::map<ImageKey, ImageFile*> known_images_;
  Images shared_images_;          // of another graph
  std::deque<ImageFile> images_;  // a deque, so that addresses are stable
  std::size_t loaded_ = 0;        // number of images_ already loaded
};

}  // namespace lanthorn
