// A descriptor that any thread makes readable, to wake the thread that polls it.
//
// Ownership: owns the descriptor.
// Threads:   signal() from any, the rest from one.
// Failure:   create() fails where no descriptor is left.
#pragma once

#include <utility>

#include "core/base/result.h"

namespace dance {

class WakeEvent {
 public:
  static Result<WakeEvent> create();
  WakeEvent(WakeEvent&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  WakeEvent& operator=(WakeEvent&&) = delete;
  ~WakeEvent();

  int fd() const { return fd_; }
  void signal() const;
  // Makes the descriptor unreadable until the next signal(); false where it was not readable.
  bool clear() const;

 private:
  explicit WakeEvent(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace dance
