// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Builds a scene from its description, and shares with another scene what has not changed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/plain_data.h"
#include "scene/scene.h"
#include "scene/scene_data.h"
#include "scene/scene_memory.h"

namespace lanthorn {

namespace {

// A number that no other scene has.
std::uint64_t unique_hash() {
  std::random_device random;
  return (std::uint64_t{random()} << 32) | random();
}

// The lights before `replace_environment`.
const description::Table<description::Light>& own_lights(const SceneDescription& scene) {
  return scene.environment.source.empty() ? scene.lights : scene.own_lights;
}

bool have_same_textures(const SceneDescription& a, const SceneDescription& b) {
  return is_same(a.embedded_images, b.embedded_images) && is_same(a.float_textures, b.float_textures) &&
         is_same(a.spectrum_textures, b.spectrum_textures);
}

bool have_same_surfaces(const SceneDescription& a, const SceneDescription& b) {
  return have_same_textures(a, b) && is_same(a.measured_brdfs, b.measured_brdfs) && is_same(a.materials, b.materials) &&
         is_same(a.area_lights, b.area_lights);
}

bool have_same_shapes(const SceneDescription& a, const SceneDescription& b) {
  return is_same(a.shapes, b.shapes) && is_same(a.objects, b.objects) && is_same(a.instances, b.instances);
}

// True if the scene has its own lights, except for the environments that `replace_environment` has replaced.
bool has_own_lamps(const SceneDescription& scene) {
  const auto lamps_of = [](const std::vector<description::Light>& lights) {
    std::vector<description::Light> lamps;
    std::copy_if(lights.begin(), lights.end(), std::back_inserter(lamps), [](const description::Light& light) {
      return !std::holds_alternative<description::InfiniteLight>(light.node);
    });
    return lamps;
  };
  return lamps_of(scene.lights) == lamps_of(own_lights(scene));
}

// A number that tells views apart.
std::uint64_t hash_of(const ViewDescription& view) {
  plain::Reader reader;
  ViewDescription copy;
  plain::read(reader, plain::write(view), copy);
  return reader.hash;
}

// True if the descriptions differ at most in what the identity of a scene's states contains besides its hash: the
// environment.
bool are_same_scene(const SceneDescription& a, const SceneDescription& b) {
  const bool differ_in_environment = !(a.environment == b.environment) && is_same(own_lights(a), own_lights(b)) &&
                                     has_own_lamps(a) && has_own_lamps(b);
  return have_same_surfaces(a, b) && have_same_shapes(a, b) && is_same(a.media, b.media) &&
         (is_same(a.lights, b.lights) || differ_in_environment) && a.color_space == b.color_space &&
         hash_of(a.view) == hash_of(b.view);
}

// True if one description is a copy of the other in which something may have changed. One that was read anew shares
// nothing.
bool is_copy(const SceneDescription& a, const SceneDescription& b) {
  const auto is_shared = [](const auto& x, const auto& y) { return !x.empty() && is_same(x, y); };
  return is_shared(a.shapes, b.shapes) || is_shared(a.objects, b.objects) || is_shared(a.materials, b.materials) ||
         is_shared(a.lights, b.lights) || is_shared(a.instances, b.instances);
}

// Images of the previous scene are found by their place in these tables.
bool have_same_files_inside(const SceneDescription& a, const SceneDescription& b) {
  const auto is_equal = [](const description::EmbeddedImage& x, const description::EmbeddedImage& y) {
    return x.bytes == y.bytes;
  };
  return is_same(a.measured_brdfs, b.measured_brdfs) &&
         (is_same(a.embedded_images, b.embedded_images) ||
          std::ranges::equal(a.embedded_images.entries(), b.embedded_images.entries(), is_equal));
}

BoundingSphere bounding_sphere(const Bounds& box) {
  if (box.empty()) return {};
  return {box.centre(), std::sqrt(distance_squared(box.centre(), box.max))};
}

// Builds one part after the other. `previous` may be null.
class SceneBuilder {
 public:
  SceneBuilder(std::shared_ptr<SceneData> data, const SceneData* previous)
      : data_(std::move(data)),
        now_(data_->description),
        previous_(previous),
        before_(previous != nullptr ? &previous->description : nullptr) {}

  void build() {
    settle_hash();
    std::optional<Error> reason = reason_for_new_shapes();
    if (reason) require_meshes(*reason);
    make_materials(!reason);
    if (!reason && (reason = reason_in_traits())) require_meshes(*reason);
    make_media();
    if (reason)
      build_shapes(*data_, new_materials_);
    else
      share_shapes();
    data_->sphere = bounding_sphere(data_->geometry->bounds());
    note_spectra();
    if (may_share_lights())
      data_->lights = previous_->lights;
    else
      build_lights(data_, new_materials_.get(), previous_);
    data_->materials->textures.require_readable();
    gather_warnings();
    count();
  }

 private:
  // States of an edited scene must not be taken for those of the scene that it comes from.
  void settle_hash() {
    data_->given_hash = now_.hash;
    const bool is_of_previous = previous_ != nullptr && is_copy(now_, *before_) &&
                                (now_.hash == before_->hash || now_.hash == previous_->given_hash);
    if (!is_of_previous) return;
    data_->given_hash = previous_->given_hash;
    data_->description.hash = are_same_scene(now_, *before_) ? before_->hash : unique_hash();
  }

  // Why the shapes cannot be those of the previous scene; nullopt if they can, unless materials are in the way. Notes
  // which instances have moved.
  std::optional<Error> reason_for_new_shapes() {
    const bool has_previous =
        previous_ != nullptr && is_same(now_.shapes, before_->shapes) && is_same(now_.objects, before_->objects) &&
        is_same(now_.float_textures, before_->float_textures) &&
        is_same(now_.embedded_images, before_->embedded_images) &&
        now_.view.camera.shutter_open == before_->view.camera.shutter_open &&
        now_.view.camera.shutter_close == before_->view.camera.shutter_close &&
        now_.materials.size() >= before_->materials.size() && now_.area_lights.size() >= before_->area_lights.size() &&
        now_.media.size() >= before_->media.size() && now_.instances.size() == before_->instances.size();
    if (!has_previous)
      return Error(SourceLocation{now_.filename},
                   "the meshes of this description were moved into the scene that was built from it: read the scene's "
                   "file again");
    if (is_same(now_.instances, before_->instances)) return {};
    moved_.resize(now_.instances.size());
    for (std::size_t i = 0; i < moved_.size(); ++i) {
      const description::Instance &now = now_.instances[i], &then = before_->instances[i];
      if (now.object != then.object)
        return Error(now.location, "the instance is of another object: build the scene again");
      moved_[i] = !(now.object_to_world == then.object_to_world);
    }
    return reason_in_places();
  }
  std::optional<Error> reason_in_places() const {
    std::vector<bool> found(moved_.size());
    for (const PlacedInstance& p : *previous_->placed) {
      if (!has_moved(p)) continue;
      if (p.emits) return Error(p.location, "the instance emits light: build the scene again to move it");
      if (!can_be_placed(now_.instances[*p.instance].object_to_world, p.placed.inner))
        return Error(p.location, "the instance's new transformation is singular in single precision");
      found[*p.instance] = true;
    }
    for (std::size_t i = 0; i < moved_.size(); ++i)
      if (moved_[i] && !found[i])
        return Error(now_.instances[i].location,
                     "the instance has no visible shapes, or was left out: build the scene again to move it");
    return {};
  }
  bool has_moved(const PlacedInstance& p) const { return !moved_.empty() && p.instance && moved_[*p.instance]; }
  // Records of surfaces hold some traits of their materials; an interface between equal media has no record.
  std::optional<Error> reason_in_traits() const {
    if (!new_materials_) return {};
    for (const description::Shape& shape : now_.shapes)
      if (auto reason = reason_in_material(shape.material)) return reason;
    for (const description::Object& object : now_.objects)
      for (const description::Shape& shape : object.shapes)
        if (auto reason = reason_in_material(shape.material)) return reason;
    return {};
  }
  std::optional<Error> reason_in_material(description::Index material) const {
    const MaterialTraits& now = new_materials_->table.traits(material);
    const MaterialTraits& then = previous_->materials->table.traits(material);
    if (now.is_interface == then.is_interface && now.interior == then.interior && now.is_hair == then.is_hair)
      return {};
    return Error(now_.materials[material].location,
                 "this edit would change where surfaces and media are (an interface, a medium inside, or hair): build "
                 "the scene again");
  }
  // `reason`: why they are needed.
  void require_meshes(const Error& reason) {
    if (now_.shapes.is_taken() || now_.objects.is_taken()) throw Error(reason);
    require_scene_memory(data_->description);  // before images are read
  }

  void make_materials(bool may_share) {
    if (may_share && have_same_surfaces(now_, *before_) && now_.color_space == before_->color_space) {
      data_->materials = previous_->materials;
      return;
    }
    const bool shares_images = previous_ != nullptr && have_same_files_inside(now_, *before_);
    new_materials_ = std::make_shared<MaterialPart>(now_, shares_images ? previous_->materials.get() : nullptr);
    data_->materials = new_materials_;
  }

  void share_shapes() {
    data_->description.shapes = before_->shapes;  // without meshes
    data_->description.objects = before_->objects;
    data_->shapes = previous_->shapes;
    data_->placed = previous_->placed;
    data_->geometry = previous_->geometry;
    const bool has_moved_any = std::find(moved_.begin(), moved_.end(), true) != moved_.end();
    if (!new_materials_ && !has_moved_any) return;
    Geometry geometry = *previous_->geometry;
    if (new_materials_)
      geometry.update_records(
          [&](GeometryRecord& record) { note_traits(record, new_materials_->table.traits(record.material)); });
    if (has_moved_any) move_instances(geometry);
    data_->geometry = std::make_shared<const Geometry>(std::move(geometry));
  }
  void move_instances(Geometry& geometry) {
    std::vector<PlacedInstance> placed = *previous_->placed;
    std::vector<PlacedGroup> groups;
    for (PlacedInstance& p : placed) {
      if (has_moved(p)) p.placed.outer = now_.instances[*p.instance].object_to_world;
      groups.push_back(p.placed);
    }
    geometry.place_again(groups);
    data_->placed = std::make_shared<const std::vector<PlacedInstance>>(std::move(placed));
  }

  void make_media() {
    if (previous_ != nullptr && is_same(now_.media, before_->media) && now_.color_space == before_->color_space) {
      data_->media = previous_->media;
    } else {
      const auto media = std::make_shared<MediumPart>();
      media->all = lanthorn::make_media(now_, media->spectra);
      data_->media = media;
    }
    find_media_under_surfaces(*data_);
    data_->has_emissive =
        std::any_of(data_->media->all.begin(), data_->media->all.end(), [](const Medium& m) { return is_emissive(m); });
  }

  void note_spectra() {
    if (previous_ != nullptr && data_->geometry == previous_->geometry && data_->materials == previous_->materials) {
      data_->has_measured_spectra = previous_->has_measured_spectra;
      data_->has_dispersion = previous_->has_dispersion;
      return;
    }
    for (const GeometryRecord& record : data_->geometry->records()) {
      const MaterialTraits& traits = data_->materials->table.traits(record.material);
      data_->has_measured_spectra = data_->has_measured_spectra || traits.has_tables || traits.is_dispersive;
      data_->has_dispersion = data_->has_dispersion || traits.is_dispersive;
    }
  }

  bool may_share_lights() const {
    return previous_ != nullptr && data_->shapes == previous_->shapes && data_->placed == previous_->placed &&
           data_->media == previous_->media && have_same_textures(now_, *before_) &&
           (data_->materials == previous_->materials || data_->media->all.empty()) &&  // which media surround lights
           is_same(now_.area_lights, before_->area_lights) && is_same(now_.lights, before_->lights) &&
           now_.color_space == before_->color_space && now_.view.camera.medium == before_->view.camera.medium;
  }

  void gather_warnings() {
    std::vector<description::Warning>& all = data_->description.warnings;
    for (const description::Warning& w : data_->materials->warnings)
      if (std::none_of(all.begin(), all.end(),
                       [&](const auto& a) { return a.location == w.location && a.message == w.message; }))
        all.push_back(w);
    for (const auto* part : {&data_->shapes->warnings, &data_->lights->warnings})
      for (const description::Warning& w : *part) warn_once(all, w.location, w.message);
  }

  void count() {
    SceneStatistics& statistics = data_->statistics;
    statistics = data_->shapes->statistics;
    statistics.instances = now_.instances.size();
    statistics.materials = data_->materials->table.size();
    statistics.textures = now_.float_textures.size() + now_.spectrum_textures.size();
    statistics.lights = data_->lights->all.size();
    statistics.bvh_bytes = data_->geometry->bvh_bytes();
    statistics.texture_bytes = data_->materials->textures.bytes();
    statistics.texture_disk_bytes = data_->materials->textures.disk_bytes();
  }

  std::shared_ptr<SceneData> data_;
  const SceneDescription& now_;
  const SceneData* previous_;
  const SceneDescription* before_;
  std::shared_ptr<MaterialPart> new_materials_;  // null if they are the previous ones
  std::vector<bool> moved_;                      // by instance; empty if none has moved
};

}  // namespace

MaterialPart::MaterialPart(const SceneDescription& scene, const MaterialPart* loaded)
    : textures(scene, spectra, loaded != nullptr ? &loaded->textures : nullptr),
      table(scene, textures, spectra, warnings, loaded != nullptr ? &loaded->table : nullptr) {}

std::shared_ptr<const SceneData> build(SceneDescription&& description, const SceneData* previous) {
  const auto started = std::chrono::steady_clock::now();
  const auto data = std::make_shared<SceneData>();
  data->description = std::move(description);
  SceneBuilder(data, previous).build();
  data->statistics.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return data;
}

const SourceLocation& SceneData::light_location(std::uint32_t light) const {
  return std::prev(lights->locations.upper_bound(light))->second;
}

float shutter_middle(const SceneDescription& description) {
  const description::Camera& camera = description.view.camera;
  return lerp(0.5f, camera.shutter_open, std::max(camera.shutter_open, camera.shutter_close));
}

void warn_once(std::vector<description::Warning>& warnings, const SourceLocation& location,
               const std::string& message) {
  const bool known = std::any_of(warnings.begin(), warnings.end(),
                                 [&](const description::Warning& w) { return w.message == message; });
  if (!known) warnings.push_back({location, message});
}

// Products of light with densities and areas must stay below the largest float, 3e38.
void check_power(const Light& light, const SourceLocation& location) {
  constexpr float most = 1e32f;  // the sun's is 4e26
  if (!(power(light) <= most))
    throw Error(location, "the light's power exceeds 1e32 W: it is too bright, or it or the scene is too large");
}

void check_radiance(float radiance, const SourceLocation& location) {
  constexpr float most = 1e25f;  // the sun's is 2e7
  if (!(radiance <= most))
    throw Error(location,
                "the emission is too bright: its radiance, or that of a white surface near the light, exceeds 1e25 "
                "W/(m² sr)");
}

}  // namespace lanthorn
