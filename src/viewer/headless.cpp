// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "gl/context.h"
#include "lanthorn/denoise.h"
#include "lanthorn/methods.h"
#include "lanthorn/session.h"
#include "lanthorn/viewer.h"
#include "scene/medium_around.h"
#include "viewer/accumulation.h"
#include "viewer/realtime_view.h"

namespace lanthorn {

namespace {

ViewerFrames offline_frames(const SharedScene& scene, const ViewDescription& view, const ViewerOptions& options) {
  RenderOptions render = options.render;
  render.integrator = find_method(options.method).name;
  render.passes = options.frames;
  Session session(scene, view, render);
  const RenderStatistics statistics = session.render();
  ViewerFrames result{with_noise(session.state(), session.picture()), {}};
  result.report.method = options.method;
  result.report.frames = statistics.passes;
  result.report.seconds = statistics.seconds;
  for (const description::Warning& warning : session.warnings()) result.report.limitations.push_back(warning.message);
  if (!options.denoises) return result;
  if (options.frames > 1)
    result.image = denoise(result.image).picture;
  else
    result.report.limitations.emplace_back(
        "a picture of a single pass is not denoised: the noise is the difference of passes");
  return result;
}

ViewerFrames realtime_frames(const SharedScene& scene, const ViewDescription& description,
                             const ViewerOptions& options) {
  if (!is_drawable(description))
    throw Error(description.camera.location,
                "a rasteriser draws for perspective and orthographic cameras only; offline methods draw for this one");
  const View view = view_in(*scene, description, options.render);
  if (options.denoises)
    throw Error(options.method + " draws by OpenGL: only pictures of offline methods can be denoised");
  const RealtimeSettings settings = realtime_settings(*scene, view, options);
  const gl::Context context = gl::Context::headless();
  Renderer renderer(*scene);
  Accumulation sum(view.window.width(), view.window.height());
  StageSums stages;
  ViewerFrames result;
  const ViewerClock::time_point start = ViewerClock::now();
  for (std::uint32_t frame = 0; frame < options.frames; ++frame) {
    renderer.draw(view, frame_settings(settings, view, frame));
    sum.add(renderer, view.imaging_ratio);
    FrameReport report = renderer.report();
    stages.add(report);
    result.report.photons_per_bounce = std::move(report.photons_per_bounce);
  }
  result.report.seconds = seconds_since(start);
  result.image = sum.read();
  renderer.log().check();
  result.report.method = options.method;
  result.report.driver = context.driver().renderer;
  result.report.software = context.driver().software;
  result.report.frames = options.frames;
  result.report.stages = stages.means();
  result.report.limitations = limitations_of(renderer, *scene, settings);
  return result;
}

}  // namespace

ViewerFrames render_frames(const SharedScene& scene, const ViewDescription& view, const ViewerOptions& options) {
  try {
    ViewerFrames result = find_technique(options.method) != nullptr ? realtime_frames(scene, view, options)
                                                                    : offline_frames(scene, view, options);
    result.report.width = result.image.width;
    result.report.height = result.image.height;
    return result;
  } catch (const gl::Unavailable& e) {
    throw ViewerUnavailable(e.message);
  }
}

}  // namespace lanthorn
