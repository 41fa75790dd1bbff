// PanelStack: all panels of a window. Keys go to the first that takes them; the last is in front.
//
// Ownership: owns the panels.
// Threads:   the drawing thread.
// Failure:   none.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "viewer/panel/window_panel.h"

namespace dance {

class PanelStack {
 public:
  void add(std::unique_ptr<WindowPanel> panel) { panels_.push_back(std::move(panel)); }
  bool on_key(const KeyPress& press);
  void draw(const PanelFrame& frame);
  std::vector<KeyHelp> keys() const;

 private:
  std::vector<std::unique_ptr<WindowPanel>> panels_;
};

}  // namespace dance
