// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A scene that differs from another one in some materials, lights and placements, and shares the rest with it.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/scene.h"
#include "scene/area_lights.h"
#include "scene/medium_around.h"
#include "scene/scene_data.h"
#include "scene/volume_lights.h"

namespace lanthorn {

namespace {

template <class Value>
void replace(std::vector<Value>& values, const std::map<description::Index, Value>& by, const char* kind) {
  for (const auto& [index, value] : by) {
    if (index >= values.size())
      throw Error("the scene has no " + std::string(kind) + " with index " + std::to_string(index));
    values[index] = value;
  }
}

bool is_environment(const description::Light& light) {
  return std::holds_alternative<description::InfiniteLight>(light.node);
}

// A number that no other edit has, so that states of different edited scenes are never mixed up.
std::uint64_t unique_hash() {
  std::random_device random;
  return (std::uint64_t{random()} << 32) | random();
}

SceneDescription edited(const SceneDescription& description, const SceneEdits& edits) {
  SceneDescription result = description;
  replace(result.materials, edits.materials, "material");
  replace(result.area_lights, edits.area_lights, "area light");
  if (edits.environment) replace_environment(result, *edits.environment);
  replace(result.lights, edits.lights, "light");
  for (const auto& [index, object_to_world] : edits.instances) {
    if (index >= result.instances.size()) throw Error("the scene has no instance with index " + std::to_string(index));
    result.instances[index].object_to_world = object_to_world;
  }
  result.hash = edits.hash ? *edits.hash : unique_hash();
  return result;
}

class SceneEditor {
 public:
  SceneEditor(std::shared_ptr<const SceneData> base, const SceneEdits& edits)
      : base_(std::move(base)),
        edits_(edits),
        data_(std::make_shared<SceneData>(edited(base_->description, edits), base_.get(), base_->geometry)) {}

  std::shared_ptr<const SceneData> edit() {
    const auto started = std::chrono::steady_clock::now();
    keep();
    data_->media = base_->media;
    data_->is_under_surface = base_->is_under_surface;
    data_->most_under_surface = base_->most_under_surface;
    data_->has_interfaces = base_->has_interfaces;
    data_->has_hidden_shapes = base_->has_hidden_shapes;
    data_->has_emissive = base_->has_emissive;
    data_->has_unlit_emission = base_->has_unlit_emission;
    data_->endless_media = base_->endless_media;
    update_records();
    place();
    data_->sphere = bounding_sphere(data_->geometry.bounds());
    update_lights();
    data_->statistics = base_->statistics;
    data_->statistics.texture_bytes = data_->textures.bytes();
    data_->statistics.texture_disk_bytes = data_->textures.disk_bytes();
    data_->statistics.bvh_bytes = data_->geometry.bvh_bytes();
    data_->statistics.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return data_;
  }

 private:
  // Shapes belong to the scene that was built. Lights that were edited point to spectra, images and textures of the
  // scene in which that happened.
  void keep() {
    data_->kept = base_->kept;
    if (!base_->is_edited || base_->has_edited_lights) data_->kept.push_back(base_);
    data_->is_edited = true;
    data_->emitters = base_->emitters;
    data_->light_media = base_->light_media;
    data_->volume_lights = base_->volume_lights;
    data_->light_locations = base_->light_locations;
    data_->placed = base_->placed;
    data_->has_edited_lights = edits_.environment || !edits_.lights.empty() || !edits_.area_lights.empty();
  }

  // Records of surfaces hold some traits of their materials.
  void update_records() {
    data_->geometry.update_records([&](GeometryRecord& record) {
      const MaterialTraits& now = data_->materials.traits(record.material);
      const MaterialTraits& before = base_->materials.traits(record.material);
      if (now.is_interface != before.is_interface || now.interior != before.interior || now.is_hair != before.is_hair)
        throw Error(data_->description.materials[record.material].location,
                    "this edit would change where surfaces and media are (an interface, a medium inside, or hair): "
                    "build the scene again");
      record.wants_tangents = now.is_anisotropic || now.has_relief || is_flat(record);
      record.wants_footprint = now.has_levels;
      record.wants_uv = record.wants_uv || now.varies || now.has_relief;
      data_->has_measured_spectra = data_->has_measured_spectra || now.has_tables || now.is_dispersive;
      data_->has_dispersion = data_->has_dispersion || now.is_dispersive;
    });
  }

  void place() {
    if (edits_.instances.empty()) return;
    std::vector<PlacedGroup> placed;
    std::map<description::Index, bool> found;
    for (PlacedInstance& p : data_->placed) {
      const auto edit = p.instance ? edits_.instances.find(*p.instance) : edits_.instances.end();
      if (edit != edits_.instances.end()) {
        if (p.emits) throw Error(p.location, "the instance emits light: build the scene again to move it");
        if (!can_be_placed(edit->second, p.placed.inner))
          throw Error(p.location, "the instance's new transformation is singular in single precision");
        p.placed.outer = edit->second;
        found[*p.instance] = true;
      }
      placed.push_back(p.placed);
    }
    for (const auto& [index, unused] : edits_.instances)
      if (!found[index])
        throw Error(data_->description.instances[index].location,
                    "the instance has no visible shapes, or was left out: build the scene again to move it");
    data_->geometry.place_again(placed);
  }

  void update_lights() {
    data_->lights = base_->lights;
    if (edits_.environment) exchange_environments();
    for (const EmittingShape& emitter : data_->emitters)
      if (edits_.area_lights.contains(*emitter.source->area_light)) update(emitter);
    const std::size_t first = data_->first_described_light();
    const bool same_size = data_->sphere.centre == base_->sphere.centre && data_->sphere.radius == base_->sphere.radius;
    std::vector<description::Index> unsettled;  // lights around which there may be another medium
    for (std::size_t i = 0; i < data_->description.lights.size(); ++i) {
      Light& light = data_->lights[first + i];
      const auto index = static_cast<description::Index>(i);
      const bool is_edited = edits_.lights.contains(index);
      if (is_edited || (!same_size && !set_scene_bounds(light, data_->sphere))) update(light, i);
      if (is_edited || !edits_.instances.empty()) unsettled.push_back(index);
    }
    // Moved instances may bound media.
    const bool may_move_media = !data_->media->empty() && !edits_.instances.empty();
    if (may_move_media) make_volume_lights(*data_, shutter_middle(data_->description));
    if (data_->has_edited_lights || !same_size || may_move_media)
      index_lights(*data_);
    else
      reuse_index();
    settle_light_media(data_, unsettled);
  }
  // All lights but environments keep their order.
  void exchange_environments() {
    const std::size_t first = base_->first_described_light();
    data_->lights.erase(data_->lights.begin() + static_cast<std::ptrdiff_t>(first), data_->lights.end());
    data_->light_media.resize(first);
    data_->light_locations.erase(data_->light_locations.lower_bound(static_cast<std::uint32_t>(first)),
                                 data_->light_locations.end());
    const auto add = [&](const Light& light, const MediumInterface& media, const SourceLocation& location) {
      const auto index = static_cast<std::uint32_t>(data_->lights.size());
      data_->lights.push_back(light);
      data_->light_media.push_back(media);
      data_->light_locations[index] = location;
      return index;
    };
    std::size_t old = first;  // the next light of the old scene
    for (const description::Light& light : data_->description.lights) {
      if (is_environment(light)) {
        add(made(light), {}, light.location);
        continue;
      }
      while (is_environment(base_->description.lights[old - first])) ++old;
      add(base_->lights[old], base_->light_media[old], light.location);
      ++old;
    }
    for (auto& [medium, index] : data_->volume_lights)
      index = add(base_->lights[index], base_->light_media[index], base_->light_location(index));
  }
  void update(const EmittingShape& emitter) {
    const description::AreaLight& light = data_->description.area_lights[*emitter.source->area_light];
    const SpectrumInput radiance =
        data_->textures.compile(light.radiance, description::SpectrumRole::illuminant, light.location);
    data_->textures.load_images();
    const std::vector<Light> lights = make_area_lights(emitter, light, radiance, *data_->light_store);
    for (std::size_t i = 0; i < lights.size(); ++i) {
      check_power(lights[i], light.location);
      data_->lights[emitter.first_light + i] = lights[i];
    }
  }
  void update(Light& light, std::size_t described) { light = made(data_->description.lights[described]); }
  Light made(const description::Light& source) {
    std::optional<Light> light = make_from(*base_, source, data_->sphere);
    if (!light)
      light = make_light(source, data_->description.access, data_->sphere, *data_->spectra,
                         data_->description.color_space, *data_->light_store, data_->description.warnings);
    check_power(*light, source.location);
    return *light;
  }
  void reuse_index() {
    data_->infinite_lights = base_->infinite_lights;
    data_->largest_radiance = edits_.instances.empty() ? base_->largest_radiance : find_largest_radiance(*data_);
    data_->light_bvh = base_->light_bvh;
    data_->ray_lights = base_->ray_lights;
  }

  std::shared_ptr<const SceneData> base_;
  const SceneEdits& edits_;
  std::shared_ptr<SceneData> data_;
};

}  // namespace

namespace {

// The one value that scales a light: its power or illuminance if given, otherwise the scale of its emission.
template <class L>
float& magnitude_of(L& light) {
  if constexpr (requires { light.power; })
    if (light.power) return *light.power;
  if constexpr (requires { light.illuminance; })
    if (light.illuminance) return *light.illuminance;
  if constexpr (requires { light.intensity; })
    return light.intensity.scale;
  else if constexpr (requires { light.radiance.scale; })
    return light.radiance.scale;
  else
    return light.scale;
}

}  // namespace

void scale_light(description::Light& light, float factor) {
  std::visit([factor](auto& l) { magnitude_of(l) *= factor; }, light.node);
}
void scale_light(description::AreaLight& light, float factor) { magnitude_of(light) *= factor; }

std::string name_of_light(description::Index index) { return "light" + std::to_string(index + 1); }
std::string name_of_area_light(description::Index index) { return "area" + std::to_string(index + 1); }

SharedScene edit_scene(const Scene& scene, const SceneEdits& edits) {
  return std::make_shared<const Scene>(SceneEditor(scene.data(), edits).edit());
}

}  // namespace lanthorn
