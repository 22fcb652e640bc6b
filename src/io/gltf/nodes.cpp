// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 §3.5; EXT_mesh_gpu_instancing.
#include "io/gltf/nodes.h"

#include <optional>
#include <string>

#include "io/gltf/accessor.h"

namespace lanthorn::gltf {

namespace {

constexpr std::size_t most_instances = std::size_t{1} << 24;

// The root nodes of the scene that the member "scene" names, else of the first scene. In a file without scenes, the
// nodes without a parent.
std::vector<std::size_t> root_nodes(Document& document) {
  std::vector<std::size_t> roots;
  const auto chosen = document.root().find("scene");
  if (chosen || document.count("scenes") > 0) {
    const Value scene = chosen ? document.follow("scenes", *chosen) : document.element("scenes", 0);
    if (document.count("scenes") > 1)
      document.warn("scenes", scene, "the file has several scenes: only this one is rendered");
    if (const auto nodes = scene.find_array("nodes"))
      for (std::size_t i = 0; i < nodes->size(); ++i) roots.push_back(document.index("nodes", nodes->element(i)));
    return roots;
  }
  std::vector<bool> has_parent(document.count("nodes"));
  for (std::size_t n = 0; n < has_parent.size(); ++n)
    if (const auto children = document.element("nodes", n).find_array("children"))
      for (std::size_t i = 0; i < children->size(); ++i)
        has_parent[document.index("nodes", children->element(i))] = true;
  for (std::size_t n = 0; n < has_parent.size(); ++n)
    if (!has_parent[n]) roots.push_back(n);
  return roots;
}

}  // namespace

std::vector<PlacedNode> placed_nodes(Document& document, const Pose& pose) {
  std::vector<PlacedNode> placed;
  std::vector<bool> reached(document.count("nodes"));
  const auto place = [&](std::size_t n, const glm::dmat4& parent) {
    const Value node = document.element("nodes", n);
    if (reached[n]) throw node.error("the node is reached twice: it has two parents, or is its own ancestor");
    reached[n] = true;
    placed.push_back({n, parent * pose.local_transform(n)});
  };
  for (const std::size_t root : root_nodes(document)) place(root, glm::dmat4(1.0));
  for (std::size_t i = 0; i < placed.size(); ++i) {  // NOLINT(modernize-loop-convert): the vector grows
    const PlacedNode parent = placed[i];
    if (const auto children = document.element("nodes", parent.node).find_array("children"))
      for (std::size_t k = 0; k < children->size(); ++k)
        place(document.index("nodes", children->element(k)), parent.to_world);
  }
  return placed;
}

std::vector<Transform> mesh_places(Document& document, const PlacedNode& placed) {
  const Value node = document.element("nodes", placed.node);
  std::vector<Transform> places;
  const auto add = [&](const glm::dmat4& m) { places.emplace_back(m); };
  const auto instancing = node.extension("EXT_mesh_gpu_instancing");
  if (!instancing) {
    add(placed.to_world);
    return places;
  }
  const Value attributes = instancing->at("attributes");
  std::optional<std::size_t> count;
  const auto accessor = [&](const char* name, std::size_t components) -> std::optional<Accessor> {
    const auto reference = attributes.find(name);
    if (!reference) return {};
    Accessor result(document, *reference, components);
    if (count.value_or(result.count()) != result.count())
      throw reference->error("has " + std::to_string(result.count()) + " elements, but another attribute has " +
                             std::to_string(*count));
    count = result.count();
    return result;
  };
  const auto translation = accessor("TRANSLATION", 3), rotation = accessor("ROTATION", 4), scale = accessor("SCALE", 3);
  if (count.value_or(0) > most_instances)
    throw instancing->error("there are more than " + std::to_string(most_instances) + " instances");
  const auto vec3 = [](const std::optional<Accessor>& a, std::size_t i, double otherwise) {
    return a ? glm::dvec3(a->finite_number(i, 0), a->finite_number(i, 1), a->finite_number(i, 2))
             : glm::dvec3(otherwise);
  };
  for (std::size_t i = 0; i < count.value_or(0); ++i) {
    std::vector<double> turn{0, 0, 0, 1};
    for (std::size_t c = 0; rotation && c < 4; ++c) turn[c] = static_cast<double>(rotation->finite_number(i, c));
    add(placed.to_world * from_parts(vec3(translation, i, 0), turn, vec3(scale, i, 1)));
  }
  return places;
}

}  // namespace lanthorn::gltf
