// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "console.h"
#include "lanthorn/text.h"

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

// Width of the terminal; unlimited if it does not report one.
std::size_t columns() {
  winsize size{};
  const bool is_known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? size.ws_col : std::string::npos;
}

// A line that wraps could not be redrawn. Drops the bar first, then the end of the text.
std::string fitted(double fraction, const std::string& text) {
  const std::string bare = fmt::format("{:3.0f} %  {}", 100 * fraction, text);
  const std::string whole = fmt::format("[{}] {}", bar(fraction), bare);
  const std::size_t width = columns();
  return whole.size() < width ? whole : bare.substr(0, width - 1);
}

std::string progress_text(const RenderProgress& progress, const RenderStatistics& s) {
  const double seconds = std::max(1e-9, s.seconds);
  std::string text = fmt::format("pass {}", s.passes);
  if (progress.passes_left) text += fmt::format("/{}", s.passes + *progress.passes_left);
  if (s.light_paths > 0)
    text += fmt::format("  {} photons/s", format_count(static_cast<double>(s.light_paths) / seconds));
  text += fmt::format("  {} rays/s", format_count(static_cast<double>(s.rays.walk + s.rays.shadow) / seconds));
  if (s.radius > 0) text += fmt::format("  radius {:.3g} m", s.radius);
  if (s.volume_radius > 0) text += fmt::format("  in media {:.3g} m", s.volume_radius);
  if (s.error) text += "  error " + describe_error(*s.error);
  if (progress.seconds_left) text += fmt::format("  {} left", format_duration(*progress.seconds_left));
  return text;
}

}  // namespace

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

ProgressDisplay::ProgressDisplay(const StopRule& stop, bool quiet) : stop_(stop), line_(quiet) {}

void ProgressDisplay::update(const RenderState& state, const RenderStatistics& statistics) {
  const RenderProgress progress = progress_of(stop_, state, statistics);
  line_.show(progress.fraction, statistics.seconds, [&] { return progress_text(progress, statistics); });
}

}  // namespace lanthorn::program
