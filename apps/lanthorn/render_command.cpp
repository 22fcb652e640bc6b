// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "render_command.h"

#include <utility>

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

}  // namespace

OptionTable render_command_options(RenderCommand& a) {
  constexpr std::uint64_t most_places = 1'000'000;
  OptionTable files{
      outputs_option(a.outputs, "Where to write the picture", "the name in the scene file"),
      {.names = "-p,--passes",
       .value = into(a.options.passes, count_type({1, most_passes})),
       .brief = "Passes to render (samples per pixel for path)",
       .otherwise = "the scene file's, else 64"},
      {.names = "-t,--time",
       .value = into(a.options.seconds, duration_type()),
       .brief = "Stop after the passes that are running at this time: 30s, 1.5m, 2h"},
      {.names = "--noise",
       .value = into(a.options.noise, share_type()),
       .brief = "Stop when the picture's error is below this, such as 2%",
       .details = "The error (noise and bias) is measured while rendering and is below the bound with a "
                  "probability of 90 %. It is the root mean square of each value's relative error, where dark "
                  "values are compared to a tenth of the picture's mean. -p and -t remain limits."},
      {.names = "--pass-range",
       .value = into(a.options.pass_range, pass_range_type()),
       .brief = "Passes FIRST:END (END not included), for a shard to be merged with others",
       .excludes = "--passes"},
      {.names = "--checkpoint",
       .value = interval(a.checkpoint_seconds, a.no_checkpoint),
       .brief = "Save the state at this interval (90s, 10m) and keep it, or none",
       .details = "The file is a .state beside the first output. none saves no states while rendering.",
       .otherwise = "every ten minutes, in a file that is removed after the render"},
      {.names = "--preview",
       .value = interval(a.preview_seconds, a.no_preview),
       .brief = "Update the pictures while rendering, at intervals of at least this (5s), or none",
       .details = "They are written after the first pass and each time the elapsed time has doubled. none writes them "
                  "at the end "
                  "alone.",
       .otherwise = "2s on a terminal; else none"},
      {.names = "--tev",
       .value = into(a.tev, text_type("HOST:PORT")),
       .brief = "Show the picture in the viewer tev while it is rendered, such as localhost:14158",
       .details = "tev gets all layers."},
      {.names = "--turntable",
       .value = into(a.turntable, count_type({1, most_places})),
       .brief = "Render this many pictures from all around the model, to -o NAME.####.png",
       .details = "The camera turns to the right around what it looks at; --at chooses the time of an animation."},
      {.names = "--frames",
       .value = into(a.frames, frame_range_type()),
       .brief = "Render the frames FIRST:END (END not included) of a glTF animation, to -o NAME.####.png",
       .details = "The frame's number replaces ####. Frame 0 is at 0 seconds. With --turntable: "
                  "numbers of its pictures.",
       .otherwise = "24 frames a second"},
      {.names = "--resume",
       .value = into(a.resume, existing_file_type()),
       .brief = "Continue a saved state of the same scene and settings"},
      {.names = "--json",
       .value = into(a.json, text_type("FILE")),
       .brief = "Write statistics (times, rays, photons, memory) as JSON"}};
  OptionTable table = joined(joined(render_options(a), scene_change_options(a.changes)), std::move(files));
  table = joined(std::move(table), output_options(a.output));
  table.push_back({.names = "-q,--quiet", .value = flag(a.quiet), .brief = "No progress, no closing line"});
  table.push_back({.names = "-v,--verbose",
                   .value = flag(a.verbose),
                   .brief = "Show the variance and work of a pass that auto predicts for each choice"});
  return table;
}

std::string render_command_line(const RenderCommand& arguments) {
  RenderCommand printed;  // starts with the defaults, which the table remembers
  const OptionTable table = render_command_options(printed);
  printed = arguments;
  return command_line("lanthorn render", table);
}

}  // namespace lanthorn::program
