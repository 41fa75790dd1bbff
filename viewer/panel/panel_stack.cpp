#include "viewer/panel/panel_stack.h"

#include <algorithm>

namespace dance {

// Panels open by a key, by a click or from the beginning; each is looked at before keys and
// pictures.
void PanelStack::note_open() {
  std::erase_if(open_, [](const WindowPanel* panel) { return !panel->is_open(); });
  for (const auto& panel : panels_)
    if (panel->is_open() && std::ranges::find(open_, panel.get()) == open_.end())
      open_.push_back(panel.get());
}

bool PanelStack::on_key(const KeyPress& press) {
  note_open();
  const std::vector<WindowPanel*> open = open_;
  bool is_taken = std::any_of(open.rbegin(), open.rend(),
                              [&](WindowPanel* panel) { return panel->on_key(press); });
  for (const auto& panel : panels_) {
    if (is_taken) break;
    if (std::ranges::find(open, panel.get()) == open.end()) is_taken = panel->on_key(press);
  }
  note_open();
  return is_taken;
}

bool PanelStack::on_character(char32_t character) {
  note_open();
  return std::any_of(open_.rbegin(), open_.rend(),
                     [&](WindowPanel* panel) { return panel->on_character(character); });
}

void PanelStack::draw(const PanelFrame& frame) {
  note_open();
  for (const auto& panel : panels_) panel->draw(frame);
}

float PanelStack::bottom_px(const PanelFrame& frame) const {
  float most = 0.0f;
  for (const auto& panel : panels_) most = std::max(most, panel->bottom_px(frame));
  return most;
}

std::vector<PanelStack::Group> PanelStack::key_groups() const {
  std::vector<Group> groups;
  for (const auto& panel : panels_)
    if (!panel->keys().empty()) groups.push_back({panel->title(), panel->keys()});
  return groups;
}

}  // namespace dance
