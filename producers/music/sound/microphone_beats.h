// MicrophoneBeats: tracks the beat of the music that a microphone records, on this house's clock;
// the sound server's latency is subtracted.
//
// Units/frames: `trim` is latency that the server does not know of.
// Ownership:    owns its connection with the server and the tracker.
// Threads:      none inside; work() is to be called a hundred times a second.
// Failure:      open() names what is missing; work() fails when the connection is lost.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/beat.h"
#include "core/sound/pulse_input.h"
#include "producers/music/tracker/beat_tracker.h"

namespace dance {

class MicrophoneBeats {
 public:
  // `source` as PulseInput takes it.
  static Result<std::unique_ptr<MicrophoneBeats>> open(const std::string& source, Duration trim);
  MicrophoneBeats(const MicrophoneBeats&) = delete;
  MicrophoneBeats& operator=(const MicrophoneBeats&) = delete;

  Result<void> work(MonoTime now);
  // What the dancers' steps say, from now on.
  void set_tempo_hint(const TempoHint& hint) { tracker_.set_tempo_hint(hint); }
  // The next beat, while one is heard.
  std::optional<Beat> beat(MonoTime now) const;

 private:
  explicit MicrophoneBeats(Duration trim);

  Duration trim_;
  std::unique_ptr<PulseServer> server_;
  BeatTracker tracker_;
  std::unique_ptr<PulseInput> input_;  // last: its samples go to what stands above
  MonoTime next_timing_request_;
};

}  // namespace dance
