// PoseReceiver: the interface of a dancer who comes from another program or a device: datagrams of
// a protocol, an engine's own tracker. It publishes what comes as captures of its guest, at once.
//
// Units/frames: what comes becomes poses as core/pose/pose.h has them, in this house's clock.
// Ownership:    owns its socket; refers to sink and poller, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      what cannot be used is dropped and counted by cause: summary() tells.
#pragma once

#include <string>

namespace dance {

class PoseReceiver {
 public:
  virtual ~PoseReceiver() = default;
  // One line: what came, and what was left out and why.
  virtual std::string summary() const = 0;
};

}  // namespace dance
