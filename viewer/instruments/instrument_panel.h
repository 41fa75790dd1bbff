// InstrumentPanel: key I: one row for each guest, a bar of where the time goes and its figures;
// beside it the last minute of the guest who is chosen, by Tab or a click.
//
// Units/frames: as WindowPanel.
// Ownership:    borrows the records, which must outlive it.
// Threads:      the drawing thread.
// Failure:      in a window that is too narrow the plots are left out; where there are more guests
//               than rows, those around the chosen one are shown.
#pragma once

#include "viewer/instruments/instrument_records.h"
#include "viewer/panel/window_panel.h"

namespace dance {

class PanelInk;

class InstrumentPanel : public WindowPanel {
 public:
  explicit InstrumentPanel(const InstrumentRecords& records) : records_(records) {}

  void open(bool is_open) { is_open_ = is_open; }
  void choose(const GuestId& guest) { chosen_ = guest; }
  // Not set: the first by name.
  const GuestId& chosen() const { return chosen_; }

  Text title() const override { return Text::kKeysEngineers; }
  std::span<const KeyHelp> keys() const override;
  bool is_open() const override { return is_open_; }
  bool on_key(const KeyPress& press) override;
  void draw(const PanelFrame& frame) override;

 private:
  struct Layout;
  std::size_t chosen_place() const;
  void draw_heads(const PanelInk& ink, const Layout& layout) const;
  void draw_row(const PanelInk& ink, const Layout& layout, const GuestRecord& record,
                float y) const;
  void draw_table(const PanelInk& ink, const Layout& layout);
  void draw_plots(const PanelInk& ink, const Layout& layout) const;

  const InstrumentRecords& records_;
  GuestId chosen_;
  bool is_open_ = false;
};

}  // namespace dance
