// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/pass_undo.h"

#include <chrono>
#include <fstream>
#include <limits>
#include <new>
#include <string>
#include <utility>

namespace lanthorn {

namespace {

constexpr double shortest_pass = 1;        // seconds; shorter ones are finished
constexpr double passes_per_copy = 50;     // a copy costs at most 2 % of the time
constexpr double copied_per_second = 1e9;  // bytes; a guess, until a copy has been timed
constexpr double share_of_memory = 0.25;

// Bytes that can be had without swapping; none if the system does not say.
double available_memory() {
  std::ifstream in("/proc/meminfo");
  std::string name;
  double kibibytes = 0;
  for (std::string unit; in >> name >> kibibytes; std::getline(in, unit))
    if (name == "MemAvailable:") return kibibytes * 1024;
  return 0;
}

// The old film is gone before the new one is made.
void clear(Film& film) {
  const int width = film.width(), height = film.height(), exponent = film.step_exponent();
  const FilmContents contents = film.contents();
  film = Film();
  film = Film::with_exponent(width, height, exponent, contents);
}

}  // namespace

bool PassUndo::begin(const RenderState& state, std::optional<double> pass_seconds) {
  // An empty film can be made again.
  if (rule_ == Undo::never || state.pass_count() == 0) return true;
  if (rule_ == Undo::always || is_worth_it(state, pass_seconds)) return copy(state.film);
  copy_.reset();
  return false;
}

bool PassUndo::is_worth_it(const RenderState& state, std::optional<double> pass_seconds) const {
  const auto bytes = static_cast<double>(state.film.memory());
  if (bytes > share_of_memory * available_memory() && !copy_) return false;
  // Of a render that is resumed nothing is known: its first pass may be long.
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
  if (rule_ == Undo::never)
    state.passes.clear();
  else if (state.pass_count() == 0)
    clear(film);
  else
    film = std::move(*copy_);
  copy_.reset();
}

}  // namespace lanthorn
