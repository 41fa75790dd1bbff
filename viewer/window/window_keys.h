// The window's own keys, in one table: what each does, and the words for the list of keys. Panels
// declare theirs (viewer/panel/window_panel.h).
//
// Ownership: constants; window_key_groups() points into them.
// Threads:   any.
// Failure:   a key without a row does nothing.
#pragma once

#include <optional>
#include <vector>

#include "viewer/panel/panel_stack.h"
#include "viewer/view/view_mode.h"

namespace dance {

enum class WindowAction {
  kNone,  // told in the list of keys only
  kNextView,
  kShowView,
  kChooseNumber,
  kNextGuest,
  kZoom,
  kStartOver,
  kRotate,
  kTrails,
  kTags,
  kPlace,
  kHud,
  kFullScreen,
  kPicture,
  kDisplayMode,
  kExtrapolate,
  kTalk,  // while the key is held
  kMute,
  kDeafen,
  kClose,
};

struct WindowCommand {
  WindowAction action = WindowAction::kNone;
  int step = 1;                      // forwards or backwards; the number of kChooseNumber, from 0
  ViewMode view = ViewMode::kOrbit;  // of kShowView
};

// What a key means to the window.
std::optional<WindowCommand> window_command(const KeyPress& press);

// For the list of keys. With a log open some keys are its timeline's.
std::vector<PanelStack::Group> window_key_groups(bool has_log);

}  // namespace dance
