// CaptureSink: where a producer's poses go: to the house's captures, or to a recording before them.
//
// Threads: none inside; the producer's thread calls.
// Failure: none; a sink that cannot take a message counts it.
#pragma once

#include "core/base/guest_id.h"
#include "core/bus/captures.h"
#include "core/net/mono_clock.h"

namespace dance {

class CaptureSink {
 public:
  virtual ~CaptureSink() = default;
  // May stamp the pose.
  virtual void capture(const GuestId& guest, Pose& pose, MonoTime now) = 0;
  virtual void capture(const GuestId& guest, const Hands& hands) = 0;
  virtual void capture(const GuestId& guest, const TimedSkeleton& skeleton) = 0;
  // Only where the dancer wants it; a recording does not keep it.
  virtual void capture_face(const GuestId&, const Face&) {}
  // What the producer itself knows of its dancer's steps; of no use to a recording.
  virtual void tell(const GuestId&, const Steps&) {}
};

// Publishes on POSE/capture/<guest> and its companions.
class PortCaptureSink : public CaptureSink {
 public:
  explicit PortCaptureSink(SignalPort& port) : captures_(port, this_clock_id()) {}
  Captures& captures() { return captures_; }
  // The dancer has been worked out since `now`: published later.
  void capture(const GuestId& guest, Pose& pose, MonoTime) override {
    captures_.publish(guest, pose, mono_now());
  }
  void capture(const GuestId& guest, const Hands& hands) override {
    captures_.port().publish(Where::kCapture, guest, hands);
  }
  void capture(const GuestId& guest, const TimedSkeleton& skeleton) override {
    captures_.port().publish(Where::kCapture, guest, skeleton);
  }
  void capture_face(const GuestId& guest, const Face& face) override {
    captures_.port().publish(Where::kCapture, guest, face);
  }
  void tell(const GuestId& guest, const Steps& steps) override {
    captures_.port().publish(Where::kCapture, guest, steps);
  }

 private:
  Captures captures_;
};

}  // namespace dance
