// The microphones and loudspeakers of this machine's sound server, for a choice among them.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      one, that of the server's connection; waits for its answer, a few seconds at most.
// Failure:      an Error tells why the server does not say; no devices are empty lists.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance {

class PulseServer;

struct SoundDevice {
  std::string name;         // as the server's own tools, `dance voice` and a session file take it
  std::string description;  // as people know it, printable
  bool is_default = false;
  bool is_muted = false;
  bool is_monitor = false;     // a source: what a sink plays
  bool leads_nowhere = false;  // a sink: made by the server where it found no device
};

struct SoundDevices {
  std::vector<SoundDevice> sources;  // microphones, and monitors
  std::vector<SoundDevice> sinks;    // loudspeakers, headphones
};

constexpr std::size_t kMostSoundDevices = 128;  // of each kind; more are left out

Result<SoundDevices> list_sound_devices(PulseServer& server);

}  // namespace dance
