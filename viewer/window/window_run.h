// WindowRun: the window's loop: events, the moment at which poses are taken (DisplayPath), the
// picture, the swap, and what was measured on the way. It outlives a lost OpenGL context.
//
// Units/frames: MonoTime of this process; the scene in the house's clock.
// Ownership:    owns window, painter and panels; borrows the source and the options. close() gives
//               the window to who shows something else in it.
// Threads:      the main thread. The bus has its own: a swap that waits holds up nothing else.
// Failure:      create() and run() name what display or driver refuse, and the cure.
#pragma once

#include <memory>

#include "core/program/program.h"
#include "viewer/avatar/user_avatars.h"
#include "viewer/dance_panel/banner_watch.h"
#include "viewer/display/display_path.h"
#include "viewer/display/render_scale.h"
#include "viewer/display/swap_meter.h"
#include "viewer/feed/photon_predictor.h"
#include "viewer/feed/picture_source.h"
#include "viewer/instruments/instrument_records.h"
#include "viewer/replay/recorded_teacher.h"
#include "viewer/stage/stage_painter.h"
#include "viewer/view/view_director.h"
#include "viewer/window/view_window.h"
#include "viewer/window/voice_keys.h"
#include "viewer/window/window_export.h"
#include "viewer/window/window_input.h"
#include "viewer/window/window_notes.h"
#include "viewer/window/window_state.h"

namespace dance {

// How often pictures come, averaged over about a second.
class PictureRate {
 public:
  void on_picture(MonoTime now) {
    if (last_.is_set()) {
      const double period_s = (now - last_).as_seconds();
      mean_period_s_ += std::min(1.0, period_s) * (period_s - mean_period_s_);
    }
    last_ = now;
  }
  double hz() const { return 1.0 / mean_period_s_; }

 private:
  MonoTime last_;
  double mean_period_s_ = 1.0 / 60.0;
};

class WindowRun {
 public:
  // In a window of its own, or in one that is open and shows nothing else meanwhile.
  static Result<std::unique_ptr<WindowRun>> create(const ViewOptions& options,
                                                   PictureSource& source,
                                                   std::unique_ptr<ViewWindow> window = nullptr);
  // Gives the window back, which must be told at once who hears its events from now on.
  static std::unique_ptr<ViewWindow> close(std::unique_ptr<WindowRun> run);
  ~WindowRun();

  // Until the window is closed or the source ends.
  Result<void> run();
  // One turn of it.
  Result<void> turn();
  bool is_over() const;

  // For tests.
  ViewWindow& window() { return *window_; }
  StagePainter& painter() { return *painter_; }
  AvatarLibrary& avatars() { return avatars_; }
  WindowInput& input() { return input_; }
  const WindowState& state() const { return state_; }
  DanceWishes& wishes() { return state_.dance; }
  const ViewDirector& director() const { return director_; }
  const SceneState& scene() const { return scene_; }
  int contexts_lost() const { return contexts_lost_; }
  int pictures() const { return pictures_; }
  const DisplayPath& path() const { return path_; }
  const RenderScale& render_scale() const { return render_scale_; }

 private:
  WindowRun(const ViewOptions& options, PictureSource& source);
  Result<void> make_painter();
  Result<void> renew_after_loss();
  void apply_display_mode();
  void look_at_monitor(MonoTime now);
  void wait_to_take();
  void take_poses(MonoTime now);
  Result<void> obey_wishes();
  void ask_before_closing();
  Result<void> turn_to_next_picture();
  void hide_guests();
  void let_teacher_join();
  void choose_guest();
  void write_notes(MonoTime now);
  Result<void> draw(ViewWindow::Size size, Duration since_last);
  Result<void> show(ViewWindow::Size size);
  void report(const PictureTimes& times);
  bool scales_pictures() const;
  void take_picture(MonoTime now);
  MonoTime house_time(MonoTime now);

  const ViewOptions& options_;
  PictureSource& source_;
  WindowState state_;
  ViewDirector director_;
  AvatarLibrary avatars_{
      avatars_of(AvatarStore::of_user(), data_folder() + "/avatars", options_.avatars)};
  InstrumentRecords records_;
  std::unique_ptr<RecordedTeacher> teacher_;  // null: none
  TeacherChoices teacher_choices_{options_.teacher.choices};
  BannerWatch::Drawing drawing_;
  bool draws_plainly_ = false;  // asked for, as drawing was slow
  PanelStack panels_;
  VoiceKeys voice_keys_;
  WindowInput input_{state_, director_, panels_};
  std::unique_ptr<ViewWindow> window_;
  std::unique_ptr<StagePainter> painter_;
  DisplayPath path_;
  DisplayMode display_;       // that the window has been told
  double refresh_hz_ = 60.0;  // that the path goes by
  MonoTime monitor_looked_at_;
  std::string picture_words_;  // about the last picture that was taken
  MonoTime picture_taken_;
  int place_changes_shown_ = 0;
  MonoTime place_changed_;
  RenderScale render_scale_;
  SwapMeter meter_;
  std::optional<SwapFigures> swap_figures_;
  MonoTime figures_since_;
  PictureRate rate_;
  MonoTime begun_;
  StageRoster roster_;
  PhotonPredictor predictor_;
  WindowExport export_{options_, source_, director_, avatars_};
  MonoTime last_picture_;
  SceneState scene_;
  bool focus_was_here_ = false;
  int contexts_lost_ = 0;
  int pictures_ = 0;
};

}  // namespace dance
