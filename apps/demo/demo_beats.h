// DemoBeats: the music of a demo without a song: publishes its beats on both houses' buses, at the
// tempo of the synthetic dancers. It makes no sound.
//
// Units/frames: beats as core/base/beat.h counts them; the first is heard at `origin`.
// Ownership:    refers to the buses, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      none.
#pragma once

#include <array>
#include <cmath>

#include "core/bus/signal_port.h"
#include "core/net/mono_clock.h"

namespace dance {

class DemoBeats {
 public:
  DemoBeats(SignalPort& bus_a, SignalPort& bus_b, MonoTime origin, double tempo_bpm)
      : buses_{&bus_a, &bus_b}, origin_(origin), tempo_bpm_(tempo_bpm) {}

  // Publishes, and returns when to publish again.
  MonoTime say(MonoTime now) {
    Beat beat;
    beat.time = now;
    beat.clock_id = this_clock_id();
    beat.tempo_bpm = tempo_bpm_;
    beat.beat = std::ceil((now - origin_).as_seconds() * tempo_bpm_ / 60.0);
    beat.beat_time = origin_ + Duration::seconds(beat.beat * 60.0 / tempo_bpm_);
    beat.beats_per_bar = 4;
    beat.confidence = 1.0f;
    beat.playing = true;
    for (SignalPort* bus : buses_) bus->publish(Channel::of_house(Signal::kBeat), beat);
    return now + Duration::ms(200);
  }

 private:
  std::array<SignalPort*, 2> buses_;
  MonoTime origin_;
  double tempo_bpm_;
};

}  // namespace dance
