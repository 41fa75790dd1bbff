// HelpPanel: the list of all keys, the window's and every panel's, over the picture: in as many
// columns, as large as fits, in several pages where the window is too small. `?` or F1 shows it,
// turns its pages and closes it; Esc closes it.
//
// Units/frames: as PanelFrame.
// Ownership:    borrows the stack whose panels it lists, and which owns it.
// Threads:      the drawing thread.
// Failure:      none.
#pragma once

#include <span>
#include <vector>

#include "viewer/panel/panel_stack.h"

namespace dance {

class HelpPanel final : public WindowPanel {
 public:
  // `own` are the window's own keys.
  HelpPanel(const PanelStack& panels, std::vector<PanelStack::Group> own)
      : panels_(panels), own_(std::move(own)) {}

  std::span<const KeyHelp> keys() const override { return {}; }
  bool is_open() const override { return page_ >= 0; }
  bool on_key(const KeyPress& press) override;
  void draw(const PanelFrame& frame) override;

  void open() { page_ = 0; }

 private:
  const PanelStack& panels_;
  std::vector<PanelStack::Group> own_;
  int page_ = -1;  // -1: closed
  int pages_ = 1;  // when it was drawn last
};

}  // namespace dance
