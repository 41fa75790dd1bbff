// The devices of this machine that can rumble: gamepads, Joy-Cons, wheels; through the kernel's
// evdev interface.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      devices that may not be opened are listed with the reason.
#pragma once

#include <string>
#include <vector>

namespace dance {

struct EvdevDevice {
  std::string path;  // /dev/input/event5
  std::string name;  // printable
  int effects = 0;   // that it plays at a time
  bool rumbles = false, has_waves = false;
  std::string trouble;  // why it cannot be used; "" = nothing
};

// Whether an input device, "event5", may have force feedback as the kernel tells without opening
// it; true where it does not tell.
bool may_rumble(const std::string& event, const std::string& classes = "/sys/class/input");
// Opens those only that may rumble. `folder`: /dev/input, but for tests.
std::vector<EvdevDevice> list_evdev_devices(const std::string& folder = "/dev/input");

}  // namespace dance
