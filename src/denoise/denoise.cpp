// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/denoise.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "denoise/layer.h"
#include "lanthorn/error.h"

namespace lanthorn {

using namespace denoising;

namespace {

constexpr std::array<const char*, 3> components{"R", "G", "B"};
const std::string noise_prefix = "noise.", denoised_prefix = "denoised.", share_channel = "noise.share";

struct FeatureLayer {
  const char* name;
  std::array<const char*, 3> components;
};
constexpr std::array<FeatureLayer, 3> feature_layers{FeatureLayer{"albedo", {"R", "G", "B"}},
                                                     FeatureLayer{"normal", {"X", "Y", "Z"}},
                                                     FeatureLayer{"position", {"X", "Y", "Z"}}};

bool has_layer(const Image& picture, const std::string& layer, const std::array<const char*, 3>& names) {
  for (const char* const name : names)
    if (!picture.find_channel(layer + "." + name)) return false;
  return true;
}
bool has_layer_with_noise(const Image& picture, const std::string& layer, const std::array<const char*, 3>& names) {
  return has_layer(picture, layer, names) && has_layer(picture, noise_prefix + layer, names);
}

// Those whose noise is known.
std::vector<std::string> light_layers(const Image& picture) {
  std::vector<std::string> layers;
  for (const std::string& channel : picture.channels) {
    if (!channel.starts_with(noise_prefix) || !channel.ends_with(".R")) continue;
    const std::string layer = channel.substr(noise_prefix.size(), channel.size() - noise_prefix.size() - 2);
    if (layer != "albedo" && has_layer_with_noise(picture, layer, components)) layers.push_back(layer);
  }
  return layers;
}

struct ChannelChoice {
  std::string name;
  std::size_t from;
};

Image chosen(const Image& picture, const std::vector<ChannelChoice>& choices) {
  std::vector<std::string> channels;
  channels.reserve(choices.size());
  for (const ChannelChoice& choice : choices) channels.push_back(choice.name);
  Image out(picture.width, picture.height, std::move(channels));
  out.window = picture.window;
  for (std::size_t i = 0; i * picture.channel_count() < picture.pixels.size(); ++i)
    for (std::size_t c = 0; c < choices.size(); ++c)
      out.pixels[i * choices.size() + c] = picture.pixels[i * picture.channel_count() + choices[c].from];
  return out;
}

Image without_denoised(const Image& picture) {
  std::vector<ChannelChoice> choices;
  for (std::size_t c = 0; c < picture.channel_count(); ++c)
    if (!picture.channels[c].starts_with(denoised_prefix)) choices.push_back({picture.channels[c], c});
  return chosen(picture, choices);
}

// Light of this layer is in others, too.
bool is_repeated(const std::string& layer) { return layer == "media"; }

// Pixels of a tile, and of the margin around it that they are denoised with.
struct Tile {
  int x, y, width, height;  // of what is written
  int outer_x, outer_y, outer_width, outer_height;
};

std::vector<Tile> tiles_of(int width, int height) {
  // Multiples of the pyramid's coarsest pixels and of the spacing of regressions.
  constexpr int size = 1024, margin = 96;
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += size)
    for (int x = 0; x < width; x += size) {
      Tile t{
          x, y, std::min(size, width - x), std::min(size, height - y), std::max(0, x - margin), std::max(0, y - margin),
          0, 0};
      t.outer_width = std::min(width, x + size + margin) - t.outer_x;
      t.outer_height = std::min(height, y + size + margin) - t.outer_y;
      tiles.push_back(t);
    }
  return tiles;
}

class Denoiser {
 public:
  explicit Denoiser(const Image& picture) : picture_(picture), layers_(light_layers(picture)) {
    const std::size_t share = channel_of(share_channel), samples = channel_of("samples");
    const std::array<std::size_t, color_channels> color{channel_of("R"), channel_of("G"), channel_of("B")};
    double first = 0, all = 0, light = 0;
    for (std::size_t i = 0; i < pixels(); ++i) {
      first += value(i, share) * value(i, samples);
      all += value(i, samples);
      for (const std::size_t c : color) light += value(i, c) / color_channels;
    }
    check_sum(light);
    const auto own = all > 0 ? std::clamp(static_cast<float>(first / all), 0.0f, 1.0f) : 0.0f;
    if (own == 0 || own == 1)
      throw Error("a picture of a single pass cannot be denoised: the noise is the difference of passes");
    shares_ = {own, 1 - own};
    fewest_passes_ = std::min(own, 1 - own) * all / static_cast<double>(pixels());
    mean_ = static_cast<float>(light / static_cast<double>(pixels()));
    std::vector<std::string> channels;
    const auto add = [&](const std::string& layer) {
      for (const char* const c : components) channels.push_back(denoised_prefix + layer + c);
    };
    add("");
    for (const std::string& layer : layers_) add(layer + ".");
    add("error.");
    denoised_ = Image(picture.width, picture.height, channels);
    denoised_.window = picture.window;
  }

  DenoisedPicture run() {
    for (const Tile& tile : tiles_of(picture_.width, picture_.height)) denoise_tile(tile);
    estimate();
    return {with_layers(without_denoised(picture_), denoised_), error_};
  }

 private:
  std::size_t pixels() const { return picture_.pixels.size() / picture_.channel_count(); }
  std::size_t channel_of(const std::string& name) const { return *picture_.find_channel(name); }
  double value(std::size_t pixel, std::size_t channel) const {
    const float v = picture_.pixels[pixel * picture_.channel_count() + channel];
    return std::isfinite(v) ? static_cast<double>(v) : 0.0;
  }

  // Layers may be missing from files that other programs have written. `light`: of all pixels.
  void check_sum(double light) const {
    constexpr double rounding = 1e-2;  // of files in half precision
    double sum = 0;
    for (const std::string& layer : layers_) {
      if (is_repeated(layer)) continue;
      for (const char* const c : components) {
        const std::size_t channel = channel_of(layer + "." + c);
        for (std::size_t i = 0; i < pixels(); ++i) sum += value(i, channel) / color_channels;
      }
    }
    if (std::fabs(sum - light) > rounding * std::fabs(light))
      throw Error(
          fmt::format("the layers whose noise is known ({}) have {:.3g} times the light of color; expected all of it",
                      fmt::join(layers_, ", "), sum / light));
  }

  // A channel of the tile with its margin.
  Plane read(const Tile& tile, const std::string& name) const {
    const std::size_t channel = channel_of(name);
    Plane plane(tile.outer_width, tile.outer_height);
    plane.for_each_row([&](int y) {
      float* const to = plane.row(y);
      for (int x = 0; x < plane.width(); ++x) {
        const float v = picture_.at(tile.outer_x + x, tile.outer_y + y, channel);
        to[x] = std::isfinite(v) ? v : 0.0f;
      }
    });
    return plane;
  }

  Halves read_halves(const Tile& tile, const std::string& layer, const std::array<const char*, 3>& names) const {
    Halves halves;
    for (std::size_t c = 0; c < color_channels; ++c) {
      const std::string name = layer + "." + names[c];
      const Plane all = read(tile, name), noise = read(tile, noise_prefix + name);
      const float ratio = shares_[0] / shares_[1];
      halves[0][c] = Plane::of(all.width(), all.height(), [&](std::size_t i) { return all[i] + noise[i]; });
      halves[1][c] = Plane::of(all.width(), all.height(), [&](std::size_t i) { return all[i] - ratio * noise[i]; });
    }
    return halves;
  }

  // The picture's light around each pixel, as errors are relative to it (`ErrorEstimate`).
  Plane scale_of(const Tile& tile) const {
    constexpr int radius = 2;
    constexpr float dark = 0.01f, tiny = 1e-30f;
    Plane light(tile.outer_width, tile.outer_height);
    for (const char* const c : components) {
      const Plane color = read(tile, c);
      light.fill([&](std::size_t i) { return light[i] + color[i] / 3; });
    }
    light = box_filtered(light, radius);
    light.fill([&](std::size_t i) { return sqr(light[i]) + dark * sqr(mean_) + tiny; });
    return light;
  }

  // By the albedo, which is the first of the features.
  ColorPlanes demodulation_of(const std::array<FeaturePlanes, 2>& features) const {
    constexpr float dark = 0.1f;  // surfaces that are darker reflect light by more than their albedo
    ColorPlanes factors;
    for (std::size_t c = 0; c < color_channels; ++c) {
      const Plane &a = features[0].values[c], &b = features[1].values[c];
      factors[c] = Plane::of(a.width(), a.height(), [&](std::size_t i) {
        return 1 / (std::max(0.0f, shares_[0] * a[i] + shares_[1] * b[i]) + dark);
      });
    }
    return factors;
  }

  void denoise_tile(const Tile& tile) {
    constexpr std::size_t level_count = 3;
    std::vector<Surroundings> levels{{.features = {}, .demodulation = {}, .scale = scale_of(tile)}};
    for (const FeatureLayer& layer : feature_layers)
      add_features(read_halves(tile, layer.name, layer.components), shares_, levels[0].features);
    levels[0].demodulation = demodulation_of(levels[0].features);
    while (levels.size() < level_count) levels.push_back(halved(levels.back()));
    Halves light, result;  // sums over layers
    for (const auto sums : {&light, &result})
      for (ColorPlanes& half : *sums) half.fill(Plane(tile.outer_width, tile.outer_height));
    for (std::size_t l = 0; l < layers_.size(); ++l) {
      const Halves noisy = read_halves(tile, layers_[l], components);
      Halves smooth = denoise_layer(noisy, shares_, levels);
      for (ColorPlanes& half : smooth)
        for (Plane& plane : half) plane.fill([&](std::size_t i) { return std::max(0.0f, plane[i]); });
      write(tile, 1 + l, [&](std::size_t c) { return mean_of(smooth, c, shares_); });
      if (is_repeated(layers_[l])) continue;
      add(noisy, light);
      add(smooth, result);
    }
    write_sum(tile);
    write_error(tile, light, result, levels[0].scale);
  }

  static void add(const Halves& part, Halves& sum) {
    for (std::size_t h = 0; h < 2; ++h)
      for (std::size_t c = 0; c < color_channels; ++c)
        sum[h][c].fill([&](std::size_t i) { return sum[h][c][i] + part[h][c][i]; });
  }

  // The pixels of the tile, of the layer of this number in the result.
  template <class Channel>
  void write(const Tile& tile, std::size_t layer, Channel&& plane_of) {
    for (std::size_t c = 0; c < color_channels; ++c) {
      const Plane plane = plane_of(c);
      for (int y = 0; y < tile.height; ++y) {
        const float* const from = plane.row(tile.y - tile.outer_y + y) + tile.x - tile.outer_x;
        for (int x = 0; x < tile.width; ++x) denoised_.at(tile.x + x, tile.y + y, layer * color_channels + c) = from[x];
      }
    }
  }

  // As the film sums up its layers.
  void write_sum(const Tile& tile) {
    for (int y = tile.y; y < tile.y + tile.height; ++y)
      for (int x = tile.x; x < tile.x + tile.width; ++x)
        for (std::size_t c = 0; c < color_channels; ++c) {
          double sum = 0;
          for (std::size_t l = 0; l < layers_.size(); ++l)
            if (!is_repeated(layers_[l])) sum += static_cast<double>(denoised_.at(x, y, (1 + l) * color_channels + c));
          denoised_.at(x, y, c) = static_cast<float>(sum);
        }
  }

  void write_error(const Tile& tile, const Halves& light, const Halves& result, const Plane& scale) {
    constexpr int radius = 4;
    Plane error = squared_error(light, result, shares_, scale);
    error.fill([&](std::size_t i) { return sqr(optimism) * error[i]; });
    Plane bias(scale.width(), scale.height());
    if (has_layer(picture_, "bias", components))
      for (const char* const c : components) {
        const Plane own = read(tile, std::string("bias.") + c);
        bias.fill([&](std::size_t i) { return bias[i] + sqr(own[i]) / (color_channels * scale[i]); });
      }
    add_to_estimate(tile, error, bias, result, scale);
    error.fill([&](std::size_t i) { return error[i] + bias[i]; });
    const Plane smooth = box_filtered(box_filtered(error, radius), radius);
    write(tile, 1 + layers_.size(), [&](std::size_t) {
      return Plane::of(scale.width(), scale.height(),
                       [&](std::size_t i) { return std::sqrt(std::max(0.0f, smooth[i]) * scale[i]); });
    });
  }

  // Means over blocks of pixels, as independent values.
  void add_to_estimate(const Tile& tile, const Plane& error, const Plane& bias, const Halves& result,
                       const Plane& scale) {
    constexpr int block = 16;
    for (int by = tile.y; by < tile.y + tile.height; by += block)
      for (int bx = tile.x; bx < tile.x + tile.width; bx += block) {
        Block sum;
        for (int y = by; y < std::min(by + block, tile.y + tile.height); ++y)
          for (int x = bx; x < std::min(bx + block, tile.x + tile.width); ++x) {
            const auto i = static_cast<std::size_t>(y - tile.outer_y) * static_cast<std::size_t>(scale.width()) +
                           static_cast<std::size_t>(x - tile.outer_x);
            sum.error += static_cast<double>(error[i] + bias[i]);
            for (std::size_t c = 0; c < color_channels; ++c)
              sum.noise += static_cast<double>(shares_[0] * shares_[1] * sqr(result[0][c][i] - result[1][c][i]) /
                                               (color_channels * scale[i]));
          }
        blocks_.push_back(sum);
      }
  }

  void estimate() {
    constexpr double fewest_passes = 2, confidence_z = 1.28;  // 90 % of a normal distribution are below it
    const auto count = static_cast<double>(pixels()), blocks = static_cast<double>(blocks_.size());
    Block sum;
    double squares = 0;
    for (const Block& b : blocks_) {
      sum.error += b.error;
      sum.noise += b.noise;
      squares += b.error * b.error;
    }
    const double error2 = std::max(0.0, sum.error / count), noise2 = std::min(error2, sum.noise / count);
    const double variance = std::max(0.0, squares - sum.error * sum.error / blocks);
    ErrorEstimate& e = error_;
    e.error = std::sqrt(error2);
    e.noise = std::sqrt(noise2);
    e.bias = std::sqrt(error2 - noise2);
    e.bound = std::sqrt(error2 + confidence_z * std::sqrt(variance) / count);
    if (fewest_passes_ < fewest_passes) e.doubt = "there are too few passes";
  }

  // The estimate is too small, because the least of several is taken and the second guide knows both halves. True
  // errors are mostly 1.1 to 1.5 times as large (48 renders of 4 to 64 passes).
  static constexpr float optimism = 1.3f;

  struct Block {
    double error = 0, noise = 0;
  };

  const Image& picture_;
  std::vector<std::string> layers_;
  Shares shares_{};
  double fewest_passes_ = 0;  // of a half
  float mean_ = 0;
  Image denoised_;
  ErrorEstimate error_;
  std::vector<Block> blocks_;
};

}  // namespace

bool can_denoise(const Image& picture) {
  for (const FeatureLayer& layer : feature_layers)
    if (!has_layer_with_noise(picture, layer.name, layer.components)) return false;
  return picture.find_channel(share_channel) && picture.find_channel("samples") && select_layer(picture, "color") &&
         !light_layers(picture).empty();
}

DenoisedPicture denoise(const Image& picture) {
  if (!can_denoise(picture))
    throw Error(
        "the picture has no layers `noise`, by which its noise is known; .exr files that lanthorn renders have them");
  return Denoiser(picture).run();
}

Image with_denoised_light(const Image& picture) {
  std::vector<ChannelChoice> choices;
  for (std::size_t c = 0; c < picture.channel_count(); ++c) {
    const std::string& name = picture.channels[c];
    if (!is_noise_channel(name) && !name.starts_with(denoised_prefix))
      choices.push_back({name, picture.find_channel(denoised_prefix + name).value_or(c)});
  }
  return chosen(picture, choices);
}

}  // namespace lanthorn
