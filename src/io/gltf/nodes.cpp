// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 §3.5, §3.11 and appendix C; EXT_mesh_gpu_instancing.
#include "io/gltf/nodes.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>

#include "io/gltf/accessor.h"
#include "lanthorn/text.h"

namespace lanthorn::gltf {

namespace {

using Numbers = std::vector<double>;

constexpr std::size_t most_targets = 4096;

glm::dquat quaternion(const Numbers& xyzw) {
  const glm::dquat q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  const double length = glm::length(q);
  return length > 0 && std::isfinite(length) ? q / length : glm::dquat(1, 0, 0, 0);
}

glm::dvec3 vec3(const Numbers& v) { return {v[0], v[1], v[2]}; }

glm::dmat4 matrix_of(const Value& matrix) {
  const std::vector<float> m = matrix.numbers(16);
  glm::dmat4 result;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      result[column][row] = m[4 * static_cast<std::size_t>(column) + static_cast<std::size_t>(row)];
  if (m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1) return result;
  // Other programs ignore the row.
  matrix.warn("matrix", fmt::format("the matrix must be affine, but its last row is {} {} {} {}: 0 0 0 1 is used", m[3],
                                    m[7], m[11], m[15]));
  for (int column = 0; column < 4; ++column) result[column][3] = column == 3 ? 1 : 0;
  return result;
}

// Number of morph targets of a node's mesh.
std::size_t target_count(const Document& document, std::size_t node) {
  const auto mesh = document.element("nodes", node).find("mesh");
  if (!mesh) return 0;
  const Value primitives = document.follow("meshes", *mesh).at("primitives");
  if (primitives.size() == 0) return 0;
  const auto targets = primitives.element(0).find_array("targets");
  if (targets && targets->size() > most_targets)
    throw targets->error("there are more than " + std::to_string(most_targets) + " morph targets");
  return targets ? targets->size() : 0;
}

enum class Interpolation : std::uint8_t { step, linear, cubic_spline };

Interpolation interpolation_of(const Value& sampler) {
  const std::string name = sampler.text("interpolation", "LINEAR");
  if (name == "STEP") return Interpolation::step;
  if (name == "LINEAR") return Interpolation::linear;
  if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
  throw sampler.at("interpolation").error("must be STEP, LINEAR or CUBICSPLINE, not " + in_quotes(name));
}

// The keys around a time. Before the first and after the last key, `first` equals `second`.
struct Keys {
  std::size_t first = 0, second = 0;
  double fraction = 0;  // of the way from the first to the second
  double span = 0;      // seconds between them

  Keys(const Accessor& times, double seconds) {
    const auto time = [&](std::size_t i) { return static_cast<double>(times.finite_number(i, 0)); };
    std::size_t low = 0, high = times.count();  // times before `low` are <= `seconds`, from `high` on later
    while (low < high) {
      const std::size_t middle = low + (high - low) / 2;
      (time(middle) <= seconds ? low : high) = time(middle) <= seconds ? middle + 1 : middle;
    }
    first = low > 0 ? low - 1 : 0;
    second = std::min(low, times.count() - 1);
    if (low == 0 || second == first) return;
    span = time(second) - time(first);
    fraction = span > 0 ? (seconds - time(first)) / span : 0;
  }
};

// A channel's values: `width` numbers per key, and in a spline as many for the tangents before and after it.
class Track {
 public:
  Track(Document& document, const Value& sampler, std::size_t components, std::size_t elements)
      : times_(document, sampler.at("input"), 1),
        values_(document, sampler.at("output"), components),
        interpolation_(interpolation_of(sampler)),
        components_(components),
        elements_(elements) {
    if (times_.count() == 0) throw sampler.at("input").error("an animation needs at least one key");
    const std::size_t needed = elements * (interpolation_ == Interpolation::cubic_spline ? 3 : 1);
    if (needed == 0 || values_.count() % needed != 0 || values_.count() / needed != times_.count())
      throw sampler.at("output").error("has " + std::to_string(values_.count()) + " elements, but " +
                                       std::to_string(times_.count()) + " keys need " + std::to_string(needed) +
                                       " each");
  }

  Numbers at(double seconds, bool is_rotation) const {
    const Keys keys(times_, seconds);
    const bool is_cubic = interpolation_ == Interpolation::cubic_spline;
    if (is_cubic) return spline(keys);
    const Numbers a = value(keys.first, 0, 1), b = value(keys.second, 0, 1);
    if (interpolation_ == Interpolation::step) return a;
    if (is_rotation) {
      const glm::dquat q = glm::slerp(quaternion(a), quaternion(b), keys.fraction);
      return {q.x, q.y, q.z, q.w};
    }
    Numbers result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) result[i] = (1 - keys.fraction) * a[i] + keys.fraction * b[i];
    return result;
  }

 private:
  // Part `part` of the `parts` that each key has.
  Numbers value(std::size_t key, std::size_t part, std::size_t parts) const {
    Numbers result;
    for (std::size_t e = 0; e < elements_; ++e)
      for (std::size_t c = 0; c < components_; ++c)
        result.push_back(static_cast<double>(values_.finite_number((key * parts + part) * elements_ + e, c)));
    return result;
  }
  // Cubic spline interpolation (appendix C.5).
  Numbers spline(const Keys& keys) const {
    const Numbers a = value(keys.first, 1, 3), leaving = value(keys.first, 2, 3);
    const Numbers b = value(keys.second, 1, 3), arriving = value(keys.second, 0, 3);
    const double t = keys.fraction, t2 = t * t, t3 = t2 * t;
    Numbers result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      result[i] = (2 * t3 - 3 * t2 + 1) * a[i] + keys.span * (t3 - 2 * t2 + t) * leaving[i] + (3 * t2 - 2 * t3) * b[i] +
                  keys.span * (t3 - t2) * arriving[i];
    return result;
  }

  Accessor times_, values_;
  Interpolation interpolation_;
  std::size_t components_, elements_;
};

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

glm::dmat4 from_parts(const glm::dvec3& translation, const std::vector<double>& rotation, const glm::dvec3& scale) {
  glm::dmat4 m = glm::mat4_cast(quaternion(rotation));
  for (int i = 0; i < 3; ++i) m[i] *= scale[i];
  m[3] = glm::dvec4(translation, 1);
  return m;
}

Pose::Pose(Document& document, std::optional<double> seconds) : document_(document) {
  const std::size_t count = document.count("animations");
  if (seconds && count == 0) throw Error(SourceLocation{document.name()}, "--at: the file has no animation");
  if (!seconds && count > 0)
    document.warn(
        "animations", document.root().at("animations"),
        "animations are not played: objects are in the rest pose; --at selects a time, such as --at 1.5 (seconds)");
  if (!seconds) return;
  if (count > 1)
    document.warn("animations", document.root().at("animations"),
                  "the file has several animations: the first one is used");
  animate(document.element("animations", 0), *seconds);
}

void Pose::animate(const Value& animation, double seconds) {
  const Value channels = animation.at("channels");
  for (std::size_t i = 0; i < channels.size(); ++i)
    document_.reads([&] { animate_channel(animation, channels.element(i), seconds); });
}

void Pose::animate_channel(const Value& animation, const Value& channel, double seconds) {
  const Value target = channel.at("target");
  const auto reference = target.find("node");
  const std::string path = target.at("path").text();
  const bool is_known = path == "translation" || path == "rotation" || path == "scale" || path == "weights";
  if (!reference || !is_known) {
    document_.warn("animation path", target, "animations of " + in_quotes(path) + " without a node are ignored");
    return;
  }
  const Value samplers = animation.at("samplers");
  const Value index = channel.at("sampler");
  if (index.integer() >= samplers.size())
    throw index.error("is " + std::to_string(index.integer()) + ", but there are " + std::to_string(samplers.size()) +
                      " samplers");
  const Value sampler = samplers.element(static_cast<std::size_t>(index.integer()));
  const std::size_t node = document_.index("nodes", *reference);
  Animated& animated = animated_[node];
  if (path == "weights") {
    const std::size_t targets = target_count(document_, node);
    if (targets == 0) throw target.error("animates weights, but the node's mesh has no morph targets");
    animated.weights = Track(document_, sampler, 1, targets).at(seconds, false);
    return;
  }
  const bool is_rotation = path == "rotation";
  auto& value = is_rotation ? animated.rotation : path == "scale" ? animated.scale : animated.translation;
  value = Track(document_, sampler, is_rotation ? 4 : 3, 1).at(seconds, is_rotation);
}

glm::dmat4 Pose::local_transform(std::size_t node) const {
  const Value value = document_.element("nodes", node);
  const auto found = animated_.find(node);
  const Animated none, &animated = found == animated_.end() ? none : found->second;
  const bool moves = animated.translation || animated.rotation || animated.scale;
  if (const auto matrix = value.find("matrix"); matrix && !moves) return matrix_of(*matrix);
  const auto part = [&](const std::optional<Numbers>& given, const char* key, Numbers otherwise) {
    if (given) return *given;
    const auto own = value.find(key);
    if (!own) return otherwise;
    const std::vector<float> numbers = own->numbers(otherwise.size());
    return Numbers(numbers.begin(), numbers.end());
  };
  return from_parts(vec3(part(animated.translation, "translation", {0, 0, 0})),
                    part(animated.rotation, "rotation", {0, 0, 0, 1}), vec3(part(animated.scale, "scale", {1, 1, 1})));
}

std::vector<float> Pose::morph_weights(std::size_t node) const {
  const Value value = document_.element("nodes", node);
  std::vector<float> weights(target_count(document_, node));
  if (weights.empty()) return weights;
  const auto take = [&](const auto& given) {
    for (std::size_t i = 0; i < std::min(weights.size(), given.size()); ++i) weights[i] = static_cast<float>(given[i]);
  };
  if (const auto found = animated_.find(node); found != animated_.end() && found->second.weights) {
    take(*found->second.weights);
  } else {
    auto given = value.find_array("weights");
    if (!given) given = document_.follow("meshes", value.at("mesh")).find_array("weights");
    if (given) take(given->numbers(given->size()));
  }
  return weights;
}

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
