// The table of devices for `dance haptics --to` and `[[haptics]]` of a session file: a new kind is
// one row.
//
// Units/frames: strength times the amplitude, limit 0 to 1, latency a length of time.
// Ownership:    the caller owns what is made.
// Threads:      constants only.
// Failure:      make_haptic_output() of an unknown name lists the known ones; a device that cannot
//               be had is named with the cure.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "haptics/haptic_maker.h"
#include "haptics/haptic_output.h"
#include "haptics/haptic_player.h"

namespace dance {

struct HapticOptions {
  std::string device;   // evdev: a path or a part of a name; sound: a sink; "" = the usual one
  std::string address;  // osc, bhaptics: host:port; "" = the usual one
  HapticPlayerOptions player;
  HapticMakerOptions maker;
};

std::vector<std::string> haptic_output_names();
// What is wrong: an unknown name, an address for a device that has none, …
Result<void> check_haptic_options(const std::string& to, const HapticOptions& options);
Result<std::unique_ptr<HapticOutput>> make_haptic_output(const std::string& to,
                                                         const HapticOptions& options);
// One that is not there now, and is looked for again; null: this kind is not.
std::unique_ptr<HapticOutput> haptic_output_for_later(const std::string& to,
                                                      const HapticOptions& options);
// "leftHand", "leftLowerArm": what one device lets feel, as HapticPlayerOptions have it; all where
// none is named.
Result<std::uint32_t> parse_bones(const std::vector<std::string>& names);
// "touch", "lead", "beat" or "beats": what is felt.
Result<HapticMakerOptions> parse_felt(const std::vector<std::string>& words);

}  // namespace dance
