// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Guo, Hasan, Zhao 2018: Position-Free Monte Carlo Simulation for Arbitrary Layered BSDFs [G18].
//
// Both ends of every walk lie outside the coat, so the refraction factors of radiance cancel. The walks carry flux,
// with weights that stay below 1, and both transport modes share the same symmetric function.
#include "surface/coated.h"

#include <algorithm>
#include <bit>
#include <tuple>
#include <utility>

#include "math/hash.h"
#include "math/henyey_greenstein.h"
#include "math/sampling.h"
#include "surface/fresnel.h"

namespace lanthorn {
namespace {

/// Fraction of light transmitted through the optical depth `depth` in direction w.
float transmittance(float depth, const Vec3& w) { return std::exp(-depth / abs_cos_theta(w)); }

/// One random walk inside the layer: its depth, direction and weight.
template <class Base>
class LayerWalk {
 public:
  enum class Event { absorbed, scattered, at_base, at_coat };

  LayerWalk(const Coated<Base>& layers, const Vec3& direction, float weight, HashRng& rng)
      : layers_(layers), rng_(rng), depth_(0), direction_(direction), weight_(weight) {}

  /// Advances one segment, to the next interface or scattering event, after Russian roulette. The walk's weight then
  /// includes the segment, and at a scattering event the albedo, but not the phase function.
  Event advance() {
    if (direction_.z == 0 || segments_ == layers_.max_depth || !survives_roulette()) return Event::absorbed;
    ++segments_;
    const bool down = direction_.z < 0;
    if (layers_.albedo.is_black()) {
      weight_ *= transmittance(layers_.thickness, direction_);
    } else {
      const float step = -std::log(1 - rng_.next()) * abs_cos_theta(direction_);
      const float depth = down ? depth_ + step : depth_ - step;
      if (depth > 0 && depth < layers_.thickness) {
        depth_ = depth;
        weight_ *= layers_.albedo;
        return Event::scattered;
      }
    }
    depth_ = down ? layers_.thickness : 0;
    return down ? Event::at_base : Event::at_coat;
  }

  void turn(const Vec3& direction) { direction_ = direction; }
  void turn(const Vec3& direction, const Spectrum& factor) {
    direction_ = direction;
    weight_ *= factor;
  }

  /// True if the walk may still reach the coat and leave; a walk of `max_depth` segments may not.
  bool may_leave() const { return segments_left() > 0; }
  int segments_left() const { return layers_.max_depth - segments_; }
  /// Fraction of light transmitted from here to the coat in direction w.
  float transmittance_to_coat(const Vec3& w) const { return transmittance(depth_, w); }
  float transmittance_to_base(const Vec3& w) const { return transmittance(layers_.thickness - depth_, w); }
  const Vec3& direction() const { return direction_; }
  const Spectrum& weight() const { return weight_; }

 private:
  bool survives_roulette() {
    const float p = max_component(weight_);
    if (segments_ <= 3 || p >= 0.25f) return true;
    if (rng_.next() >= p) return false;
    weight_ /= p;
    return true;
  }

  const Coated<Base>& layers_;
  HashRng& rng_;
  int segments_ = 0;
  float depth_;  ///< optical, below the coat
  Vec3 direction_;
  Spectrum weight_;
};

/// Fraction of light from direction w that a smooth base reflects as a mirror.
template <class Base>
Spectrum mirror_reflectance(const Base& base, const Vec3& w) {
  // Reflection is the first lobe of a base with several lobes.
  const auto bounce = sample(base, w, 0.0f, Vec2(0.5f), Transport::importance);
  return bounce && bounce->delta ? bounce->weight * bounce->pdf : Spectrum();
}

/// Light that leaves a smooth base towards `exit` through a clear coat, divided by the light that leaves at once: the
/// sum over all numbers of reflections between coat and base. Neither end of a walk can sample these delta reflections
/// by chance.
template <class Base>
Spectrum mirrored_again(const Coated<Base>& c, const LayerWalk<Base>& walk, const InterfaceSample& exit) {
  const auto back = sample_reflection(c.coat, exit.wo, Vec2(0.5f));
  const Spectrum mirror = mirror_reflectance(c.base, -exit.wo);
  Spectrum sum(1);
  if (!back || mirror.is_black()) return sum;
  const float across = transmittance(c.thickness, exit.wo);
  Spectrum term(1);
  for (int left = walk.segments_left(); left >= 3; left -= 2) {
    term *= mirror * (across * across * back->weight);
    sum += term;
  }
  return sum;
}

/// Light from a scattering event between a mirror and a clear coat that reaches `exit` via the mirror: the sum over all
/// numbers of reflections between the two, as in `mirrored_again`.
template <class Base>
Spectrum mirrored(const Coated<Base>& c, const LayerWalk<Base>& walk, const InterfaceSample& exit) {
  const Vec3 up = -exit.wo;
  const Vec3 down(up.x, up.y, -up.z);
  const auto back = sample_reflection(c.coat, exit.wo, Vec2(0.5f));
  const Spectrum mirror = mirror_reflectance(c.base, up);
  if (!back || mirror.is_black()) return Spectrum();
  const float across = transmittance(c.thickness, up);
  const Vec3& in = walk.direction();
  const float downwards = henyey_greenstein(c.g, in, down) * walk.transmittance_to_base(down);
  const float upwards = henyey_greenstein(c.g, in, up) * walk.transmittance_to_coat(up) * back->weight * across;
  Spectrum arriving = mirror * (across * exit.weight / up.z);
  Spectrum sum;
  for (int left = walk.segments_left(); left >= 2; left -= 2) {
    sum += arriving * (left >= 3 ? downwards + upwards : downwards);
    arriving *= mirror * (across * across * back->weight);
  }
  return sum;
}

/// Estimates the light that one walk from wi carries to wo through the coat: next-event estimation with a direction
/// `exit`, refracted backwards from wo, combined by MIS with walks that leave towards wo by themselves [G18 §4.2].
template <class Base>
class WalkBelowCoat {
 public:
  WalkBelowCoat(const Coated<Base>& layers, const Vec3& wo, const InterfaceSample& entry, const InterfaceSample& exit,
                HashRng& rng)
      : layers_(layers),
        wo_(wo),
        exit_(exit),
        up_(-exit.wo),
        rough_coat_(!is_smooth(layers.coat)),
        rng_(rng),
        walk_(layers, entry.wo, entry.weight, rng) {}

  Spectrum estimate() {
    while (go_on(walk_.advance())) {
    }
    return sum_;
  }

 private:
  using Event = typename LayerWalk<Base>::Event;

  bool go_on(Event event) {
    switch (event) {
      case Event::absorbed:
        return false;
      case Event::at_coat:
        return meet_coat();
      case Event::at_base:
        return meet_base();
      case Event::scattered:
        return meet_medium();
    }
    return false;
  }

  bool meet_coat() {
    const auto reflected = sample_reflection(layers_.coat, -walk_.direction(), rng_.next2());
    if (!reflected || reflected->weight == 0) return false;
    walk_.turn(reflected->wo, Spectrum(reflected->weight));
    return true;
  }

  bool meet_base() {
    const Vec3 back = -walk_.direction();
    if (has_non_delta(layers_.base) && walk_.may_leave()) {
      const BsdfValue base = evaluate(layers_.base, back, up_, Transport::importance, {.f = true, .pdf = rough_coat_});
      Spectrum leaving = walk_.weight() * base.f;
      if (!rough_coat_ && is_smooth(layers_.base)) leaving *= mirrored_again(layers_, walk_, exit_);
      sum_ += leaving * (exit_weight(base.pdf) * exit_.weight * walk_.transmittance_to_coat(up_));
    }
    const float u_lobe = rng_.next();
    const auto bounced = sample(layers_.base, back, u_lobe, rng_.next2(), Transport::importance);
    if (!bounced) return false;
    walk_.turn(bounced->wo, bounced->weight);
    add_hit(bounced->pdf, !bounced->delta);
    return true;
  }

  bool meet_medium() {
    const Vec3 in = walk_.direction();
    const float phase = henyey_greenstein(layers_.g, in, up_);
    if (walk_.may_leave())
      sum_ += walk_.weight() *
              (phase * exit_weight(phase) * exit_.weight / abs_cos_theta(up_) * walk_.transmittance_to_coat(up_));
    if (!rough_coat_ && is_smooth(layers_.base)) sum_ += walk_.weight() * mirrored(layers_, walk_, exit_);
    const SampledScattering scattered = sample_henyey_greenstein(layers_.g, in, rng_.next2());
    walk_.turn(scattered.out);
    add_hit(scattered.pdf, true);
    return true;
  }

  /// MIS weight of next-event estimation against a walk that samples the same direction with this density.
  float exit_weight(float walk_density) const { return rough_coat_ ? power_heuristic(exit_.pdf, walk_density) : 1.0f; }

  /// Adds the light that the walk brings to wo by itself, having sampled its direction with this density.
  void add_hit(float density, bool competes) {
    const Vec3& w = walk_.direction();
    if (!rough_coat_ || w.z <= 0 || !walk_.may_leave()) return;
    const float f = evaluate(layers_.coat, -w, wo_, Transport::importance, {.f = true}).f[0];
    if (f == 0) return;
    const float weight = competes ? power_heuristic(density, pdf_transmission(layers_.coat, wo_, -w)) : 1.0f;
    sum_ += walk_.weight() * (f * weight * walk_.transmittance_to_coat(w));
  }

  const Coated<Base>& layers_;
  Vec3 wo_;
  InterfaceSample exit_;
  Vec3 up_;  ///< direction in the layer that refracts into wo
  bool rough_coat_;
  HashRng& rng_;
  LayerWalk<Base> walk_;
  Spectrum sum_;
};

template <class Base>
Spectrum estimate_below_coat(const Coated<Base>& c, const Vec3& wi, const Vec3& wo, HashRng& rng) {
  const auto entry = sample_transmission(c.coat, wi, rng.next2(), Transport::importance);
  if (!entry) return Spectrum();
  const auto exit = sample_transmission(c.coat, wo, rng.next2(), Transport::radiance);
  if (!exit) return Spectrum();
  return WalkBelowCoat<Base>(c, wo, *entry, *exit, rng).estimate();
}

/// f between two directions above the coat; `coat`: that of the coat's own reflection.
template <class Base>
Spectrum f_with_base(const Coated<Base>& c, Vec3 i, Vec3 o, const Spectrum& coat) {
  // Only the expected value is symmetric; ordering the two directions makes the estimate symmetric too.
  if (std::tie(i.z, i.x, i.y) < std::tie(o.z, o.x, o.y)) std::swap(i, o);
  HashRng rng(hash_vec(o, hash_vec(i)));
  Spectrum below;
  for (int s = 0; s < c.n_samples; ++s) below += estimate_below_coat(c, i, o, rng);
  return coat + below / static_cast<float>(c.n_samples);
}

/// The walk of `sample` inside the layer; nullopt if absorbed.
template <class Base>
std::optional<BsdfSample> walk_through(const Coated<Base>& c, const BsdfSample& entry, HashRng& rng) {
  using Event = typename LayerWalk<Base>::Event;
  LayerWalk<Base> walk(c, entry.wo, entry.weight[0], rng);
  bool delta = entry.delta;
  float probability = entry.pdf;
  for (;;) {
    const Event event = walk.advance();
    const Vec3 in = walk.direction();
    if (event == Event::absorbed) return std::nullopt;
    if (event == Event::scattered) {
      walk.turn(sample_henyey_greenstein(c.g, in, rng.next2()).out);
      delta = false;
      continue;
    }
    const float u_lobe = rng.next();
    const Vec2 u = rng.next2();
    const auto next = event == Event::at_base ? sample(c.base, -in, u_lobe, u, Transport::importance)
                                              : sample(c.coat, -in, u_lobe, u, Transport::importance);
    if (!next || next->weight.is_black()) return std::nullopt;
    walk.turn(next->wo, next->weight);
    delta = delta && next->delta;
    probability *= next->pdf;
    if (next->transmission)
      return BsdfSample{.wo = next->wo, .weight = walk.weight(), .pdf = probability, .delta = delta};
  }
}

/// GGX width of the base as seen through a rough coat. A facet of slope s turns a refracted ray by (1 - 1/eta) s
/// inside, as much as a base facet of half that slope does by reflection. The variances of the two passages add.
float blurred(float base_alpha, float coat_alpha, const Dielectric& coat) {
  if (is_smooth(coat)) return base_alpha;
  return std::sqrt(sqr(base_alpha) + 0.5f * sqr(1 - 1 / coat.eta) * sqr(coat_alpha));
}

/// The specular reflection of the base alone, as seen through the coat.
Conductor seen_mirror(const CoatedConductor& c) {
  Conductor base = c.base;
  base.alpha_x = blurred(base.alpha_x, c.coat.alpha_x, c.coat);
  base.alpha_y = blurred(base.alpha_y, c.coat.alpha_y, c.coat);
  return base;
}
Plastic seen_mirror(const CoatedPlastic& c) {
  Plastic base = c.base;
  base.reflectance = Spectrum();
  base.alpha = blurred(base.alpha, geometric_alpha(c.coat.alpha_x, c.coat.alpha_y), c.coat);
  return base;
}

/// w after refraction into the layer by a smooth coat.
Vec3 refracted(const Dielectric& coat, const Vec3& w) {
  return {w.x / coat.eta, w.y / coat.eta, fresnel_dielectric(w.z, coat.eta).cos_t};
}

template <class Base>
float pdf_one_mirror_bounce(const Coated<Base>& c, const Vec3& i, const Vec3& o) {
  const Vec3 inside_o = refracted(c.coat, o);
  if (inside_o.z <= 0) return 0;
  const float jacobian = o.z / (sqr(c.coat.eta) * inside_o.z);  // d(inside_o) / d(o)
  return evaluate(seen_mirror(c), refracted(c.coat, i), inside_o, Transport::importance, {.pdf = true}).pdf * jacobian;
}

/// Density of leaving towards `o` after one reflection at the base, with both refractions as at a smooth coat.
float pdf_one_bounce(const CoatedDiffuse& /*any*/, const Vec3& /*i*/, const Vec3& o) {
  // Light from the base inside the escape cone is Lambertian outside, too.
  return pdf_cosine_hemisphere(o.z);
}
float pdf_one_bounce(const CoatedConductor& c, const Vec3& i, const Vec3& o) { return pdf_one_mirror_bounce(c, i, o); }
float pdf_one_bounce(const CoatedPlastic& c, const Vec3& i, const Vec3& o) {
  const float diffuse = lobe_weights(c.base, refracted(c.coat, i)).diffuse;
  return lerp(diffuse, pdf_one_mirror_bounce(c, i, o), pdf_cosine_hemisphere(o.z));
}

/// The share of the light from below the coat that the density treats as Lambertian: the light of several bounces, and
/// of scattering in the medium.
template <class Base>
float several_bounces(const Coated<Base>& c) {
  if (is_smooth(c.base) && is_smooth(c.coat)) return 1;
  constexpr float clear = 0.1f;
  if (c.albedo.is_black()) return clear;
  return lerp(std::exp(-2 * c.thickness), 1.0f, clear);
}

/// Density of leaving towards `o`, above the coat; `coat`: that of the coat's own reflection.
template <class Base>
float pdf_with_base(const Coated<Base>& c, const Vec3& i, const Vec3& o, float coat) {
  const float entering = c.coat.eta == 1.0f ? 1.0f : 1.0f - fresnel_dielectric(i.z, c.coat.eta).reflectance;
  const float rest = several_bounces(c);
  return coat + entering * ((1 - rest) * pdf_one_bounce(c, i, o) + rest * pdf_cosine_hemisphere(o.z));
}

/// Fraction of Lambertian light below a plane interface of index ratio `eta` >= 1 that is reflected back, within 0.002;
/// 0 for eta < 1. Up to eta = 2, the fit of Jensen et al. 2001, A Practical Model for Subsurface Light Transport, §2.1,
/// which grows beyond 1 for larger indices. There, by reciprocity, 1 - T / eta^2 with a fit to T, the fraction that the
/// interface lets in from above.
float internal_diffuse_reflectance(float eta) {
  if (eta <= 1) return 0;
  const float x = 1 / eta;
  if (eta <= 2) return std::max(0.0f, ((-1.4399f * x + 0.7099f) * x + 0.6681f) + 0.0636f * eta);
  return 1 - x * x * (x * (4.607f + x * (-12.175f + x * (18.501f - x * 11.749f))));
}

float coat_reflectance(const Dielectric& coat, const Vec3& wi) {
  return coat.eta == 1.0f ? 0.0f : fresnel_dielectric(abs_cos_theta(wi), coat.eta).reflectance;
}
/// Fraction that survives a passage through the layer and back; light scattered in the layer counts as surviving.
template <class Base>
Spectrum round_trip(const Coated<Base>& c) {
  return exp(-2.0f * c.thickness * (Spectrum(1) - c.albedo));
}

/// Share of the light transmitted by the coat that leaves again, after any number of reflections between base and coat
/// (Kubelka's series). `round`: survival of one round trip; `back`: fraction reflected back at the coat each time.
Spectrum base_and_back(const Spectrum& base, const Spectrum& round, float back) {
  return map(base * round, [back](float once) {
    // The denominator is 1 - once * back, a sum of positive numbers here, and 0 only if all light stays inside.
    const float escapes = once * (1 - back), sum = (1 - once) + escapes;
    return sum > 0 ? escapes / sum : 0.0f;
  });
}
Spectrum albedo_below(const CoatedDiffuse& c, const Vec3&) {
  return base_and_back(c.base.reflectance, round_trip(c), internal_diffuse_reflectance(c.coat.eta));
}
Spectrum albedo_below(const CoatedConductor& c, const Vec3& wi) {
  const float cos_t = fresnel_dielectric(abs_cos_theta(wi), c.coat.eta).cos_t;
  return base_and_back(fresnel_conductor(cos_t, c.base.eta, c.base.k), round_trip(c), coat_reflectance(c.coat, wi));
}
Spectrum albedo_below(const CoatedPlastic& c, const Vec3& wi) {
  const Vec3 inside = refracted(c.coat, {wi.x, wi.y, abs_cos_theta(wi)});
  const float diffuse = lobe_weights(c.base, inside).diffuse;
  const float back = lerp(diffuse, coat_reflectance(c.coat, wi), internal_diffuse_reflectance(c.coat.eta));
  return base_and_back(albedo(c.base, inside), round_trip(c), back);
}

/// The base's lobes as seen through the coat; a rough coat makes mirrors glossy.
template <class Base>
LobeWeights lobes_below(const Coated<Base>& c) {
  LobeWeights lobes = lobe_weights(c.base, Vec3(0, 0, 1));
  if (is_smooth(c.coat) || lobes.diffuse == 1) return lobes;
  lobes.glossy += std::exchange(lobes.delta, 0.0f);
  lobes.alpha = std::max(lobes.alpha, geometric_alpha(c.coat.alpha_x, c.coat.alpha_y));
  return lobes;
}

}  // namespace

template <class Base>
BsdfValue evaluate(const Coated<Base>& c, const Vec3& wi, const Vec3& wo, Transport /*symmetric*/, BsdfParts parts) {
  if (!same_hemisphere(wi, wo) || !has_non_delta(c)) return {};
  const float side = std::copysign(1.0f, wi.z);
  const Vec3 i = side * wi, o = side * wo;
  const BsdfValue coat = evaluate(c.coat, i, o, Transport::importance, parts);
  BsdfValue value;
  if (parts.f) value.f = f_with_base(c, i, o, coat.f);
  if (parts.pdf) value.pdf = pdf_with_base(c, i, o, coat.pdf);
  if (parts.pdf_reverse) value.pdf_reverse = pdf_with_base(c, o, i, coat.pdf_reverse);
  return value;
}

template <class Base>
std::optional<BsdfSample> sample(const Coated<Base>& c, const Vec3& wi, float u_lobe, const Vec2& u,
                                 Transport /*symmetric*/) {
  const float side = std::copysign(1.0f, wi.z);
  const Vec3 i = side * wi;
  auto s = sample(c.coat, i, u_lobe, u, Transport::importance);
  if (!s) return std::nullopt;
  if (s->transmission) {
    HashRng rng(hash_words({hash_vec(i), std::bit_cast<std::uint32_t>(u_lobe), std::bit_cast<std::uint32_t>(u.x),
                            std::bit_cast<std::uint32_t>(u.y)}));
    s = walk_through(c, *s, rng);
    if (!s) return std::nullopt;
  }
  if (!s->delta) {
    s->pdf = evaluate(c, i, s->wo, Transport::importance, {.pdf = true}).pdf;
    s->pdf_is_exact = false;
  }
  s->wo *= side;
  return s;
}

template <class Base>
Spectrum albedo(const Coated<Base>& c, const Vec3& wi) {
  const float r = coat_reflectance(c.coat, wi);
  return Spectrum(r) + albedo_below(c, wi) * (1 - r);
}

template <class Base>
LobeWeights lobe_weights(const Coated<Base>& c, const Vec3& wi) {
  const float r = coat_reflectance(c.coat, wi);
  const float below = (1 - r) * max_component(albedo_below(c, wi));
  if (r + below <= 0) return {};
  const LobeWeights coat = lobe_weights(c.coat, wi);
  const LobeWeights base = lobes_below(c);
  const float share = r / (r + below);
  const float scattered = max_component(c.albedo) * (1 - std::exp(-2 * c.thickness));
  const float from_base = (1 - share) * (1 - scattered);
  LobeWeights sum{.diffuse = (1 - share) * scattered + from_base * base.diffuse,
                  .glossy = share * coat.glossy + from_base * base.glossy,
                  .delta = share * coat.delta + from_base * base.delta};
  if (coat.glossy > 0 && base.glossy > 0) {
    sum.alpha = std::min(coat.alpha, base.alpha);
  } else {
    sum.alpha = coat.glossy > 0 ? coat.alpha : base.alpha;
  }
  return sum;
}

template BsdfValue evaluate(const CoatedDiffuse&, const Vec3&, const Vec3&, Transport, BsdfParts);
template std::optional<BsdfSample> sample(const CoatedDiffuse&, const Vec3&, float, const Vec2&, Transport);
template Spectrum albedo(const CoatedDiffuse&, const Vec3&);
template LobeWeights lobe_weights(const CoatedDiffuse&, const Vec3&);
template BsdfValue evaluate(const CoatedConductor&, const Vec3&, const Vec3&, Transport, BsdfParts);
template std::optional<BsdfSample> sample(const CoatedConductor&, const Vec3&, float, const Vec2&, Transport);
template Spectrum albedo(const CoatedConductor&, const Vec3&);
template LobeWeights lobe_weights(const CoatedConductor&, const Vec3&);
template BsdfValue evaluate(const CoatedPlastic&, const Vec3&, const Vec3&, Transport, BsdfParts);
template std::optional<BsdfSample> sample(const CoatedPlastic&, const Vec3&, float, const Vec2&, Transport);
template Spectrum albedo(const CoatedPlastic&, const Vec3&);
template LobeWeights lobe_weights(const CoatedPlastic&, const Vec3&);

}  // namespace lanthorn
