// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Frames of image-space photon mapping, stage by stage: bench_realtime SCENE [WIDTH HEIGHT [PHOTONS...]] A line for
// each radius and number of photons, by splats and by tiles: wall-clock time, and processor time, which other programs
// disturb less. Reports when OpenGL draws in software, and counts the shader invocations of a frame, from which its
// time on a GPU can be estimated (docs/lab/realtime.md).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "gl/context.h"
#include "lanthorn/scene.h"
#include "realtime/frame/renderer.h"

namespace lanthorn {

namespace {

constexpr std::uint32_t warm_up = 2, measured = 8;

struct Result {
  double milliseconds = 0, processor_milliseconds = 0;  // of a frame, of all threads
  FrameReport last;
  std::uint64_t vertices = 0, fragments = 0, computations = 0;  // shader invocations of the last frame
};

/// Counts shader invocations between its construction and the call of `count`; 0 if the driver does not support it.
class InvocationQuery {
 public:
  explicit InvocationQuery(GLenum kind) : kind_(kind) {
    glGenQueries(1, &query_);
    glBeginQuery(kind_, query_);
  }
  ~InvocationQuery() { glDeleteQueries(1, &query_); }
  InvocationQuery(const InvocationQuery&) = delete;
  InvocationQuery& operator=(const InvocationQuery&) = delete;

  std::uint64_t count() {
    glEndQuery(kind_);
    GLuint64 result = 0;
    glGetQueryObjectui64v(query_, GL_QUERY_RESULT, &result);
    return result;
  }

 private:
  GLenum kind_;
  GLuint query_ = 0;
};

Result run(Renderer& renderer, const View& view, FrameSettings settings) {
  Result result;
  for (std::uint32_t frame = 0; frame < warm_up + measured; ++frame) {
    settings.views.frame = frame;
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t processor_begin = std::clock();
    renderer.draw(view, settings);
    glFinish();
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - begin;
    if (frame >= warm_up) {
      result.milliseconds += spent.count() / measured;
      result.processor_milliseconds +=
          1e3 * static_cast<double>(std::clock() - processor_begin) / CLOCKS_PER_SEC / measured;
    }
    result.last = renderer.report();
  }
  if (epoxy_has_gl_extension("GL_ARB_pipeline_statistics_query")) {
    InvocationQuery vertices(GL_VERTEX_SHADER_INVOCATIONS_ARB), fragments(GL_FRAGMENT_SHADER_INVOCATIONS_ARB),
        computations(GL_COMPUTE_SHADER_INVOCATIONS_ARB);
    settings.views.frame = warm_up + measured;
    renderer.draw(view, settings);
    result.vertices = vertices.count();
    result.fragments = fragments.count();
    result.computations = computations.count();
  }
  return result;
}

void print(const char* name, std::uint32_t photons, const Result& r) {
  fmt::print("{:>8} photons, {:<6} {:8.1f} ms a frame, {:5.1f} Hz, {:8.1f} ms of processors; last frame:", photons,
             name, r.milliseconds, 1000 / r.milliseconds, r.processor_milliseconds);
  for (const gl::StageTime& stage : r.last.stages) fmt::print(" {} {:.1f}", stage.stage, stage.milliseconds);
  fmt::print("; photons by bounce");
  for (const std::uint64_t count : r.last.photons_per_bounce) fmt::print(" {}", count);
  fmt::print("; million vertices {:.3f}, fragments {:.3f}, computations {:.3f}\n",
             1e-6 * static_cast<double>(r.vertices), 1e-6 * static_cast<double>(r.fragments),
             1e-6 * static_cast<double>(r.computations));
}

int run(int argc, char** argv) {
  const auto number = [&](int i) { return static_cast<std::uint32_t>(std::strtoul(argv[i], nullptr, 10)); };
  const SharedScene scene = build_scene(read_scene(argv[1]));
  ViewOptions options;
  options.resolution = {argc > 3 ? static_cast<int>(number(2)) : 320, argc > 3 ? static_cast<int>(number(3)) : 180};
  std::vector<std::uint32_t> counts;
  for (int i = 4; i < argc; ++i) counts.push_back(number(i));
  if (counts.empty()) counts = {5000, 20000, 50000, 200000};
  const gl::Context context = gl::Context::headless();
  fmt::print("{} by {}\n", context.driver().renderer, context.driver().platform);
  if (context.driver().software) fmt::print("*** SOFTWARE: the CPU drew this. These are not GPU times. ***\n");
  Renderer renderer(*scene);
  const View view = make_view(scene->description().view, options);
  fmt::print("{} triangles, {} x {}\n", renderer.gpu_scene().triangles(), view.window.width(), view.window.height());
  FrameSettings settings;
  for (const float share : {0.05f, 0.02f}) {  // the viewer's initial radius, and that after some frames at rest
    const float radius = share * scene->bounding_sphere().radius;
    fmt::print("radius {:.3g} m, {:.0f} % of the scene's\n", radius, 100 * share);
    for (const std::uint32_t count : counts)
      for (const auto& [name, gather] : {std::pair{"splats", "splat"}, {"tiles", "tiles"}}) {
        // A radius that does not change from frame to frame.
        settings.technique =
            TechniqueChoice("ispm", {{"radius", fmt::format("{}", radius)}, {"gather", gather}, {"alpha", "1"}});
        settings.photons = count;
        print(name, count, run(renderer, view, settings));
      }
  }
  return 0;
}

}  // namespace

}  // namespace lanthorn

int main(int argc, char** argv) {
  try {
    if (argc > 1) return lanthorn::run(argc, argv);
    fmt::print("usage: bench_realtime SCENE [WIDTH HEIGHT [PHOTONS...]]\n");
  } catch (const lanthorn::Error& e) {
    fmt::print("bench_realtime: {}\n", e.what());
  }
  return 2;
}
