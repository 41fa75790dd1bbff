// SoundCheck: microphone and loudspeaker before the dance: how loud one speaks, whether anything is
// heard at all, a test of the loudspeaker, and the way there and back. Devices are named as
// `dance voice` and a session file's [voice] name them.
//
// Units/frames: levels in dB of full scale.
// Ownership:    owns its connection with the sound server. What is returned is good until the next
//               read().
// Threads:      one inside, in which the sound server is waited for; the rest belongs to one
//               owner, who waits in the destructor alone: up to 3 s where a server hangs.
// Failure:      start() does not fail: whatever is wrong is advice(). A server or a device that is
//               missing is looked for again every two seconds.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/time.h"
#include "lobby/checks/level_meter.h"
#include "lobby/checks/round_trip.h"
#include "lobby/checks/sound_advice.h"
#include "viewer/words/texts.h"

namespace dance {

struct SoundChoice {
  std::string microphone;   // as `pactl list short sources` names it; "" = the default
  std::string loudspeaker;  // as `pactl list short sinks` names it; "" = the default
  bool operator==(const SoundChoice&) const = default;
};

struct ListedSound {
  std::string name;         // what a session file holds
  std::string description;  // for people, printable
  bool is_default = false;
};

class SoundCheck {
 public:
  static std::unique_ptr<SoundCheck> start(const SoundChoice& choice);
  virtual ~SoundCheck() = default;

  // Other devices, from now on.
  virtual void choose(const SoundChoice& choice) = 0;
  // Four tones on the chosen loudspeaker; again while they sound: from their begin.
  virtual void play_count_in() = 0;
  // A sweep: round_trip() has the answer about a second later.
  virtual void measure_round_trip() = 0;

  // Readable when there is something to read(); -1 where nothing ever comes.
  virtual int fd() const = 0;
  // Takes what is new; twenty times a second there is something.
  virtual void read(MonoTime now) = 0;

  virtual const SoundLevel& level() const = 0;
  virtual bool is_playing() const = 0;
  virtual const std::optional<RoundTrip>& round_trip() const = 0;
  // Microphones first, then what the sinks play, which some record from.
  virtual std::span<const ListedSound> microphones() const = 0;
  virtual std::span<const ListedSound> loudspeakers() const = 0;
  // What to mend, what matters most first, three at most; or that all is well. Never empty.
  virtual std::span<const Text> advice() const = 0;

  bool is_good() const { return advice().front() == Text::kSoundGood; }
};

// "Loudspeaker and microphone: 84 ms there and back", or that nothing came back.
std::string say_round_trip(const Texts& texts, const RoundTrip& trip);

// Why the sound server cannot be reached, in a printable line; "" if it can, or in a build without
// sound. Waits up to three seconds for a server that hangs.
std::string sound_server_error();

}  // namespace dance
