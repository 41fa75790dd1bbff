// What a key means on the person's own keyboard. Letters are known by what the key bears, digits by
// their places (on a French keyboard they are printed with shift), and the signs ? [ ] , . by the
// character that is typed, wherever it lies and with whatever keys it is made.
//
// Units/frames: keys and modifiers as GLFW numbers them.
// Ownership:    plain values.
// Threads:      none inside; the main thread.
// Failure:      nullopt for what is no key of this program's.
#pragma once

#include <optional>

#include "viewer/panel/window_panel.h"

namespace dance {

// A key going down or repeating, as the window system tells it.
struct RawKey {
  int key = 0;  // by its place on an American keyboard
  // What it prints without other keys, in UTF-8; null where that is not known.
  const char* printed = nullptr;
  bool is_repeat = false;
  int modifiers = 0;
  bool has_alt_gr = false;  // not among the modifiers: with it keys print other signs
};

// What it does by itself; nothing where its character will come, or with Alt.
std::optional<KeyPress> press_of_key(const RawKey& raw);
// What a typed character does.
std::optional<KeyPress> press_of_letter(unsigned int letter, bool is_repeat);

}  // namespace dance
