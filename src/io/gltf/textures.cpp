// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/materials.h"

#include <cmath>
#include <string>
#include <utility>

#include "io/missing_files.h"
#include "lanthorn/text.h"

namespace lanthorn::gltf {

namespace {

using namespace description;

Wrap wrap_mode(const Value& sampler, std::string_view key) {
  const std::uint64_t mode = sampler.integer(key, 10497);
  switch (mode) {
    case 33071:
      return Wrap::clamp;
    case 33648:
      return Wrap::mirror;
    case 10497:
      return Wrap::repeat;
    default:
      sampler.at(key).warn(key, "there is no wrapping mode " + std::to_string(mode) + ": the texture repeats");
      return Wrap::repeat;
  }
}

void read_sampler(const Document& document, const Value& texture, ImageTexture& image) {
  const auto reference = texture.find("sampler");
  if (!reference) return;
  const Value sampler = document.follow("samplers", *reference);
  image.wrap = wrap_mode(sampler, "wrapS");
  if (const Wrap along_t = wrap_mode(sampler, "wrapT"); along_t != image.wrap) image.wrap_t = along_t;
  constexpr std::uint64_t nearest = 9728;
  if (sampler.integer("magFilter", 0) == nearest) image.filter = ImageFilter::point;
}

// Some files refer to KTX2 images without declaring the extension.
bool is_ktx2(const Value& image) {
  const auto uri = image.find("uri");
  return image.text("mimeType", "") == "image/ktx2" || (uri && uri->text().ends_with(".ktx2"));
}

// The image of a texture: "source", or the image of an extension for another format. nullopt, with a warning, if it is
// unsupported.
std::optional<Value> find_image(Document& document, const Value& texture) {
  const auto image_of = [&](const std::optional<Value>& owner) -> std::optional<Value> {
    const auto source = owner ? owner->find("source") : std::nullopt;
    if (!source) return {};
    return document.follow("images", *source);
  };
  if (auto webp = image_of(texture.extension("EXT_texture_webp"))) return webp;
  auto plain = image_of(texture);
  if (plain && !is_ktx2(*plain)) return plain;
  const std::optional<Value> basis = plain ? plain : image_of(texture.extension("KHR_texture_basisu"));
  if (!basis) {
    document.warn("texture source", texture,
                  "the texture has no image in PNG, JPEG or WebP format: a neutral value replaces it");
    return {};
  }
  const auto uri = basis->find("uri");
  const bool is_file = uri && !uri->text().starts_with("data:");
  document.warn("KHR_texture_basisu", texture,
                "KHR_texture_basisu: KTX2 images such as " +
                    (is_file ? file_in_quotes(uri->text()) : basis->location().file) +
                    " are not supported: neutral values replace textures without another image. Convert the file with "
                    "\"gltf-transform ktxdecompress IN OUT\" (of npm's @gltf-transform/cli and Khronos' KTX-Software)");
  return {};
}

// Returns false if the image's file is missing and skipped.
bool read_image(Document& document, const Value& image, ImageTexture& texture) {
  const auto uri = image.find("uri");
  if (!uri || uri->text().starts_with("data:"))
    return document.reads([&] { texture.embedded = document.embedded_image(image); });
  texture.filename = document.add_file(*uri).string();
  return !document.leaves_out(texture.filename);
}

// (u', v') = T R S (u, v) in glTF's coordinates, whose v points down the image, converted from and to t = 1 - v. A
// positive angle rotates the coordinates counter-clockwise in the image.
UvMapping mapping(const Value* transform) {
  if (transform == nullptr) return {};
  const auto pair = [&](std::string_view key, float otherwise) {
    const std::vector<float> v = transform->numbers(key, {otherwise, otherwise});
    return Vec2(v[0], v[1]);
  };
  const Vec2 offset = pair("offset", 0), scale = pair("scale", 1);
  const float angle = transform->number("rotation", 0);
  const float c = std::cos(angle), s = std::sin(angle);
  // u' = c sx u + s sy v + ox, v' = -s sx u + c sy v + oy, with v = 1 - t and t' = 1 - v'.
  return {Mat2(c * scale.x, s * scale.x, -s * scale.y, c * scale.y),
          {s * scale.y + offset.x, 1 - c * scale.y - offset.y}};
}

}  // namespace

std::optional<TextureUse> find_texture(Document& document, const Value& owner, std::string_view key) {
  const auto info = owner.find(key);
  if (!info) return {};
  const Value texture = document.follow("textures", info->at("index"));
  const auto source = find_image(document, texture);
  ImageTexture image;
  if (!source || !read_image(document, *source, image)) return TextureUse{};
  read_sampler(document, texture, image);
  const auto transform = info->extension("KHR_texture_transform");
  image.mapping = mapping(transform ? &*transform : nullptr);
  constexpr std::uint64_t most_sets = 1024;
  TextureUse use{std::move(image)};
  use.uv_set = static_cast<std::size_t>(info->find("texCoord") ? info->at("texCoord").integer(most_sets) : 0);
  if (transform && transform->find("texCoord"))
    use.uv_set = static_cast<std::size_t>(transform->at("texCoord").integer(most_sets));
  return use;
}

}  // namespace lanthorn::gltf
