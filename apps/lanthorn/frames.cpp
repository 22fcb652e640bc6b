// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "frames.h"

#include <fmt/format.h>

#include <string>

#include "lanthorn/error.h"

namespace lanthorn::program {

namespace {

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
