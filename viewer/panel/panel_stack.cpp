#include "viewer/panel/panel_stack.h"

#include <algorithm>

namespace dance {

bool PanelStack::on_key(const KeyPress& press) {
  for (const auto& panel : panels_)
    if (panel->on_key(press)) return true;
  return false;
}

void PanelStack::draw(const PanelFrame& frame) {
  for (const auto& panel : panels_) panel->draw(frame);
}

float PanelStack::bottom_px(const PanelFrame& frame) const {
  float most = 0.0f;
  for (const auto& panel : panels_) most = std::max(most, panel->bottom_px(frame));
  return most;
}

std::vector<KeyHelp> PanelStack::keys() const {
  std::vector<KeyHelp> all;
  for (const auto& panel : panels_)
    all.insert(all.end(), panel->keys().begin(), panel->keys().end());
  return all;
}

std::vector<PanelStack::Group> PanelStack::key_groups() const {
  std::vector<Group> groups;
  for (const auto& panel : panels_)
    if (!panel->keys().empty()) groups.push_back({panel->title(), panel->keys()});
  return groups;
}

}  // namespace dance
