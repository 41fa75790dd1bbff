// TimelinePanel: what a video player has under its picture, for a recorded night: play, pause,
// steps, speed, loop and export; a bar with times, beats and bars, when each guest danced and where
// a lapse was; scrubbing with the mouse.
//
// Units/frames: pixels; sizes in letters' heights, so that it grows with the monitor's scale.
// Ownership:    borrows the source.
// Threads:      the drawing thread.
// Failure:      none; until the log is looked through it shows how far that is.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "viewer/panel/window_panel.h"
#include "viewer/replay/export/replay_export.h"
#include "viewer/replay/replay_source.h"
#include "viewer/replay/timeline/timeline_scale.h"

namespace dance {

class TimelinePanel : public WindowPanel {
 public:
  // What an export needs beside the recording; empty: there is no export.
  using StartExport = std::function<void(ExportKind)>;
  struct Exporting {
    StartExport start;
    std::function<void()> cancel;
    // "writing x.mp4: 43 %", or what came of it; "" when nothing was asked for.
    std::function<std::string()> note;
    std::function<bool()> is_running;
  };

  explicit TimelinePanel(ReplaySource& source, Exporting exporting = {})
      : source_(source), exporting_(std::move(exporting)) {}

  Text title() const override { return Text::kKeysRecording; }
  std::span<const KeyHelp> keys() const override;
  // While it asks about exports.
  bool is_open() const override { return asks_what_to_export_; }
  bool on_key(const KeyPress& press) override;
  void draw(const PanelFrame& frame) override;
  float bottom_px(const PanelFrame& frame) const override;

 private:
  struct Ink;
  struct Box;

  bool on_player_key(const KeyPress& press, ReplayPlayer& player);
  bool on_export_key(const KeyPress& press);
  bool exports() const { return exporting_.is_running && exporting_.is_running(); }
  void ask_about_export(bool asks);
  void draw_waiting(const Ink& ink, const Box& box) const;
  void draw_controls(const Ink& ink, const Box& box, ReplayPlayer& player);
  void draw_tip(const Ink& ink, const Box& box) const;
  void draw_words(const Ink& ink, const Box& box, const ReplayPlayer& player, float left) const;
  void draw_bar(const Ink& ink, const Box& box, const ReplayPlayer& player) const;
  void draw_density(const Ink& ink, const Box& box) const;
  void draw_ticks(const Ink& ink, const Box& box) const;
  void draw_guests(const Ink& ink, const Box& box) const;
  void draw_hover(const Ink& ink, const Box& box) const;
  void draw_export(const Ink& ink, const Box& box);
  void use_mouse(const Box& box, ReplayPlayer& player);
  std::string gap_text(MonoTime moment, float y, const Box& box) const;

  ReplaySource& source_;
  Texts texts_{Language::kEnglish};
  ShownNames names_;         // those of the last picture
  Text tip_ = Text::kCount;  // of the button under the mouse; kCount: none
  Exporting exporting_;
  std::optional<TimelineScale> scale_;
  MonoTime followed_;
  bool asks_what_to_export_ = false;
  bool asks_of_running_ = false;  // what to do with it
  bool is_scrubbing_ = false;
  bool was_playing_ = false;
  std::optional<float> hover_px_, hover_y_px_;
};

}  // namespace dance
