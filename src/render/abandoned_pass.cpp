// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/abandoned_pass.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <new>
#include <system_error>
#include <utility>

#include "base/memory.h"

namespace lanthorn {

namespace {

constexpr double shortest_pass = 1;        // seconds; shorter ones are finished
constexpr double passes_per_copy = 50;     // a copy costs at most 2 % of the time
constexpr double copied_per_second = 1e9;  // bytes; a guess, until a copy has been timed
constexpr double share_of_memory = 0.25;

// Frees the old film before the new one is made.
void clear(Film& film) {
  const int width = film.width(), height = film.height(), exponent = film.step_exponent();
  const FilmContents contents = film.contents();
  film = Film();
  film = Film::with_exponent(width, height, exponent, contents);
}

}  // namespace

Deadline::Deadline(const std::atomic<bool>* drop, std::optional<Clock::time_point> time) : drop_(drop) {
  if (!time) return;
  try {
    thread_ = std::thread([this, at = *time] { watch(at); });
  } catch (const std::system_error&) {  // the limit of threads: see `flag`
  }
}

Deadline::~Deadline() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  ending_.notify_all();
  thread_.join();
}

// A signal handler may set `drop_`, so this thread must look at it now and then.
void Deadline::watch(Clock::time_point time) {
  constexpr std::chrono::milliseconds interval{10};
  std::unique_lock lock(mutex_);
  while (!ends_ && !(drop_ && drop_->load()) && Clock::now() < time)
    ending_.wait_until(lock, drop_ ? std::min(time, Clock::now() + interval) : time);
  is_set_ = !ends_;
}

bool PassUndo::begin(const RenderState& state, std::optional<double> pass_seconds) {
  // Before the first pass no copy is needed: an empty film can be made again.
  if (rule_ == Undo::never || state.pass_count() == 0) return true;
  if (rule_ == Undo::always || is_worth_it(state, pass_seconds)) return copy(state.film);
  copy_.reset();
  return false;
}

bool PassUndo::is_worth_it(const RenderState& state, std::optional<double> pass_seconds) const {
  const auto bytes = static_cast<double>(state.film.memory());
  const auto available = available_memory();
  if (!copy_ && !(available && bytes <= share_of_memory * static_cast<double>(*available))) return false;
  // The duration of a resumed render's passes is not known: assume long ones.
  const double expected = pass_seconds.value_or(std::numeric_limits<double>::infinity());
  return expected > shortest_pass && expected > passes_per_copy * copy_seconds_.value_or(bytes / copied_per_second);
}

bool PassUndo::copy(const Film& film) try {
  const auto start = std::chrono::steady_clock::now();
  copy_ = film;
  copy_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return true;
} catch (const std::bad_alloc&) {
  copy_.reset();
  return false;
}

void PassUndo::restore(RenderState& state) {
  Film& film = state.film;
  if (state.pass_count() == 0)
    clear(film);
  else if (rule_ == Undo::never)
    state.passes.clear();
  else
    film = std::move(*copy_);
  copy_.reset();
}

}  // namespace lanthorn
