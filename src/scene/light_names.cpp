// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <variant>

#include "scene/scene.h"
#include "scene/scene_data.h"

namespace lanthorn {

namespace {

// A light before it has a number.
struct Described {
  std::string id, kind, place;
};

// Where things are in a scene, as its camera sees it.
class Places {
 public:
  explicit Places(const Scene& scene) : bounds_(scene.bounds()) {
    const Transform& to_world = scene.description().view.camera.camera_to_world.start;
    const Vec3 up = to_world.vector({0, 1, 0});
    for (int i = 1; i < 3; ++i)
      if (std::fabs(up[i]) > std::fabs(up[up_axis_])) up_axis_ = i;
    up_ = Vec3(0);
    up_[up_axis_] = up[up_axis_] < 0 ? -1.0f : 1.0f;
    right_ = normalize(to_world.vector({1, 0, 0}));
    forward_ = normalize(to_world.vector({0, 0, 1}));
  }

  // Ceiling and floor are where a flat lamp lies at the scene's upper or lower end.
  std::string of(const Bounds& box) const {
    if (bounds_.empty() || box.empty()) return {};
    const float height = share(box.centre(), up_);
    const Vec3 size = box.max - box.min;
    constexpr float flat = 0.05f, edge = 0.75f;
    const bool is_flat = size[up_axis_] < flat * max_component(size);
    if (is_flat && std::fabs(height) > edge) return height > 0 ? "ceiling" : "floor";
    const std::pair<float, const char*> ways[]{{height, "top"},
                                               {-height, "bottom"},
                                               {share(box.centre(), right_), "right"},
                                               {-share(box.centre(), right_), "left"},
                                               {share(box.centre(), forward_), "back"},
                                               {-share(box.centre(), forward_), "front"}};
    const auto farthest = std::max_element(std::begin(ways), std::end(ways),
                                           [](const auto& a, const auto& b) { return a.first < b.first; });
    constexpr float off = 0.4f;
    return farthest->first > off ? farthest->second : "middle";
  }

 private:
  // The position of `p` along this direction: 0 at the middle of the scene, 1 at its end, -1 at the opposite end.
  float share(const Point& p, const Vec3& direction) const {
    const Vec3 half = 0.5f * (bounds_.max - bounds_.min);
    const float reach = dot(half, abs(direction));
    return reach > 0 ? dot(p - bounds_.centre(), direction) / reach : 0;
  }

  Bounds bounds_;
  int up_axis_ = 0;
  Vec3 up_, right_, forward_;
};

Described area_light(const Scene& scene, const Places& places, description::Index index) {
  const SceneData& data = *scene.data();
  const std::size_t end = data.first_described_light();
  std::string kind;
  Bounds box;
  const std::vector<EmittingShape>& emitters = data.shapes->emitters;
  for (std::size_t i = 0; i < emitters.size(); ++i) {
    const EmittingShape& emitter = emitters[i];
    if (emitter.source->area_light != index) continue;
    if (kind.empty()) kind = data.description.materials[emitter.source->material].name;
    const std::size_t last = i + 1 < emitters.size() ? emitters[i + 1].first_light : end;
    for (std::size_t l = emitter.first_light; l < last; ++l)
      if (const auto bounds = emission_bounds(data.lights->all[l])) box.extend(bounds->box);
  }
  return {name_of_area_light(index), kind.empty() ? "Lamp" : kind, places.of(box)};
}

Described light(const Scene& scene, const Places& places, description::Index index) {
  const description::Light& light = scene.description().lights[index];
  return std::visit(
      [&]<class L>(const L& l) -> Described {
        Bounds box;
        if constexpr (L::kind.has_place) {
          Point from(0);
          if constexpr (requires { l.from; }) from = l.from;
          box.extend(light.light_to_world.point(from));
        }
        return {name_of_light(index), L::kind.label, places.of(box)};
      },
      light.node);
}

}  // namespace

std::string name_of_light(description::Index index) { return "light" + std::to_string(index + 1); }
std::string name_of_area_light(description::Index index) { return "area" + std::to_string(index + 1); }

std::vector<NamedLight> lights_of(const Scene& scene) {
  const Places places(scene);
  std::vector<bool> has_shape(scene.description().area_lights.size());
  for (const EmittingShape& emitter : scene.data()->shapes->emitters) has_shape[*emitter.source->area_light] = true;
  std::vector<Described> all;
  for (description::Index i = 0; i < has_shape.size(); ++i)
    if (has_shape[i]) all.push_back(area_light(scene, places, i));
  for (description::Index i = 0; i < scene.description().lights.size(); ++i) all.push_back(light(scene, places, i));
  std::map<std::string, int> total, so_far;
  for (const Described& d : all) ++total[d.kind];
  std::vector<NamedLight> named;
  for (const Described& d : all) {
    std::string words = d.kind;
    if (total[d.kind] > 1) words.append(" ").append(std::to_string(++so_far[d.kind]));
    if (!d.place.empty()) words.append(", ").append(d.place);
    named.push_back({d.id, std::move(words)});
  }
  return named;
}

}  // namespace lanthorn
