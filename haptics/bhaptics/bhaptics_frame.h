// What is to be felt as a message to the bHaptics Player: which device, which of its motors, how
// strong, how long.
//
// Units/frames: intensity 0 to 100; milliseconds.
// Ownership:    returns a new text.
// Threads:      none inside.
// Failure:      none.
// Source:       the JSON that bHaptics Player takes on its WebSocket, version 2 (feedbacks).
#pragma once

#include <string>

#include "core/signal/haptic.h"

namespace dance {

// The device and the motor that stand for a bone.
struct BhapticsPlace {
  const char* position;  // "VestFront", "ForearmL", …
  int motor;             // of the device's, from 0
};
BhapticsPlace bhaptics_place(Bone bone);
std::string bhaptics_frame(const Haptic& haptic);
// All of it ends.
std::string bhaptics_stop();

}  // namespace dance
