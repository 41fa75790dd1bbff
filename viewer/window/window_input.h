// WindowInput: what mouse and keys do: panels first, then the window's own keys and the camera.
//
// Units/frames: drags as shares of the window's height.
// Ownership:    borrows state, director and panels.
// Threads:      the main thread, in ViewWindow::poll_events().
// Failure:      none.
#pragma once

#include "viewer/panel/panel_stack.h"
#include "viewer/view/view_director.h"
#include "viewer/window/view_window.h"
#include "viewer/window/window_keys.h"
#include "viewer/window/window_state.h"

namespace dance {

class WindowInput final : public WindowEvents {
 public:
  WindowInput(WindowState& state, ViewDirector& director, PanelStack& panels)
      : state_(state), director_(director), panels_(panels) {}

  void on_key(const KeyPress& press) override;
  void on_key_released(const KeyPress& press) override;
  void on_character(unsigned int character) override { panels_.on_character(character); }
  void on_drag(WindowDrag drag, float right, float up) override;
  void on_wheel(float notches) override { director_.zoom(notches); }

 private:
  void obey(const WindowCommand& command);

  WindowState& state_;
  ViewDirector& director_;
  PanelStack& panels_;
};

}  // namespace dance
