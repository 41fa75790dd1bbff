// ViewWindow: a GLFW window with an OpenGL 3.3 core context. Mouse and keys go to WindowEvents.
//
// Units/frames: drags as shares of the window's height.
// Ownership:    owns the window; one per process. Borrows who hears its events.
// Threads:      the main thread, as window systems want it.
// Failure:      create() and renew() report a missing display or OpenGL, and the alternative. A
//               context that the driver has given up is told by is_context_lost().
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/base/result.h"
#include "core/base/time.h"
#include "viewer/panel/window_panel.h"
#include "viewer/window/mouse_buttons.h"

struct GLFWwindow;

namespace dance {

enum class WindowDrag { kNone, kOrbit, kPan };

class WindowEvents {
 public:
  virtual ~WindowEvents() = default;
  virtual void on_key(const KeyPress& press) = 0;
  // A key was let go; all are when the window is left.
  virtual void on_key_released(const KeyPress&) {}
  virtual void on_drag(WindowDrag drag, float right, float up) = 0;
  virtual void on_wheel(float notches) = 0;
  // As the window system tells it, for those who hand everything to Dear ImGui: a key by its place
  // (GLFW_KEY_…), a character that was typed, buttons and wheel of the mouse.
  virtual void on_raw_key(int /*key*/, bool /*is_down*/, int /*modifiers*/) {}
  virtual void on_character(unsigned int /*character*/) {}
  virtual void on_mouse_button(int /*button*/, bool /*is_down*/) {}
  virtual void on_raw_wheel(float /*notches*/) {}
};

class ViewWindow {
 public:
  struct Size {
    int width_px;
    int height_px;
  };

  static Result<std::unique_ptr<ViewWindow>> create(Size size, WindowEvents& events);
  ~ViewWindow();
  // Who hears the events from now on: a window outlives what is shown in it.
  void set_events(WindowEvents& events);
  ViewWindow(const ViewWindow&) = delete;
  ViewWindow& operator=(const ViewWindow&) = delete;

  void poll_events();
  // Returns early on mouse or key events.
  void wait_for_events(Duration longest);
  // Shows what was drawn; waits for the display's turn where the driver can.
  void swap();
  // Whether swap() waits. Otherwise a late picture is shown at once: with the driver's help only
  // that one (true is returned), else any.
  bool set_tear_free(bool is_tear_free);

  // The graphics card was reset, or the driver has lost what it knew. Everything of OpenGL must be
  // let go; renew() then gives a window at the same place with another context.
  bool is_context_lost() const;
  Result<void> renew();
  // As if the driver had said so: for tests.
  void lose_context() { is_made_lost_ = true; }
  // Notes that were shown in this window and are not shown again, also in the dances that follow.
  struct ShownNotes {
    bool slow_drawing = false;
  };
  ShownNotes& shown_notes() { return shown_notes_; }
  // As if it had been moved to a monitor of that rate: for tests.
  void set_refresh_hz(double refresh_hz) { told_refresh_hz_ = refresh_hz; }

  Size framebuffer_size() const;  // 0 when minimised
  // The scale of letters and panels: the monitor's, times the one that the user has chosen.
  float scale() const { return letter_scale_ * monitor_scale(); }
  float monitor_scale() const;  // of the monitor that the window is on
  void set_letter_scale(float letter_scale) { letter_scale_ = letter_scale; }
  double refresh_hz() const;  // of that monitor; 60 where it is not known
  bool is_over() const;
  // Fills the monitor that the window is on, or returns to the window's previous place and size.
  void toggle_full_screen();
  bool is_full_screen() const;
  // Revokes a request to close the window, and brings it back if it is minimised.
  void keep_open();
  GLFWwindow* handle() const { return window_; }
  // Gives the current context of Dear ImGui the clipboard.
  void lend_clipboard();
  // Gives Dear ImGui the mouse and the clipboard. Call it before each picture.
  void pass_input_to_panels();

 private:
  explicit ViewWindow(WindowEvents& events) : events_(&events) {}
  Result<void> open(Size size);
  bool make_window(Size size, bool is_robust);
  void hear_events();
  void on_key(int key, int scancode, int action, int modifiers);
  void on_letter(unsigned int letter);
  void on_wheel(float notches);
  void on_cursor(double x, double y);
  void on_button(int button, int action, int modifiers);
  std::pair<float, float> cursor_px() const;

  WindowEvents* events_;
  GLFWwindow* window_ = nullptr;
  bool tells_loss_ = false;  // glGetGraphicsResetStatus can be asked
  bool is_made_lost_ = false;
  std::optional<double> told_refresh_hz_;
  float letter_scale_ = 1.0f;
  struct Place {
    int left = 0, top = 0, width = 0, height = 0;
  };
  Place place_;  // before the full screen
  ShownNotes shown_notes_;
  bool is_tear_free_ = true;
  bool is_repeat_ = false;  // of the last key
  float wheel_ = 0.0f;      // notches that panels have not seen
  MouseButtons buttons_;    // changes that panels have not seen
  WindowDrag drag_ = WindowDrag::kNone;
  double last_x_ = 0.0;
  double last_y_ = 0.0;
};

}  // namespace dance
