// State of voices at the server: how much each guest may send, and for each receiver its talkers
// and the packets that wait for it.
//
// Units/frames: MonoTime of the server's clock; guests by slot.
// Ownership:    plain values of fixed size.
#pragma once

#include <bitset>

#include "core/base/token_bucket.h"
#include "tunnel/server/voice/talker_places.h"
#include "tunnel/server/voice/voice_queue.h"
#include "tunnel/server/voice/voice_share.h"

namespace dance {

// Of one guest.
struct GuestVoice {
  TokenBucket packets, bytes;
  std::uint64_t packets_in = 0, bytes_in = 0;  // taken
};

// Of one receiver.
struct SessionVoice {
  std::bitset<wire::kMaxGuestsPerRoom> muted;  // by slot; follows from what the link wants
  TalkerPlaces places;
  VoiceShare share;
  VoiceQueue queue;
  MonoTime due;  // when the queue goes out; not set: it is empty
  std::uint64_t packets_out = 0;
  std::uint64_t bytes_out = 0;  // with all headers
};

}  // namespace dance
