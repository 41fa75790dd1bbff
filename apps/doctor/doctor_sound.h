// Whether music can be heard from this machine: connects to the sound server and plays silence for
// half a second.
//
// Ownership: plain values.
// Threads:   call from main.
// Failure:   the finding says what is missing and the cure. It is a note at most: a house without
//            sound keeps the time of the music and dances.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "apps/doctor/doctor_checks.h"
#include "core/sound/microphone.h"
#include "producers/music/loudspeaker.h"

namespace dance {

enum class SoundTrouble : std::uint8_t {
  kNotBuilt,
  kNoServer,       // no server listens at the socket
  kNotYours,       // the socket is another user's
  kRefused,        // a server is there and refuses the connection
  kHangs,          // a server accepts the connection and does not answer
  kNoLoudspeaker,  // connected, but the server has no output device
  kFarServer,      // on another machine, by PULSE_SERVER: cannot be checked from here
};

// Why there is no sound.
struct SoundFailure {
  SoundTrouble trouble = SoundTrouble::kNoServer;
  std::string reason;            // in the server's or its library's words
  std::string socket;            // of the server
  bool is_named = false;         // the socket or machine, by PULSE_SERVER
  std::string installed_server;  // the program that could be started, or ""
};

// From the state of the loudspeaker, or why there is none. Pure.
Finding check_loudspeaker(const tl::expected<Loudspeaker, SoundFailure>& loudspeaker);

// Where programs of this user find the sound server: a socket's path, or with PULSE_SERVER what
// that names.
std::string sound_server_place();
// Of this machine.
tl::expected<Loudspeaker, SoundFailure> find_loudspeaker();

Finding check_sound();
// For dance voice: of the microphone, or why there is none. Pure.
Finding check_microphone(const Result<Microphone>& microphone);
Finding check_microphone();

}  // namespace dance
