// LobbyInput: hands mouse and keys to Dear ImGui. What was pressed and let go between two pictures
// counts as pressed in the first and let go in the second, so that no click is lost.
//
// Units/frames: pixels of the framebuffer.
// Ownership:    keeps what has come since the last picture, at most kMostEvents.
// Threads:      the main thread.
// Failure:      events beyond the bound are left out.
#pragma once

#include <array>
#include <deque>

#include "viewer/window/view_window.h"

namespace dance {

class LobbyInput final : public WindowEvents {
 public:
  static constexpr std::size_t kMostEvents = 256;

  void on_key(const KeyPress&) override { has_news_ = true; }
  void on_drag(WindowDrag, float, float) override { has_news_ = true; }
  void on_wheel(float) override {}
  void on_raw_wheel(float notches) override;
  void on_raw_key(int key, bool is_down, int modifiers) override;
  void on_character(unsigned int character) override;
  void on_mouse_button(int button, bool is_down) override;

  // To the current context of Dear ImGui, once in its life.
  void begin(ViewWindow& window);
  // Before each picture. True where more waits for the next one.
  bool pass(ViewWindow& window);
  // Since it was asked last; the mouse has moved, too.
  bool take_news(ViewWindow& window);

 private:
  enum class Kind { kKey, kButton, kCharacter };
  struct Event {
    Kind kind;
    int which;
    bool is_down;
    int modifiers;
  };
  void add(const Event& event);
  static int nav_key(const Event& event);

  std::deque<Event> events_;
  std::array<bool, 3> mouse_down_{};
  float wheel_ = 0.0f;
  bool has_news_ = true;
  double mouse_x_ = -1.0, mouse_y_ = -1.0;
  int width_px_ = 0, height_px_ = 0;
};

}  // namespace dance
