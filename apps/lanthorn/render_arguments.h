// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The options of all commands that render: everything that determines the picture.
#pragma once

#include <cstdint>
#include <string>

#include "lanthorn/render_options.h"
#include "lanthorn/scene.h"
#include "options.h"

namespace lanthorn::program {

struct RenderArguments {
  std::string scene;
  RenderOptions options;
  unsigned threads = 0;
  ReadOptions reading;
};

/// The scene and its options. Each command adds `passes` itself.
OptionTable render_options(RenderArguments& arguments);
/// How a scene is read: --sandbox, --missing, ...
OptionTable read_options(ReadOptions& options);
/// Types of the values of --environment-rotate and --environment-scale.
ValueType<float> environment_rotation_type();
ValueType<float> environment_scale_type();
/// --max-pixels: limit for each picture that is read.
Option max_pixels_option(std::uint64_t& max_pixels);
/// --threads. `independence`: a sentence about what does not depend on it.
Option threads_option(unsigned& threads, const std::string& independence = "The picture does not depend on it.");

}  // namespace lanthorn::program
