// What the server keeps of voices: of each guest how loud it is and how much it may send, of each
// receiver whom it hears and what waits for it.
//
// Units/frames: MonoTime of the server's clock; guests by slot.
// Ownership:    plain values of fixed size.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <bitset>

#include "core/base/token_bucket.h"
#include "tunnel/server/voice/talker_places.h"
#include "tunnel/server/voice/voice_queue.h"
#include "tunnel/server/voice/voice_share.h"

namespace dance {

// Of one guest.
struct GuestVoice {
  Loudness loudness;
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
