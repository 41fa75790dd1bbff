// WindowState: what a person has chosen in the window, beside the view.
//
// Ownership: plain value.
// Threads:   none inside; the drawing thread owns it.
// Failure:   none.
#pragma once

#include <optional>

#include "viewer/dance_panel/dance_wishes.h"
#include "viewer/scene/place.h"

namespace dance {

// Tear-free waits for the display; low latency does so only while drawing keeps up, and shows a
// late picture at once, torn.
enum class DisplayMode { kTearFree, kLowLatency };

// What the keys of the voice have been told, for VoiceKeys.
struct VoiceWishes {
  bool is_talk_held = false;
  int mute_presses = 0;  // not handled yet
  int deafen_presses = 0;
};

struct WindowState {
  bool shows_hud = true;
  bool shows_tags = true;
  bool shows_trails = false;
  bool extrapolates = true;
  Venue place = Venue::kStudio;
  int place_changes = 0;  // how often a key has changed it
  DisplayMode display = DisplayMode::kTearFree;
  int full_screen_presses = 0;  // not handled yet
  VoiceWishes voice;
  DanceWishes dance;
  bool is_over = false;
  bool has_left = false;  // the dance, by the panel's button: a program around it goes on
  std::optional<int> chosen_number;  // of the number key that was pressed last; once
  int chosen_step = 0;               // guests forwards or backwards; once
};

}  // namespace dance
