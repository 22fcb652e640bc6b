// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Renders in progress.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <utility>

#include "bindings.h"
#include "lanthorn/methods.h"
#include "lanthorn/scene.h"
#include "lanthorn/session.h"

namespace lanthorn::python {

namespace {

using std::uint64_t;

// A session shared by Python threads: one at a time renders, and the GIL is released meanwhile.
class PythonSession {
 public:
  PythonSession(const SeenScene& scene, const RenderOptions& options)
      : scene_(scene), session_(scene.scene, scene.view, options), integrator_(options.integrator) {}

  /// Renders according to the plan, or to these limits. Throws Python's KeyboardInterrupt after the current pass if the
  /// user interrupts; completed passes are kept.
  void render(std::optional<uint64_t> passes, std::optional<double> seconds, std::optional<double> noise) {
    const std::lock_guard lock = locked();
    StopRule stop = session_.plan();
    if (passes || seconds || noise) {
      const uint64_t done = statistics_.coarse ? 0 : session_.pass_count();
      stop.passes.end = passes ? stop.passes.begin + done + *passes : std::numeric_limits<uint64_t>::max();
      stop.seconds = seconds;
      stop.noise = noise;
    }
    run(stop);
  }
  void stop() { is_stopped_ = true; }

  Picture picture(bool noise) {
    const std::lock_guard lock = locked();
    require_pass();
    return picture_of_state(session_.state(), noise);
  }
  Picture denoised() { return python::denoised(picture(true)); }
  std::string method() const {
    return integrator_ ? *integrator_ : default_method(description_of(*scene_.scene).hints.integrator).name;
  }
  uint64_t pass_count() const { return session_.pass_count(); }
  std::vector<description::Warning> warnings() const { return session_.warnings(); }
  SeenScene scene() const { return scene_; }  // a copy, which an assignment of another scene does not change
  const RenderStatistics& statistics() const { return statistics_; }
  uint64_t planned_passes() const { return session_.plan().passes.end - session_.plan().passes.begin; }

  void set_scene(const SeenScene& scene) {
    const std::lock_guard lock = locked();
    if (scene.scene != scene_.scene) session_.set_scene(scene.scene);
    session_.set_view(scene.view);
    scene_ = scene;
  }
  void save(const std::filesystem::path& path) {
    const std::lock_guard lock = locked();
    require_pass();
    save_state(session_.state(), path);
  }
  void resume(const std::filesystem::path& path) {
    const std::lock_guard lock = locked();
    session_.resume(open_state(path), path.string());
    statistics_ = {};
  }

 private:
  // Never blocks: the thread that holds the lock may be waiting for the GIL.
  std::lock_guard<std::mutex> locked() {
    if (!mutex_.try_lock()) throw Error("the session is rendering in another thread");
    return {mutex_, std::adopt_lock};
  }
  void require_pass() const {
    if (session_.pass_count() == 0) throw Error("there is no picture before the end of the first pass");
  }
  void run(StopRule& stop) {
    std::optional<py::error_already_set> raised;
    is_stopped_ = false;
    stop.interrupted = &is_stopped_;
    Observer observer;
    observer.progress = [&](const RenderState&, const RenderStatistics&) {
      const py::gil_scoped_acquire acquire;
      if (raised || PyErr_CheckSignals() == 0) return;
      raised.emplace();
      is_stopped_ = true;
    };
    RenderStatistics statistics = without_gil([&] { return session_.render(stop, observer); });
    statistics_ = std::move(statistics);  // with the GIL, because other threads may read it
    if (raised) throw py::error_already_set(std::move(*raised));
  }

  std::mutex mutex_;
  std::atomic<bool> is_stopped_{false};
  SeenScene scene_;
  Session session_;
  std::optional<std::string> integrator_;
  RenderStatistics statistics_;
};

using SharedSession = std::shared_ptr<PythonSession>;

// Iterator for: for picture in session.passes(64)
struct Passes {
  SharedSession session;
  uint64_t left;

  Picture next() {
    if (left == 0) throw py::stop_iteration();
    --left;
    session->render(1, {}, {});
    const py::gil_scoped_release release;
    return session->picture(false);
  }
};

py::dict statistics_as_dict(const PythonSession& session) {
  const RenderStatistics& s = session.statistics();
  py::dict data;
  data["passes"] = s.passes;
  data["seconds"] = s.seconds;
  data["prepare_seconds"] = s.prepare_seconds;
  for (std::size_t i = 0; i < phase_count; ++i)
    data[(std::string(phase_name(static_cast<Phase>(i))) + "_seconds").c_str()] = s.phase_seconds[i];
  data["rays"] = s.rays.walk + s.rays.shadow;
  data["light_paths"] = s.light_paths;
  data["photons_stored"] = s.photons_stored;
  data["radius"] = s.radius;
  if (s.coarse) data["coarse"] = py::make_tuple(s.coarse->width, s.coarse->height);
  return data;
}

std::string session_text(const PythonSession& s) {
  return "<lanthorn.Session " + s.method() + ", " + std::to_string(s.pass_count()) + " of " +
         std::to_string(s.planned_passes()) + " passes>";
}

std::string session_help() {
  std::string options;
  for_each_render_option([&](const auto& option) { options.append(option.name).append(", "); });
  return "Renders a scene pass by pass, with the picture available at any time.\n\n"
         "Keyword arguments are the options of `lanthorn render`:\n" +
         options +
         "passes, seconds, noise, pass_range.\n"
         "resolution is (width, height), crop (x0, y0, x1, y1), color 'rgb' or 'spectral', photons the light paths "
         "per\n"
         "pass, memory in bytes, noise the error at which to stop (0.02 is 2 %), pass_range (first, end). Other "
         "keywords\n"
         "are parameters of the method (see `methods`). Raises Error for unknown options and invalid values.\n\n"
         "Rendering does not hold the GIL. Ctrl-C raises KeyboardInterrupt after the current pass; the session keeps "
         "all\n"
         "passes and can continue.";
}

void bind_passes(py::module_& module) {
  py::class_<Passes>(module, "Passes", "The pictures of a session, pass by pass: see Session.passes.")
      .def(
          "__iter__", [](const py::object& self) { return self; }, "Itself.")
      .def("__next__", &Passes::next, "Renders a pass and returns its Picture.");
}

}  // namespace

void bind_session(py::module_& module) {
  bind_passes(module);
  py::class_<PythonSession, SharedSession>(module, "Session", session_help().c_str())
      .def(py::init([](const SeenScene& scene, const py::kwargs& options) {
             const RenderOptions read = options_of(options);
             const py::gil_scoped_release release;
             return std::make_shared<PythonSession>(scene, read);
           }),
           py::arg("scene"), "Session(scene, **options): checks the options and prepares the film.")
      .def(
          "render",
          [](PythonSession& self, std::optional<uint64_t> passes, std::optional<double> seconds,
             std::optional<double> noise) {
            self.render(passes, seconds, noise);
            const py::gil_scoped_release release;
            return self.picture(false);
          },
          py::kw_only(), py::arg("passes") = py::none(), py::arg("seconds") = py::none(), py::arg("noise") = py::none(),
          "Renders as the options say; or `passes` more, or for `seconds`, or until the error is below `noise`.\n"
          "Returns the Picture.")
      .def(
          "passes",
          [](const SharedSession& self, uint64_t count) {
            return Passes{self, count};
          },
          py::arg("count"),
          "for picture in session.passes(64): renders a pass at a time and yields the Picture after each.")
      .def("stop", &PythonSession::stop, "Ends `render`, called by another thread, after the current pass.")
      .def("picture", &PythonSession::picture, py::kw_only(), py::arg("noise") = false,
           py::call_guard<py::gil_scoped_release>(),
           "The Picture of the completed passes, with all layers. noise: adds the layers that `denoise` needs.")
      .def("denoised", &PythonSession::denoised, py::call_guard<py::gil_scoped_release>(),
           "The Picture of the completed passes, denoised layer by layer.")
      .def("save", &PythonSession::save, py::arg("path"), py::call_guard<py::gil_scoped_release>(),
           "Saves the sums, whole or not at all, to be resumed or merged.")
      .def("resume", &PythonSession::resume, py::arg("path"), py::call_guard<py::gil_scoped_release>(),
           "Continues from a saved state. Raises Error, naming the first difference, if it belongs to another render.")
      .def_property(
          "scene", &PythonSession::scene, &PythonSession::set_scene,
          "Scene: the scene rendered. Assigning another one, such as scene.edit(...), restarts with the same options.")
      .def_property_readonly("pass_count", &PythonSession::pass_count, "int: completed passes.")
      .def_property_readonly("planned_passes", &PythonSession::planned_passes, "int: passes that the options ask for.")
      .def_property_readonly(
          "warnings", [](const PythonSession& s) { return texts_of(s.warnings()); },
          "list of str: unsupported features of the scene, and light that the method cannot render.")
      .def_property_readonly("statistics", &statistics_as_dict,
                             "dict: passes, seconds, rays, photons ... of the last call of `render`; `coarse`, if the "
                             "time did not\nsuffice for a pass: width and height of the picture before it was "
                             "enlarged.")
      .def("__repr__", &session_text);
}

}  // namespace lanthorn::python
