#include "lobby/run/lobby_input.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <utility>

namespace dance {
namespace {

// Dear ImGui wrote it otherwise before 1.89.
#if IMGUI_VERSION_NUM < 18900
constexpr auto kKeypadEnter = ImGuiKey_KeyPadEnter;
#else
constexpr auto kKeypadEnter = ImGuiKey_KeypadEnter;
#endif

constexpr std::array kKeys{
    std::pair{ImGuiKey_Tab, GLFW_KEY_TAB},
    std::pair{ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
    std::pair{ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
    std::pair{ImGuiKey_UpArrow, GLFW_KEY_UP},
    std::pair{ImGuiKey_DownArrow, GLFW_KEY_DOWN},
    std::pair{ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
    std::pair{ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
    std::pair{ImGuiKey_Home, GLFW_KEY_HOME},
    std::pair{ImGuiKey_End, GLFW_KEY_END},
    std::pair{ImGuiKey_Delete, GLFW_KEY_DELETE},
    std::pair{ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
    std::pair{ImGuiKey_Space, GLFW_KEY_SPACE},
    std::pair{ImGuiKey_Enter, GLFW_KEY_ENTER},
    std::pair{ImGuiKey_Escape, GLFW_KEY_ESCAPE},
    std::pair{kKeypadEnter, GLFW_KEY_KP_ENTER},
    std::pair{ImGuiKey_A, GLFW_KEY_A},
    std::pair{ImGuiKey_C, GLFW_KEY_C},
    std::pair{ImGuiKey_V, GLFW_KEY_V},
    std::pair{ImGuiKey_X, GLFW_KEY_X},
    std::pair{ImGuiKey_Y, GLFW_KEY_Y},
    std::pair{ImGuiKey_Z, GLFW_KEY_Z},
};

}  // namespace

void LobbyInput::add(const Event& event) {
  has_news_ = true;
  if (events_.size() < kMostEvents) events_.push_back(event);
}

void LobbyInput::on_raw_wheel(float notches) {
  wheel_ += notches;
  has_news_ = true;
}

void LobbyInput::on_raw_key(int key, bool is_down, int modifiers) {
  if (key >= 0 && key < 512) add({Kind::kKey, key, is_down, modifiers});
}

void LobbyInput::on_character(unsigned int character) {
  if (character >= 0x20 && character < 0x10000)
    add({Kind::kCharacter, static_cast<int>(character), true, 0});
}

void LobbyInput::on_mouse_button(int button, bool is_down) {
  if (button >= 0 && button < 3) add({Kind::kButton, button, is_down, 0});
}

void LobbyInput::begin(ViewWindow& window) {
  ImGuiIO& io = ImGui::GetIO();
  for (const auto& [name, key] : kKeys) io.KeyMap[name] = key;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  window.lend_clipboard();
  events_.clear();
  mouse_down_.fill(false);
  wheel_ = 0.0f;
  has_news_ = true;
}

// Where nobody types, Enter does what Space does, and Tab goes on as the arrows do.
int LobbyInput::nav_key(const Event& event) {
  if (ImGui::GetIO().WantTextInput) return event.which;
  if (event.which == GLFW_KEY_ENTER || event.which == GLFW_KEY_KP_ENTER) return GLFW_KEY_SPACE;
  if (event.which == GLFW_KEY_TAB)
    return (event.modifiers & GLFW_MOD_SHIFT) != 0 ? GLFW_KEY_UP : GLFW_KEY_DOWN;
  return event.which;
}

bool LobbyInput::pass(ViewWindow& window) {
  ImGuiIO& io = ImGui::GetIO();
  window.pass_input_to_panels();  // the mouse's place
  std::bitset<512> keys_touched;
  std::bitset<3> buttons_touched;
  std::copy(mouse_down_.begin(), mouse_down_.end(), std::begin(io.MouseDown));
  io.MouseWheel = std::exchange(wheel_, 0.0f);
  while (!events_.empty()) {
    const Event event = events_.front();
    const auto which = static_cast<std::size_t>(event.which);
    if (event.kind == Kind::kCharacter) {
      io.AddInputCharacter(static_cast<unsigned int>(event.which));
    } else if (event.kind == Kind::kButton) {
      if (buttons_touched[which]) return true;
      buttons_touched.set(which);
      mouse_down_[which] = io.MouseDown[which] = event.is_down;
    } else {
      const int key = nav_key(event);
      if (keys_touched[static_cast<std::size_t>(key)]) return true;
      keys_touched.set(static_cast<std::size_t>(key));
      io.KeysDown[key] = event.is_down;
      if (!event.is_down) io.KeysDown[event.which] = false;
      // Of a modifier that is let go the window system still counts it as held.
      const auto holds = [&](int bit, int left, int right) {
        if (event.which == left || event.which == right) return event.is_down;
        return (event.modifiers & bit) != 0;
      };
      io.KeyCtrl = holds(GLFW_MOD_CONTROL, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
      io.KeyShift = holds(GLFW_MOD_SHIFT, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
      io.KeyAlt = holds(GLFW_MOD_ALT, GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
    }
    events_.pop_front();
  }
  return false;
}

bool LobbyInput::take_news(ViewWindow& window) {
  double x = 0.0, y = 0.0;
  glfwGetCursorPos(window.handle(), &x, &y);
  const ViewWindow::Size size = window.framebuffer_size();
  const bool has_moved = x != mouse_x_ || y != mouse_y_;
  const bool has_another_size = size.width_px != width_px_ || size.height_px != height_px_;
  mouse_x_ = x;
  mouse_y_ = y;
  width_px_ = size.width_px;
  height_px_ = size.height_px;
  return std::exchange(has_news_, false) || has_moved || has_another_size;
}

}  // namespace dance
