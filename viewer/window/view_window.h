// ViewWindow: a GLFW window with an OpenGL 3.3 core context, and what its mouse and keys do to the
// camera.
//
// Units/frames: drags as shares of the window's height.
// Ownership:    owns the window; one per process. Borrows the rig.
// Threads:      the main thread, as window systems want it.
// Failure:      create() reports a missing display, and the alternative.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "core/base/time.h"
#include "viewer/panel/panel_stack.h"
#include "viewer/window/camera_rig.h"

struct GLFWwindow;

namespace dance {

class ViewWindow {
 public:
  struct Size {
    int width_px;
    int height_px;
  };

  static Result<std::unique_ptr<ViewWindow>> create(Size size, CameraRig& rig);
  ~ViewWindow();
  ViewWindow(const ViewWindow&) = delete;
  ViewWindow& operator=(const ViewWindow&) = delete;

  void poll_events();
  // Returns early on mouse or key events.
  void wait_for_events(Duration longest);
  // Shows what was drawn; waits for the display's turn where the driver can.
  void swap();

  Size framebuffer_size() const;  // 0 when minimised
  float scale() const;            // of the monitor that the window is on
  double refresh_hz() const;
  bool is_over() const;
  bool shows_hud() const { return shows_hud_; }
  bool compares() const { return compares_; }
  void set_comparing(bool compares) { compares_ = compares; }
  // Keys go to these first.
  void set_panels(PanelStack* panels) { panels_ = panels; }
  // Tells Dear ImGui where the mouse is and what was typed: before each picture.
  void pass_input_to_panels();
  // The guest of the number key that was pressed last, from 0; once.
  std::optional<std::size_t> take_focus_key();

 private:
  explicit ViewWindow(CameraRig& rig) : rig_(rig) {}
  void on_key(int key, int action, int modifiers);
  void on_wheel(float notches);
  bool panels_have_mouse() const;
  void on_cursor(double x, double y);
  void on_button(int button, int action, int modifiers);

  CameraRig& rig_;
  PanelStack* panels_ = nullptr;
  float wheel_ = 0.0f;  // notches that panels have not seen
  GLFWwindow* window_ = nullptr;
  bool shows_hud_ = true;
  bool compares_ = false;
  std::optional<std::size_t> focus_key_;
  enum class Drag { kNone, kOrbit, kPan };
  Drag drag_ = Drag::kNone;
  double last_x_ = 0.0;
  double last_y_ = 0.0;
};

}  // namespace dance
