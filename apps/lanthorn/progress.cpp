// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "console.h"

namespace lanthorn::program {

namespace {

constexpr double redraw_seconds = 0.1;  // on a terminal
constexpr double plain_seconds = 10;    // elsewhere
constexpr double plain_fraction = 0.1;

std::string bar(double fraction) {
  constexpr int width = 24;
  const int filled = static_cast<int>(fraction * width);
  return std::string(static_cast<std::size_t>(filled), '#') +
         std::string(static_cast<std::size_t>(width - filled), '.');
}

// Of the terminal; without limit where it does not say.
std::size_t columns() {
  winsize size{};
  const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? size.ws_col : std::string::npos;
}

// A line that wraps could not be drawn over. The bar is left out first, then the end.
std::string fitted(double fraction, const std::string& text) {
  const std::string bare = fmt::format("{:3.0f} %  {}", 100 * fraction, text);
  const std::string whole = fmt::format("[{}] {}", bar(fraction), bare);
  const std::size_t width = columns();
  return whole.size() < width ? whole : bare.substr(0, width - 1);
}

std::uint64_t passes_left(const PassRange& asked, const RenderState& start) {
  std::uint64_t left = asked.end - asked.begin;
  for (const PassRange& done : summarize(start).passes) {
    const std::uint64_t begin = std::max(asked.begin, done.begin), end = std::min(asked.end, done.end);
    if (begin < end) left -= end - begin;
  }
  return left;
}

}  // namespace

std::string format_duration(double seconds) {
  const auto s = static_cast<std::int64_t>(std::max(0.0, seconds) + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
  return fmt::format("{}:{:02}:{:02} h", s / 3600, s / 60 % 60, s % 60);
}

std::string format_count(double count) {
  if (count >= 1e9) return fmt::format("{:.2f} G", count / 1e9);
  if (count >= 1e6) return fmt::format("{:.2f} M", count / 1e6);
  if (count >= 1e3) return fmt::format("{:.1f} k", count / 1e3);
  return fmt::format("{:.0f}", count);
}

double seconds_left(double fraction, double seconds) { return fraction > 0 ? seconds * (1 - fraction) / fraction : 0; }

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

void ProgressLine::show(double fraction, double seconds, const std::function<std::string()>& text) {
  if (quiet_) return;
  const double since = seconds - shown_at_;
  const bool due =
      shown_at_ < 0 || fraction >= 1 ||
      (terminal_ ? since >= redraw_seconds : since >= plain_seconds || fraction - shown_fraction_ >= plain_fraction);
  if (!due) return;
  shown_at_ = seconds;
  shown_fraction_ = fraction;
  if (terminal_)
    say_text(fmt::format("\r{}\x1b[K", fitted(fraction, text())));
  else
    say("{:3.0f} %  {}\n", 100 * fraction, text());
  line_open_ = terminal_;
}

void ProgressLine::finish() {
  if (line_open_) say("\n");
  line_open_ = false;
}

ProgressDisplay::ProgressDisplay(const StopRule& stop, const RenderState& start, bool quiet)
    : passes_to_do_(passes_left(stop.passes, start)), seconds_(stop.seconds), noise_(stop.noise), line_(quiet) {}

double ProgressDisplay::fraction_done(const RenderStatistics& statistics, std::uint64_t state_passes) const {
  double fraction =
      static_cast<double>(statistics.passes) / static_cast<double>(std::max<std::uint64_t>(1, passes_to_do_));
  if (seconds_) fraction = std::max(fraction, statistics.seconds / *seconds_);
  if (noise_) fraction = std::max(fraction, fraction_of_noise(statistics, state_passes));
  return std::min(1.0, fraction);
}

// Of the passes of this run that the bound needs: at most nearly all, until it is reached.
double ProgressDisplay::fraction_of_noise(const RenderStatistics& statistics, std::uint64_t state_passes) const {
  if (!statistics.error || !statistics.error->is_known()) return 0;
  if (statistics.error->is_below(*noise_)) return 1;
  const double needed = growth_to_reach(*statistics.error, *noise_) * static_cast<double>(statistics.error_passes);
  const auto before = static_cast<double>(state_passes - statistics.passes);
  return std::min(0.99, static_cast<double>(statistics.passes) / std::max(1.0, needed - before));
}

std::string ProgressDisplay::text(const RenderStatistics& s, double fraction) const {
  const double seconds = std::max(1e-9, s.seconds);
  const bool is_endless = passes_to_do_ > 1u << 31;
  std::string text =
      !is_endless ? fmt::format("pass {}/{}", s.passes, passes_to_do_) : fmt::format("pass {}", s.passes);
  if (s.light_paths > 0)
    text += fmt::format("  {} photons/s", format_count(static_cast<double>(s.light_paths) / seconds));
  text += fmt::format("  {} rays/s", format_count(static_cast<double>(s.rays.walk + s.rays.shadow) / seconds));
  if (s.radius > 0) text += fmt::format("  radius {:.3g} m", s.radius);
  if (s.volume_radius > 0) text += fmt::format("  in media {:.3g} m", s.volume_radius);
  if (s.error) text += "  error " + describe_error(*s.error);
  const bool is_known = !is_endless || seconds_ || (s.error && s.error->is_known());
  return is_known ? text + fmt::format("  {} left", format_duration(seconds_left(fraction, s.seconds))) : text;
}

void ProgressDisplay::update(const RenderState& state, const RenderStatistics& statistics) {
  const double fraction = fraction_done(statistics, summarize(state).pass_count);
  line_.show(fraction, statistics.seconds, [&] { return text(statistics, fraction); });
}

}  // namespace lanthorn::program
