// PanelStack: all panels of a window. Keys go to the first that takes them; the last is in front.
//
// Ownership: owns the panels.
// Threads:   the drawing thread.
// Failure:   none.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "viewer/panel/window_panel.h"

namespace dance {

class PanelStack {
 public:
  void add(std::unique_ptr<WindowPanel> panel) { panels_.push_back(std::move(panel)); }
  bool on_key(const KeyPress& press);
  void draw(const PanelFrame& frame);
  float bottom_px(const PanelFrame& frame) const;
  std::vector<KeyHelp> keys() const;
  // As keys(), under the heading of each panel.
  struct Group {
    std::string_view title;
    std::span<const KeyHelp> keys;
  };
  std::vector<Group> key_groups() const;

 private:
  std::vector<std::unique_ptr<WindowPanel>> panels_;
};

}  // namespace dance
