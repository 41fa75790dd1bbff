// PoseReceiver: the interface of a dancer who comes from another program or a device: datagrams of
// a protocol, an engine's own tracker. It publishes what comes as captures of its guest, at once.
//
// Units/frames: what comes becomes poses as core/pose/pose.h has them, in this house's clock.
// Ownership:    owns its socket; refers to sink and poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      what cannot be used is dropped and counted by cause: summary() tells.
#pragma once

#include <cstdint>
#include <string>

#include "core/net/address.h"

namespace dance {

// Counts and state of a receiver's input.
struct InputState {
  std::uint64_t arrived = 0;  // datagrams
  std::uint64_t poses = 0;    // that they made
  Address at;                 // where it listens; not set: not at an address
  Address from;               // sender of the newest datagram
  // The sender's clock stands still or ticks coarsely: times of arrival are used instead.
  bool is_clock_unusable = false;
};

class PoseReceiver {
 public:
  virtual ~PoseReceiver() = default;
  // One line: what came, and what was left out and why.
  virtual std::string summary() const = 0;
  virtual InputState state() const = 0;
  // Why there is no pose, by what has arrived, and the cure. For people, and not on the pose path.
  virtual std::string diagnosis() const = 0;
};

}  // namespace dance
