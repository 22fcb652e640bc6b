// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/denoise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "denoise/layer.h"
#include "denoise/noisy_picture.h"
#include "film/error_estimate.h"
#include "lanthorn/error.h"

namespace lanthorn {

using namespace denoising;

namespace {

const std::string denoised_prefix = "denoised.";

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

void add(const Halves& part, Halves& sum) {
  for (std::size_t h = 0; h < 2; ++h)
    for (std::size_t c = 0; c < color_channels; ++c)
      sum[h][c].fill([&](std::size_t i) { return sum[h][c][i] + part[h][c][i]; });
}
Halves black(const Tile& tile) {
  Halves halves;
  for (ColorPlanes& half : halves) half.fill(Plane(tile.outer_width, tile.outer_height));
  return halves;
}

// Light cannot be negative.
Halves at_least_0(Halves light) {
  for (ColorPlanes& half : light)
    for (Plane& plane : half) plane.fill([&](std::size_t i) { return std::max(0.0f, plane[i]); });
  return light;
}

// Function that adds the features of a layer's halves.
using AddFeatures = void(const Halves&, const Shares&, std::array<FeaturePlanes, 2>&);

// Surroundings at full, half and quarter resolution.
std::vector<Surroundings> surroundings_of(const NoisyPicture& picture, const Tile& tile, AddFeatures& add_features) {
  constexpr std::size_t level_count = 3;
  std::vector<Surroundings> levels{{.features = {}, .demodulation = {}, .scale = picture.scale_of(tile)}};
  for (const FeatureLayer& layer : feature_layers)
    add_features(picture.read_halves(tile, layer.name, layer.components), picture.shares(), levels[0].features);
  levels[0].demodulation = picture.demodulation_of(levels[0].features);
  while (levels.size() < level_count) levels.push_back(halved(levels.back()));
  return levels;
}

// Writes the tile's pixels to a channel of the picture of this part.
void write(const Plane& plane, const Tile& tile, const Part& part, std::size_t channel, Image& to) {
  for (int y = 0; y < tile.height; ++y) {
    const float* const from = plane.row(tile.y - tile.outer_y + y) + tile.x - tile.outer_x;
    for (int x = 0; x < tile.width; ++x) to.at(tile.x - part.x + x, tile.y - part.y + y, channel) = from[x];
  }
}

// Where the picture is in `around`.
Part part_of(const Image& picture, const Image& around) {
  const Part part{picture.window.x - around.window.x, picture.window.y - around.window.y, picture.width,
                  picture.height};
  if (part.x < 0 || part.y < 0 || part.x + part.width > around.width || part.y + part.height > around.height)
    throw Error("the picture is no part of the picture around it: their data windows do not fit");
  return part;
}

// Relative squared errors above 1 count as 1. Single pixels are too noisy to tell which are, so the mean over 3 x 3
// pixels decides.
Plane at_most_1(Plane error) {
  constexpr int radius = 1;
  const Plane around = box_filtered(error, radius);
  error.fill([&](std::size_t i) { return error[i] / std::max(1.0f, around[i]); });
  return error;
}

class Denoiser {
 public:
  Denoiser(const Image& picture, const Image& around)
      : picture_(picture), part_(part_of(picture, around)), noisy_(around), layers_(light_layers(around)) {
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
    for (const Tile& tile : tiles_of(part_, noisy_.image().width, noisy_.image().height)) denoise_tile(tile);
    estimate();
    return {with_layers(without_denoised(picture_), denoised_), error_};
  }

 private:
  void denoise_tile(const Tile& tile) {
    const std::vector<Surroundings> levels = surroundings_of(noisy_, tile, add_features);
    Halves light = black(tile), result = light;  // sums over layers
    Plane optimism = light[0][0];
    for (std::size_t l = 0; l < layers_.size(); ++l) {
      const Halves noisy = noisy_.read_halves(tile, layers_[l], components);
      DenoisedLayer denoised = denoise_layer(noisy, noisy_.shares(), levels);
      const Halves smooth = at_least_0(std::move(denoised.light));
      for (std::size_t c = 0; c < color_channels; ++c)
        write(mean_of(smooth, c, noisy_.shares()), tile, part_, (1 + l) * color_channels + c, denoised_);
      if (is_repeated(layers_[l])) continue;
      add(noisy, light);
      add(smooth, result);
      optimism.fill([&](std::size_t i) { return optimism[i] + denoised.optimism[i]; });
    }
    write_sum(tile);
    const ErrorScale scale = sharpened(levels[0].scale, result);
    optimism.fill([&](std::size_t i) { return optimism[i] * levels[0].scale.light2[i] / scale.light2[i]; });
    write_error(tile, light, result, optimism, scale);
  }

  // Sums up the layers as the film does.
  void write_sum(const Tile& tile) {
    const int left = tile.x - part_.x, top = tile.y - part_.y;
    for (int y = top; y < top + tile.height; ++y)
      for (int x = left; x < left + tile.width; ++x)
        for (std::size_t c = 0; c < color_channels; ++c) {
          double sum = 0;
          for (std::size_t l = 0; l < layers_.size(); ++l)
            if (!is_repeated(layers_[l])) sum += static_cast<double>(denoised_.at(x, y, (1 + l) * color_channels + c));
          denoised_.at(x, y, c) = static_cast<float>(sum);
        }
  }

  // `scale` is a mean over a window, which blurs bright lines, so errors beside them would look small. Hence it is
  // multiplied by the pixel's denoised light squared, divided by the square of the mean in the same window.
  ErrorScale sharpened(const ErrorScale& scale, const Halves& result) const {
    constexpr int radius = NoisyPicture::scale_radius;
    const Plane& all = scale.light2;
    const float least = noisy_.least_scale();
    Plane light(all.width(), all.height());
    for (std::size_t c = 0; c < color_channels; ++c) {
      const Plane mean = mean_of(result, c, noisy_.shares());
      light.fill([&](std::size_t i) { return light[i] + std::min(mean[i], scale.white) / color_channels; });
    }
    const Plane around = box_filtered(light, radius);
    return {Plane::of(all.width(), all.height(),
                      [&](std::size_t i) { return all[i] * (sqr(light[i]) + least) / (sqr(around[i]) + least); }),
            scale.white};
  }

  void write_error(const Tile& tile, const Halves& light, const Halves& result, const Plane& optimism,
                   const ErrorScale& of_errors) {
    constexpr int radius = 4;
    const Plane& scale = of_errors.light2;
    Plane error = squared_error(light, result, noisy_.shares(), of_errors);
    error.fill([&](std::size_t i) { return error[i] + optimism[i]; });
    error = at_most_1(std::move(error));
    const Plane bias = squared_bias(tile, scale);
    add_to_estimate(tile, error, bias, result, of_errors);
    error.fill([&](std::size_t i) { return error[i] + bias[i]; });
    const Plane smooth = box_filtered(box_filtered(error, radius), radius);
    const Plane standard_error = Plane::of(
        scale.width(), scale.height(), [&](std::size_t i) { return std::sqrt(std::max(0.0f, smooth[i]) * scale[i]); });
    for (std::size_t c = 0; c < color_channels; ++c)
      write(standard_error, tile, part_, (1 + layers_.size()) * color_channels + c, denoised_);
  }

  // The noise of the halves' biases is independent: their product estimates the square of the bias, and can be
  // negative. Divided by `scale`, a mean over channels.
  Plane squared_bias(const Tile& tile, const Plane& scale) const {
    Plane sum(scale.width(), scale.height());
    if (!has_layer(noisy_.image(), "bias", components)) return sum;
    const bool knows_noise = has_layer(noisy_.image(), "noise.bias", components);
    const Halves bias = knows_noise ? noisy_.read_halves(tile, "bias", components) : Halves{};
    for (std::size_t c = 0; c < color_channels; ++c) {
      const Plane all = noisy_.read(tile, std::string("bias.") + components[c]);
      sum.fill([&](std::size_t i) {
        const float square = knows_noise ? bias[0][c][i] * bias[1][c][i] : sqr(all[i]);
        return sum[i] + std::clamp(square / scale[i], -1.0f, 1.0f) / color_channels;
      });
    }
    return sum;
  }

  // Means over blocks of pixels, which are treated as independent values.
  void add_to_estimate(const Tile& tile, const Plane& error, const Plane& bias, const Halves& result,
                       const ErrorScale& of_errors) {
    constexpr int block = 16;
    const Plane& scale = of_errors.light2;
    const auto seen = [&](float light) { return std::min(light, of_errors.white); };
    for (int by = tile.y; by < tile.y + tile.height; by += block)
      for (int bx = tile.x; bx < tile.x + tile.width; bx += block) {
        Block sum;
        for (int y = by; y < std::min(by + block, tile.y + tile.height); ++y)
          for (int x = bx; x < std::min(bx + block, tile.x + tile.width); ++x) {
            const auto i = static_cast<std::size_t>(y - tile.outer_y) * static_cast<std::size_t>(scale.width()) +
                           static_cast<std::size_t>(x - tile.outer_x);
            sum.error += static_cast<double>(error[i] + bias[i]);
            for (std::size_t c = 0; c < color_channels; ++c)
              sum.noise +=
                  static_cast<double>(noisy_.shares()[0] * noisy_.shares()[1] *
                                      sqr(seen(result[0][c][i]) - seen(result[1][c][i])) / (color_channels * scale[i]));
          }
        blocks_.push_back(sum);
      }
  }

  void estimate() {
    constexpr double fewest_passes = 2, confidence_z = 1.28;  // 90th percentile of the normal distribution
    const auto count = static_cast<double>(part_.width) * part_.height, blocks = static_cast<double>(blocks_.size());
    Block sum;
    double squares = 0;
    for (const Block& b : blocks_) {
      sum.error += b.error;
      sum.noise += b.noise;
      squares += b.error * b.error;
    }
    // The estimate is noisy itself, but the error cannot be less than the noise.
    const double noise2 = sum.noise / count, error2 = std::max(noise2, sum.error / count);
    const double variance = std::max(0.0, squares - sum.error * sum.error / blocks);
    ErrorEstimate& e = error_;
    if (std::all_of(denoised_.pixels.begin(), denoised_.pixels.end(), [](float x) { return x == 0; })) {
      e = error_of_black_picture();
      return;
    }
    e.error = std::sqrt(error2);
    e.noise = std::sqrt(noise2);
    e.bias = std::sqrt(error2 - noise2);
    e.bound = std::sqrt(error2 + confidence_z * std::sqrt(variance) / count);
    if (noisy_.fewest_passes() < fewest_passes) e.doubt = "there are too few passes";
  }

  struct Block {
    double error = 0, noise = 0;
  };

  const Image& picture_;
  Part part_;  // of the noisy picture
  NoisyPicture noisy_;
  std::vector<std::string> layers_;
  Image denoised_;
  ErrorEstimate error_;
  std::vector<Block> blocks_;
};

void require_halves(const Image& picture) {
  if (!can_denoise(picture))
    throw Error(
        "the picture has no layers `noise`, which describe its noise; .exr files that lanthorn renders have them");
}

}  // namespace

bool can_denoise(const Image& picture) { return has_halves(picture); }

DenoisedPicture denoise(const Image& picture, const std::optional<Image>& around) {
  const Image& all = around ? *around : picture;
  require_halves(all);
  return Denoiser(picture, all).run();
}

Image preview_without_noise(const Image& picture) {
  require_halves(picture);
  const NoisyPicture noisy(picture);
  Image preview(picture.width, picture.height, {components.begin(), components.end()});
  preview.window = picture.window;
  const Part whole{0, 0, picture.width, picture.height};
  for (const Tile& tile : tiles_of(whole, picture.width, picture.height)) {
    Halves light = black(tile);
    for (const std::string& layer : light_layers(picture))
      if (!is_repeated(layer)) add(noisy.read_halves(tile, layer, components), light);
    const std::vector<Surroundings> levels = surroundings_of(noisy, tile, add_noisy_features);
    const Halves smooth = at_least_0(preview_layer(light, noisy.shares(), levels));
    for (std::size_t c = 0; c < color_channels; ++c) write(mean_of(smooth, c, noisy.shares()), tile, whole, c, preview);
  }
  return preview;
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
