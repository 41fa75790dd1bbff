#include "headset/display/headset_window.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>

namespace dance {

Result<std::unique_ptr<HeadsetWindow>> HeadsetWindow::create(bool is_shown) {
  std::unique_ptr<HeadsetWindow> self(new HeadsetWindow);
  auto window = ViewWindow::create({960, 540}, *self);
  // Its advice is for who only looks.
  if (!window)
    return fail(window.error().what +
                "; or dance without pictures in the headset: dance headset --tracking-only");
  self->window_ = std::move(*window);
  self->is_shown_ = is_shown;
  if (!is_shown) glfwHideWindow(self->window_->handle());
  // The headset sets the pace; a desk's monitor must not hold it up.
  glfwSwapInterval(0);
  glfwSetWindowTitle(self->window_->handle(), "DanceGraph - headset");
  return self;
}

void HeadsetWindow::on_key(const KeyPress& press) {
  if (press.key == GLFW_KEY_Q || press.key == GLFW_KEY_ESCAPE) is_over_ = true;
}

}  // namespace dance
