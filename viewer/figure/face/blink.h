// Blinking: each dancer blinks every few seconds, at moments that follow from the guest id and the
// time alone, so that all screens show the same and a picture made again is the same.
//
// Units/frames: 0 = open … 1 = shut.
// Threads:      any.
#pragma once

#include "core/base/guest_id.h"
#include "core/base/time.h"

namespace dance {

float blink_at(const GuestId& guest, MonoTime time);

}  // namespace dance
