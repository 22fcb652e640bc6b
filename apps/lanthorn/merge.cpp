// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "console.h"
#include "lanthorn/error.h"
#include "lanthorn/state.h"
#include "output.h"
#include "output_check.h"
#include "shards.h"

namespace lanthorn::program {
namespace {

namespace fs = std::filesystem;

struct MergeCommand {
  std::vector<std::string> inputs;
  std::string output;
  std::optional<PassRange> expected;
  OutputSettings settings;
};

// Adds states one by one. Memory holds only the sum and a few blocks of pixels.
class Merger {
 public:
  void add(const std::string& input) {
    const SavedState next(input);
    if (!sum_ || !next.identity_difference(*sum_))
      passes_.insert(passes_.end(), next.passes().begin(), next.passes().end());
    if (!sum_) {
      sum_ = next.load();
      return;
    }
    try {
      next.merge_into(*sum_);
    } catch (const Error& e) {
      throw Error({input}, e.message);
    }
  }
  /// Passes of all states of this render; passes that several states hold appear several times.
  const std::vector<PassRange>& passes() const { return passes_; }
  std::shared_ptr<RenderState> sum() const { return sum_; }

 private:
  std::shared_ptr<RenderState> sum_;
  std::vector<PassRange> passes_;
};

std::shared_ptr<RenderState> merge_all(const MergeCommand& o) {
  Merger merger;
  for (const std::string& input : o.inputs) merger.add(input);
  return merger.sum();
}

// Reports all problems, and the passes to render again.
std::shared_ptr<RenderState> merge_expected(const MergeCommand& o) {
  Merger merger;
  std::size_t refused = 0;
  for (const std::string& input : o.inputs) {
    try {
      merger.add(input);
    } catch (const Error& e) {
      say("lanthorn: {}\n", e.what());
      ++refused;
    }
  }
  const PassCheck check = check_passes(*o.expected, merger.passes());
  if (!check.doubled.empty()) say("lanthorn: several states hold passes {}\n", ranges_text(check.doubled));
  for (const PassRange& missing : check.missing)
    say("lanthorn: missing: render again with --pass-range {}:{}\n", missing.begin, missing.end);
  if (!check.missing.empty() || refused > 0)
    throw Error(
        fmt::format("--expect {}:{}: {} of {} states cannot be merged, {} ranges of passes missing: nothing is written",
                    o.expected->begin, o.expected->end, refused, o.inputs.size(), check.missing.size()));
  const std::vector<PassRange> passes = summarize(*merger.sum()).passes;
  if (passes.front().begin < o.expected->begin || passes.back().end > o.expected->end)
    throw Error(fmt::format("--expect {}:{}: the states also have other passes: {}", o.expected->begin, o.expected->end,
                            ranges_text(passes)));
  return merger.sum();
}

void run(const MergeCommand& o) {
  std::vector<InputFile> read;
  for (const std::string& input : o.inputs) read.push_back({input, "one of the states to merge"});
  check_outputs(read, {{o.output, "-o", output_extensions}}, o.settings.force);
  const std::shared_ptr<RenderState> merged = o.expected ? merge_expected(o) : merge_all(o);
  StatePicture picture(*merged, {o.output}, {}, o.settings.denoise);
  const StateSummary& summary = picture.summary();
  if (fs::path(o.output).extension() == ".state" && !o.settings.force)
    check_replaced_state(o.output, *merged, summary.passes, "merge it, too");
  write_output(o.output, picture, o.settings);
  announce("{}: {} passes of {} from {} files\n", o.output, summary.pass_count, summary.integrator, o.inputs.size());
  report_film(summary.report);
}

OptionTable merge_options(MergeCommand& a) {
  const OptionTable own{{.names = "STATES",
                         .value = each_into(a.inputs, text_type("FILE"), Arity::several),
                         .brief = "Saved states with disjoint passes of one render, in any order",
                         .required = true},
                        {.names = "--expect",
                         .value = into(a.expected, pass_range_type()),
                         .brief = "Require passes FIRST to END - 1 to be complete",
                         .details = "Otherwise nothing is written, and messages name missing, damaged and duplicate "
                                    "states, and the passes to render again.",
                         .otherwise = "any passes"},
                        required_file("-o,--output", a.output, "Output file: .state, .exr (all layers) or .png")};
  return joined(own, output_options(a.settings));
}

}  // namespace

void add_merge(CLI::App& app) {
  const auto a = std::make_shared<MergeCommand>();
  constexpr const char* footer =
      "The result has the same pixels as one render of all passes. The states must have one scene, method, seed and\n"
      "settings; methods whose passes depend on earlier ones (ppm, sppm) can be resumed but not merged.\n\n"
      "Example:\n"
      "  lanthorn render a.pbrt --pass-range 0:32  -o one.state\n"
      "  lanthorn render a.pbrt --pass-range 32:64 -o two.state\n"
      "  lanthorn merge one.state two.state -o a.exr";
  add_command(app, {"merge", "Merge shards of one render (files of --pass-range), exactly", merge_options(*a), footer,
                    [a] { run(*a); }});
}

}  // namespace lanthorn::program
