// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "shards.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/methods.h"
#include "lanthorn/scene.h"
#include "lanthorn/text.h"
#include "options.h"
#include "render_arguments.h"
#include "scene_changes.h"

namespace lanthorn::program {

namespace {

namespace fs = std::filesystem;

enum class Format : std::uint8_t { shell, slurm, json };

// The options that determine the picture.
struct PictureArguments : RenderArguments {
  SceneChanges changes;
};
OptionTable picture_options(PictureArguments& a) { return joined(render_options(a), scene_change_options(a.changes)); }

struct ShardsCommand : PictureArguments {
  std::uint64_t passes = 0, shards = 0;
  std::string output;
  Format format = Format::shell;
};

std::string stem_of(const ShardsCommand& a) { return fs::path(a.output).replace_extension().string(); }

// "picture.shard-007.state": padded, so that names sort in the order of passes.
std::string state_of(const ShardsCommand& a, std::uint64_t shard) {
  const std::size_t digits = fmt::formatted_size("{}", a.shards - 1);
  return fmt::format("{}.shard-{:0{}}.state", stem_of(a), shard, digits);
}

// Words that all shards share: the scene and the options that determine the picture.
std::string render_words(const ShardsCommand& a) {
  PictureArguments printed;  // starts with the defaults, which the table remembers
  const OptionTable table = picture_options(printed);
  printed = a;
  return command_line("lanthorn render", table);
}

std::string shard_command(const ShardsCommand& a, const PassRange& passes, std::uint64_t shard) {
  return fmt::format("{} --pass-range {}:{} -o {}", render_words(a), passes.begin, passes.end,
                     shell_word(state_of(a, shard)));
}

std::string merge_command(const ShardsCommand& a) {
  std::string text = fmt::format("lanthorn merge --expect 0:{}", a.passes);
  for (std::uint64_t i = 0; i < a.shards; ++i) text += ' ' + shell_word(state_of(a, i));
  return text + " -o " + shell_word(a.output);
}

void print_shell(const ShardsCommand& a) {
  print_text("#!/bin/sh\nset -e\n");
  const std::vector<PassRange> ranges = split_passes(a.passes, a.shards);
  for (std::uint64_t i = 0; i < a.shards; ++i) print_text(shard_command(a, ranges[i], i) + '\n');
  print_text(merge_command(a) + '\n');
}

void print_json(const ShardsCommand& a) {
  nlohmann::json shards = nlohmann::json::array();
  const std::vector<PassRange> ranges = split_passes(a.passes, a.shards);
  for (std::uint64_t i = 0; i < a.shards; ++i)
    shards.push_back({{"command", shard_command(a, ranges[i], i)},
                      {"passes", {ranges[i].begin, ranges[i].end}},
                      {"output", state_of(a, i)}});
  const nlohmann::json all{{"shards", std::move(shards)},
                           {"merge", {{"command", merge_command(a)}, {"output", a.output}}}};
  print_text(all.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
}

// A job that Slurm requeues, because its node failed or it was killed, resumes from its last checkpoint.
void print_slurm(const ShardsCommand& a) {
  const std::size_t digits = fmt::formatted_size("{}", a.shards - 1);
  print_text(fmt::format(
      R"(#!/bin/bash
# Run this where the scene lies. Its arguments go to sbatch: --partition=long --cpus-per-task=64
# The last job merges, or says which passes are missing.
set -e
job=$(sbatch --parsable --job-name={0} --array=0-{1} --requeue --open-mode=append "$@" <<'JOB'
#!/bin/bash
begin=$((SLURM_ARRAY_TASK_ID * {2} / {3})) end=$(((SLURM_ARRAY_TASK_ID + 1) * {2} / {3}))
state={4}$(printf %0{5}d $SLURM_ARRAY_TASK_ID).state
resume=(); [ -e "$state" ] && resume=(--resume "$state")
{6}{8} --pass-range $begin:$end --checkpoint 10m -o "$state" "${{resume[@]}}" && exit
code=$?  # above 128: killed, by a lack of memory or of power
[ $code -gt 128 ] && [ ${{SLURM_RESTART_COUNT:-0}} -lt 3 ] && scontrol requeue $SLURM_JOB_ID
exit $code
JOB
)
sbatch --parsable --job-name={0}-merge --dependency=afterany:$job "$@" <<'JOB'
#!/bin/bash
exec {7}
JOB
)",
      shell_word(fs::path(stem_of(a)).filename().string()), a.shards - 1, a.passes, a.shards,
      shell_word(stem_of(a) + ".shard-"), digits, render_words(a), merge_command(a),
      a.threads == 0 ? " --threads ${SLURM_CPUS_PER_TASK:-0}" : ""));
}

// The method of the options, or else of the scene file, which is read for this.
std::string method_of(const ShardsCommand& a) {
  if (a.options.integrator) return *a.options.integrator;
  return default_method(read_scene(a.scene, a.reading).hints.integrator).name;
}

void run(const ShardsCommand& a) {
  if (a.shards > a.passes)
    throw Error(fmt::format("--shards {}: expected at most one shard for each of the {} passes", a.shards, a.passes));
  const std::string extension = fs::path(a.output).extension().string();
  if (extension != ".exr" && extension != ".png" && extension != ".state")
    throw Error(fmt::format("-o {}: expected a name that ends in .exr, .png or .state", a.output));
  if (a.shards > 1) require_independent_passes("--shards", method_of(a));
  if (a.format == Format::shell) return print_shell(a);
  if (a.format == Format::json) return print_json(a);
  print_slurm(a);
}

OptionTable shards_options(ShardsCommand& a) {
  constexpr std::uint64_t most = 1'000'000;
  const OptionTable own{
      {.names = "-p,--passes",
       .value = into(a.passes, count_type({1, most})),
       .brief = "Passes of the whole picture",
       .required = true},
      {.names = "--shards",
       .value = into(a.shards, count_type({1, most})),
       .brief = "Number of jobs that share the passes",
       .required = true},
      {.names = "-o,--output",
       .value = into(a.output, text_type("FILE")),
       .brief = "The merged picture: .exr, .png or .state",
       .details = "The states of the shards lie beside it.",
       .required = true},
      {.names = "--format",
       .value = into(a.format,
                     choice_type<Format>({{"shell", Format::shell}, {"slurm", Format::slurm}, {"json", Format::json}})),
       .brief = "Print a shell script, a script that submits to Slurm, or JSON",
       .otherwise = "shell"}};
  return joined(picture_options(a), own);
}

}  // namespace

void add_shards(CLI::App& app) {
  const auto a = std::make_shared<ShardsCommand>();
  constexpr const char* footer =
      "Prints commands and renders nothing. The commands contain all options that decide the picture.\n\nExamples:\n"
      "  lanthorn shards a.pbrt -p 1000 --shards 50 -o a.exr > a.sh\n"
      "  lanthorn shards a.pbrt -p 1000 --shards 50 -o a.exr --format slurm > a.slurm.sh; bash a.slurm.sh -c 64";
  add_command(app, {"shards", "Print the commands that render a picture in parts, and merge it", shards_options(*a),
                    footer, [a] { run(*a); }});
}

}  // namespace lanthorn::program
