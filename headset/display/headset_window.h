// HeadsetWindow: the window on the desk beside a headset: its OpenGL context is the one that the
// headset's pictures are drawn with, and others see in it what the left eye sees.
//
// Units/frames: pixels.
// Ownership:    owns the window; one per process.
// Threads:      the main thread.
// Failure:      create() reports a missing display or OpenGL, and the alternative.
#pragma once

#include "viewer/window/view_window.h"

namespace dance {

class HeadsetWindow final : private WindowEvents {
 public:
  // Not shown: only the context is wanted.
  static Result<std::unique_ptr<HeadsetWindow>> create(bool is_shown);

  void poll_events() { window_->poll_events(); }
  void swap() { window_->swap(); }
  bool is_shown() const { return is_shown_; }
  // Closed, or Q was pressed.
  bool is_over() const { return is_over_ || window_->is_over(); }
  ViewWindow& window() { return *window_; }

 private:
  void on_key(const KeyPress& press) override;
  void on_drag(WindowDrag, float, float) override {}
  void on_wheel(float) override {}

  std::unique_ptr<ViewWindow> window_;
  bool is_shown_ = true, is_over_ = false;
};

}  // namespace dance
