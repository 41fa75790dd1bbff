// StylePanel: key S: how the stage shows the chosen guest: which transformers are used and with
// what settings, and how large each zone of the body dances. Changes are live; Save writes them
// into the session file.
//
// Units/frames: as lcmtypes/flow_t.lcm and style_t.lcm say.
// Ownership:    owns the session file; borrows records and board, which must outlive it.
// Threads:      the drawing thread.
// Failure:      of a recording it shows what was in force and changes nothing; what nobody takes,
//               and what cannot be saved, it says in its last line.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "formats/session/session_file.h"
#include "viewer/instruments/instrument_records.h"
#include "viewer/panel/window_panel.h"
#include "viewer/style_panel/setting_desk.h"

namespace dance {

bool is_same_style(const Style& a, const Style& b);

class StylePanel : public WindowPanel {
 public:
  // `file` may be null: then nothing can be saved. A recording is not live.
  StylePanel(const InstrumentRecords& records, InstrumentBoard& board,
             std::shared_ptr<SessionFile> file, bool is_live)
      : records_(records), board_(board), file_(std::move(file)), is_live_(is_live) {}

  void open(bool is_open) { is_open_ = is_open; }
  void choose(const GuestId& guest) { chosen_ = guest; }
  const GuestRecord* chosen() const;  // else the first by name; null where nobody is
  // What a person would do with sliders and buttons.
  void change(const FlowSetting& setting, MonoTime now) { flow_.change(setting, now); }
  void change(const Style& style, MonoTime now) { own_.change(style, now); }
  // What is in force, unless something is being changed.
  void follow(MonoTime now);
  void save();
  const FlowSetting& setting() const { return flow_.setting(); }
  const std::string& note() const { return note_; }

  Text title() const override { return Text::kKeysStyle; }
  std::span<const KeyHelp> keys() const override;
  bool is_open() const override { return is_open_; }
  bool on_key(const KeyPress& press) override;
  void draw(const PanelFrame& frame) override;

 private:
  void choose_next(std::size_t step);
  void draw_guest(const PanelFrame& frame);
  void draw_content(const PanelFrame& frame, const GuestRecord& record);
  void draw_footer();

  const InstrumentRecords& records_;
  InstrumentBoard& board_;
  std::shared_ptr<SessionFile> file_;  // other panels save there, too
  bool is_live_;
  bool is_open_ = false;
  GuestId chosen_, followed_;
  SettingDesk<FlowSetting, is_same_setting> flow_;
  SettingDesk<Style, is_same_style> own_;
  std::string note_;
  bool is_note_error_ = false;
  float last_height_px_ = 0.0f;
};

}  // namespace dance
