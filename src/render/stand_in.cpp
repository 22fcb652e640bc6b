// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render/stand_in.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/parallel.h"

namespace lanthorn {

namespace {

double pixels_of(const RenderPlan& plan) { return static_cast<double>(plan.state.film.pixel_count()); }

// For each pixel of a film, the pixel of a coarser film of the same view that contains its centre.
std::vector<std::uint32_t> coarse_pixels(const View& view, const View& coarse) {
  const auto place = [](int i, int size, int coarse_size, int begin, int end) {
    const auto at = static_cast<int>((i + 0.5) * coarse_size / size);
    return std::clamp(at, begin, end - 1) - begin;
  };
  const PixelWindow &window = view.window, &from = coarse.window;
  std::vector<std::uint32_t> pixels;
  pixels.reserve(static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height()));
  for (int y = window.y0; y < window.y1; ++y) {
    const int row = place(y, view.camera.height(), coarse.camera.height(), from.y0, from.y1);
    for (int x = window.x0; x < window.x1; ++x)
      pixels.push_back(static_cast<std::uint32_t>(
          row * from.width() + place(x, view.camera.width(), coarse.camera.width(), from.x0, from.x1)));
  }
  return pixels;
}

// The mean of a pixel is that of the coarser pixel, in all its layers, so that its sums are the same.
void enlarge(const Film& coarse, const std::vector<std::uint32_t>& pixels, Film& film) {
  constexpr std::size_t chunk = 1u << 14;
  for (std::size_t i = 0; i < film.plane_count(); ++i) {
    const std::vector<std::int64_t> plane = coarse.plane(i);
    if (std::all_of(plane.begin(), plane.end(), [](std::int64_t sum) { return sum == 0; })) continue;
    parallel_chunks(pixels.size(), chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      std::vector<std::int64_t> enlarged;
      enlarged.reserve(end - begin);
      for (std::size_t p = begin; p < end; ++p) enlarged.push_back(plane[pixels[p]]);
      film.add_sums(i, begin, enlarged);
    });
  }
  FilmReport report = coarse.report();
  report.first_non_finite.reset();  // pixels of the coarse film
  report.first_too_large.reset();
  film.add_report(report);
}

}  // namespace

StandIn::StandIn(const Scene& scene, const RenderPlan& plan, RenderPasses render)
    : scene_(scene), plan_(plan), render_passes_(std::move(render)), full_(pixels_of(plan)) {}

// False if there was no time; the last picture is then kept.
bool StandIn::render(double pixels, const StopRule& stop) {
  RenderPlan coarse = plan_.coarse(scene_, std::sqrt(pixels / full_));
  const RenderStatistics statistics = render_passes_(coarse, stop, has_picture());
  const std::uint64_t passes = coarse.state.pass_count();
  if (passes == 0) return false;
  seconds_per_pixel_ =
      (statistics.seconds - statistics.prepare_seconds) / static_cast<double>(passes) / pixels_of(coarse);
  statistics_ = statistics;
  coarse_.emplace(std::move(coarse));
  return true;
}

bool StandIn::allows_pass(const std::function<double()>& seconds_left, const std::atomic<bool>* drop,
                          const std::atomic<bool>* deadline) {
  constexpr double first = 1024, growth = 4;  // pixels
  // Coarse pictures may take an eighth of the time. A pass may take half of it, because few pixels measure it poorly,
  // or more once they are a sixteenth of all.
  constexpr double share = 0.125, likely = 0.5, measured = 0.8, enough = 1.0 / 16;
  const std::uint64_t begin = plan_.stop.passes.begin;
  for (double pixels = std::min(first, full_ / 4); growth * pixels <= full_; pixels *= growth) {
    const std::atomic<bool>* const flag = has_picture() ? deadline : drop;
    if (!render(pixels, {.passes = {begin, begin + 1}, .drop = flag, .undo = Undo::never})) return false;
    const double left = seconds_left(), prepared = statistics_.prepare_seconds;
    if (prepared + seconds_per_pixel_ * full_ < (pixels < enough * full_ ? likely : measured) * left) return true;
    if (prepared + growth * (statistics_.seconds - prepared) > share * left) return false;
  }
  return true;
}

void StandIn::refine(double seconds, const StopRule& stop) {
  // Four passes: the two halves of the passes then show the noise.
  constexpr double passes = 4, most_of_time = 0.8;
  const double pixels = most_of_time * (seconds - statistics_.prepare_seconds) / passes / seconds_per_pixel_;
  StopRule rest = stop;
  rest.seconds = seconds;
  rest.noise.reset();
  rest.error_of = {};
  constexpr double finer = 1.5;
  if (pixels > finer * pixels_of(*coarse_)) render(std::min(pixels, full_ / 2), rest);
}

void StandIn::put_into(RenderPlan& plan, RenderStatistics& statistics) {
  RenderState& state = plan.state;
  RenderState& coarse = coarse_->state;
  enlarge(coarse.film, coarse_pixels(plan.view, coarse_->view), state.film);
  state.passes = coarse.passes;
  state.seconds += coarse.seconds;
  state.eye += coarse.eye;
  state.light += coarse.light;
  const PixelWindow& crop = coarse_->view.crop;
  state.record.identity.coarse = {crop.width(), crop.height()};
  const double seconds = statistics.seconds;
  statistics = statistics_;
  statistics.seconds = seconds;
  statistics.coarse = CoarsePicture{crop.width(), crop.height(), seconds_per_pixel_ * full_};
}

void remove_stand_in(RenderPlan& plan) {
  if (!plan.state.record.identity.coarse) return;
  const double seconds = plan.state.seconds;
  plan.state = empty_like(plan.state);
  plan.state.seconds = seconds;
  plan.state.record.identity.coarse.reset();
}

}  // namespace lanthorn
