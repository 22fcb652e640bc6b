// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/render.h"

#include <atomic>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "io/image.h"
#include "io/read_scene.h"
#include "lanthorn/error.h"
#include "render/render.h"
#include "render/session.h"
#include "scene/media_check.h"
#include "scene/scene.h"

namespace lanthorn {

namespace {

RenderOptions options_of(const RenderRequest& request) {
  RenderOptions options;
  if (!request.integrator.empty()) options.integrator = request.integrator;
  options.passes = request.passes;
  options.seconds = request.seconds;
  options.seed = request.seed;
  options.set = request.parameters;
  options.memory = request.memory;
  if (request.width.has_value() != request.height.has_value())
    throw Error("a render request needs both width and height, or neither");
  if (request.width) options.resolution = {*request.width, *request.height};
  return options;
}

}  // namespace

Image render(const RenderRequest& request) {
  const RenderOptions options = options_of(request);
  const ThreadLimit limit(request.threads);
  SceneDescription description =
      read_scene(request.scene, {.sandbox = request.sandbox, .max_pixels = request.max_pixels});
  View view = make_view(description, options);
  const Scene scene(std::move(description));
  const auto warn = [&](const std::vector<description::Warning>& warnings) {
    for (const description::Warning& warning : warnings) request.warning(warning.location, warning.message);
  };
  if (request.warning) {
    warn(scene.warnings());
    warn(media_warnings(scene, view));
  }

  Session session = open_session(scene, std::move(view), options);
  if (const std::string limitation = session.integrator->limitation(scene); !limitation.empty() && request.warning)
    request.warning({}, limitation);
  std::atomic<bool> stopped{false};
  session.stop.interrupted = &stopped;
  session.stop.drop = request.stop;
  session.stop.undo = Undo::always;
  Observer observer;
  if (request.progress)
    observer.progress = [&](const RenderState& state, const RenderStatistics&) {
      if (!request.progress(state.pass_count())) stopped = true;
    };
  RenderStatistics statistics;
  const RenderState state = render(scene, session, observer, statistics);
  if (state.pass_count() == 0) throw Error("stopped before the end of the first pass");
  if (const auto problem = describe_problems(state.film.report()); problem && request.warning)
    request.warning({}, *problem);
  return state.film.resolve(state.pass_count());
}

void save(const Image& image, const std::filesystem::path& path) {
  write_image(path, image, DisplaySettings{}, nlohmann::json::object());
}

}  // namespace lanthorn
