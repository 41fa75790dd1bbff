// Starts a dance from the window: reports what would prevent it, then starts the house. Takes over
// what was changed during the dance.
#include <utility>

#include "core/net/mono_clock.h"
#include "lobby/checks/sound_check.h"
#include "lobby/run/lobby_run.h"
#include "viewer/scene/place.h"

namespace dance {
namespace {

// Returns the arguments of `dance join`; the house file holds the rest.
std::vector<std::string> house_words(const std::string& file, LobbyWish wish,
                                     const WindowChoices& window) {
  std::vector<std::string> words{file, "--no-view"};
  words.push_back("--band=" + window.band);
  if (wish == LobbyWish::kWatchRoom) words.emplace_back("--watch");
  if (wish == LobbyWish::kJoin || wish == LobbyWish::kWatchRoom) return words;
  words.emplace_back("--alone");
  if (wish == LobbyWish::kAlone) words.push_back("--partner=" + window.partner);
  if (wish == LobbyWish::kPractise && !window.music.empty())
    words.push_back("--music=" + window.music);
  return words;
}

}  // namespace

// Returns the error that prevents a start; nullopt = none.
std::optional<LobbyBanner> LobbyRun::find_start_error(LobbyWish wish) {
  LobbySettings chosen = house_settings();
  if (wish == LobbyWish::kWatchRoom) {
    chosen.source = DancerSource::kWatch;
    wish = LobbyWish::kJoin;
  }
  // Sound errors do not delay an invitation: the voice program reports them in the room.
  const bool needs_sound = wish == LobbyWish::kJoin && chosen.speaks && model_.has_voice &&
                           chosen.source != DancerSource::kWatch && !trial_;
  model_.sound_error = needs_sound ? sound_server_error() : "";
  return model_.start_error(wish, chosen);
}

// Returns the path of the house file to start with; nullopt, with a banner, if writing it failed.
std::optional<std::string> LobbyRun::house_file() {
  if (!trial_) {
    save();
    if (!(saved_ == only_what_counts(model_.settings))) return std::nullopt;
    return file_.path();
  }
  auto saved = file_.save_trial(*trial_);
  if (saved) return *saved;
  model_.tell(error_banner(Text::kLobbyNotSaved, {}, saved.error().what));
  return std::nullopt;
}

void LobbyRun::go_in(LobbyWish wish) {
  if (chooses_source_ && !model_.knows_cameras && !trial_) {
    model_.wish = wish;  // waits until the cameras of a new dancer are listed
    return;
  }
  model_.banners.clear();
  if (auto error = find_start_error(wish)) return model_.tell(std::move(*error));
  const auto file = house_file();
  if (!file) return;
  seen_.stop(model_);  // the house opens the camera
  auto started = ChildWords::start("dance-join", house_words(*file, wish, model_.settings.window));
  if (!started) return model_.tell(error_banner(Text::kLobbyDanceEnded, {}, started.error().what));
  house_ = std::move(*started);
  house_for_ = wish == LobbyWish::kWatchRoom ? LobbyWish::kJoin : wish;
  going_since_ = mono_now();
  model_.is_going_in = true;
}

// A place that was chosen by key during the dance stays for the next one. The dance panel saves
// into the same file as the lobby.
void LobbyRun::take_choices_of_dance() {
  model_.settings.window.place = name_of(stage_->state().place);
  if (!saved_) return;
  const auto opened = file_.open();
  if (!opened || opened->is_new) return;
  note_saved(opened->trouble, opened->kept_as);
  if (!opened->kept_as.empty()) return saved_.reset();
  model_.take_changes(*saved_, opened->settings);
  saved_ = opened->settings;
}

void LobbyRun::choose_practice_view() {
  const WindowChoices& window = model_.settings.window;
  view_.panel = "practice";
  view_.pupil = GuestId::parse(model_.settings.name);
  view_.teacher.file = window.teacher;
  if (!window.mirror) return;
  view_.view = ViewMode::kMirror;
  view_.focus = view_.pupil;
}

}  // namespace dance
