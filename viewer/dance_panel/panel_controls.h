// PanelControls: buttons, rows and sliders that work with the mouse alone and with the keyboard
// alone: up and down go from one to the next, left and right change a value, Enter presses.
//
// Units/frames: pixels; `em` is the height of a line's letters.
// Ownership:    remembers the controls of the last picture; at most kMost.
// Threads:      the drawing thread, between ImGui's Begin and End.
// Failure:      a control that has gone gives the keyboard to the one that is in its place.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <vector>

#include "viewer/panel/window_panel.h"

namespace dance {

class PanelControls {
 public:
  static constexpr std::size_t kMost = 1024;
  enum class Look : std::uint8_t { kPlain, kStrong, kWarning, kQuiet };

  // True where the key is one of these.
  bool on_key(const KeyPress& press);
  // Nothing has the keyboard any more.
  void let_go() { has_keyboard_ = false, focus_ = 0; }

  // Around all controls of a picture.
  void begin();
  void end();

  // Next to the last control where there is room in this line for that much, else below it.
  void flow(float width);
  // For what the keyboard has a key of its own for.
  bool mouse_button(const char* id, const char* label, Look look);
  // The keyboard goes to the control that was just made, where a person uses it.
  void take_keyboard();
  float width_of(const char* label) const;
  bool button(const char* id, const char* label, Look look = Look::kPlain, float width = 0.0f);
  // The whole line; the caller draws on it, from its low corner on.
  bool row(const char* id, float height);
  bool slider(const char* id, float width, float& value, float least, float most, float step,
              const char* words);

  bool has_keyboard() const { return has_keyboard_; }

 private:
  // The control that was just made has the keyboard.
  bool settle(ImGuiID id);
  bool draw_button(const char* label, Look look, float width);

  std::vector<ImGuiID> order_, last_order_;
  ImGuiID focus_ = 0;
  std::size_t place_ = 0;  // of it, among the others
  bool has_keyboard_ = false;
  bool is_pressed_ = false;  // Enter, since the last picture
  int steps_ = 0;            // left and right
  int scrolls_ = 0;          // for so many pictures it is scrolled to: lists grow meanwhile
};

}  // namespace dance
