// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <memory>
#include <type_traits>

#include "surface/bsdf.h"

namespace lanthorn {

namespace detail {
inline constexpr Bsdf no_closure{};
}

/// The closure at a point: the material's own closure if that is the same everywhere, as in most materials, otherwise
/// one made for the point. Converts to `Bsdf`. The scene must outlive it.
class PointBsdf {
 public:
  /// Any closure, to be replaced. It is not made in place, because points are default-constructed often.
  PointBsdf() : of_material_(&detail::no_closure) {}
  /// A closure made for the point.
  template <class Closure>
  requires std::constructible_from<Bsdf, const Closure&> PointBsdf(const Closure& closure) : own_(closure) {}
  /// The material's own closure.
  explicit PointBsdf(const Bsdf* of_material) : of_material_(of_material) {}
  PointBsdf(const PointBsdf& other) : of_material_(other.of_material_) { copy_own(other); }
  PointBsdf& operator=(const PointBsdf& other) {
    if (this == &other) return *this;
    of_material_ = other.of_material_;
    copy_own(other);
    return *this;
  }

  /// Replaces the closure by one made for the point.
  template <class Closure>
  requires std::constructible_from<Bsdf, const Closure&>
  void emplace(const Closure& closure) {
    std::construct_at(&own_, closure);
    of_material_ = nullptr;
  }

  const Bsdf& get() const { return of_material_ != nullptr ? *of_material_ : own_; }
  operator const Bsdf&() const { return get(); }

 private:
  static_assert(std::is_trivially_copyable_v<Bsdf>);
  void copy_own(const PointBsdf& other) {
    if (of_material_ == nullptr) std::construct_at(&own_, other.own_);
  }

  const Bsdf* of_material_ = nullptr;
  union {
    // Constructed only if of_material_ is null, because points are copied often.
    Bsdf own_;  // NOLINT(readability-identifier-naming): private, which clang-tidy does not see of a union's member
  };
};

/// True if the closure is another one on facets whose shading normal is not the geometric one (`Bent`): if no light
/// passes through the surface.
bool is_bendable(const Bsdf& bsdf);
/// Replaces such a closure by that of a facet with the normals `plane` and `horizon`, unit, in the shading frame.
/// Returns false if it stays, because `plane` is the shading normal up to rounding.
bool bend(PointBsdf& bsdf, const Normal& plane, const Normal& horizon);

}  // namespace lanthorn
