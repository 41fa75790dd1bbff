#include "viewer/window/window_run.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <utility>

#include "core/base/printable.h"
#include "core/net/mono_clock.h"
#include "core/program/talk.h"
#include "viewer/dance_panel/recording.h"
#include "viewer/gl/offscreen.h"
#include "viewer/window/window_panels.h"
#include "voice/control/voice_control.h"

namespace dance {
namespace {

// Events are waited for up to so short before poses are taken; the rest is slept exactly.
constexpr Duration kFineWait = Duration::us(1'200);
constexpr Duration kMinimised = Duration::ms(100);
constexpr Duration kPictureWordsHold = Duration::s(6);
constexpr Duration kPlaceNameHolds = Duration::s(3);
constexpr Duration kHintHolds = Duration::s(12);
constexpr Duration kFiguresHold = Duration::ms(500);  // else they cannot be read
constexpr int kMostContextsLost = 20;
constexpr Duration kLookAtMonitorAfter = Duration::s(1);

Text text_of(Venue place) {
  static_assert(static_cast<int>(Text::kPlaceTerrace) - static_cast<int>(Text::kPlacePlain) ==
                static_cast<int>(Venue::kTerrace));
  return static_cast<Text>(static_cast<int>(Text::kPlacePlain) + static_cast<int>(place));
}

Quality quality_of(QualityWish wish) {
  if (wish == QualityWish::kAuto) return is_software_rendering() ? Quality::kLow : Quality::kHigh;
  return wish == QualityWish::kLow ? Quality::kLow : Quality::kHigh;
}

// In low-latency mode too swap calls wait where the driver can tear late pictures alone: what they
// do is found out by looking.
DisplayPath::Options path_options(const ViewOptions& options) {
  DisplayPath::Options path;
  path.is_late_latching = options.late_latching;
  path.latency = options.display_latency;
  return path;
}

}  // namespace

Result<std::unique_ptr<WindowRun>> WindowRun::create(const ViewOptions& options,
                                                     PictureSource& source,
                                                     std::unique_ptr<ViewWindow> window) {
  std::unique_ptr<WindowRun> run(new WindowRun(options, source));
  if (!options.teacher.file.empty()) {  // a bad file is refused before a window opens
    DANCE_TRY(run->teacher_, RecordedTeacher::open(options.teacher));
  }
  if (window) {
    run->window_ = std::move(window);
    run->window_->set_events(run->input_);
  } else {
    DANCE_TRY(run->window_,
              ViewWindow::create({options.size.width_px, options.size.height_px}, run->input_));
  }
  run->state_.dance.knows_slow_drawing = run->window_->shown_notes().slow_drawing;
  if (auto made = run->make_painter(); !made) return tl::make_unexpected(made.error());
  if (!run->painter_->overlay().font_note().empty())
    talk::info("{}", run->painter_->overlay().font_note());
  if (options.quality == QualityWish::kAuto && run->painter_->renderer().quality() == Quality::kLow)
    talk::info("no graphics card here: drawing plainly; --quality high draws all the same");
  if (auto added = add_panels(
          {options, source, run->records_, run->export_.for_timeline(), run->state_.dance,
           run->drawing_, run->teacher_ ? &run->teacher_choices_ : nullptr,
           [raw = run.get()] { return raw->teacher_->note(); }},
          run->panels_);
      !added)
    return tl::make_unexpected(added.error());
  run->apply_display_mode();
  return run;
}

WindowRun::WindowRun(const ViewOptions& options, PictureSource& source)
    : options_(options),
      source_(source),
      director_(options.camera, options.view),
      voice_keys_(
          [&options](const GuestId& guest, std::string_view command) {
            return send_voice_command(options.feed.bus_url, guest, command);
          },
          options.language),
      path_(Duration::period_of_hz(60.0), path_options(options)),
      display_(options.display),
      begun_(mono_now()),
      roster_(source.board()) {
  state_.display = options.display;
  state_.extrapolates = options.extrapolates;
  state_.shows_hud = options.hud;
  state_.shows_tags = options.tags;
  state_.place = place_to_draw(options);
  director_.set_language(options.language);
  if (options.focus) director_.choose(*options.focus);
  director_.rig().set_turning(options.camera == CameraPreset::kAuto ||
                              options.camera == CameraPreset::kOrbit);
}

WindowRun::~WindowRun() = default;

std::unique_ptr<ViewWindow> WindowRun::close(std::unique_ptr<WindowRun> run) {
  if (run->window_->is_full_screen()) run->window_->toggle_full_screen();
  run->window_->shown_notes().slow_drawing = run->state_.dance.knows_slow_drawing;
  return std::move(run->window_);  // what was drawn goes before it, while its context is current
}

Result<void> WindowRun::make_painter() {
  const Quality quality = draws_plainly_ ? Quality::kLow : quality_of(options_.quality);
  DANCE_TRY(painter_, StagePainter::create(quality, window_->scale()));
  painter_->overlay().set_language(options_.language);
  drawing_.is_software = is_software_rendering();
  drawing_.is_plain = quality == Quality::kLow;
  render_scale_ = RenderScale();
  painter_->renderer().build_meshes_beside();
  return {};
}

void WindowRun::apply_display_mode() {
  display_ = state_.display;
  window_->set_tear_free(display_ == DisplayMode::kTearFree);
  refresh_hz_ = window_->refresh_hz();
  path_.start_over(Duration::period_of_hz(refresh_hz_), path_options(options_));
}

// A window is moved to another monitor, or its monitor set to another rate, and nothing tells so.
void WindowRun::look_at_monitor(MonoTime now) {
  if (now - monitor_looked_at_ < kLookAtMonitorAfter) return;
  monitor_looked_at_ = now;
  if (window_->refresh_hz() != refresh_hz_) apply_display_mode();
}

bool WindowRun::is_over() const {
  return state_.is_over || window_->is_over() || source_.is_over();
}

Result<void> WindowRun::run() {
  while (!is_over())
    if (auto turned = turn(); !turned) return turned;
  // Keys ask before; a click on the window's frame does not.
  if (export_.is_running()) talk::warn("the window was closed: {}", export_.cancel());
  return {};
}

// What a person has asked for by the dance panel.
Result<void> WindowRun::obey_wishes() {
  DanceWishes& wishes = state_.dance;
  state_.voice.mute_presses += std::exchange(wishes.mute_presses, 0);
  state_.voice.deafen_presses += std::exchange(wishes.deafen_presses, 0);
  if (std::exchange(state_.full_screen_presses, 0) % 2 == 1) window_->toggle_full_screen();
  if (std::exchange(wishes.leaves, false)) state_.is_over = state_.has_left = true;
  if (!std::exchange(wishes.draws_plainly, false) || draws_plainly_) return {};
  draws_plainly_ = true;
  painter_.reset();  // one at a time
  return make_painter();
}

// Closing the window once more while the question is open closes it.
void WindowRun::ask_before_closing() {
  Closing& closing = state_.dance.closing;
  if (closing == Closing::kYes) state_.is_over = true;
  const bool closes = window_->is_over() || (state_.is_over && !state_.has_left);
  if (!options_.hosts_room || source_.dance() == nullptr || !closes || closing != Closing::kNo)
    return;
  closing = Closing::kAsked;
  state_.is_over = false;
  window_->keep_open();
}

Result<void> WindowRun::turn() {
  auto turned = turn_to_next_picture();
  ask_before_closing();  // an event may have arrived while the picture waited for poses
  return turned;
}

Result<void> WindowRun::turn_to_next_picture() {
  window_->poll_events();
  ask_before_closing();
  if (auto obeyed = obey_wishes(); !obeyed) return obeyed;
  if (window_->is_context_lost()) return renew_after_loss();
  if (state_.display != display_) apply_display_mode();
  look_at_monitor(mono_now());
  wait_to_take();
  // Asked late: a size from before the wait would be drawn once too small or too large.
  const ViewWindow::Size size = window_->framebuffer_size();
  if (size.width_px <= 0 || size.height_px <= 0) {  // minimised: nothing to draw
    window_->wait_for_events(kMinimised);
    return {};
  }
  return show(size);
}

// What was on the graphics card is gone, and so is the context; all of it is made anew.
Result<void> WindowRun::renew_after_loss() {
  if (++contexts_lost_ > kMostContextsLost)
    return fail(
        "the graphics driver keeps losing what was drawn; start again, or make pictures "
        "with: dance view --headless --out DIR");
  talk::warn("the graphics driver has lost everything: making it anew");
  state_.voice.is_talk_held = false;  // the window that would tell of its key is gone
  painter_.reset();
  if (auto renewed = window_->renew(); !renewed) return renewed;
  if (auto made = make_painter(); !made) return made;
  apply_display_mode();
  return {};
}

void WindowRun::wait_to_take() {
  const MonoTime at = path_.when_to_take(mono_now());
  for (MonoTime now = mono_now(); now < at && !is_over(); now = mono_now()) {
    const Duration left = at - now;
    if (left > kFineWait)
      window_->wait_for_events(left - kFineWait);
    else
      std::this_thread::sleep_for(std::chrono::nanoseconds(left.count_ns()));
  }
}

// A recorded house's clock goes along with ours.
MonoTime WindowRun::house_time(MonoTime now) {
  return source_.wait_until(source_.begin() + (now - begun_));
}

void WindowRun::take_poses(MonoTime now) {
  const MonoTime house_now = house_time(now);
  roster_.update(house_now, scene_);
  drawing_.pictures_hz = static_cast<float>(rate_.hz());
  let_teacher_join();
  scene_.notes.clear();  // the avatars' come first
  avatars_.dress(scene_);
  records_.take(source_.instruments());
  hide_guests();
  scene_.shows_trails = state_.shows_trails;
  predictor_.observe(roster_.fresh());
  // A recorded stage is shown as it was; so are the halves of a comparison.
  const bool is_live = source_.replay() == nullptr;
  if (is_live && state_.extrapolates && director_.mode() != ViewMode::kCompare)
    predictor_.predict(path_.photon_time(now), scene_);
}

void WindowRun::let_teacher_join() {
  StepScoreBoard* scores = source_.step_scores();
  if (!teacher_ || scores == nullptr) return;
  const auto pupil = scores->find(options_.pupil, scene_.time);
  teacher_->join(pupil ? std::optional(pupil->guest) : std::nullopt, teacher_choices_, scene_);
}

void WindowRun::hide_guests() {
  const auto& hidden = state_.dance.hidden;
  std::erase_if(scene_.guests, [&](const SceneGuest& guest) {
    return std::find(hidden.begin(), hidden.end(), guest.id) != hidden.end();
  });
}

void WindowRun::choose_guest() {
  if (state_.chosen_step != 0) director_.choose_next(scene_, state_.chosen_step);
  if (state_.chosen_number && *state_.chosen_number < static_cast<int>(scene_.guests.size()))
    director_.choose(scene_.guests[static_cast<std::size_t>(*state_.chosen_number)].id);
  state_.chosen_step = 0;
  state_.chosen_number.reset();
}

void WindowRun::write_notes(MonoTime now) {
  focus_was_here_ =
      focus_was_here_ || std::any_of(scene_.guests.begin(), scene_.guests.end(),
                                     [&](const SceneGuest& it) { return it.id == options_.focus; });
  write_stage_notes(options_, source_.name(), director_.words(), focus_was_here_, scene_);
  if (const std::string& words = voice_keys_.words(now); !words.empty())
    scene_.notes.push_back(words);
  if (picture_taken_.is_set() && now - picture_taken_ < kPictureWordsHold)
    scene_.notes.push_back(picture_words_);
  if (state_.place_changes != place_changes_shown_) {
    place_changes_shown_ = state_.place_changes;
    place_changed_ = now;
  }
  if (place_changed_.is_set() && now - place_changed_ < kPlaceNameHolds)
    scene_.notes.emplace_back(Texts(options_.language)[text_of(state_.place)]);
  if (now - begun_ < kHintHolds)
    scene_.notes.emplace_back(Texts(options_.language)[Text::kKeysHint]);
  if (!state_.shows_hud) return;
  if (now - figures_since_ > kFiguresHold) {
    swap_figures_ = meter_.figures(now);
    figures_since_ = now;
  }
  write_figure_notes({rate_.hz(), path_.phase(), path_.period(), path_.missed(), display_,
                      options_.late_latching, swap_figures_},
                     scene_);
}

Result<void> WindowRun::draw(ViewWindow::Size size, Duration since_last) {
  const PanelFrame frame{scene_, static_cast<float>(size.width_px),
                         static_cast<float>(size.height_px), window_->scale()};
  director_.update(
      scene_,
      {size.width_px, size.height_px, painter_->overlay().panel_height_px(size.height_px),
       static_cast<int>(panels_.bottom_px(frame))},
      since_last);
  write_notes(mono_now());
  painter_->overlay().set_scale(window_->scale());
  window_->pass_input_to_panels();
  painter_->set_render_scale(scales_pictures() ? render_scale_.scale() : 1.0f);
  OverlayChoice choice{state_.shows_tags, state_.shows_hud};
  choice.panels = &panels_;
  choice.whole = &scene_;
  if (state_.dance.takes_picture) {  // of the stage alone
    choice.panels = nullptr;
    choice.hud = false;
    scene_.notes.clear();
  }
  if (director_.comparison()) {
    painter_->renderer().set_light_yaw(director_.light_yaw_rad());
    return painter_->draw(*director_.comparison(), director_.camera(), size.width_px,
                          size.height_px, choice);
  }
  return painter_->draw(director_.cells(), size.width_px, size.height_px, choice);
}

Result<void> WindowRun::show(ViewWindow::Size size) {
  PictureTimes times;
  times.taken = mono_now();
  take_poses(times.taken);
  choose_guest();
  voice_keys_.work(scene_, director_.chosen(), state_.voice, times.taken);
  // Cameras go on while a recording is paused, or jumps.
  const Duration since_last = last_picture_.is_set() ? times.taken - last_picture_ : Duration();
  last_picture_ = times.taken;
  painter_->set_place(state_.place);
  painter_->set_render_scale(1.0f);
  export_.step({size.width_px, size.height_px}, state_.shows_trails, *painter_);
  if (auto drawn = draw(size, since_last); !drawn) {
    // A driver that has lost its context refuses everything.
    if (window_->is_context_lost()) return renew_after_loss();
    return drawn;
  }
  if (std::exchange(state_.dance.takes_picture, false)) take_picture(mono_now());
  painter_->present();
  glFinish();  // so that drawing is measured, and swap() waits for the display alone
  times.drawn = mono_now();
  window_->swap();
  times.swapped = mono_now();
  ++pictures_;
  report(times);
  return {};
}

void WindowRun::take_picture(MonoTime now) {
  const auto save = [&]() -> Result<std::string> {
    DANCE_TRY(const std::string path,
              new_dance_file(recordings_folder([](const char* name) { return std::getenv(name); }),
                             ".png"));
    if (auto written = write_png(path, painter_->read()); !written)
      return fail(written.error().what);
    return path;
  };
  const auto saved = save();
  const Texts texts(options_.language);
  picture_words_ = saved ? texts.say(Text::kDancePictureKept, {printable(*saved)})
                         : texts.say(Text::kDancePictureLost, {printable(saved.error().what)});
  picture_taken_ = now;
}

// --quality high keeps all pixels.
bool WindowRun::scales_pictures() const {
  return drawing_.is_software && (draws_plainly_ || options_.quality != QualityWish::kHigh);
}

void WindowRun::report(const PictureTimes& times) {
  path_.on_picture(times);
  if (scales_pictures() && !export_.is_running())
    render_scale_.on_picture(times.drawn - times.taken, times.drawn);
  drawing_.is_at_smallest_scale = !scales_pictures() || render_scale_.is_smallest();
  rate_.on_picture(times.swapped);
  for (const StageRoster::Fresh& fresh : roster_.fresh())
    if (fresh.pose.clock_id == this_clock_id() && fresh.pose.capture_time.is_set() &&
        source_.replay() == nullptr)
      meter_.add(fresh.pose.capture_time, fresh.heard, times);
  source_.report_shown(roster_.fresh(), times.swapped);
}

}  // namespace dance
