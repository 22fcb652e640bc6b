// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/primary_samples.h"

#include <cmath>

#include "math/hash.h"
#include "math/vec.h"

namespace lanthorn {

namespace {

// Two independent normal deviates (Box & Muller 1958).
Vec2 normal_deviates(HashRng& rng) {
  const float radius = std::sqrt(-2 * std::log1p(-rng.next()));
  const float angle = 2 * pi * rng.next();
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

float wrapped(float x) {
  const float fraction = x - std::floor(x);
  return fraction < 1 ? fraction : 0.0f;  // rounding of a tiny negative number gives 1
}

}  // namespace

void PrimarySamples::start(std::uint64_t key) {
  entries_.clear();
  key_ = key;
  time_ = redrawn_ = redrawn_before_ = 1;
  number_ = 0;
}

void PrimarySamples::propose(Mutation mutation) {
  ++time_;
  ++number_;
  redrawn_before_ = redrawn_;
  if (mutation == Mutation::large) redrawn_ = time_;
}

void PrimarySamples::accept() { redrawn_before_ = redrawn_; }

void PrimarySamples::reject() {
  for (Entry& entry : entries_)
    if (entry.modified == time_) static_cast<Numbers&>(entry) = entry.before;
  redrawn_ = redrawn_before_;
  --time_;
}

PrimarySamples::Entry& PrimarySamples::up_to_date(std::uint32_t index) {
  if (index >= entries_.size()) entries_.resize(index + 1);
  Entry& entry = entries_[index];
  if (entry.modified == time_) return entry;
  // First restores the group's state before the proposed mutation: an accepted large mutation may have redrawn it since
  // it was last read. Each of the two draws uses its own hash word.
  if (entry.modified < redrawn_before_) {
    draw(entry, index, 0);
    entry.modified = redrawn_before_;
  }
  entry.before = entry;
  if (redrawn_ == time_ && redrawn_ > redrawn_before_)
    draw(entry, index, 1);
  else if (entry.modified < time_)
    perturb(entry, index, time_ - entry.modified);
  entry.modified = time_;
  return entry;
}

void PrimarySamples::draw(Numbers& numbers, std::uint32_t index, std::uint64_t salt) const {
  HashRng rng(hash_words({key_, number_, index, salt}));
  for (float& x : numbers.values) x = rng.next();
  numbers.seed = hash_words({key_, number_, index, salt, 1});
}

void PrimarySamples::perturb(Numbers& numbers, std::uint32_t index, std::uint64_t mutations) const {
  constexpr float kept = 0.875f;  // probability with which a mutation keeps a seed
  HashRng rng(hash_words({key_, number_, index, 2}));
  // The sum of `mutations` independent normal deviates is normal, with variance `mutations` times sigma².
  const float sigma = sigma_ * std::sqrt(static_cast<float>(mutations));
  for (std::size_t i = 0; i < group_size; i += 2) {
    const Vec2 step = sigma * normal_deviates(rng);
    numbers.values[i] = wrapped(numbers.values[i] + step.x);
    numbers.values[i + 1] = wrapped(numbers.values[i + 1] + step.y);
  }
  if (rng.next() >= std::pow(kept, static_cast<float>(mutations))) numbers.seed = hash_words({key_, number_, index, 3});
}

}  // namespace lanthorn
