#include "viewer/window/view_window.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "core/base/printable.h"
#include "core/program/program.h"
#include "viewer/window/printed_keys.h"

namespace dance {
namespace {

constexpr const char* kCure =
    "; make pictures instead with: dance view --headless --out DIR, or start it from a desktop";

// A driver's or display server's words may hold anything.
std::string last_glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? printable(text) : "no reason given";
}

ViewWindow& self_of(GLFWwindow* window) {
  return *static_cast<ViewWindow*>(glfwGetWindowUserPointer(window));
}

// Where panels are drawn they may want the mouse.
bool panels_have_mouse() {
  return ImGui::GetCurrentContext() != nullptr && ImGui::GetIO().WantCaptureMouse;
}

// The monitor that most of the window lies on; null without monitors.
GLFWmonitor* monitor_of(GLFWwindow* window) {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  int left = 0, top = 0, width = 0, height = 0;
  glfwGetWindowPos(window, &left, &top);
  glfwGetWindowSize(window, &width, &height);
  GLFWmonitor* best = glfwGetPrimaryMonitor();
  int most = 0;
  for (int i = 0; i < count; ++i) {
    int x = 0, y = 0;
    glfwGetMonitorPos(monitors[i], &x, &y);
    const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
    if (mode == nullptr) continue;
    const int across = std::min(left + width, x + mode->width) - std::max(left, x);
    const int down = std::min(top + height, y + mode->height) - std::max(top, y);
    if (across <= 0 || down <= 0 || across * down <= most) continue;
    most = across * down;
    best = monitors[i];
  }
  return best;
}

}  // namespace

Result<std::unique_ptr<ViewWindow>> ViewWindow::create(Size size, WindowEvents& events) {
  if (display_name().empty())
    return fail(std::string("no display here (DISPLAY is not set)") + kCure);
  std::unique_ptr<ViewWindow> self(new ViewWindow(events));
  if (glfwInit() != GLFW_TRUE)
    return fail("the display cannot be opened (" + last_glfw_error() + ")" + kCure);
  if (auto opened = self->open(size); !opened) return tl::make_unexpected(opened.error());
  return self;
}

bool ViewWindow::make_window(Size size, bool is_robust) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  if (is_robust) glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  window_ = glfwCreateWindow(size.width_px, size.height_px, "DanceGraph", nullptr, nullptr);
  return window_ != nullptr;
}

Result<void> ViewWindow::open(Size size) {
  // Some drivers know no contexts that tell their loss.
  if (!make_window(size, true) && !make_window(size, false))
    return fail("no window with OpenGL 3.3 can be had (" + last_glfw_error() + ")" + kCure);
  glfwMakeContextCurrent(window_);
  tells_loss_ = glfwGetWindowAttrib(window_, GLFW_CONTEXT_ROBUSTNESS) != GLFW_NO_ROBUSTNESS &&
                (epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_ARB_robustness"));
  is_made_lost_ = false;
  set_tear_free(is_tear_free_);
  glfwSetWindowSizeLimits(window_, 160, 120, GLFW_DONT_CARE, GLFW_DONT_CARE);
  hear_events();
  return {};
}

void ViewWindow::hear_events() {
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
    self_of(w).on_key(key, scancode, action, modifiers);
  });
  glfwSetCharCallback(window_,
                      [](GLFWwindow* w, unsigned int letter) { self_of(w).on_letter(letter); });
  glfwSetCursorPosCallback(window_,
                           [](GLFWwindow* w, double x, double y) { self_of(w).on_cursor(x, y); });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int mods) {
    self_of(w).on_button(button, action, mods);
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double notches) {
    self_of(w).on_wheel(static_cast<float>(notches));
  });
}

Result<void> ViewWindow::renew() {
  int left = 0, top = 0, width = 0, height = 0;
  glfwGetWindowPos(window_, &left, &top);
  glfwGetWindowSize(window_, &width, &height);
  float scale_x = 1.0f, scale_y = 1.0f;
  glfwGetWindowContentScale(window_, &scale_x, &scale_y);
  glfwDestroyWindow(window_);
  window_ = nullptr;
  drag_ = WindowDrag::kNone;
  buttons_.clear();
  if (auto opened = open({width, height}); !opened) return opened;
  // Sizes are scaled to the monitor when a window is made; these were already.
  glfwSetWindowSize(window_, width, height);
  glfwSetWindowPos(window_, left, top);
  return {};
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

bool ViewWindow::is_full_screen() const { return glfwGetWindowMonitor(window_) != nullptr; }

void ViewWindow::toggle_full_screen() {
  if (is_full_screen())
    return glfwSetWindowMonitor(window_, nullptr, place_.left, place_.top, place_.width,
                                place_.height, GLFW_DONT_CARE);
  GLFWmonitor* const monitor = monitor_of(window_);
  const GLFWvidmode* const mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  if (mode == nullptr) return;
  glfwGetWindowPos(window_, &place_.left, &place_.top);
  glfwGetWindowSize(window_, &place_.width, &place_.height);
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void ViewWindow::keep_open() {
  glfwSetWindowShouldClose(window_, GLFW_FALSE);
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != 0) glfwRestoreWindow(window_);
}

bool ViewWindow::set_tear_free(bool is_tear_free) {
  is_tear_free_ = is_tear_free;
  const bool can_tear_when_late = glfwExtensionSupported("GLX_EXT_swap_control_tear") != 0 ||
                                  glfwExtensionSupported("EGL_EXT_swap_control_tear") != 0 ||
                                  glfwExtensionSupported("WGL_EXT_swap_control_tear") != 0;
  glfwSwapInterval(is_tear_free ? 1 : can_tear_when_late ? -1 : 0);
  return can_tear_when_late;
}

bool ViewWindow::is_context_lost() const {
  if (is_made_lost_) return true;
  if (!tells_loss_) return false;
  const GLenum status =
      epoxy_gl_version() >= 45 ? glGetGraphicsResetStatus() : glGetGraphicsResetStatusARB();
  return status != GL_NO_ERROR;
}

ViewWindow::Size ViewWindow::framebuffer_size() const {
  Size size{0, 0};
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == 0)
    glfwGetFramebufferSize(window_, &size.width_px, &size.height_px);
  return size;
}

float ViewWindow::monitor_scale() const {
  float x = 1.0f;
  float y = 1.0f;
  glfwGetWindowContentScale(window_, &x, &y);
  return std::clamp(std::max(x, y), 0.5f, 4.0f);
}

double ViewWindow::refresh_hz() const {
  constexpr double kUnknown_hz = 60.0;
  if (told_refresh_hz_) return *told_refresh_hz_;
  GLFWmonitor* monitor = monitor_of(window_);
  const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  if (mode == nullptr || mode->refreshRate < 20) return kUnknown_hz;
  return std::min(mode->refreshRate, 480);
}

// Panels use pixels; GLFW reports the cursor in the window's own units.
std::pair<float, float> ViewWindow::cursor_px() const {
  int width = 0, height = 0;
  glfwGetWindowSize(window_, &width, &height);
  const Size pixels = framebuffer_size();
  double x = 0.0, y = 0.0;
  glfwGetCursorPos(window_, &x, &y);
  return {static_cast<float>(x * pixels.width_px / std::max(width, 1)),
          static_cast<float>(y * pixels.height_px / std::max(height, 1))};
}

void ViewWindow::lend_clipboard() {
  ImGuiIO& io = ImGui::GetIO();
  io.ClipboardUserData = window_;
  io.SetClipboardTextFn = [](void* window, const char* text) {
    glfwSetClipboardString(static_cast<GLFWwindow*>(window), text);
  };
  io.GetClipboardTextFn = [](void* window) {
    return glfwGetClipboardString(static_cast<GLFWwindow*>(window));
  };
}

void ViewWindow::pass_input_to_panels() {
  ImGuiIO& io = ImGui::GetIO();
  lend_clipboard();
  const auto [x_px, y_px] = cursor_px();
  io.MousePos = ImVec2(x_px, y_px);
  const std::size_t changes = buttons_.take([&](const MouseButtons::Change& change) {
    io.MousePos = ImVec2(change.x_px, change.y_px);
    io.MouseDown[change.button] = change.is_down;
  });
  if (changes == 0)
    for (int button = 0; button < static_cast<int>(MouseButtons::kButtons); ++button)
      io.MouseDown[button] = glfwGetMouseButton(window_, button) == GLFW_PRESS;
  io.MouseWheel = std::exchange(wheel_, 0.0f);
}

void ViewWindow::set_events(WindowEvents& events) {
  events_ = &events;
  drag_ = WindowDrag::kNone;
  wheel_ = 0.0f;
  buttons_.clear();
}

void ViewWindow::on_key(int key, int scancode, int action, int modifiers) {
  const bool is_release = action == GLFW_RELEASE;
  if (action != GLFW_REPEAT) events_->on_raw_key(key, !is_release, modifiers);
  // A key that is let go was pressed alone perhaps, whatever is held with it by now.
  RawKey raw{key, nullptr, action == GLFW_REPEAT, is_release ? 0 : modifiers};
  // Keys beyond 127 print nothing, and GLFW does not take them.
  if (key == GLFW_KEY_UNKNOWN || key < 128) raw.printed = glfwGetKeyName(key, scancode);
  raw.has_alt_gr = !is_release && glfwGetKey(window_, GLFW_KEY_RIGHT_ALT) == GLFW_PRESS;
  const auto press = press_of_key(raw);
  if (is_release) {
    if (press) events_->on_key_released(*press);
    return;
  }
  is_repeat_ = raw.is_repeat;  // its characters come next
  if (press) events_->on_key(*press);
}

void ViewWindow::on_letter(unsigned int letter) {
  events_->on_character(letter);
  if (const auto press = press_of_letter(letter, is_repeat_)) events_->on_key(*press);
}

void ViewWindow::on_wheel(float notches) {
  events_->on_raw_wheel(notches);
  if (panels_have_mouse())
    wheel_ += notches;
  else
    events_->on_wheel(notches);
}

void ViewWindow::on_button(int button, int action, int modifiers) {
  events_->on_mouse_button(button, action == GLFW_PRESS);
  const auto [x_px, y_px] = cursor_px();
  buttons_.add({static_cast<std::size_t>(button), action == GLFW_PRESS, x_px, y_px});
  if (action != GLFW_PRESS || panels_have_mouse()) {
    drag_ = WindowDrag::kNone;
    return;
  }
  const bool pans = button != GLFW_MOUSE_BUTTON_LEFT || (modifiers & GLFW_MOD_SHIFT) != 0;
  drag_ = pans ? WindowDrag::kPan : WindowDrag::kOrbit;
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
  if (drag_ != WindowDrag::kNone) events_->on_drag(drag_, right, up);
}

}  // namespace dance
