#include "lobby/run/lobby_run.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/net/mono_clock.h"
#include "core/program/program.h"
#include "lobby/run/trouble_words.h"
#include "viewer/gl/offscreen.h"
#include "viewer/scene/place.h"

namespace dance {
namespace {

constexpr int kSettlingFrames = 3;
constexpr Duration kFastestFrame = Duration::ms(16);
constexpr Duration kIdle = Duration::ms(500);
constexpr Duration kBusy = Duration::ms(50);  // while programs are about to say something
constexpr Duration kLongestGoingIn = Duration::s(20);
constexpr Duration kHouseEnds = Duration::s(3);
constexpr Duration kLookAtHouse = Duration::ms(100);

// Mouse and keys come first: dancers are drawn once the page has settled, or after this time.
constexpr Duration kLongestStill = Duration::ms(400);

}  // namespace

Result<std::unique_ptr<LobbyRun>> LobbyRun::create(const std::string& settings_path,
                                                   const std::string& invitation) {
  std::unique_ptr<LobbyRun> run(new LobbyRun(settings_path));
  // Before any thread begins: signals come to the main thread's poller.
  DANCE_TRY(run->poller_, Poller::create());
  if (auto stops = run->poller_->stop_on_signals(); !stops)
    return tl::make_unexpected(stops.error());
  run->figures_ =
      std::make_unique<LobbyFigures>(AvatarStore::of_user(), data_folder() + "/avatars");
  LobbyModel& model = run->model_;
  model.settings_path = with_tilde(settings_path);
  find_parts(model);
  find_addresses(model);
  find_headset(model);
  LobbySettings first = first_settings();
  bool is_new = true;
  if (auto opened = run->file_.open()) {
    first = opened->settings;
    is_new = opened->is_new;
    // Else the file is not there yet.
    if (!is_new && opened->kept_as.empty()) run->saved_ = first;
    model.take(first);
    run->note_saved(opened->trouble, opened->kept_as);
  } else {
    model.take(first);
    model.tell(error_banner(Text::kLobbyNotSaved, {}, opened.error().what));
  }
  run->chooses_source_ = is_new;
  if (auto window = run->open_window(); !window) return tl::make_unexpected(window.error());
  run->opener_ = std::make_unique<InvitationOpener>([] { glfwPostEmptyEvent(); });
  run->rooms_ = std::make_unique<KnownRooms>(settings_path, [] { glfwPostEmptyEvent(); });
  run->rooms_->ask(model);
  if (!invitation.empty()) {
    model.show(LobbyScreen::kDance);
    model.invitation_typed = invitation;
    run->open_invitation_typed();
  }
  if (!model.join_request) run->look_for_cameras_once();
  return run;
}

LobbyRun::~LobbyRun() {
  stop_house();
  stage_.reset();
  seen_.stop(model_);
  release_painters();
  window_.reset();  // before threads that may take some seconds yet
  rooms_.reset();
  opener_.reset();
}

Result<void> LobbyRun::open_window() {
  const WindowChoices& size = model_.settings.window;
  DANCE_TRY(window_, ViewWindow::create({size.width_px, size.height_px}, input_));
  return make_painter();
}

Result<void> LobbyRun::make_painter() {
  DANCE_TRY(painter_, LobbyPainter::create(window_->scale()));
  input_.begin(*window_);
  window_->set_tear_free(true);
  model_.shelf.has_graphics_card = !is_software_rendering();
  fresh_frames_ = kSettlingFrames;
  return {};
}

// Both painters own OpenGL objects, to be released before the context ends or shows a dance.
void LobbyRun::release_painters() {
  if (figures_) figures_->release(model_);
  painter_.reset();
}

Result<void> LobbyRun::run() {
  while (!is_over_)
    if (auto turned = turn(); !turned) return turned;
  return {};
}

Result<void> LobbyRun::turn() { return stage_ ? turn_of_dance() : turn_of_lobby(); }

// How long nothing may happen.
Duration LobbyRun::longest_wait(MonoTime now) const {
  if (fresh_frames_ > 0) return std::max(Duration(), kFastestFrame - (now - drawn_));
  const bool is_opening = model_.host.state == HostFacts::State::kOpening;
  const bool is_busy = model_.is_going_in || is_opening || seen_.is_busy() || shelf_.is_busy();
  const Duration longest = is_busy ? kBusy : kIdle;
  if (window_->framebuffer_size().width_px <= 0) return longest;  // minimised: no dancers either
  return std::min(longest, figures_->time_until_due(model_, now).value_or(kIdle));
}

Result<void> LobbyRun::turn_of_lobby() {
  window_->poll_events();
  window_->wait_for_events(longest_wait(mono_now()));
  poller_->run_once(Duration());
  if (window_->is_over() || poller_->is_stopped()) {
    save();
    is_over_ = true;
    return {};
  }
  if (window_->is_context_lost()) {
    release_painters();
    if (auto renewed = window_->renew(); !renewed) return renewed;
    return make_painter();
  }
  if (look_around(mono_now())) fresh_frames_ = std::max(fresh_frames_, 1);
  if (stage_) return {};  // it has begun
  const MonoTime now = mono_now();
  if (input_.take_news(*window_)) {
    fresh_frames_ = kSettlingFrames;
    figures_->note_input(now);
  }
  draw_dancers(now);
  if (fresh_frames_ == 0 || mono_now() - drawn_ < kFastestFrame) return {};
  if (auto drawn = draw(); !drawn) return drawn;
  const bool waits = saved_ && loses_a_table(*saved_, model_.settings);
  if (!painter_->is_typed_in() && !waits && !model_.join_request) save();
  obey(std::exchange(model_.wish, LobbyWish::kNone));
  return {};
}

void LobbyRun::draw_dancers(MonoTime now) {
  if (fresh_frames_ > 0 && now - dancers_drawn_ < kLongestStill) return;
  const ViewWindow::Size size = window_->framebuffer_size();
  if (size.width_px <= 0 || !figures_->step(model_, window_->scale(), now)) return;
  dancers_drawn_ = mono_now();
  fresh_frames_ = std::max(fresh_frames_, 1);
}

Result<void> LobbyRun::draw() {
  const ViewWindow::Size size = window_->framebuffer_size();
  if (size.width_px <= 0 || size.height_px <= 0) {  // minimised
    fresh_frames_ = 0;
    return {};
  }
  window_->set_letter_scale(static_cast<float>(model_.settings.window.letters));
  painter_->set_scale(window_->scale());
  const bool has_more = input_.pass(*window_);
  const MonoTime now = mono_now();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  painter_->draw(model_, size.width_px, size.height_px,
                 drawn_.is_set() ? now - drawn_ : kFastestFrame);
  window_->swap();
  drawn_ = now;
  ++pictures_;
  fresh_frames_ = has_more ? kSettlingFrames : fresh_frames_ - 1;
  return {};
}

// True where something is to be drawn.
bool LobbyRun::look_around(MonoTime now) {
  bool is_new = host_.look(model_, now, model_.screen == LobbyScreen::kHost);
  is_new = seen_.look(model_, *painter_, now) || is_new;
  if (chooses_source_ && model_.knows_cameras) {
    // Who has no camera can dance at once all the same.
    if (model_.cameras.empty()) model_.settings.source = DancerSource::kSynthetic;
    chooses_source_ = false;
    is_new = true;
  }
  is_new = look_at_invitation() || is_new;
  is_new = shelf_.poll(model_) || is_new;
  is_new = rooms_->look(model_, now) || is_new;
  return look_at_house(now) || is_new;
}

bool LobbyRun::look_at_house(MonoTime now) {
  if (!house_ || stage_) return false;
  const bool is_alone = house_for_ != LobbyWish::kJoin;
  house_->read();
  for (const std::string& line : house_->take_lines()) {
    if (says_it_is_in(line, is_alone)) {
      model_.is_going_in = false;
      model_.forget(Text::kLobbyServerSilent);  // another of its addresses has answered
      keep_trial();
      if (!is_alone) model_.remember_room();
      if (auto begun = begin_dance(); !begun) {
        stop_house();
        model_.tell(error_banner(Text::kLobbyDanceEnded, {}, begun.error().what));
      }
      return true;
    }
    const auto known = trouble_in(line, house_settings());
    if (!known) continue;
    model_.tell(known->banner);
    if (!known->is_fatal) continue;
    if (known->banner.text == Text::kLobbyNameTaken && !trial_) model_.take_further_name();
    stop_house();
    return true;
  }
  if (has_house_ended()) {
    stop_house();
    return true;
  }
  if (now - going_since_ < kLongestGoingIn) return false;
  model_.tell(start_error_of(house_->lines(), house_settings()));
  stop_house();
  return true;
}

// Of itself; then it is told why.
bool LobbyRun::has_house_ended() {
  if (!house_->process().has_ended()) return false;
  house_->read();
  model_.tell(end_error_of(house_->lines(), house_settings()));
  return true;
}

void LobbyRun::stop_house() {
  model_.is_going_in = false;
  if (house_) house_->process().stop(kHouseEnds);
  house_.reset();
  if (trial_) file_.remove_trial();
  trial_.reset();
}

void LobbyRun::obey(LobbyWish wish) {
  if (wish != LobbyWish::kNone) fresh_frames_ = kSettlingFrames;
  switch (wish) {
    case LobbyWish::kNone:
      return;
    case LobbyWish::kJoin:
    case LobbyWish::kAlone:
    case LobbyWish::kPractise:
    case LobbyWish::kWatchRoom:
      return go_in(wish);
    case LobbyWish::kWithoutVoice:
      model_.settings.speaks = false;
      return go_in(LobbyWish::kJoin);
    case LobbyWish::kCancel:
      return cancel();
    case LobbyWish::kConfirmJoin:
      return confirm_join();
    case LobbyWish::kOpenRoom:
      return host_.open(model_);
    case LobbyWish::kCloseRoom:
      return host_.close(model_);
    case LobbyWish::kAskRouter:
      return host_.ask_router(model_, mono_now());
    case LobbyWish::kInvite:
      return host_.invite(model_);
    case LobbyWish::kWithdraw:
      return host_.withdraw(model_);
    case LobbyWish::kListInvited:
      return host_.list(model_);
    case LobbyWish::kCopyMessage:
      return host_.copy_message(model_);
    case LobbyWish::kSavePage:
      return host_.save_page(model_);
    case LobbyWish::kOpenPageFolder:
      return host_.open_page_folder(model_);
    case LobbyWish::kAskRooms:
      return rooms_->ask(model_);
    case LobbyWish::kLookAgain:
      find_addresses(model_);
      find_headset(model_);
      return seen_.look_for_cameras(model_);
    case LobbyWish::kOpenInvitation:
      return open_invitation_typed();
    case LobbyWish::kPlayCountIn:
      return seen_.play_count_in();
    case LobbyWish::kListDances:
    case LobbyWish::kWatch:
    case LobbyWish::kMakeVideo:
    case LobbyWish::kExportBvh:
    case LobbyWish::kExportGlb:
    case LobbyWish::kCancelExport:
    case LobbyWish::kRename:
    case LobbyWish::kDelete:
    case LobbyWish::kOpenFolder:
      return shelf_.apply(model_, wish);
    case LobbyWish::kQuit:
      is_over_ = true;
      return;
  }
}

// The window goes to the stage.
Result<void> LobbyRun::begin_dance() {
  DANCE_TRY(const HouseConfig house, load_session(file_.path()));
  view_ = ViewOptions();
  view_.feed.bus_url = house.bus;
  view_.session = file_.path();
  view_.language = model_.texts.language();
  view_.place = parse_place(house.window.place);
  view_.hosts_room = host_.is_running();
  if (house_for_ == LobbyWish::kPractise) choose_practice_view();
  DANCE_TRY(source_, PictureSource::open(view_));
  shelf_.note_dance_begins();
  release_painters();
  auto stage = WindowRun::create(view_, *source_, std::move(window_));
  if (!stage) {
    source_.reset();
    if (auto opened = open_window(); !opened) return opened;
    return tl::make_unexpected(stage.error());
  }
  stage_ = std::move(*stage);
  if (is_software_rendering() && !std::exchange(has_told_graphics_, true))
    model_.tell(
        {LobbyBanner::Kind::kGood, Text::kLobbyNoGraphics, {}, "", Text::kCount, LobbyWish::kNone});
  return {};
}

Result<void> LobbyRun::turn_of_dance() {
  if (auto turned = stage_->turn(); !turned) {
    model_.tell(error_banner(Text::kLobbyDanceEnded, {}, turned.error().what));
    return end_dance();
  }
  const MonoTime now = mono_now();
  if (now - house_looked_at_ > kLookAtHouse) {
    house_looked_at_ = now;
    host_.look(model_, now, false);  // what a server says must be read, or it would wait
    house_->read();
    for (const std::string& line : house_->take_lines())
      if (const auto known = trouble_in(line, model_.settings); known && !known->is_fatal)
        model_.tell(known->banner);
    if (has_house_ended()) return end_dance();
  }
  return stage_->is_over() ? end_dance() : Result<void>();
}

Result<void> LobbyRun::end_dance() {
  const bool has_signal = source_->is_over();
  take_choices_of_dance();
  window_ = WindowRun::close(std::move(stage_));
  stage_.reset();
  source_.reset();
  stop_house();
  is_over_ = has_signal || window_->is_over();
  if (is_over_) return {};
  window_->set_events(input_);
  shelf_.note_dance_ends(model_);
  rooms_->ask(model_);
  return make_painter();
}

void LobbyRun::note_saved(const std::string& what, const std::string& kept_as) {
  if (!what.empty())
    model_.tell(error_banner(Text::kLobbySettingsBroken, {with_tilde(kept_as)}, what));
}

void LobbyRun::save() {
  if (window_) {
    const ViewWindow::Size size = window_->framebuffer_size();
    const auto unscaled = [&](int pixels, int least) {
      return std::clamp(
          static_cast<int>(std::lround(static_cast<float>(pixels) / window_->monitor_scale())),
          least, WindowChoices::kMost_px);
    };
    if (size.width_px > 0) {
      WindowChoices& window = model_.settings.window;
      window.width_px = unscaled(size.width_px, WindowChoices::kLeastWidth_px);
      window.height_px = unscaled(size.height_px, WindowChoices::kLeastHeight_px);
    }
  }
  const LobbySettings counts = only_what_counts(model_.settings);
  if (counts == saved_) return;
  auto saved = file_.save(counts);
  if (!saved) return model_.tell(error_banner(Text::kLobbyNotSaved, {}, saved.error().what));
  note_saved(saved->trouble, saved->kept_as);
  saved_ = counts;
}

}  // namespace dance
