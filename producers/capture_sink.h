// CaptureSink: where a producer's poses go: to the house's bus, or straight into the manager that
// hosts the producer.
//
// Threads: none inside; the producer's thread calls.
// Failure: none; a sink that cannot take a message counts it.
#pragma once

#include "core/base/guest_id.h"
#include "core/bus/bus.h"
#include "core/bus/messages.h"
#include "core/net/mono_clock.h"
#include "core/pose/music_tag.h"
#include "core/pose/pose.h"

namespace dance {

class CaptureSink {
 public:
  virtual ~CaptureSink() = default;
  // May stamp the pose.
  virtual void capture(const GuestId& guest, Pose& pose, MonoTime now) = 0;
  virtual void capture(const GuestId& guest, const Hands& hands) = 0;
  virtual void capture(const GuestId& guest, const TimedSkeleton& skeleton) = 0;
};

// Publishes on POSE/capture/<guest> and its companions, with the musical time of the house: whoever
// owns the bus drains it.
class BusCaptureSink : public CaptureSink {
 public:
  explicit BusCaptureSink(Bus& bus) : bus_(bus), tag_(this_clock_id()) {
    bus_.on_beat([this](const Channel&, const Beat& beat, MonoTime) { tag_.hear(beat); });
  }
  BusCaptureSink(const BusCaptureSink&) = delete;
  BusCaptureSink& operator=(const BusCaptureSink&) = delete;
  void capture(const GuestId& guest, Pose& pose, MonoTime) override {
    tag_.tag(pose);
    pose.stamp(Hop::kPublished, mono_now());
    bus_.publish(Channel::of(Signal::kPose, Where::kCapture, guest), pose);
  }
  void capture(const GuestId& guest, const Hands& hands) override {
    bus_.publish(Channel::of(Signal::kHands, Where::kCapture, guest), hands);
  }
  void capture(const GuestId& guest, const TimedSkeleton& skeleton) override {
    bus_.publish(Channel::of(Signal::kSkeleton, Where::kCapture, guest), skeleton);
  }

 private:
  Bus& bus_;
  MusicTag tag_;
};

}  // namespace dance
