// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/lights/light_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <variant>

#include "light/light.h"
#include "math/frame.h"
#include "math/sampling.h"
#include "scene/scene_data.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

namespace {

const Wavelengths& rgb() {
  static const Wavelengths w = Wavelengths::rgb(0.5f);
  return w;
}

/// Lights that share views: the primitives of an emitting shape, or one other light.
struct Group {
  std::uint32_t first = 0, count = 1;
  float power = 0;
};

bool has_view(const Light& light) {
  return std::visit(
      [](const auto& l) {
        using L = std::decay_t<decltype(l)>;
        return std::is_same_v<L, AreaLight> || std::is_same_v<L, EvenPointLight> || std::is_same_v<L, SpotLight> ||
               std::is_same_v<L, DistantLight> || std::is_same_v<L, SunLight> || std::is_same_v<L, EvenSky> ||
               std::is_same_v<L, ImageSky>;
      },
      light);
}

bool is_all_around(const Light& light) { return is_infinite(light) && !std::holds_alternative<SunLight>(light); }

std::vector<Group> groups_of(const Scene& scene) {
  const std::vector<Light>& lights = scene.lights();
  std::set<std::uint32_t> starts;
  for (const EmittingShape& shape : scene.data()->shapes->emitters) starts.insert(shape.first_light);
  std::vector<Group> groups;
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    if (!has_view(lights[i])) continue;
    const bool joins = std::holds_alternative<AreaLight>(lights[i]) && !starts.contains(i) && !groups.empty() &&
                       groups.back().first + groups.back().count == i;
    if (!joins) groups.push_back({i, 0, 0});
    ++groups.back().count;
    groups.back().power += power(lights[i]);
  }
  std::erase_if(groups, [](const Group& g) { return !(g.power > 0); });
  return groups;
}

Vec3 vec(const Spectrum& s) { return {s[0], s[1], s[2]}; }

/// A light of the group by its share of the power; `u` becomes a new number in [0,1).
struct Chosen {
  std::uint32_t light = 0;
  float probability = 1;
};
Chosen choose(const Scene& scene, const Group& group, float u) {
  float rest = u * group.power;
  for (std::uint32_t i = 0; i + 1 < group.count; ++i) {
    const float own = power(scene.lights()[group.first + i]);
    if (rest < own) return {group.first + i, own / group.power};
    rest -= own;
  }
  const std::uint32_t last = group.first + group.count - 1;
  return {last, power(scene.lights()[last]) / group.power};
}

WindowRays face(const Point& origin, const Vec3& forward, const Vec3& right, const Vec3& down, float tangent) {
  WindowRays rays;
  rays.eye = origin;
  rays.axis = forward;
  rays.corner = forward - tangent * (right + down);
  rays.right = 2 * tangent * right;
  rays.down = 2 * tangent * down;
  return rays;
}

/// The faces of a cube with axis z of the frame, those towards -z last; `count` of them.
std::vector<WindowRays> cube(const Point& origin, const Frame& f, int count) {
  std::vector<WindowRays> faces{face(origin, f.n, f.s, f.t, 1),  face(origin, f.s, f.t, f.n, 1),
                                face(origin, -f.s, f.t, f.n, 1), face(origin, f.t, f.s, f.n, 1),
                                face(origin, -f.t, f.s, f.n, 1), face(origin, -f.n, f.s, f.t, 1)};
  faces.resize(static_cast<std::size_t>(count));
  return faces;
}

Frame turned(const Direction& axis, float u) {
  const Frame f(axis);
  Frame result(axis);
  const float angle = 2 * pi * u;
  result.s = std::cos(angle) * f.s + std::sin(angle) * f.t;
  result.t = cross(axis, result.s);
  return result;
}

/// The places of texels change from frame to frame, so that their mean has no grid.
struct Jitter {
  float turn = 0;
  Vec2 direction{0.5f};
};

void set_windows(LightView& view, const EvenPointLight&, const BoundingSphere&, const Jitter& jitter, int,
                 const std::optional<LightFocus>&) {
  view.windows = cube(view.origin, turned(sample_uniform_sphere(jitter.direction), jitter.turn), 6);
}

void set_windows(LightView& view, const SpotLight& light, const BoundingSphere&, const Jitter& jitter, int size,
                 const std::optional<LightFocus>&) {
  const SpotProfile& spot = light.profile;
  view.axis = spot.axis;
  view.cone_start = spot.one_minus_cos_start;
  view.cone_end = spot.one_minus_cos_total;
  view.square_falloff = spot.shape == SpotProfile::Falloff::square;
  const float cos = 1 - spot.one_minus_cos_total;
  constexpr float widest_cos = 0.3f;  // beyond 72 degrees from the axis one window is coarse at its middle
  const Frame frame = turned(spot.axis, jitter.turn);
  if (cos < widest_cos) {
    view.windows = cube(view.origin, frame, 6);
    return;
  }
  const float tangent = std::sqrt(1 - cos * cos) / cos * (1 + 2 / static_cast<float>(size));
  view.windows = {face(view.origin, spot.axis, frame.s, frame.t, tangent)};
}

void set_windows(LightView& view, const AreaLight& area, const BoundingSphere&, const Jitter& jitter, int,
                 const std::optional<LightFocus>&) {
  view.kind = LightView::Kind::area;
  view.two_sided = area.two_sided;
  view.windows = cube(view.origin, turned(view.axis, jitter.turn), area.two_sided ? 6 : 5);
}

/// The part of a window of parallel rays around the focus, as whole texels; nullopt if that part would be most of the
/// window.
std::optional<WindowRays> window_around(const std::optional<LightFocus>& focus, const WindowRays& whole, int size) {
  if (!focus) return std::nullopt;
  const auto across = static_cast<float>(size);
  const float texel = std::sqrt(length_squared(whole.right)) / across;
  const float count = std::ceil(2 * focus->radius / texel) + 1;
  if (!(2 * count <= across)) return std::nullopt;
  const Vec3 right = whole.right / across, down = whole.down / across, way = focus->centre - whole.corner;
  const auto first = [&](const Vec3& step) {
    return std::clamp(std::floor((dot(way, step) / texel - focus->radius) / texel), 0.0f, across - count);
  };
  WindowRays part = whole;
  part.corner += first(right) * right + first(down) * down;
  part.right = count * right;
  part.down = count * down;
  return part;
}

template <class AnyFarLight>
void set_windows(LightView& view, const AnyFarLight&, const BoundingSphere& sphere, const Jitter& jitter, int size,
                 const std::optional<LightFocus>& focus) {
  view.kind = LightView::Kind::parallel;
  const Frame frame = turned(-view.axis, jitter.turn);
  const float half = sphere.radius * (1 + 2 / static_cast<float>(size));
  WindowRays rays;
  rays.parallel = true;
  rays.axis = -view.axis;
  rays.right = 2 * half * frame.s;
  rays.down = 2 * half * frame.t;
  rays.corner = sphere.centre + sphere.radius * view.axis - 0.5f * (rays.right + rays.down);
  view.windows = {rays};
  if (const auto fine = window_around(focus, rays, size)) view.windows.insert(view.windows.begin(), *fine);
}

/// Colour, origin and axis of a view from a sample of the light's emission: flux = L |cos| / (p_A p_ω). The view has
/// the power of an area light with a spread, but is diffuse.
void set_emission(LightView& view, const Light& light, const EmissionSample& s) {
  const Vec3 flux = vec(s.flux);
  view.origin = s.origin;
  view.position_error = s.position_error;
  if (is_far(light)) {
    view.axis = -s.direction;
    view.colour = flux * s.pdf_position;
  } else if (const auto* area = std::get_if<AreaLight>(&light)) {
    view.axis = s.normal;
    view.colour = flux * (s.pdf_direction / (s.cos_origin * area->spread.factor(s.cos_origin)));
  } else {
    const auto* spot = std::get_if<SpotLight>(&light);
    view.colour = spot != nullptr ? vec(spot->profile.intensity.evaluate(rgb())) : flux * s.pdf_direction;
  }
}

std::optional<LightView> view_of(const Scene& scene, const Group& group, Sampler& sampler,
                                 const LightViewSettings& settings) {
  const auto number = [&] { return settings.is_random ? sampler.next() : 0.5f; };
  const Chosen chosen = choose(scene, group, number());
  const Light& light = scene.lights()[chosen.light];
  Jitter jitter;
  jitter.turn = settings.is_random ? number() : 0;
  const Vec2 position(number(), number());
  const Vec2 direction(number(), number());
  const std::optional<EmissionSample> sample = sample_emission(light, position, direction, rgb());
  if (!sample || sample->flux.is_black()) return {};
  LightView view;
  view.light = chosen.light;
  view.is_all_around = is_all_around(light);
  view.power = group.power;
  set_emission(view, light, *sample);
  view.colour /= chosen.probability;
  jitter.direction = settings.is_random ? Vec2(number(), number()) : Vec2(0);
  std::visit(
      [&](const auto& l) { set_windows(view, l, scene.bounding_sphere(), jitter, settings.map_size, settings.focus); },
      light);
  return view;
}

int views_wanted(const Scene& scene, const Group& group, const LightViewSettings& settings) {
  return is_all_around(scene.lights()[group.first]) ? settings.sky_views : 1;
}

/// How many views a group of lights gets in this frame.
struct Quota {
  Group group;
  int views = 0;
  float part = 0;  ///< of the group's light, in each view
};

/// Quotas if there are more groups than views: group g has most_views * power / total views on average (systematic
/// sampling).
std::vector<Quota> quotas_by_power(const std::vector<Group>& groups, const LightViewSettings& settings,
                                   std::uint32_t frame) {
  const auto most = static_cast<float>(settings.most_views);
  float total = 0;
  for (const Group& group : groups) total += group.power;
  Sampler sampler = Sampler::for_pixel(settings.seed, stream_of("lights of a frame"), 0, frame);
  float next = sampler.next() * total / most, sum = 0;
  std::vector<Quota> quotas;
  for (const Group& group : groups) {
    sum += group.power;
    int views = 0;
    for (; next < sum; next += total / most) ++views;
    const auto count = static_cast<float>(views);
    if (views > 0) quotas.push_back({group, views, count * total / (most * group.power) / count});
  }
  return quotas;
}

std::vector<Quota> quotas_of(const Scene& scene, const LightViewSettings& settings, std::uint32_t frame) {
  const std::vector<Group> groups = groups_of(scene);
  std::vector<Quota> quotas;
  int wanted = 0;
  for (const Group& group : groups) {
    const int views = views_wanted(scene, group, settings);
    quotas.push_back({group, views, 1 / static_cast<float>(views)});
    wanted += views;
  }
  return wanted <= settings.most_views ? quotas : quotas_by_power(groups, settings, frame);
}

}  // namespace

std::vector<LightView> light_views(const Scene& scene, const LightViewSettings& settings) {
  const std::uint32_t frame = settings.is_random ? settings.frame : 0;
  std::vector<LightView> views;
  for (const Quota& quota : quotas_of(scene, settings, frame))
    for (int i = 0; i < quota.views; ++i) {
      const std::uint32_t number = quota.group.first * 64 + static_cast<std::uint32_t>(i);
      Sampler sampler = Sampler::for_pixel(settings.seed, stream_of("light views"), number, frame);
      std::optional<LightView> view = view_of(scene, quota.group, sampler, settings);
      if (!view) continue;
      view->colour *= quota.part;
      view->power *= quota.part;
      views.push_back(std::move(*view));
    }
  return views;
}

std::vector<std::uint32_t> share_photons(const std::vector<LightView>& views, std::uint32_t photons) {
  double total = 0, sum = 0;
  for (const LightView& view : views) total += static_cast<double>(view.power);
  std::vector<std::uint32_t> counts;
  std::uint32_t given = 0;
  for (const LightView& view : views) {
    sum += static_cast<double>(view.power);
    const auto until = static_cast<std::uint32_t>(std::min(1.0, sum / total) * photons + 0.5);
    counts.push_back(until - given);
    given = until;
  }
  return counts;
}

std::vector<std::string> light_limitations(const Scene& scene) {
  const auto count_of = [&](auto&& is_limited) {
    return std::count_if(scene.lights().begin(), scene.lights().end(), is_limited);
  };
  std::vector<std::string> messages;
  if (const auto count = count_of([](const Light& l) { return !has_view(l); }); count > 0)
    messages.push_back(fmt::format(
        "{} light{} ignored: projected images, goniometric lights, portals and emissive media are not supported", count,
        count == 1 ? " is" : "s are"));
  const auto has_spread = [](const Light& l) {
    const auto* area = std::get_if<AreaLight>(&l);
    return area != nullptr && !area->spread.is_diffuse();
  };
  if (const auto count = count_of(has_spread); count > 0)
    messages.push_back(
        fmt::format("the spread of {} area light{} is not supported: {} in all directions, with the same power", count,
                    count == 1 ? "" : "s", count == 1 ? "it shines" : "they shine"));
  return messages;
}

}  // namespace lanthorn
