// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/interactive_render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include "base/parallel.h"
#include "camera/view.h"
#include "film/film.h"
#include "lanthorn/denoise.h"
#include "lanthorn/error.h"
#include "render/method_of_file.h"
#include "render/plan.h"
#include "scene/scene.h"

namespace lanthorn {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr double first_coarse_pixels = 96 * 96, fewest_coarse_pixels = 48 * 48;
constexpr double coarse_seconds = 0.06;  // for a coarse pass, so that more than ten a second fit while the camera moves
constexpr double patient_seconds = 1.5;  // slower full passes get intermediate pictures after the coarse one
constexpr double largest_growth = 6;     // of the pixel count from one of these pictures to the next
constexpr Clock::duration moving_time = 300ms;      // full passes wait this long for the next edit
constexpr Clock::duration picture_interval = 40ms;  // between pictures of full passes
constexpr int picture_share = 8;                    // making pictures takes at most 1/8 of the time
constexpr double denoising_growth = 1.5;            // in the number of passes, from one denoised picture to the next
constexpr double denoising_rest = 3;                // before each preview, rendering runs this many times as long
constexpr double guessed_denoising_seconds = 1e-6;  // per pixel, before the first measurement

double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }

PixelWindow window_of(const ViewDescription& view, const RenderOptions& options) {
  return make_view(view, options).window;
}
double pixels_of(const PixelWindow& window) { return static_cast<double>(window.width()) * window.height(); }

// Denoising needs passes in both halves, since their difference is the noise.
bool has_both_halves(const InteractivePicture& picture) {
  std::array<bool, 2> has{};
  for (const PassRange& range : picture.state.passes)
    for (std::uint64_t pass = range.begin; pass < range.end && !(has[0] && has[1]); ++pass)
      has[static_cast<std::size_t>(half_of_pass(pass))] = true;
  return has[0] && has[1] && !picture.is_coarse;
}

InteractiveDenoised denoised_picture(const InteractivePicture& picture, bool is_preview) {
  return {
      is_preview ? preview_without_noise(picture.image) : with_denoised_light(lanthorn::denoise(picture.image).picture),
      is_preview, picture.state.pass_count};
}

// Avoids the pilots of `auto` and of photons' starts, which would take several times as long as a coarse pass. Drops
// parameters meant for another method.
void leave_out_pilot(RenderOptions& options) {
  options.integrator = method_without_pilot;
  options.set.insert_or_assign("emission", "power");
  for (const ParameterInfo& p : find_integrator(method_without_pilot).parameters)
    options.set.emplace(p.name, p.default_value);
}

}  // namespace

// A single thread executes `run`. `wanted_` accumulates all edits; the thread copies it, renders without the lock, and
// checks again. An edit changes `wanted_` and sets `drop_` under the lock, and the thread clears `drop_` and copies
// under the same lock, so that no edit is missed.
class InteractiveRender::Worker {
 public:
  Worker(SharedScene scene, const ViewDescription& view, const RenderOptions& options,
         const InteractiveSettings& settings)
      : settings_(settings),
        scene_(std::move(scene)),
        wanted_{{}, 0, 1, 1, view, options},
        denoises_(settings.denoises) {
    make_plan(wanted_);
    warnings_ = warnings_of(*scene_, view);
    if (std::string limitation = plan_->integrator->limitation(*scene_); !limitation.empty())
      warnings_.push_back({{}, std::move(limitation)});
    if (!settings_.coarse_first) coarse_revision_ = 1;
    thread_ = std::thread([this] { run(); });
  }

  ~Worker() { stop(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  std::uint64_t edit(RenderEdit edit) {
    const std::lock_guard lock(mutex_);
    if (edit.scene || edit.view || edit.options) {
      ++wanted_.revision;
      if (edit.scene) {
        wanted_.make_scene = std::make_shared<const std::function<SharedScene()>>(std::move(edit.scene));
        wanted_.scene_revision = wanted_.revision;
      }
      if (edit.view) wanted_.view = std::move(*edit.view);
      if (edit.options) {
        wanted_.options = std::move(*edit.options);
        wanted_.options_revision = wanted_.revision;
      }
      if (!settings_.coarse_first) coarse_revision_ = wanted_.revision;
      drop_ = drop_denoising_ = true;
    }
    moving_until_ = edit.is_moving ? Clock::now() + moving_time : Clock::time_point();
    edited_.notify_all();
    tell_phase();
    return wanted_.revision;
  }

  void pause(bool is_paused) {
    const std::lock_guard lock(mutex_);
    if (is_paused == is_paused_) return;
    rest_ = is_paused_ = is_paused;
    edited_.notify_all();
    tell_phase();
  }

  void denoise(bool is_wanted) {
    const std::lock_guard lock(mutex_);
    if (is_wanted == denoises_) return;
    denoises_ = is_wanted;
    drop_denoising_ = !is_wanted;
    denoised_.reset();
    ++number_;
    edited_.notify_all();
    changed_.notify_all();
  }

  InteractiveSnapshot snapshot() const {
    const std::lock_guard lock(mutex_);
    return seen();
  }

  InteractiveSnapshot wait(std::uint64_t number, std::chrono::milliseconds patience) const {
    Lock lock(mutex_);
    changed_.wait_for(lock, patience, [&] { return number_ != number || has_ended_; });
    return seen();
  }

  const std::vector<description::Warning>& warnings() const { return warnings_; }
  void stop() {
    {
      const std::lock_guard lock(mutex_);
      has_ended_ = true;
      drop_ = end_ = drop_denoising_ = true;
      edited_.notify_all();
      changed_.notify_all();
    }
    std::call_once(joined_, [this] {
      thread_.join();
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    });
  }

  const RenderState* state() const {
    const std::lock_guard lock(mutex_);
    const bool is_there = is_over_ && settings_.keeps_sums && plan_ && plan_revision_ == wanted_.revision &&
                          plan_->state.pass_count() > 0;
    return is_there ? &plan_->state : nullptr;
  }

 private:
  using Lock = std::unique_lock<std::mutex>;
  struct Wanted {
    std::shared_ptr<const std::function<SharedScene()>> make_scene;  // null once the scene is made
    std::uint64_t scene_revision = 0, options_revision = 0, revision = 0;
    ViewDescription view;
    RenderOptions options;
  };
  enum class Step : std::uint8_t { coarse, refine, preview, denoise, rest, end };

  void run() {
    Lock lock(mutex_);
    while (true) {
      tell_phase();
      const Step step = next_step();
      if (step == Step::end) break;
      if (step == Step::rest) {
        rest(lock);
        continue;
      }
      Wanted wanted = wanted_;
      drop_ = false;
      rest_ = is_paused_;
      lock.unlock();
      render(step, wanted);
      lock.lock();
    }
    if (plan_) plan_->integrator.reset();  // its OpenGL objects belong to this thread
  }

  Step next_step() const {
    if (has_ended_) return Step::end;
    if (failed_revision_ == wanted_.revision) return Step::rest;
    if (coarse_revision_ != wanted_.revision) return Step::coarse;
    if (Clock::now() < moving_until_) return Step::rest;
    const bool rests = is_paused_ || over_revision_ == wanted_.revision;
    return rests ? next_step_at_rest() : Step::refine;
  }

  // Final and paused pictures are denoised: first as a preview, then at full quality.
  Step next_step_at_rest() const {
    if (!can_denoise_shown()) return Step::rest;
    const bool is_over = over_revision_ == wanted_.revision;
    const bool is_of_shown = denoised_ && denoised_->passes == picture_->state.pass_count;
    if (!denoised_ || (!is_of_shown && !is_over)) return Step::preview;
    return is_over && (!is_of_shown || denoised_->is_preview) ? Step::denoise : Step::rest;
  }

  // Waits until something changes or the current movement ends.
  void rest(Lock& lock) {
    if (Clock::now() < moving_until_)
      edited_.wait_until(lock, moving_until_);
    else
      edited_.wait(lock);
  }

  void render(Step step, Wanted& wanted) {
    try {
      if (scene_revision_ != wanted.scene_revision) make_scene(wanted);
      // Invalid options are rejected before a coarse picture is shown.
      if (options_revision_ != wanted.options_revision) make_plan(wanted);
      if (step == Step::coarse)
        render_coarse(wanted);
      else if (step == Step::refine)
        refine(wanted);
      else
        denoise_shown(step == Step::preview);
    } catch (const std::bad_alloc&) {
      fail(wanted, "not enough memory for this picture");
    } catch (const std::exception& problem) {
      fail(wanted, problem.what());
    }
  }

  // Renders coarse pictures, each finer than the last, until the full one will follow soon.
  void render_coarse(const Wanted& wanted) {
    const double full = pixels_of(window_of(wanted.view, wanted.options));
    const double taken = render_coarse(wanted, coarse_pixels_, /*is_first=*/true);
    // For few pixels, fixed costs dominate: then this pixel count is a cautious guess.
    const double growth = std::clamp(coarse_seconds / std::max(taken, 1e-4), 0.25, 2.0);
    double pixels = std::min(coarse_pixels_, full);
    coarse_pixels_ = std::clamp(pixels * growth, std::min(fewest_coarse_pixels, full), full);
    {
      const std::lock_guard lock(mutex_);
      coarse_revision_ = wanted.revision;
      if (Clock::now() < moving_until_ || is_paused_) return;
    }
    for (double rate = taken / pixels; rate * full > patient_seconds && is_wanted(wanted);) {
      pixels *= largest_growth;
      if (2 * pixels > full) return;
      rate = render_coarse(wanted, pixels, /*is_first=*/false) / pixels;
    }
  }

  // Returns the seconds that it took.
  double render_coarse(const Wanted& wanted, double pixels, bool is_first) {
    const Clock::time_point start = Clock::now();
    const double full = pixels_of(window_of(wanted.view, wanted.options));
    const double share = std::sqrt(std::min(1.0, pixels / full));
    RenderOptions options = coarse_options(wanted.options, wanted.view.film, share, photons_of(wanted, full));
    if (plan_->info->name == automatic_method) leave_out_pilot(options);
    RenderPlan plan = plan_render(*scene_, wanted.view, options);
    // The first picture of an edit is always completed; later ones may be abandoned.
    const RenderStatistics statistics =
        lanthorn::render(*scene_, plan, {.passes = {0, 1}, .drop = is_first ? &end_ : &drop_, .undo = Undo::never});
    if (plan.state.pass_count() > 0) {
      auto picture = coarse_picture(wanted, plan, statistics);
      const std::lock_guard lock(mutex_);
      show(std::move(picture));
    }
    return seconds(Clock::now() - start);
  }

  void refine(const Wanted& wanted) {
    if (plan_revision_ != wanted.revision) make_plan(wanted);
    StopRule stop = plan_->stop;
    if (stop.seconds) *stop.seconds = std::max(0.0, *stop.seconds - plan_->state.seconds);
    stop.interrupted = &rest_;
    stop.drop = &drop_;
    stop.undo = settings_.keeps_sums ? Undo::always : Undo::never;
    std::uint64_t shown_passes = 0;
    Observer observer;
    observer.progress = [&](const RenderState&, const RenderStatistics& statistics) {
      const Clock::time_point now = Clock::now();
      if (now < next_picture_) return;
      auto picture = full_picture(wanted, stop, statistics);
      {
        const std::lock_guard lock(mutex_);
        show(std::move(picture));
      }
      shown_passes = plan_->state.pass_count();
      next_picture_ = Clock::now() + std::max(picture_interval, picture_share * (Clock::now() - now));
      denoise_if_due(statistics);
    };
    const RenderStatistics statistics = lanthorn::render(*scene_, *plan_, stop, observer);
    if (statistics.out_of_memory) throw std::bad_alloc();
    if (drop_) return;
    const bool is_news = shown_passes < plan_->state.pass_count();
    auto last = is_news ? full_picture(wanted, stop, statistics) : nullptr;
    // Updates phase and picture together, so that an observer of the end also sees its picture.
    const std::lock_guard lock(mutex_);
    if (!rest_) note_end(wanted, statistics, stop);
    if (last) show(std::move(last));
  }

  void denoise_if_due(const RenderStatistics& statistics) {
    const Clock::time_point now = Clock::now();
    {
      const std::lock_guard lock(mutex_);
      if (!can_denoise_shown() || now < next_preview_) return;
      const double pixels = static_cast<double>(picture_->image.width) * picture_->image.height;
      if (!denoised_ && statistics.seconds < denoising_rest * preview_seconds_ * pixels) return;
      const auto passes = static_cast<double>(picture_->state.pass_count);
      if (denoised_ && passes < denoising_growth * static_cast<double>(denoised_->passes)) return;
    }
    denoise_shown(/*is_preview=*/true);
    next_preview_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(denoising_rest * (Clock::now() - now));
  }

  // Runs without the lock, because edits would have to wait for it.
  void denoise_shown(bool is_preview) {
    std::shared_ptr<const InteractivePicture> picture;
    {
      const std::lock_guard lock(mutex_);
      if (!can_denoise_shown()) return;
      picture = picture_;
      drop_denoising_ = has_ended_;
    }
    const Clock::time_point start = Clock::now();
    std::shared_ptr<const InteractiveDenoised> made;
    try {
      const StopScope scope(&drop_denoising_);
      made = std::make_shared<const InteractiveDenoised>(denoised_picture(*picture, is_preview));
    } catch (const Stopped&) {
      return;
    }
    const double pixels = static_cast<double>(picture->image.width) * picture->image.height;
    if (is_preview) preview_seconds_ = seconds(Clock::now() - start) / pixels;
    const std::lock_guard lock(mutex_);
    if (!can_denoise_shown()) return;
    denoised_ = std::move(made);
    ++number_;
    changed_.notify_all();
  }

  // The parts that coarse and full pictures have in common.
  InteractivePicture make_picture(const Wanted& wanted, const RenderPlan& plan,
                                  const RenderStatistics& statistics) const {
    const PixelWindow full = window_of(wanted.view, wanted.options);
    InteractivePicture picture{.image = picture_of(plan.state),
                               .revision = wanted.revision,
                               .full_size = {full.width(), full.height()},
                               .state = summarize(plan.state),
                               .statistics = statistics,
                               .limitation = plan.integrator->limitation(*scene_)};
    picture.state.integrator = plan_->state.integrator;  // even if a coarse picture used another method
    return picture;
  }

  std::shared_ptr<const InteractivePicture> coarse_picture(const Wanted& wanted, const RenderPlan& plan,
                                                           const RenderStatistics& statistics) const {
    InteractivePicture picture = make_picture(wanted, plan, statistics);
    picture.is_coarse = true;
    return std::make_shared<const InteractivePicture>(std::move(picture));
  }

  std::shared_ptr<const InteractivePicture> full_picture(const Wanted& wanted, const StopRule& stop,
                                                         const RenderStatistics& statistics) const {
    InteractivePicture picture = make_picture(wanted, *plan_, statistics);
    picture.image = with_noise(plan_->state, picture.image);
    picture.seconds_left = progress_of(stop, plan_->state, statistics).seconds_left;
    picture.remark = plan_->integrator->remark();
    return std::make_shared<const InteractivePicture>(std::move(picture));
  }

  void make_scene(Wanted& wanted) {
    SharedScene made = (*wanted.make_scene)();
    if (!made) throw Error("the function of the edit made no scene");
    scene_ = std::move(made);
    scene_revision_ = wanted.scene_revision;
    // The function may hold a whole description.
    wanted.make_scene.reset();
    const std::lock_guard lock(mutex_);
    if (wanted_.scene_revision == scene_revision_) wanted_.make_scene.reset();
  }

  void make_plan(const Wanted& wanted) {
    plan_.reset();  // two films may not fit into memory
    plan_revision_ = options_revision_ = 0;
    plan_.emplace(plan_render(*scene_, wanted.view, wanted.options));
    plan_->coarse = nullptr;  // `render_coarse` has shown coarse pictures
    plan_revision_ = wanted.revision;
    options_revision_ = wanted.options_revision;
    const RenderSettings& settings = plan_->settings;
    photons_per_pixel_ = static_cast<double>(settings.photons * settings.parts) / pixels_of(plan_->view.window);
  }

  double photons_of(const Wanted& wanted, double pixels) const {
    return wanted.options.photons ? static_cast<double>(*wanted.options.photons) : photons_per_pixel_ * pixels;
  }

  bool is_wanted(const Wanted& wanted) const {
    const std::lock_guard lock(mutex_);
    return !has_ended_ && wanted.revision == wanted_.revision;
  }

  void fail(const Wanted& wanted, const std::string& problem) {
    const std::lock_guard lock(mutex_);
    failed_revision_ = wanted.revision;
    problem_ = problem;
  }

  InteractivePhase phase() const {
    if (failed_revision_ == wanted_.revision) return InteractivePhase::failed;
    if (over_revision_ == wanted_.revision) return over_;
    if (is_paused_) return InteractivePhase::paused;
    const bool is_there = picture_ && !picture_->is_coarse && picture_->revision == wanted_.revision;
    return is_there ? InteractivePhase::refining : InteractivePhase::preparing;
  }

  InteractiveSnapshot seen() const {
    const InteractivePhase now = phase();
    return {number_,
            {wanted_.revision, now, now == InteractivePhase::failed ? problem_ : std::string()},
            picture_,
            denoised_};
  }

  void tell_phase() {
    if (const InteractivePhase now = phase(); now != told_) {
      told_ = now;
      ++number_;
      changed_.notify_all();
    }
  }

  // Call this one and the next two with the lock held.
  bool can_denoise_shown() const {
    return denoises_ && picture_ && picture_->revision == wanted_.revision && has_both_halves(*picture_);
  }

  void show(std::shared_ptr<const InteractivePicture> picture) {
    if (picture_ && picture_->revision != picture->revision) denoised_.reset();
    picture_ = std::move(picture);
    told_ = phase();
    ++number_;
    changed_.notify_all();
  }

  void note_end(const Wanted& wanted, const RenderStatistics& statistics, const StopRule& stop) {
    over_revision_ = wanted.revision;
    const bool is_good = stop.noise && statistics.error && statistics.error->is_below(*stop.noise);
    const bool has_all = plan_->state.pass_count() >= stop.passes.end - stop.passes.begin;
    over_ = is_good || has_all ? InteractivePhase::finished : InteractivePhase::out_of_time;
  }

  const InteractiveSettings settings_;

  // Used by the thread, and by those who wait for it to end.
  SharedScene scene_;
  std::uint64_t scene_revision_ = 0, options_revision_ = 0, plan_revision_ = 0;
  std::optional<RenderPlan> plan_;
  std::vector<description::Warning> warnings_;
  double photons_per_pixel_ = 0;
  double coarse_pixels_ = first_coarse_pixels;  // estimate of what a coarse pass can render in time
  Clock::time_point next_picture_{}, next_preview_{};
  double preview_seconds_ = guessed_denoising_seconds;  // per pixel

  mutable std::mutex mutex_;  // guards all members below
  std::condition_variable edited_;
  mutable std::condition_variable changed_;
  Wanted wanted_;
  bool is_paused_ = false, denoises_ = false;
  bool has_ended_ = false, is_over_ = false;  // `stop` was called; the thread has ended
  std::uint64_t coarse_revision_ = 0, failed_revision_ = 0, over_revision_ = 0;
  InteractivePhase over_ = InteractivePhase::finished;  // phase for over_revision_
  std::string problem_;
  Clock::time_point moving_until_{};
  std::shared_ptr<const InteractivePicture> picture_;
  std::shared_ptr<const InteractiveDenoised> denoised_;  // of the revision of picture_
  std::uint64_t number_ = 1;
  InteractivePhase told_ = InteractivePhase::preparing;  // the last phase counted in `number_`
  std::atomic<bool> drop_{false};                        // abandons the running pass
  std::atomic<bool> end_{false};                         // abandons every pass, even the first coarse one of an edit
  std::atomic<bool> rest_{false};                        // pauses after the running pass
  std::atomic<bool> drop_denoising_{false};              // abandons the running denoising

  std::once_flag joined_;
  std::thread thread_;
};

InteractiveRender::InteractiveRender(SharedScene scene, const ViewDescription& view, const RenderOptions& options,
                                     const InteractiveSettings& settings)
    : worker_(std::make_unique<Worker>(std::move(scene), view, options, settings)) {}
InteractiveRender::~InteractiveRender() = default;
std::uint64_t InteractiveRender::edit(RenderEdit edit) { return worker_->edit(std::move(edit)); }
void InteractiveRender::pause(bool is_paused) { worker_->pause(is_paused); }
void InteractiveRender::denoise(bool is_wanted) { worker_->denoise(is_wanted); }
InteractiveSnapshot InteractiveRender::snapshot() const { return worker_->snapshot(); }
InteractiveSnapshot InteractiveRender::wait(std::uint64_t number, std::chrono::milliseconds patience) const {
  return worker_->wait(number, patience);
}
const std::vector<description::Warning>& InteractiveRender::warnings() const { return worker_->warnings(); }
void InteractiveRender::stop() { worker_->stop(); }
const RenderState* InteractiveRender::state() const { return worker_->state(); }

}  // namespace lanthorn
