// WindowPanel: a part of the window over the stage that a person works with: a timeline,
// instruments, sliders, the list of keys. It declares its keys, hears them, and draws itself with
// Dear ImGui in the frame that the overlay has begun, so that it appears alike in a window and in a
// file.
//
// Units/frames: pixels from the top left; `scale` is the monitor's (1 = 96 dpi).
// Ownership:    PanelStack owns the panels.
// Threads:      the drawing thread.
// Failure:      none of its own.
#pragma once

#include <span>
#include <string_view>

#include "viewer/scene/scene.h"
#include "viewer/words/texts.h"

struct ImFont;

namespace dance {

// A key as GLFW numbers it (GLFW_KEY_…), going down or repeating.
struct KeyPress {
  int key = 0;
  bool is_repeat = false;
  bool has_shift = false;
  bool has_control = false;
};

// An entry in the list of keys: "I", "where each guest's delay comes from".
struct KeyHelp {
  std::string_view key;  // "" where its name depends on the language
  Text what = Text::kCount;
  Text key_text = Text::kCount;
  std::string_view key_in(const Texts& texts) const { return key.empty() ? texts[key_text] : key; }
};

struct PanelFrame {
  const SceneState& scene;
  float width_px = 0.0f;
  float height_px = 0.0f;
  float scale = 1.0f;
  ImFont* large_font = nullptr;
  ImFont* small_font = nullptr;
  ImFont* digit_font = nullptr;  // the ten digits alone, as high as they are read from afar
  Language language = Language::kEnglish;
  float figures_px = 0.0f;  // width that the guests' figures cover at the top left
};

class WindowPanel {
 public:
  virtual ~WindowPanel() = default;
  // The heading in the list of keys; kCount for a panel without keys.
  virtual Text title() const { return Text::kCount; }
  virtual std::span<const KeyHelp> keys() const = 0;
  // A person has opened it and can close it: it receives keys before those opened earlier.
  virtual bool is_open() const { return false; }
  // True when the key was this panel's. Esc closes what is open.
  virtual bool on_key(const KeyPress& press) = 0;
  // A typed character, after the key that made it. Only open panels receive it.
  virtual bool on_character(char32_t) { return false; }
  virtual void draw(const PanelFrame& frame) = 0;
  // The height that it covers at the picture's bottom, over the whole width; notes are above it.
  virtual float bottom_px(const PanelFrame&) const { return 0.0f; }
};

}  // namespace dance
