// HostedVoice: the [voice] of a session: who speaks in this house, and how.
//
// Units/frames: as `dance voice` takes them.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      read_voice() complains in the reader, with file, line and column.
#pragma once

#include <string>
#include <vector>

#include "core/base/guest_id.h"

namespace dance {

class TomlReader;  // its header costs a second in every file that reads it

struct HostedVoice {
  GuestId guest;
  bool names_guest = false;  // else it is the first of the house
  std::string microphone;    // "" = the default
  std::string loudspeaker;   // "" = the default
  std::string reference;     // the sink that is taken out; "" = the loudspeaker
  bool headphones = false;
  bool enabled = true;  // false: as written, but nobody speaks or is heard
  bool push_to_talk = false;
  bool muted = false;
  bool deafened = false;
  bool with_picture = false;
  bool low_delay = false;
  bool no_cleaning = false;
  double buffer_ms = 0.0;            // 0 = as dance voice has it
  double bitrate_kbit = 0.0;         // 0 = as dance voice has it
  std::vector<std::string> volumes;  // "bob=0.5"
};

// `first` speaks where no other guest is named; not set: the house has no dancer.
HostedVoice read_voice(TomlReader& reader, const GuestId& first);

// The words of `dance voice` for what a session says.
std::vector<std::string> voice_arguments(const HostedVoice& voice, const std::string& bus);

}  // namespace dance
