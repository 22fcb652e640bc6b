// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Renders small scenes in-process, for the transport and conformance tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "integrators/integrator.h"
#include "lanthorn/image.h"
#include "lanthorn/scene.h"
#include "render/plan.h"
#include "scene/scene.h"
#include "support/statistics.h"

namespace lanthorn::test {

/// Renders with the view of the scene's file.
inline RenderPlan plan_render(const Scene& scene, const RenderOptions& options) {
  return lanthorn::plan_render(scene, scene.description().view, options);
}

inline RenderState render_state(const Scene& scene, const RenderOptions& options, RenderState resumed = {}) {
  RenderPlan plan = test::plan_render(scene, options);
  if (resumed.film.width() > 0) plan.state = std::move(resumed);
  render(scene, plan, plan.stop);
  const FilmReport lost = plan.state.film.report();
  // Light of any strength may exceed a film's range; a NaN sample is a defect.
  EXPECT_EQ(lost.non_finite, 0u) << plan.state.integrator << ": " << describe_problems(lost).value_or("");
  plan.state.seconds = 0;  // the only part of a state that may differ between equal renders
  return std::move(plan.state);
}

inline Image render_image(const Scene& scene, const RenderOptions& options) {
  const RenderState state = render_state(scene, options);
  return picture_of(state);
}

inline Scene scene_from_text(const std::string& text, const std::filesystem::path& folder = ".") {
  return Scene(read_pbrt_string(text, folder, "test scene"));
}

/// `integrator`: its name, followed by parameters after colons: "mlt:over=path". The seed is test::seed(number).
inline RenderOptions options_for(const std::string& integrator, std::uint64_t passes, std::uint64_t number = 0) {
  RenderOptions options;
  std::istringstream words(integrator);
  std::string word;
  std::getline(words, word, ':');
  options.integrator = word;
  while (std::getline(words, word, ':')) {
    const std::size_t equals = word.find('=');
    options.set[word.substr(0, equals)] = word.substr(equals + 1);
  }
  options.passes = passes;
  options.seed = seed(number);
  return options;
}

/// True if a method, named as for `options_for`, has this parameter.
inline bool has_parameter(const std::string& integrator, const std::string& name) {
  const std::vector<ParameterInfo>& known = find_integrator(integrator.substr(0, integrator.find(':'))).parameters;
  return std::any_of(known.begin(), known.end(), [&](const ParameterInfo& p) { return p.name == name; });
}

/// True if a method estimates densities: such methods take a "radius".
inline bool has_radius(const std::string& integrator) { return has_parameter(integrator, "radius"); }

/// For test names: everything except letters and digits becomes an underscore.
inline std::string identifier(std::string text) {
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return text;
}

}  // namespace lanthorn::test
