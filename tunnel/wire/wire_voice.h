// Voices in a datagram of their own, behind whatever dances: one record for each 10 ms of a guest's
// voice. Each can be read for itself, none is acknowledged and none is sent again.
// docs/wire-format.md says it byte by byte.
//
// Units/frames: little-endian; times are of the server's clock, on the wire in ticks of 16 µs.
// Ownership:    packets are views of the caller's bytes.
// Threads:      none inside.
// Failure:      as in tunnel/wire/wire.h; nothing here allocates. What is in a packet is not looked
//               at.
#pragma once

#include "core/bus/voice.h"
#include "tunnel/wire/wire.h"

namespace dance::wire {

// 10 ms of one guest's voice.
struct VoiceRecord {
  Slot slot;
  std::uint32_t sequence = 0;
  std::int64_t capture_us = 0;  // of the first sample; in whole ticks behind a wire
  std::int8_t level_dbfs = kSilence_dbfs;
  Bytes packet;
};
// Slot and generation, sequence, capture, level, length.
constexpr std::size_t kVoiceRecordHeader = 3 + 4 + 3 + 1 + 1;
constexpr std::size_t kVoiceOpening = 1;
// Of one guest, whom a server takes it from: packets, which come a hundred times a second.
constexpr double kVoicesPerSecond = 120.0, kVoiceBurst = 30.0;

void begin_voices(ByteWriter& out);
void add_voice(const VoiceRecord& record, ByteWriter& out);

// Of what follows the opening: one record; call until nothing remains. `now_us` is about now by the
// server's clock.
std::optional<VoiceRecord> parse_voice(std::int64_t now_us, ByteReader& in);
// Whether what follows the opening is records and nothing else: of a datagram all is taken or
// nothing.
bool are_voices(std::int64_t now_us, Bytes body);

}  // namespace dance::wire
