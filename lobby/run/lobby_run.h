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
#include "lobby/figures/lobby_figures.h"
#include "lobby/run/child_words.h"
#include "lobby/run/dance_shelf.h"
#include "lobby/run/invitation_opener.h"
#include "lobby/run/known_rooms.h"
#include "lobby/run/lobby_input.h"
#include "lobby/run/lobby_painter.h"
#include "lobby/run/machine_facts.h"
#include "lobby/run/room_host.h"
#include "lobby/run/seen_and_heard.h"
#include "lobby/settings/settings_file.h"
#include "viewer/window/window_run.h"

namespace dance {

class LobbyRun {
 public:
  // `settings_path` is the house file that the window keeps. `invitation` is a link from outside,
  // dance://…, or "": it is shown as a question, and until that is answered no device is opened.
  static Result<std::unique_ptr<LobbyRun>> create(const std::string& settings_path,
                                                  const std::string& invitation = "");
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
  void draw_dancers(MonoTime now);
  bool look_around(MonoTime now);
  void release_painters();
  bool look_at_house(MonoTime now);
  bool look_at_invitation();
  void open_invitation_typed();
  bool has_joined(const Invitation& invitation) const;
  void confirm_join();
  void cancel();
  void look_for_cameras_once();
  void obey(LobbyWish wish);
  void go_in(LobbyWish wish);
  std::optional<LobbyBanner> find_start_error(LobbyWish wish);
  std::optional<std::string> house_file();
  void keep_trial();
  // The settings that the house was started with.
  const LobbySettings& house_settings() const { return trial_ ? *trial_ : model_.settings; }
  bool has_house_ended();
  void stop_house();
  Result<void> begin_dance();
  void choose_practice_view();
  Result<void> turn_of_dance();
  Result<void> end_dance();
  void take_choices_of_dance();
  void save();
  void note_saved(const std::string& trouble, const std::string& kept_as);
  Duration longest_wait(MonoTime now) const;

  SettingsFile file_;
  std::optional<LobbySettings> saved_;  // not set: nothing stands in the file
  LobbyModel model_;
  std::optional<Invitation> invitation_;  // the one that model_.join_request asks about
  MonoTime asked_;                        // when the question appeared
  // Settings of an invitation: saved as the model's when the server has admitted the house.
  std::optional<LobbySettings> trial_;
  std::unique_ptr<Poller> poller_;  // for signals
  LobbyInput input_;
  std::unique_ptr<ViewWindow> window_;
  std::unique_ptr<LobbyPainter> painter_;
  std::unique_ptr<LobbyFigures> figures_;  // from create() on
  std::unique_ptr<KnownRooms> rooms_;
  std::unique_ptr<InvitationOpener> opener_;
  RoomHost host_;
  SeenAndHeard seen_;
  DanceShelf shelf_{recording_folders()};
  bool has_looked_for_cameras_ = false;
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
  MonoTime drawn_, dancers_drawn_;
  int pictures_ = 0;
  bool has_told_graphics_ = false;
  bool is_over_ = false;
};

}  // namespace dance
