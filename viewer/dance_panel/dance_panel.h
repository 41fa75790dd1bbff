// DancePanel: what a dancer works with during the dance, at one side of the window: the guests and
// how well each comes over, the music, the own voice, recording, leaving; and above the picture,
// whether it is open or not, one banner that says what is wrong and how it is mended.
//
// Units/frames: pixels from the top left.
// Ownership:    borrows what DanceNeeds names, which must outlive it; owns the recording.
// Threads:      the drawing thread.
// Failure:      what cannot be told or recorded is said in the panel.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "viewer/dance_panel/arrivals.h"
#include "viewer/dance_panel/banner_watch.h"
#include "viewer/dance_panel/count_in.h"
#include "viewer/dance_panel/dance_records.h"
#include "viewer/dance_panel/dance_wishes.h"
#include "viewer/dance_panel/music_desk.h"
#include "viewer/dance_panel/own/own_choices.h"
#include "viewer/dance_panel/panel_controls.h"
#include "viewer/dance_panel/recording.h"
#include "viewer/dance_panel/removal_desk.h"
#include "viewer/panel/window_panel.h"

namespace dance {

struct DanceNeeds {
  DanceBoard& board;
  const InstrumentRecords& figures;
  DanceWishes& wishes;
  const BannerWatch::Drawing& drawing;
  Language language = Language::kEnglish;
  DanceRecording::Options recording;
  // A line for the dance voice of a guest of this house, as "volume bob=0.5".
  std::function<Result<void>(const GuestId& guest, std::string_view command)> send_voice_command;
  // The machine's wall clock, since any zero of its own.
  std::function<Duration()> wall;
  MusicDesk::Needs music = {};
  // The guest is a synthetic dancer of this house; `role` is "lead", "follow" or "any".
  std::function<bool(const GuestId& guest)> has_role = {};
  std::function<Result<void>(const GuestId& guest, std::string_view role)> send_role = {};
  OwnNeeds own = {};
};

class DancePanel : public WindowPanel {
 public:
  explicit DancePanel(DanceNeeds needs)
      : needs_(std::move(needs)),
        texts_(needs_.language),
        recording_(needs_.recording),
        music_(needs_.music),
        own_(needs_.own, needs_.language) {}
  ~DancePanel() override { music_.keep(); }

  void open(bool is_open);
  // While one of these is open this panel is at the left.
  void yield_to(const WindowPanel& other) { rivals_.push_back(&other); }
  void choose(const GuestId& guest) { chosen_ = guest; }
  DanceRecords& records() { return records_; }
  const DanceRecording& recording() const { return recording_; }
  const OwnChoices& own() const { return own_; }

  Text title() const override { return Text::kDancePanel; }
  std::span<const KeyHelp> keys() const override;
  bool is_open() const override { return is_open_; }
  bool on_key(const KeyPress& press) override;
  bool on_character(char32_t character) override { return own_.on_character(character); }
  void draw(const PanelFrame& frame) override;

 private:
  void work(const PanelFrame& frame);
  void note_mouse(MonoTime now);
  bool is_at_left() const;

  // dance_panel_over.cpp
  void draw_corner(const PanelFrame& frame);
  float draw_banner(const PanelFrame& frame);  // returns its lower edge; 0: no banner
  void draw_slow_note(const PanelFrame& frame);
  // Returns its lower edge, or banner_end_px if no other house records.
  float draw_recorders(const PanelFrame& frame, float banner_end_px) const;
  void draw_arrivals(const PanelFrame& frame, float banner_end_px) const;
  void draw_closing(const PanelFrame& frame);
  void answer_closing(bool closes);
  void draw_count(const PanelFrame& frame) const;
  void draw_column(const PanelFrame& frame);
  void draw_music(const PanelFrame& frame);
  void draw_lamps(const SceneMusic& music) const;
  void draw_music_volume(MonoTime now);
  void draw_own(const PanelFrame& frame);
  void draw_voice_switch(const GuestId& speaker, MonoTime now);
  void draw_footer(const PanelFrame& frame);
  void act(BannerAction action);

  // dance_panel_band.cpp
  std::optional<std::string> band_title() const;
  void draw_band();
  bool has_own_song() const;
  bool finds_beat(const PanelFrame& frame) const;
  void draw_own_song();
  void draw_roles(const DanceGuest& guest, MonoTime now);

  // dance_panel_guests.cpp
  void draw_guests(const PanelFrame& frame, float height);
  void draw_guest(const PanelFrame& frame, const DanceGuest& guest);
  void draw_choices(const PanelFrame& frame, const DanceGuest& guest);
  std::string_view chosen_name(const GuestId& guest) const;
  void draw_removal(const DanceGuest& guest, MonoTime now);
  std::string removal_question(const DanceGuest& guest) const;
  float guests_height() const;
  float guest_height(const DanceGuest& guest) const;
  void tell_volume(const SceneState& scene, const GuestId& guest);
  void tell_volumes_anew(const SceneState& scene);
  void set_hidden(const GuestId& guest, bool is_hidden);
  bool may_remove() const;

  DanceNeeds needs_;
  Texts texts_;
  ShownNames names_;  // those of the last picture
  DanceRecords records_;
  BannerWatch watch_;
  BannerChoice banners_;
  SlowNote slow_note_;
  Arrivals arrivals_;
  DanceRecording recording_;
  MusicDesk music_;
  OwnChoices own_;
  RemovalDesk removal_;
  CountIn count_in_;
  std::optional<CountIn::Count> count_;
  PanelControls controls_;
  std::vector<const WindowPanel*> rivals_;
  bool is_open_ = false;
  GuestId chosen_;      // the guest whose choices are shown
  GuestId role_guest_;  // the guest that has_role_ was read for
  MonoTime role_read_;  // when it was read
  bool has_role_ = false;
  GuestId to_be_removed_;          // asked back about
  bool is_removal_asked_ = false;  // in this picture
  std::string voice_trouble_;      // why a voice could not be told
  std::size_t voices_ = 0;         // that ran in the last picture
  float last_height_px_ = 0.0f;
  float footer_px_ = 0.0f;
  float banner_px_ = 0.0f;  // its height in the last picture
  ImVec2 mouse_{-1e6f, -1e6f};
  MonoTime mouse_moved_;
};

}  // namespace dance
