// LobbyRun: the window before, between and after dances: draws the lobby when something is new,
// does what is asked for, and gives the window to the stage while there is a dance. The house runs
// as `dance join` beside it: whatever becomes of it, the window stays.
//
// Units/frames: MonoTime of this process.
// Ownership:    owns window, painter and programs; all end with it.
// Threads:      the main thread, as window systems want it.
// Failure:      create() and run() name what display or driver refuse; all else is a banner.
#pragma once

#include <memory>
#include <optional>

#include "core/net/poller.h"
#include "lobby/run/child_words.h"
#include "lobby/run/invitation_opener.h"
#include "lobby/run/known_rooms.h"
#include "lobby/run/lobby_input.h"
#include "lobby/run/lobby_painter.h"
#include "lobby/run/room_host.h"
#include "lobby/run/seen_and_heard.h"
#include "lobby/settings/settings_file.h"
#include "viewer/window/window_run.h"

namespace dance {

class LobbyRun {
 public:
  // The file with what was chosen.
  static Result<std::unique_ptr<LobbyRun>> create(const std::string& settings_path);
  // dance://…, as if it had been pasted.
  void open(const std::string& invitation);
  ~LobbyRun();

  // Until the window is closed or a signal comes.
  Result<void> run();
  // One turn: of the lobby, or of the dance.
  Result<void> turn();
  bool is_over() const { return is_over_; }

  // For tests.
  LobbyModel& model() { return model_; }
  ViewWindow* window() { return stage_ ? &stage_->window() : window_.get(); }
  WindowRun* stage() { return stage_.get(); }
  int pictures() const { return pictures_; }

 private:
  explicit LobbyRun(std::string settings_path) : file_(std::move(settings_path)) {}
  Result<void> open_window();
  Result<void> make_painter();
  Result<void> turn_of_lobby();
  Result<void> draw();
  bool look_around(MonoTime now);
  bool look_at_house(MonoTime now);
  bool look_at_invitation();
  void open_invitation_typed();
  void obey(LobbyWish wish);
  void go_in(LobbyWish wish);
  bool has_house_ended();
  void stop_house();
  Result<void> begin_dance();
  Result<void> turn_of_dance();
  Result<void> end_dance();
  void save();
  void note_saved(const std::string& trouble, const std::string& kept_as);
  Duration patience(MonoTime now) const;

  SettingsFile file_;
  std::optional<LobbySettings> saved_;  // not set: nothing stands in the file
  LobbyModel model_;
  std::unique_ptr<Poller> poller_;  // for signals
  LobbyInput input_;
  std::unique_ptr<ViewWindow> window_;
  std::unique_ptr<LobbyPainter> painter_;
  std::unique_ptr<KnownRooms> rooms_;
  std::unique_ptr<InvitationOpener> opener_;
  RoomHost host_;
  SeenAndHeard seen_;
  bool chooses_source_ = false;      // a new dancer's, once the cameras are known
  std::optional<ChildWords> house_;  // dance join
  LobbyWish house_for_ = LobbyWish::kNone;
  MonoTime going_since_;
  // The stage: what it refers to comes first.
  ViewOptions view_;
  std::unique_ptr<PictureSource> source_;
  std::unique_ptr<WindowRun> stage_;
  MonoTime house_looked_at_;
  int fresh_frames_ = 0;  // to draw: Dear ImGui settles in some
  MonoTime drawn_;
  int pictures_ = 0;
  bool has_told_graphics_ = false;
  bool is_over_ = false;
};

}  // namespace dance
