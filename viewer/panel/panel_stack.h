// PanelStack: all panels of a window. Keys go to the panel opened last, then to those opened
// before, then to the others in order, until one takes them. The last added is drawn in front.
//
// Ownership: owns the panels.
// Threads:   the drawing thread.
// Failure:   none.
#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "viewer/panel/window_panel.h"

namespace dance {

class PanelStack {
 public:
  void add(std::unique_ptr<WindowPanel> panel) { panels_.push_back(std::move(panel)); }
  bool on_key(const KeyPress& press);
  bool on_character(char32_t character);
  void draw(const PanelFrame& frame);
  float bottom_px(const PanelFrame& frame) const;
  // The keys of all panels, each under the heading of its panel.
  struct Group {
    Text title = Text::kCount;
    std::span<const KeyHelp> keys;
  };
  std::vector<Group> key_groups() const;

 private:
  void note_open();

  std::vector<std::unique_ptr<WindowPanel>> panels_;
  std::vector<WindowPanel*> open_;  // the one opened last at the end
};

}  // namespace dance
