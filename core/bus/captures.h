// Captures: where the poses of a house's dancers enter, and the one place that puts musical time on
// them: where the music stood, as it is heard here, when each was captured. Producers publish
// through it; a link hears captures through it, as producers in other languages put no musical time
// on theirs.
//
// Units/frames: times of this house's clock; beats as core/base/beat.h counts them.
// Ownership:    refers to the port, which must outlive it; the port's handlers refer to this.
// Threads:      the port's.
// Failure:      none; what the port does not take it counts.
#pragma once

#include <utility>

#include "core/bus/signal_port.h"
#include "core/pose/music_tag.h"

namespace dance {

class Captures {
 public:
  Captures(SignalPort& port, std::uint64_t clock_id) : port_(port), tag_(clock_id) {
    port_.subscribe<Beat>(Where::kLocal,
                          [this](const Channel&, const Beat& beat, MonoTime) { tag_.hear(beat); });
  }
  Captures(const Captures&) = delete;
  Captures& operator=(const Captures&) = delete;

  // Of a producer that has it ready at `now`: gets its musical time and its stamp.
  void publish(const GuestId& guest, Pose& pose, MonoTime now) {
    tag_.tag(pose);
    pose.stamp(Hop::kPublished, now);
    port_.publish(Where::kCapture, guest, pose);
  }
  // Captures of this house, with musical time; of all guests where the guest is not set.
  void subscribe(const GuestId& guest, SignalPort::Handler<Pose> handler) {
    port_.subscribe<Pose>({Where::kCapture, guest},
                          [this, handler = std::move(handler)](const Channel& channel,
                                                               const Pose& pose, MonoTime now) {
                            Pose tagged = pose;
                            tag_.tag(tagged);
                            handler(channel, tagged, now);
                          });
  }

  SignalPort& port() { return port_; }
  // The music of this house, for those who dance to it.
  const BeatClock& music() const { return tag_.clock(); }

 private:
  SignalPort& port_;
  MusicTag tag_;
};

}  // namespace dance
