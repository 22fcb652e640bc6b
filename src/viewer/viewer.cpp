// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The loop of the window: input, then a frame, then the picture and the panel.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <fstream>
#include <future>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include "camera/view.h"
#include "film/display.h"
#include "gl/context.h"
#include "lanthorn/denoise.h"
#include "lanthorn/file.h"
#include "lanthorn/interactive_render.h"
#include "lanthorn/methods.h"
#include "lanthorn/text.h"
#include "lanthorn/viewer.h"
#include "scene/medium_around.h"
#include "viewer/accumulation.h"
#include "viewer/edited_scene.h"
#include "viewer/interaction.h"
#include "viewer/offline_command.h"
#include "viewer/panel.h"
#include "viewer/picking.h"
#include "viewer/realtime_view.h"

namespace lanthorn {

namespace {

namespace fs = std::filesystem;

/// The window, and the OpenGL context that is current as long as it is there.
class OpenWindow {
 public:
  OpenWindow(const std::string& title, int width, int height) : functions_(window_functions()) {
    std::string failure;
    window_ = functions_.open(title.c_str(), width, height, failure);
    if (window_ == nullptr) throw ViewerUnavailable("no window can be opened: " + failure);
  }
  OpenWindow(const OpenWindow&) = delete;
  OpenWindow& operator=(const OpenWindow&) = delete;
  ~OpenWindow() { functions_.close(window_); }

  Input read(bool may_wait, int width, int height, Panel& panel) const {
    return functions_.read(window_, may_wait, width, height, panel);
  }
  /// `width`, `height`: of the picture in full.
  void show(const gl::Texture& picture, int width, int height, Panel& panel) const {
    constexpr std::array<GLfloat, 4> background{0.06f, 0.062f, 0.066f, 1};
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glClearNamedFramebufferfv(0, GL_COLOR, 0, background.data());
    functions_.show(window_, picture.name(), width, height, panel);
  }
  void copy(const std::string& text) const { functions_.copy(window_, text.c_str()); }

 private:
  const WindowFunctions& functions_;
  void* window_ = nullptr;
};

Ray middle_ray(const View& view) {
  return ray_through(view,
                     0.5f * Vec2(static_cast<float>(view.window.width()), static_cast<float>(view.window.height())));
}

// Distance of the point around which the camera turns: the surface in the middle of the picture.
float first_distance(const Scene& scene, const View& view, const Picker& picker) {
  const Ray ray = middle_ray(view);
  if (const auto hit = picker.pick(ray)) return hit->distance;
  const BoundingSphere sphere = scene.bounding_sphere();
  return std::max(std::sqrt(distance_squared(ray.origin, sphere.centre)), 0.1f * sphere.radius);
}

// The camera turns around the subject that it frames, or else around the surface in the middle of the picture.
CameraPose first_pose(const ViewDescription& description, const Scene& scene, const View& view, const Picker& picker) {
  const description::Camera& camera = description.camera;
  if (!camera.subject) return pose_of(camera.camera_to_world.start, first_distance(scene, view, picker));
  return framing_pose(camera, middle_ray(view).origin);
}

ToneSettings::Curve window_curve(ToneCurve curve) {
  if (curve == ToneCurve::filmic) return ToneSettings::Curve::filmic;
  if (curve == ToneCurve::highlights) return ToneSettings::Curve::highlights;
  return curve == ToneCurve::agx ? ToneSettings::Curve::agx : ToneSettings::Curve::clipped;
}

// For the panel; nothing if the picture is not denoised.
std::string describe_denoised(const std::shared_ptr<const InteractiveDenoised>& denoised) {
  if (!denoised) return {};
  return fmt::format("{} passes{}", denoised->passes, denoised->is_preview ? ", preview" : "");
}

// The first name of the form STEM-N.EXTENSION that no file has.
fs::path free_name(const fs::path& folder, const std::string& stem, const std::string& extension) {
  for (int n = 1;; ++n) {
    fs::path path = folder / fmt::format("{}-{}{}", stem, n, extension);
    std::error_code code;
    if (!fs::exists(path, code)) return path;
  }
}

class Viewer {
 public:
  Viewer(const SharedScene& scene, const ViewDescription& description, const ViewerOptions& options);
  ViewerReport run();

 private:
  void make_panel();
  void apply_panel();
  void apply(const Input& input);
  void apply_wishes();
  void note_change();
  void forget_frames();
  void draw();
  void draw_frame();
  Accumulation& picture_of(const View& view);
  void measure();
  std::string notice() const;
  void refine();
  void start_render();
  std::shared_ptr<const Image> offline_image() const;
  void load_offline_image();
  void update_information();
  void present();
  void save_picture(const std::string& extension);
  void save_exr();
  void report_saved();
  fs::path save_scene();
  std::string command() const;
  void copy_command();
  bool rests() const { return seconds_since(last_change_) > rest_seconds; }
  bool may_wait() const;

  static constexpr double rest_seconds = 0.3;  // before an offline method or exact frames begin
  static constexpr std::uint64_t most_frames = 4096;
  static constexpr std::uint32_t soft_frames = 8;  // whose mean would show the texels of shadow maps

  ViewerOptions options_;
  ViewDescription description_;
  View view_;
  Picker picker_;
  EditedScene scene_;
  Interaction interaction_;
  SharedScene original_, shown_scene_;
  OpenWindow window_;
  gl::Driver driver_;
  Renderer renderer_;
  Accumulation picture_;
  std::optional<Accumulation> small_;        // while things move, if frames in full would take long
  bool is_small_ = false;                    // the frame that is shown
  std::optional<InteractiveRender> render_;  // of the offline method, if one is chosen
  bool render_is_stale_ = false;             // camera or scene have changed since its last edit
  Panel panel_, before_;
  StageSums stages_;
  EyePathSpacing eye_path_spacing_;
  MovingResolution moving_resolution_;
  // The frame that was drawn last while something moves: when it began, and its share of the resolution.
  std::optional<std::pair<ViewerClock::time_point, double>> moving_frame_;
  bool shown_is_exact_ = true;  // the last frame
  std::shared_ptr<const InteractivePicture> offline_;
  std::shared_ptr<const InteractiveDenoised> denoised_;  // of the same edit
  std::shared_ptr<const Image> loaded_;                  // of these, the one that is shown
  std::future<std::string> saving_;                      // its message
  // The last saved file, with the camera and the scene that it holds.
  fs::path saved_file_;
  Transform saved_camera_;
  SharedScene saved_scene_;
  bool is_black_ = false;               // the picture that was measured last
  float brightest_ = 0;                 // of that picture
  std::uint64_t next_measurement_ = 1;  // frames in the mean
  ViewerClock::time_point started_ = ViewerClock::now(), last_change_ = ViewerClock::now();
  std::uint64_t frames_ = 0;
};

constexpr float metres_per_second_share = 0.4f;  // of the scene's radius: flying

Viewer::Viewer(const SharedScene& scene, const ViewDescription& description, const ViewerOptions& options)
    : options_(options),
      description_(drawable(description)),
      view_(view_in(*scene, description_, options.render)),
      picker_(*scene),
      scene_(scene, options.light_factors),
      interaction_(first_pose(description_, *scene, view_, picker_),
                   metres_per_second_share * scene->bounding_sphere().radius),
      original_(scene),
      shown_scene_(scene),
      window_("Lanthorn: " + options.scene_file.filename().string(), view_.window.width(), view_.window.height()),
      driver_(gl::current_driver("window")),
      renderer_(*scene),
      picture_(view_.window.width(), view_.window.height()),
      saved_file_(options.scene_file),
      saved_camera_(interaction_.pose().camera_to_world),
      saved_scene_(scene) {
  make_panel();
  if (!is_drawable(description))
    panel_.message = "The scene's camera is shown as a perspective one, which OpenGL can draw.";
  description_.camera = placed(description_.camera, interaction_.pose());
}

void Viewer::make_panel() {
  for (const TechniqueInfo* technique : technique_registry()) {
    panel_.techniques.push_back(technique->description);
    panel_.techniques.back().parameters = all_parameters(technique->description);
    panel_.methods.push_back(technique->description.name);
  }
  for (const MethodInfo& method : methods())
    if (find_technique(method.name) == nullptr) panel_.methods.push_back(method.name);
  const auto chosen = std::find(panel_.methods.begin(), panel_.methods.end(), options_.method);
  if (chosen == panel_.methods.end()) find_method(options_.method);  // throws Error that lists the methods
  panel_.method = static_cast<std::size_t>(chosen - panel_.methods.begin());
  panel_.settings = realtime_settings(*original_, view_, options_);
  panel_.scene_radius = original_->bounding_sphere().radius;
  panel_.exposure = options_.display.exposure;
  panel_.measures_exposure = options_.measures_exposure;
  panel_.denoises = options_.denoises;
  panel_.curve = options_.display.curve;
  panel_.lights = scene_.lights();
  panel_.scene = options_.scene_file.filename().string();
  panel_.driver = driver_.renderer;
  panel_.notes = limitations_of(renderer_, *original_, panel_.settings);
  panel_.can_save_scene = lower_extension(options_.scene_file) == ".pbrt";
  before_ = panel_;
}

void Viewer::note_change() {
  last_change_ = ViewerClock::now();
  render_is_stale_ = true;
  offline_.reset();
  denoised_.reset();
  loaded_.reset();
  panel_.is_offline = false;
  forget_frames();
}

void Viewer::forget_frames() {
  picture_.reset();
  if (small_) small_->reset();
  stages_ = {};
  next_measurement_ = 1;
}

// Applies the user's changes in the panel.
void Viewer::apply_panel() {
  for (std::size_t i = 0; i < panel_.lights.size(); ++i) {
    if (panel_.lights[i] == scene_.lights()[i]) continue;
    try {
      scene_.set_light(i, panel_.lights[i]);
    } catch (const Error& e) {
      panel_.message = e.message;
      panel_.lights[i] = scene_.lights()[i];
      continue;
    }
    note_change();
  }
  if (panel_.method != before_.method || !(panel_.settings == before_.settings)) {
    panel_.settings.technique = panel_.wants_offline() ? stand_in_technique : panel_.methods[panel_.method];
    panel_.notes = limitations_of(renderer_, *original_, panel_.settings);
    render_.reset();
    note_change();
  }
  if (panel_.denoises != before_.denoises && render_) render_->denoise(panel_.denoises);
  before_.denoises = panel_.denoises;
  before_.method = panel_.method;
  before_.settings = panel_.settings;
}

void Viewer::apply(const Input& input) {
  const Interaction::Change change = interaction_.apply(input, view_, picker_, scene_, panel_);
  if (change.scene) panel_.lights = scene_.lights();
  if (change.scene || change.camera) note_change();
  if (!(interaction_.pose().camera_to_world == description_.camera.camera_to_world.start)) {
    description_.camera = placed(description_.camera, interaction_.pose());
    view_ = view_in(*scene_.scene(), description_, options_.render);
  }
}

void Viewer::apply_wishes() {
  Wishes wishes = std::exchange(panel_.wishes, {});
  if (is_small_ && !offline_) {  // pictures in motion: they are saved once they rest and have their full size
    panel_.wishes.save_png = std::exchange(wishes.save_png, false);
    panel_.wishes.save_exr = std::exchange(wishes.save_exr, false);
  }
  report_saved();
  if (saving_.valid()) panel_.wishes.save_exr |= std::exchange(wishes.save_exr, false);  // one after the other
  try {
    if (wishes.save_png) save_picture(".png");
    if (wishes.save_exr) save_exr();
    if (wishes.save_scene) save_scene();
    if (wishes.copy_command) copy_command();
  } catch (const Error& e) {
    panel_.message = e.what();
  }
  if (wishes.reset_camera) {
    interaction_.go_home();
    apply(Input{});
    note_change();
  }
  if (wishes.reset_scene) {
    if (scene_.is_edited()) scene_ = EditedScene(original_);
    panel_.lights = scene_.lights();
    note_change();
  }
}

void Viewer::draw_frame() {
  const bool is_exact = rests();
  const double share = is_exact ? 1 : moving_resolution_.share();
  const int spacing = is_exact ? 1 : eye_path_spacing_.pixels();
  if (is_exact && !shown_is_exact_) forget_frames();  // the mean is of frames that are exact
  if (picture_.frames() >= most_frames) return;
  const ViewerClock::time_point start = ViewerClock::now();
  View view = view_;
  if (share < 1) {
    view = make_view(description_, scaled(options_.render, description_.film, share));
    view.medium = view_.medium;
  }
  Accumulation& picture = picture_of(view);
  const auto frame = static_cast<std::uint32_t>(picture.frames());
  FrameSettings settings = frame_settings(panel_.settings, view, frame);
  settings.eye_path_spacing = spacing;
  settings.has_stand_ins = !is_exact;
  settings.disperses = settings.disperses && is_exact;
  settings.has_soft_edges = frame < soft_frames;
  shown_is_exact_ = is_exact || (share == 1 && spacing == 1 && !renderer_.gpu_scene().has_stand_ins());
  renderer_.draw(view, settings);
  picture.add(renderer_, view.imaging_ratio);
  FrameReport report = renderer_.report();
  if (!is_exact) moving_frame_.emplace(start, share);
  eye_path_spacing_.learn(report, spacing);
  stages_.add(report);
  panel_.stages = stages_.means();
  panel_.photons_per_bounce = std::move(report.photons_per_bounce);
  panel_.frames = picture.frames();
  ++frames_;
}

// The accumulation to which frames of this view are added.
Accumulation& Viewer::picture_of(const View& view) {
  const int width = view.window.width(), height = view.window.height();
  is_small_ = width != picture_.width() || height != picture_.height();
  if (!is_small_) return picture_;
  if (!small_ || small_->width() != width || small_->height() != height) small_.emplace(width, height);
  return *small_;
}

// After 1, 4, 16 ... frames at rest, and with each picture of an offline method.
void Viewer::measure() {
  if (is_small_ && !offline_) return;
  const Image image = offline_ ? offline_->image : picture_.read();
  is_black_ = std::none_of(image.pixels.begin(), image.pixels.end(), [](float value) { return value > 0; });
  if (panel_.measures_exposure && !is_black_) panel_.exposure = measured_exposure(image);
  brightest_ = brightest_level(image);
}

std::string Viewer::notice() const {
  if (panel_.wants_offline() && !offline_) return fmt::format("First pass by {} ...", panel_.methods[panel_.method]);
  if (!is_black_) return {};
  if (scene_.scene()->lights().empty()) return "The scene has no light: the picture is black.";
  const TechniqueInfo* technique = find_technique(panel_.methods[panel_.method]);
  if (technique != nullptr && !technique->description.has_light_views && scene_.scene()->infinite_lights().empty())
    return fmt::format("Black: {} lights by the environment alone, and the scene has none. Choose another method.",
                       technique->description.name);
  return "The picture is black: no light that the camera sees.";
}

void Viewer::start_render() {
  RenderOptions render = options_.render;
  render.integrator = panel_.methods[panel_.method];
  if (render.integrator != options_.method) render.set.clear();  // parameters of another method
  try {
    render_.emplace(scene_.scene(), description_, render,
                    InteractiveSettings{.coarse_first = false, .denoises = panel_.denoises});
    render_is_stale_ = false;
  } catch (const Error& e) {
    panel_.message = e.message;
    panel_.method = 0;
  }
}

// An offline method starts when the input rests; until its first pass is done, frames by OpenGL stand in for it.
void Viewer::refine() {
  if (!render_ && rests()) start_render();
  if (!render_) return;
  if (std::exchange(render_is_stale_, false))
    render_->edit({.scene = [scene = scene_.scene()] { return scene; }, .view = description_, .is_moving = true});
  InteractiveSnapshot now = render_->snapshot();
  if (!now.status.problem.empty()) panel_.message = std::move(now.status.problem);
  if (!now.picture || now.picture->revision != now.status.revision) return;
  denoised_ = std::move(now.denoised);
  panel_.denoised = describe_denoised(denoised_);
  const bool is_new = now.picture != offline_;
  offline_ = std::move(now.picture);
  load_offline_image();
  if (!is_new) return;
  is_small_ = false;
  measure();
  panel_.is_offline = true;
  panel_.frames = offline_->state.pass_count;
  const std::optional<ErrorEstimate>& error = offline_->statistics.error;
  panel_.error = error ? describe_error(*error) : "";
  const double left = offline_->seconds_left.value_or(0);
  panel_.left = left > 0 ? format_duration(left) : "";
  panel_.remark = offline_->remark;
}

// The picture as it is shown. Previews have no layers: a chosen layer is shown without denoising.
std::shared_ptr<const Image> Viewer::offline_image() const {
  if (denoised_ && (!denoised_->is_preview || panel_.layer == 0)) return {denoised_, &denoised_->image};
  return {offline_, &offline_->image};
}

void Viewer::load_offline_image() {
  const std::shared_ptr<const Image> image = offline_image();
  if (image == loaded_) return;
  picture_.load(*image);
  loaded_ = image;
}

void Viewer::draw() {
  if (shown_scene_ != scene_.scene()) {
    renderer_.update(*scene_.scene());
    shown_scene_ = scene_.scene();
  }
  if (panel_.wants_offline()) refine();
  // Draws only the first frames after a change: then the processors belong to the offline method.
  if (!panel_.is_offline && (!panel_.wants_offline() || picture_.frames() < 4)) draw_frame();
  if (!offline_ && picture_.frames() >= next_measurement_) {
    measure();
    next_measurement_ = 4 * picture_.frames();
  }
  renderer_.log().check();
}

void Viewer::present() {
  ToneSettings tone;
  tone.exposure = std::exp2(panel_.exposure);
  tone.curve = window_curve(panel_.curve);
  if (panel_.curve == ToneCurve::highlights)
    tone.highlight_strength = HighlightCurve(brightest_ * tone.exposure).strength();
  if (panel_.layer > 0) {
    tone.shown = glm::vec4(0);
    tone.shown[panel_.layer - 1] = 1;
  }
  Accumulation& shown = is_small_ ? *small_ : picture_;
  shown.present(tone);
  window_.show(shown.screen(), picture_.width(), picture_.height(), panel_);
}

void Viewer::update_information() {
  panel_.marks = light_marks(view_, panel_.lights);
  panel_.command = command();
  panel_.notice = notice();
  if (panel_.selected_object) {
    const SceneDescription& scene = description_of(*scene_.scene());
    const std::string& name = scene.objects[scene.instances[*panel_.selected_object].object].name;
    panel_.object_name = name.empty() ? fmt::format("object {}", *panel_.selected_object + 1) : name;
  }
}

void Viewer::save_picture(const std::string& extension) {
  Image image = offline_ ? *offline_image() : picture_.read();
  if (panel_.layer > 0 && extension == ".png") {
    Image layer = *select_layer(image, light_layer_names[static_cast<std::size_t>(panel_.layer - 1)]);
    layer.channels = {"R", "G", "B"};
    image = std::move(layer);
  }
  const DisplaySettings display{panel_.exposure, panel_.curve};
  const fs::path path = free_name(".", stem_of(options_.scene_file), extension);
  write_image(path, image, display);
  panel_.message = "Saved " + path.lexically_normal().string();
}

// Denoising in full quality takes seconds: meanwhile the window stays responsive.
void Viewer::save_exr() {
  const bool denoises = offline_ && panel_.denoises && offline_->state.pass_count > 1;
  if (!denoises) return save_picture(".exr");
  const fs::path path = free_name(".", stem_of(options_.scene_file), ".exr");
  panel_.message = "Denoising, to be saved as " + path.lexically_normal().string();
  saving_ = std::async(std::launch::async, [path, picture = offline_] {
    write_image(path, denoise(picture->image).picture, {});
    return "Saved " + path.lexically_normal().string();
  });
}

void Viewer::report_saved() {
  using namespace std::chrono_literals;
  if (!saving_.valid() || saving_.wait_for(0s) != std::future_status::ready) return;
  try {
    panel_.message = saving_.get();
  } catch (const std::exception& e) {
    panel_.message = e.what();
  }
}

fs::path Viewer::save_scene() {
  if (!panel_.can_save_scene) throw Error("only scenes of pbrt files can be saved");
  std::ifstream file(options_.scene_file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string edited = edited_pbrt(text, description_of(*original_), interaction_.pose(), scene_.description());
  // Beside the scene, because file names in it are relative to that folder.
  const fs::path path = free_name(options_.scene_file.parent_path(), stem_of(options_.scene_file) + "-view", ".pbrt");
  write_file(path, edited);
  saved_file_ = path;
  saved_camera_ = interaction_.pose().camera_to_world;
  saved_scene_ = scene_.scene();
  panel_.message = "Saved " + path.lexically_normal().string();
  return path;
}

std::string Viewer::command() const {
  const bool stands_there = interaction_.pose().camera_to_world == saved_camera_;
  // Edited colours and places are only in a saved scene.
  const bool needs_strengths = !panel_.can_save_scene && scene_.scene() != saved_scene_;
  ShownPicture shown;
  shown.scene = saved_file_;
  shown.method = panel_.methods[panel_.method];
  shown.settings = panel_.settings;
  shown.display.exposure = panel_.exposure;
  shown.display.curve = panel_.curve;
  shown.measures_exposure = panel_.measures_exposure;
  shown.denoises = panel_.denoises && panel_.wants_offline();
  if (!stands_there) shown.camera = interaction_.pose();
  if (needs_strengths) shown.strengths = strengths_of(panel_.lights);
  shown.width = view_.camera.width();
  shown.height = view_.camera.height();
  shown.origin = scene_.scene()->description().origin;
  return options_.command(offline_render(shown, options_));
}

void Viewer::copy_command() {
  const bool lacks_edits = scene_.scene() != saved_scene_;
  if (lacks_edits && panel_.can_save_scene) save_scene();
  window_.copy(command());
  panel_.message = (lacks_edits && !panel_.can_save_scene
                        ? "Copied, without colours and places that were edited, which only pbrt files hold: "
                        : "Copied: ") +
                   command();
}

bool Viewer::may_wait() const {
  if (panel_.wants_offline()) return panel_.is_offline || picture_.frames() >= 4;
  return picture_.frames() >= most_frames;
}

ViewerReport Viewer::run() {
  while (options_.frames == 0 || frames_ < options_.frames) {
    const ViewerClock::time_point start = ViewerClock::now();
    const Input input = window_.read(may_wait(), picture_.width(), picture_.height(), panel_);
    if (input.closed) break;
    apply(input);
    apply_panel();
    draw();
    update_information();
    present();
    if (const auto moving = std::exchange(moving_frame_, {}))
      moving_resolution_.learn(seconds_since(moving->first), moving->second);
    apply_wishes();
    constexpr double smoothing = 0.1;
    const double ms = 1e3 * seconds_since(start);
    panel_.frame_milliseconds += (frames_ < 3 ? 1 : smoothing) * (ms - panel_.frame_milliseconds);
  }
  render_.reset();
  ViewerReport report;
  report.method = panel_.methods[panel_.method];
  report.driver = driver_.renderer;
  report.software = driver_.software;
  report.width = picture_.width();
  report.height = picture_.height();
  report.frames = frames_;
  report.seconds = seconds_since(started_);
  report.stages = stages_.means();
  report.photons_per_bounce = panel_.photons_per_bounce;
  report.limitations = panel_.notes;
  return report;
}

}  // namespace

ViewerReport run_viewer(const SharedScene& scene, const ViewDescription& view, const ViewerOptions& options) {
  try {
    return Viewer(scene, view, options).run();
  } catch (const gl::Unavailable& e) {
    throw ViewerUnavailable(e.message);
  }
}

}  // namespace lanthorn
