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
  Text group = Text::kCount;
  KeyHelp help;
  Key key = {};
  Key other = {};
  // The keys left while a log is open: its timeline uses the arrows.
  std::optional<KeyHelp> with_log = {};
};

constexpr WindowCommand view(ViewMode mode) { return {WindowAction::kShowView, 1, mode}; }
constexpr WindowCommand step(WindowAction action, int way) { return {action, way}; }

constexpr std::array kRows{
    Row{Text::kKeysViews, {"V", Text::kDoNextView}, {GLFW_KEY_V, {WindowAction::kNextView}}},
    Row{Text::kKeysViews, {"O", Text::kDoStage}, {GLFW_KEY_O, view(ViewMode::kOrbit)}},
    Row{Text::kKeysViews, {"W", Text::kDoWalk}, {GLFW_KEY_W, view(ViewMode::kFollow)}},
    Row{Text::kKeysViews, {"M", Text::kDoMirror}, {GLFW_KEY_M, view(ViewMode::kMirror)}},
    Row{Text::kKeysViews, {"P", Text::kDoEyes}, {GLFW_KEY_P, view(ViewMode::kFirstPerson)}},
    Row{Text::kKeysViews, {"C", Text::kDoCompare}, {GLFW_KEY_C, view(ViewMode::kCompare)}},
    Row{Text::kKeysViews, {"G", Text::kDoGrid}, {GLFW_KEY_G, view(ViewMode::kGrid)}},

    Row{Text::kKeysDancers,
        {"Tab", Text::kDoNextDancer},
        {GLFW_KEY_TAB, step(WindowAction::kNextGuest, 1), true}},
    Row{Text::kKeysDancers,
        {"← →", Text::kDoPreviousDancer},
        {GLFW_KEY_RIGHT, step(WindowAction::kNextGuest, 1), true},
        {GLFW_KEY_LEFT, step(WindowAction::kNextGuest, -1), true},
        KeyHelp{}},
    Row{Text::kKeysDancers, {"1 – 9", Text::kDoChosen}},
    Row{Text::kKeysDancers, {"F", Text::kDoEverybody}, {GLFW_KEY_F, {WindowAction::kStartOver}}},

    Row{Text::kKeysCamera, {"", Text::kDoTurn, Text::kKeyDrag}},
    Row{Text::kKeysCamera, {"", Text::kDoMove, Text::kKeyShiftDrag}},
    Row{Text::kKeysCamera,
        {"", Text::kDoNearer, Text::kKeyWheelArrows},
        {GLFW_KEY_UP, step(WindowAction::kZoom, 1), true},
        {GLFW_KEY_DOWN, step(WindowAction::kZoom, -1), true},
        KeyHelp{"", Text::kDoNearer, Text::kKeyWheel}},
    Row{Text::kKeysCamera, {"R", Text::kDoRotate}, {GLFW_KEY_R, {WindowAction::kRotate}}},

    Row{Text::kKeysVoice, {"B", Text::kDoTalk}, {GLFW_KEY_B, {WindowAction::kTalk}}},
    Row{Text::kKeysVoice, {"U", Text::kDoMicrophone}, {GLFW_KEY_U, {WindowAction::kMute}}},
    Row{Text::kKeysVoice, {"J", Text::kDoSpeaker}, {GLFW_KEY_J, {WindowAction::kDeafen}}},

    Row{Text::kKeysPicture, {"T", Text::kDoTrails}, {GLFW_KEY_T, {WindowAction::kTrails}}},
    Row{Text::kKeysPicture, {"N", Text::kDoNames}, {GLFW_KEY_N, {WindowAction::kTags}}},
    Row{Text::kKeysPicture, {"Z", Text::kDoPlace}, {GLFW_KEY_Z, step(WindowAction::kPlace, 1)}},
    Row{Text::kKeysPicture, {"K", Text::kDoPicture}, {GLFW_KEY_K, {WindowAction::kPicture}}},
    Row{Text::kKeysPicture,
        {"F11", Text::kDoFullScreen},
        {GLFW_KEY_F11, {WindowAction::kFullScreen}}},
    Row{Text::kKeysPicture, {"?  F1", Text::kDoKeys}},
    // Esc too, where nothing is open and no dance panel takes it: of a log.
    Row{Text::kKeysPicture,
        {"Q", Text::kDoClose},
        {GLFW_KEY_Q, {WindowAction::kClose}},
        {GLFW_KEY_ESCAPE, {WindowAction::kClose}},
        KeyHelp{"Q  Esc", Text::kDoClose}},

    Row{Text::kKeysEngineers, {"H", Text::kDoMeasurements}, {GLFW_KEY_H, {WindowAction::kHud}}},
    Row{Text::kKeysEngineers, {"D", Text::kDoDisplay}, {GLFW_KEY_D, {WindowAction::kDisplayMode}}},
    Row{Text::kKeysEngineers, {"X", Text::kDoPredict}, {GLFW_KEY_X, {WindowAction::kExtrapolate}}},
};

struct Helps {
  std::array<KeyHelp, kRows.size()> rows{};
  std::array<Text, kRows.size()> groups{};
  std::size_t count = 0;
};

constexpr Helps helps(bool has_log) {
  Helps all;
  for (const Row& row : kRows) {
    KeyHelp help = row.help;
    if (has_log && row.with_log) help = *row.with_log;
    if (help.what == Text::kCount) continue;
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
