// HapticOutput: the interface of a device that a dancer feels. A new kind of device is one class
// that implements this, and one row of haptic_table.cpp.
//
// Units/frames: amplitudes 0 to 1 of what the device has, strength and limit already in them.
// Ownership:    owns its device, file or socket; memory is bounded.
// Threads:      called from one thread and never waits; what a library insists on a thread for is
//               behind it.
// Failure:      play() is false where the device did not take the order; a device that is gone is
//               looked for again in work().
#pragma once

#include <string>

#include "core/signal/haptic.h"

namespace dance {

class HapticOutput {
 public:
  virtual ~HapticOutput() = default;
  // Hands the order to the device in this call: its moment is now.
  virtual bool play(const Haptic& haptic, MonoTime now) = 0;
  // Called when it asked to be, and once a second; returns when it wants to be called next,
  // MonoTime() = with the next second.
  virtual MonoTime work(MonoTime) { return {}; }
  // What is felt at a time is in sum no stronger than this.
  virtual void set_limit(float) {}
  // Nothing is felt any more, at once.
  virtual void stop() = 0;
  // Whether the device can be had; of one that is sent to blindly, whether it can be sent to.
  virtual bool is_there() const { return true; }
  // Which device, for people.
  virtual std::string name() const = 0;
  // From play() to what is felt, as the device itself reports; nothing where it does not.
  virtual Duration latency() const { return {}; }
  // One line: which device, and what went wrong.
  virtual std::string summary() const = 0;
};

}  // namespace dance
