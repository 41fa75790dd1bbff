#include "viewer/window/view_window.h"

// epoxy first: GLFW then leaves OpenGL's own headers out.
#include <epoxy/gl.h>
// clang-format off
#include <GLFW/glfw3.h>
// clang-format on

#include <imgui.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/program/program.h"

namespace dance {
namespace {

constexpr const char* kCure =
    "; make pictures instead with: dance view --headless --out DIR, or start it from a desktop";

std::string last_glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason given";
}

ViewWindow& self_of(GLFWwindow* window) {
  return *static_cast<ViewWindow*>(glfwGetWindowUserPointer(window));
}

}  // namespace

Result<std::unique_ptr<ViewWindow>> ViewWindow::create(Size size, CameraRig& rig) {
  if (display_name().empty())
    return fail(std::string("no display here (DISPLAY is not set)") + kCure);
  std::unique_ptr<ViewWindow> self(new ViewWindow(rig));
  if (glfwInit() != GLFW_TRUE)
    return fail("the display cannot be opened (" + last_glfw_error() + ")" + kCure);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  self->window_ = glfwCreateWindow(size.width_px, size.height_px, "DanceGraph", nullptr, nullptr);
  if (self->window_ == nullptr)
    return fail("no window with OpenGL 3.3 can be had (" + last_glfw_error() + ")" + kCure);
  glfwMakeContextCurrent(self->window_);
  glfwSwapInterval(1);
  glfwSetWindowSizeLimits(self->window_, 160, 120, GLFW_DONT_CARE, GLFW_DONT_CARE);

  glfwSetWindowUserPointer(self->window_, self.get());
  glfwSetKeyCallback(self->window_, [](GLFWwindow* w, int key, int, int action, int modifiers) {
    self_of(w).on_key(key, action, modifiers);
  });
  glfwSetCursorPosCallback(self->window_,
                           [](GLFWwindow* w, double x, double y) { self_of(w).on_cursor(x, y); });
  glfwSetMouseButtonCallback(self->window_, [](GLFWwindow* w, int button, int action, int mods) {
    self_of(w).on_button(button, action, mods);
  });
  glfwSetScrollCallback(self->window_, [](GLFWwindow* w, double, double notches) {
    self_of(w).on_wheel(static_cast<float>(notches));
  });
  return self;
}

ViewWindow::~ViewWindow() {
  if (window_ != nullptr) glfwDestroyWindow(window_);
  glfwTerminate();
}

void ViewWindow::poll_events() { glfwPollEvents(); }
void ViewWindow::wait_for_events(Duration longest) {
  if (longest > Duration()) glfwWaitEventsTimeout(longest.as_seconds());
}
void ViewWindow::swap() { glfwSwapBuffers(window_); }
bool ViewWindow::is_over() const { return glfwWindowShouldClose(window_) != 0; }

ViewWindow::Size ViewWindow::framebuffer_size() const {
  Size size{0, 0};
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == 0)
    glfwGetFramebufferSize(window_, &size.width_px, &size.height_px);
  return size;
}

float ViewWindow::scale() const {
  float x = 1.0f;
  float y = 1.0f;
  glfwGetWindowContentScale(window_, &x, &y);
  return std::clamp(std::max(x, y), 0.5f, 4.0f);
}

double ViewWindow::refresh_hz() const {
  constexpr double kUnknown_hz = 60.0;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  if (mode == nullptr || mode->refreshRate < 20) return kUnknown_hz;
  return std::min(mode->refreshRate, 480);
}

std::optional<std::size_t> ViewWindow::take_focus_key() {
  return std::exchange(focus_key_, std::nullopt);
}

void ViewWindow::on_wheel(float notches) {
  if (panels_have_mouse())
    wheel_ += notches;
  else
    rig_.zoom(notches);
}

bool ViewWindow::panels_have_mouse() const {
  return panels_ != nullptr && ImGui::GetIO().WantCaptureMouse;
}

void ViewWindow::pass_input_to_panels() {
  ImGuiIO& io = ImGui::GetIO();
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  const Size pixels = framebuffer_size();
  double x = 0.0, y = 0.0;
  glfwGetCursorPos(window_, &x, &y);
  // Panels are drawn in pixels, the mouse is told in the window's own units.
  io.MousePos = ImVec2(static_cast<float>(x * pixels.width_px / std::max(width, 1)),
                       static_cast<float>(y * pixels.height_px / std::max(height, 1)));
  for (const int button : {GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_RIGHT})
    io.MouseDown[button] = glfwGetMouseButton(window_, button) == GLFW_PRESS;
  io.MouseWheel = std::exchange(wheel_, 0.0f);
}

void ViewWindow::on_key(int key, int action, int modifiers) {
  if (action == GLFW_RELEASE) return;
  const KeyPress press{key, action == GLFW_REPEAT, (modifiers & GLFW_MOD_SHIFT) != 0,
                       (modifiers & GLFW_MOD_CONTROL) != 0};
  if (panels_ != nullptr && panels_->on_key(press)) return;
  if (action != GLFW_PRESS) return;
  if (key == GLFW_KEY_Q || key == GLFW_KEY_ESCAPE) glfwSetWindowShouldClose(window_, GLFW_TRUE);
  if (key == GLFW_KEY_F) rig_.frame_all();
  if (key == GLFW_KEY_SPACE) rig_.toggle_turning();
  if (key == GLFW_KEY_H) shows_hud_ = !shows_hud_;
  if (key == GLFW_KEY_C) compares_ = !compares_;
  if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9)
    focus_key_ = static_cast<std::size_t>(key - GLFW_KEY_1);
}

void ViewWindow::on_button(int button, int action, int modifiers) {
  if (action != GLFW_PRESS || panels_have_mouse()) {
    drag_ = Drag::kNone;
    return;
  }
  const bool pans = button != GLFW_MOUSE_BUTTON_LEFT || (modifiers & GLFW_MOD_SHIFT) != 0;
  drag_ = pans ? Drag::kPan : Drag::kOrbit;
  glfwGetCursorPos(window_, &last_x_, &last_y_);
}

void ViewWindow::on_cursor(double x, double y) {
  int width = 0;
  int height = 0;
  glfwGetWindowSize(window_, &width, &height);
  const double scale = 1.0 / std::max(height, 1);
  const auto right = static_cast<float>((x - last_x_) * scale);
  const auto up = static_cast<float>((last_y_ - y) * scale);
  last_x_ = x;
  last_y_ = y;
  if (drag_ == Drag::kOrbit) rig_.drag_orbit(right, up);
  if (drag_ == Drag::kPan) rig_.drag_pan(right, up);
}

}  // namespace dance
