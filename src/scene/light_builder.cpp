// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Makes the lights of a scene from its description, emitting shapes and media.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "base/parallel.h"
#include "lanthorn/error.h"
#include "math/hash.h"
#include "scene/medium_around.h"
#include "scene/scene_data.h"
#include "scene/volume_lights.h"

namespace lanthorn {

namespace {

// The least distance at which `count` rays from a light without extent meet something. The scene's radius is no measure
// for it: a lamp may hang above a table in a landscape. Distances below 2^-16 of the radius are raised to that, so that
// a lamp that touches its holder does not push the rest, 2^32 times darker, below the film's resolution.
float distance_lit(const SceneData& data, const Light& light, HashRng rng, std::size_t count) {
  float nearest = data.sphere.radius;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 u_position = rng.next2(), u_direction = rng.next2();
    const std::optional<EmissionSample> s = sample_emission(light, u_position, u_direction, Wavelengths::rgb(0.5f));
    if (!s) continue;
    if (const auto hit = data.geometry->intersect({s->origin, s->direction, nearest})) nearest = hit->t;
  }
  return std::max(nearest, 0x1p-16f * data.sphere.radius);
}

// Largest radiance of any light, in any channel. For lights without extent, the radiance of a white surface at the
// nearest place that they illuminate. Throws Error as `check_radiance` does.
float find_largest_radiance(const SceneData& data) {
  const std::vector<Light>& lights = data.lights->all;
  constexpr std::size_t chunk = 4096, most_rays = std::size_t{1} << 18;
  const std::size_t rays =
      std::clamp<std::size_t>(most_rays / std::max<std::size_t>(1, lights.size()), 1, 64);  // of a light
  struct Brightest {
    float radiance = 0;
    std::uint32_t light = 0;
  };
  std::vector<Brightest> of_chunks((lights.size() + chunk - 1) / chunk);
  parallel_chunks(lights.size(), chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float distance = is_point(lights[i]) ? distance_lit(data, lights[i], HashRng(i), rays) : 0;
      const float radiance = largest_radiance(lights[i], distance);
      if (radiance > of_chunks[c].radiance) of_chunks[c] = {radiance, static_cast<std::uint32_t>(i)};
    }
  });
  Brightest brightest;
  for (const Brightest& b : of_chunks)
    if (b.radiance > brightest.radiance) brightest = b;
  if (brightest.radiance > 0) check_radiance(brightest.radiance, data.light_location(brightest.light));
  return brightest.radiance;
}

class LightBuilder {
 public:
  LightBuilder(const std::shared_ptr<SceneData>& data, MaterialPart* materials, const SceneData* previous)
      : shared_(data),
        data_(*data),
        scene_(data->description),
        materials_(materials),
        previous_(previous != nullptr && previous->description.color_space == scene_.color_space ? previous : nullptr),
        has_same_shapes_(previous_ != nullptr && previous_->shapes == data_.shapes),
        is_same_size_(previous_ != nullptr && previous_->sphere.centre == data_.sphere.centre &&
                      previous_->sphere.radius == data_.sphere.radius) {
    store_->materials = data_.materials;
    data_.lights = lights_;
  }
  void build() {
    add_emitters();
    add_described();
    add_lights_of_media();
    index();
    for (const auto& store : lights_->stores)
      for (const description::Warning& w : store->warnings) warn_once(lights_->warnings, w.location, w.message);
    settle_light_media(Scene(shared_), *lights_);
  }

 private:
  struct Made {
    Light light;
    std::shared_ptr<const LightStore> store;
  };

  void add_emitters() {
    const bool has_same_textures =
        has_same_shapes_ && is_same(scene_.spectrum_textures, previous_->description.spectrum_textures);
    std::map<description::Index, SpectrumInput> radiances;  // of area lights that are new or have changed
    for (const EmittingShape& emitter : data_.shapes->emitters) {
      const description::Index i = *emitter.source->area_light;
      const description::AreaLight& light = scene_.area_lights.at(i);
      if (radiances.contains(i) || (has_same_textures && light == previous_->description.area_lights.at(i))) continue;
      radiances[i] =
          materials_->textures.compile(light.radiance, description::SpectrumRole::illuminant, light.location);
    }
    if (!radiances.empty()) materials_->textures.load_images();
    for (const EmittingShape& emitter : data_.shapes->emitters) {
      const auto found = radiances.find(*emitter.source->area_light);
      add(emitter, found != radiances.end() ? &found->second : nullptr);
    }
  }
  // `radiance`: null if the lights are those of the previous scene.
  void add(const EmittingShape& emitter, const SpectrumInput* radiance) {
    const std::size_t first = emitter.first_light, count = light_count(*emitter.shape);
    lights_->locations[emitter.first_light] = emitter.source->location;
    lights_->media.insert(lights_->media.end(), count, emitter.shape->record.media);
    if (radiance == nullptr) {
      const auto before = previous_->lights->all.begin() + static_cast<std::ptrdiff_t>(first);
      lights_->all.insert(lights_->all.end(), before, before + static_cast<std::ptrdiff_t>(count));
      lights_->stores.push_back(previous_->lights->stores[lights_->stores.size()]);
      return;
    }
    const description::AreaLight& light = scene_.area_lights.at(*emitter.source->area_light);
    for (Light& made : make_area_lights(emitter, light, materials_->textures, *radiance, *store_)) {
      check_power(made, emitter.source->location);
      lights_->all.push_back(std::move(made));
    }
    lights_->stores.push_back(store_);
    has_changed_ = true;
  }

  void add_described() {
    has_changed_ = has_changed_ || scene_.lights.size() != previous_->description.lights.size();
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
      Made made = described(i);
      check_power(made.light, scene_.lights[i].location);
      lights_->locations[static_cast<std::uint32_t>(lights_->all.size())] = scene_.lights[i].location;
      lights_->all.push_back(std::move(made.light));
      lights_->stores.push_back(std::move(made.store));
    }
    lights_->media.resize(lights_->all.size());
  }
  Made described(std::size_t index) {
    const description::Light& light = scene_.lights[index];
    if (const std::optional<std::size_t> same = same_before(index)) {
      Made made = before(*same);
      has_changed_ = has_changed_ || *same != index || !is_same_size_;
      if (is_same_size_ || set_scene_bounds(made.light, data_.sphere)) return made;
    }
    has_changed_ = true;
    if (std::optional<Made> made = from_image_before(light)) return *std::move(made);
    return {make_light(light, scene_.access, data_.sphere, scene_.color_space, *store_), store_};
  }
  // The index of the same light in the previous description. Lights may have come or gone before or after it.
  std::optional<std::size_t> same_before(std::size_t index) const {
    if (previous_ == nullptr) return {};
    const auto& now = scene_.lights;
    const auto& then = previous_->description.lights;
    if (is_same(now, then)) return index;
    const std::size_t from_end = then.size() + index - now.size();  // wraps to more than any index
    for (const std::size_t i : {index, from_end})
      if (i < then.size() && then[i] == now[index]) return i;
    return {};
  }
  Made before(std::size_t described) const {
    const LightPart& lights = *previous_->lights;
    return {lights.all[previous_->first_described_light() + described],
            lights.stores[previous_->shapes->emitters.size() + described]};
  }
  // An environment that was only turned or scaled shares its image, which takes long to make.
  std::optional<Made> from_image_before(const description::Light& light) const {
    if (previous_ == nullptr || !std::holds_alternative<description::InfiniteLight>(light.node)) return {};
    const auto& then = previous_->description.lights;
    for (std::size_t i = 0; i < then.size(); ++i) {
      const Made old = before(i);
      if (const auto made = make_from({then[i], old.light}, light, data_.sphere)) return Made{*made, old.store};
    }
    return {};
  }

  void add_lights_of_media() {
    const bool are_same = has_same_shapes_ && previous_->placed == data_.placed && previous_->media == data_.media &&
                          previous_->description.view.camera.medium == scene_.view.camera.medium;
    const auto has_none = [](const SceneData& scene) { return scene.media->all.empty(); };
    has_changed_ = has_changed_ || !(are_same || (has_none(data_) && has_none(*previous_)));
    if (!are_same) return make_volume_lights(data_, *lights_, shutter_middle(scene_));
    const LightPart& then = *previous_->lights;
    lights_->endless_media = then.endless_media;
    lights_->has_unlit_emission = then.has_unlit_emission;
    for (const auto& [medium, light] : then.volume_lights) add_volume_light(data_, *lights_, medium, then.all[light]);
  }

  // Sets what depends on all lights.
  void index() {
    lights_->largest_radiance = find_largest_radiance(data_);
    if (!has_changed_) {
      lights_->infinite = previous_->lights->infinite;
      lights_->bvh = previous_->lights->bvh;
      lights_->ray_lights = previous_->lights->ray_lights;
      return;
    }
    const std::vector<Light>& all = lights_->all;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (is_infinite(all[i])) lights_->infinite.push_back(static_cast<std::uint32_t>(i));
    lights_->bvh = LightBvh(all);
    const std::vector<Medium>& media = data_.media->all;
    if (std::any_of(media.begin(), media.end(), [](const Medium& m) { return scatters(m); }))
      lights_->ray_lights = RayLights(all);
  }

  std::shared_ptr<const SceneData> shared_;
  SceneData& data_;
  const SceneDescription& scene_;
  MaterialPart* materials_;
  const SceneData* previous_;  // null if none of its lights can be shared
  bool has_same_shapes_, is_same_size_;
  bool has_changed_ = !has_same_shapes_;  // some light is new or has another index
  std::shared_ptr<LightPart> lights_ = std::make_shared<LightPart>();
  std::shared_ptr<LightStore> store_ = std::make_shared<LightStore>();
};

}  // namespace

void build_lights(const std::shared_ptr<SceneData>& scene, MaterialPart* materials, const SceneData* previous) {
  LightBuilder(scene, materials, previous).build();
}

}  // namespace lanthorn
