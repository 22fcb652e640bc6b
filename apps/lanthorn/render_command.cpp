// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render_command.h"

#include <fmt/format.h>

#include <utility>

#include "lanthorn/error.h"

namespace lanthorn::program {

namespace {

OptionValue interval(std::optional<double>& seconds, bool& none) {
  using Interval = std::optional<double>;
  return through<Interval>(
      duration_or_none_type(),
      [&](Interval value) {
        seconds = value;
        none = !value;
      },
      [&]() -> std::optional<Interval> {
        return seconds || none ? std::optional<Interval>(std::in_place, seconds) : std::nullopt;
      });
}

OptionTable report_options(RenderCommand& a) {
  return {{.names = "-q,--quiet", .value = flag(a.quiet), .brief = "Print no progress and no summary"},
          {.names = "-v,--verbose",
           .value = flag(a.verbose),
           .brief = "Show the variance and the work that auto expects of each choice"}};
}

// Replaces the last run of "#" by the number, padded with zeros to the run's length.
std::string numbered(const std::string& name, std::uint64_t number) {
  const std::size_t end = name.rfind('#') + 1;
  std::size_t begin = end;
  while (begin > 0 && name[begin - 1] == '#') --begin;
  return name.substr(0, begin) + fmt::format("{:0{}}", number, end - begin) + name.substr(end);
}

void check_name(const std::string& option, const std::string& name) {
  if (name.find('#') == name.npos)
    throw Error(fmt::format("{} {}: expected #### in the name, where the number of the frame goes", option, name));
}

}  // namespace

OptionTable render_command_options(RenderCommand& a) {
  constexpr std::uint64_t most_places = 1'000'000;
  OptionTable files{
      outputs_option(a.outputs, "Write the picture", "the name in the scene file"),
      {.names = "-p,--passes",
       .value = into(a.options.passes, count_type({1, most_passes})),
       .brief = "Number of passes (for path: samples per pixel)",
       .otherwise = "the scene file's, else 64"},
      {.names = "-t,--time",
       .value = into(a.options.seconds, duration_type()),
       .brief = "Stop after this time: 30s, 1.5m, 2h",
       .details = "Running passes are completed."},
      {.names = "--noise",
       .value = into(a.options.noise, share_type()),
       .brief = "Stop when the estimated error is below this: 5%",
       .details = "The program estimates noise and bias while rendering. When it stops, the error is below the bound "
                  "with a probability of 90 %. The error is the root mean square of the relative errors of all values; "
                  "the denominator is at least a tenth of the picture's mean. With --denoise, the bound is for the "
                  "denoised picture. -p and -t still apply."},
      {.names = "--pass-range",
       .value = into(a.options.pass_range, pass_range_type()),
       .brief = "Render passes FIRST to END - 1 alone: a shard to merge with others",
       .excludes = "--passes"},
      {.names = "--checkpoint",
       .value = interval(a.checkpoint_seconds, a.no_checkpoint),
       .brief = "Save the state at this interval (90s, 10m) and keep it; or none",
       .details = "The file is a .state beside the first output. none saves no state while rendering.",
       .otherwise = "every ten minutes, in a file that is removed at the end"},
      {.names = "--preview",
       .value = interval(a.preview_seconds, a.no_preview),
       .brief = "Write the picture while it is rendered, at this interval (5s) or more; or none",
       .details =
           "It is written after the first pass and then at intervals that double. none writes it only at the end.",
       .otherwise = "2s on a terminal, else none"},
      {.names = "--tev",
       .value = into(a.tev, text_type("HOST:PORT")),
       .brief = "Show the picture in the viewer tev while it is rendered, such as localhost:14158",
       .details = "tev gets all layers."},
      {.names = "--turntable",
       .value = into(a.turntable, count_type({1, most_places})),
       .brief = "Render COUNT views around the model to NAME.####.png",
       .details = "The camera turns to the right around its target; --at chooses the time of an animation."},
      {.names = "--frames",
       .value = into(a.frames, frame_range_type()),
       .brief = "Render frames FIRST to END - 1 of a glTF animation to NAME.####.png",
       .details = "#### becomes the number of the frame. Frame 0 is at 0 seconds. With --turntable, FIRST:END selects "
                  "views of the turntable.",
       .otherwise = "24 frames a second"},
      {.names = "--resume",
       .value = into(a.resume, existing_file_type()),
       .brief = "Continue a saved state of the same scene and settings"},
      file_option("--json", a.json, "Write statistics (times, rays, photons, memory) as JSON")};
  const OptionTable of_scene = joined(render_options(a), scene_change_options(a.changes));
  return joined(joined(joined(of_scene, std::move(files)), output_options(a.output)), report_options(a));
}

std::string render_command_line(const RenderCommand& arguments) {
  RenderCommand printed;  // starts with the defaults, which the table remembers
  const OptionTable table = render_command_options(printed);
  printed = arguments;
  return command_line("lanthorn render", table);
}

void check_frames(const RenderCommand& a) {
  const char* const option = a.turntable ? "--turntable" : "--frames";
  if (a.outputs.empty()) throw Error(fmt::format("{}: expected -o NAME.####.png, where the pictures go", option));
  for (const std::string& name : a.outputs) check_name("-o", name);
  if (!a.json.empty()) check_name("--json", a.json);
  if (!a.resume.empty()) throw Error(fmt::format("--resume: is of one picture, and does not go with {}", option));
  if (!a.turntable && a.reading.at)
    throw Error("--at: the frames of --frames have their own times; --at goes with --turntable");
  if (a.turntable && a.frames && a.frames->end > *a.turntable)
    throw Error(fmt::format("--frames {}:{}: --turntable {} has the frames 0:{}", a.frames->begin, a.frames->end,
                            *a.turntable, *a.turntable));
}

FrameRange frames_of(const RenderCommand& a) { return a.frames.value_or(FrameRange{0, a.turntable.value_or(1)}); }

RenderCommand of_frame(const RenderCommand& a, std::uint64_t frame) {
  RenderCommand one = a;
  for (std::string& name : one.outputs) name = numbered(name, frame);
  if (!a.json.empty()) one.json = numbered(a.json, frame);
  if (!a.turntable) one.reading.at = static_cast<double>(frame) / frames_of(a).per_second;
  return one;
}

}  // namespace lanthorn::program
