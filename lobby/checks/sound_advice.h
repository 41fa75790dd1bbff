// What a dancer is told of microphone and loudspeaker, from their state.
//
// Units/frames: none.
// Ownership:    plain values; allocates nothing.
// Threads:      none inside; pure.
// Failure:      none.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "lobby/checks/level_meter.h"
#include "viewer/words/texts.h"

namespace dance {

enum class DeviceState : std::uint8_t {
  kOpening,
  kWorks,
  kNone,   // there is no device of the kind
  kGone,   // the one that was chosen is not there
  kMuted,  // on the server
};

struct SoundState {
  enum class Server : std::uint8_t { kConnecting, kHere, kNone, kNotBuilt };
  Server server = Server::kConnecting;
  DeviceState microphone = DeviceState::kOpening;
  DeviceState loudspeaker = DeviceState::kOpening;
};

struct SoundAdvice {
  std::array<Text, 3> texts{Text::kSoundOpening};
  std::size_t count = 1;
  std::span<const Text> view() const { return {texts.data(), count}; }
};

// Never empty. `echo_is_heard`: at the last measurement of the way there and back.
SoundAdvice advise(const SoundState& state, const SoundLevel& level, bool echo_is_heard);

}  // namespace dance
