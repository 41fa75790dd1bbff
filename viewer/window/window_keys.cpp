#include "viewer/window/window_keys.h"

#ifndef GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_NONE  // OpenGL comes from epoxy
#endif
#include <GLFW/glfw3.h>

#include <array>

namespace dance {
namespace {

struct Key {
  int key = 0;  // 0: the mouse, or a row of several keys
  WindowCommand command;
  bool repeats = false;
};

struct Row {
  std::string_view group;
  KeyHelp help;
  Key key = {};
  Key other = {};
  // The keys that are left while a log is open, whose timeline has the arrows.
  std::optional<std::string_view> with_log = {};
};

constexpr WindowCommand view(ViewMode mode) { return {WindowAction::kShowView, 1, mode}; }
constexpr WindowCommand step(WindowAction action, int way) { return {action, way}; }

constexpr std::array kRows{
    Row{"Views",
        {"V", "the next view; with shift the one before"},
        {GLFW_KEY_V, {WindowAction::kNextView}}},
    Row{"Views", {"O", "orbit: the whole stage"}, {GLFW_KEY_O, view(ViewMode::kOrbit)}},
    Row{"Views", {"W", "walk behind a dancer"}, {GLFW_KEY_W, view(ViewMode::kFollow)}},
    Row{"Views", {"M", "mirror of a dancer: left is left"}, {GLFW_KEY_M, view(ViewMode::kMirror)}},
    Row{"Views",
        {"P", "first person: a dancer's eyes"},
        {GLFW_KEY_P, view(ViewMode::kFirstPerson)}},
    Row{"Views",
        {"C", "compare: as it comes, as it is staged"},
        {GLFW_KEY_C, view(ViewMode::kCompare)}},
    Row{"Views",
        {"G", "grid: each dancer or couple by itself"},
        {GLFW_KEY_G, view(ViewMode::kGrid)}},

    Row{"Dancers",
        {"Tab", "the next; with shift the one before"},
        {GLFW_KEY_TAB, step(WindowAction::kNextGuest, 1), true}},
    Row{"Dancers",
        {"Left  Right", "the one before, the next"},
        {GLFW_KEY_RIGHT, step(WindowAction::kNextGuest, 1), true},
        {GLFW_KEY_LEFT, step(WindowAction::kNextGuest, -1), true},
        ""},
    Row{"Dancers", {"1 to 9", "the first to the ninth, by name"}},
    Row{"Dancers",
        {"F", "everybody, the camera as at first"},
        {GLFW_KEY_F, {WindowAction::kStartOver}}},

    Row{"Camera", {"Drag", "turn it"}},
    Row{"Camera", {"Shift drag", "move it; the right button too"}},
    Row{"Camera",
        {"Wheel  Up  Down", "nearer, farther"},
        {GLFW_KEY_UP, step(WindowAction::kZoom, 1), true},
        {GLFW_KEY_DOWN, step(WindowAction::kZoom, -1), true},
        "Wheel"},
    Row{"Camera", {"R", "rotate slowly, or stop"}, {GLFW_KEY_R, {WindowAction::kRotate}}},

    Row{"Voice", {"B", "hold to talk (push to talk)"}, {GLFW_KEY_B, {WindowAction::kTalk}}},
    Row{"Voice", {"U", "mute, or be heard again"}, {GLFW_KEY_U, {WindowAction::kMute}}},
    Row{"Voice", {"J", "deafen, or hear again"}, {GLFW_KEY_J, {WindowAction::kDeafen}}},

    Row{"Picture", {"T", "trails of hands"}, {GLFW_KEY_T, {WindowAction::kTrails}}},
    Row{"Picture", {"N", "names"}, {GLFW_KEY_N, {WindowAction::kTags}}},
    Row{"Picture", {"H", "figures"}, {GLFW_KEY_H, {WindowAction::kHud}}},
    Row{"Picture",
        {"D", "display: tear-free or low latency"},
        {GLFW_KEY_D, {WindowAction::kDisplayMode}}},
    Row{"Picture",
        {"X", "extrapolate to the photon, or not"},
        {GLFW_KEY_X, {WindowAction::kExtrapolate}}},
    Row{"Picture", {"?  F1", "these keys"}},
    // Esc too, where nothing is open and no dance panel takes it: of a log.
    Row{"Picture",
        {"Q", "close the window"},
        {GLFW_KEY_Q, {WindowAction::kClose}},
        {GLFW_KEY_ESCAPE, {WindowAction::kClose}},
        "Q  Esc"},
};

struct Helps {
  std::array<KeyHelp, kRows.size()> rows{};
  std::array<std::string_view, kRows.size()> groups{};
  std::size_t count = 0;
};

constexpr Helps helps(bool has_log) {
  Helps all;
  for (const Row& row : kRows) {
    KeyHelp help = row.help;
    if (has_log && row.with_log) help.key = *row.with_log;
    if (help.key.empty()) continue;
    all.groups[all.count] = row.group;
    all.rows[all.count++] = help;
  }
  return all;
}
constexpr Helps kLive = helps(false);
constexpr Helps kOfLog = helps(true);

}  // namespace

std::optional<WindowCommand> window_command(const KeyPress& press) {
  if (press.has_control) return std::nullopt;
  if (press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_9)
    return WindowCommand{WindowAction::kChooseNumber, press.key - GLFW_KEY_1};
  for (const Row& row : kRows)
    for (const Key* key : {&row.key, &row.other}) {
      if (key->key == 0 || key->key != press.key || (press.is_repeat && !key->repeats)) continue;
      WindowCommand command = key->command;
      if (press.has_shift) command.step = -command.step;
      return command;
    }
  return std::nullopt;
}

std::vector<PanelStack::Group> window_key_groups(bool has_log) {
  const Helps& helps = has_log ? kOfLog : kLive;
  std::vector<PanelStack::Group> groups;
  for (std::size_t begin = 0, end = 0; begin < helps.count; begin = end) {
    while (end < helps.count && helps.groups[end] == helps.groups[begin]) ++end;
    groups.push_back({helps.groups[begin], std::span(helps.rows).subspan(begin, end - begin)});
  }
  return groups;
}

}  // namespace dance
