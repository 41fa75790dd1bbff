#include "tunnel/wire/wire_voice.h"

#include "tunnel/wire/wire_records.h"

namespace dance::wire {

void begin_voices(ByteWriter& out) { out.u8(static_cast<std::uint8_t>(Type::kVoices)); }

void add_voice(const VoiceRecord& record, ByteWriter& out) {
  out.u8(record.slot.slot);
  out.u16(record.slot.generation);
  out.u32(record.sequence);
  out.u24(static_cast<std::uint32_t>(to_ticks(record.capture_us) & 0xffffff));
  out.u8(static_cast<std::uint8_t>(-record.level_dbfs));
  out.u8(static_cast<std::uint8_t>(record.packet.size()));
  out.bytes(record.packet);
}

std::optional<VoiceRecord> parse_voice(std::int64_t now_us, ByteReader& in) {
  VoiceRecord record;
  record.slot.slot = in.u8();
  record.slot.generation = in.u16();
  record.sequence = in.u32();
  const std::uint32_t ticks = in.u24();
  const std::uint8_t below_full = in.u8();
  const std::size_t size = in.u8();
  record.packet = in.bytes(size);
  if (!in.ok() || record.slot.slot >= kMaxGuestsPerRoom || below_full > -kSilence_dbfs ||
      size == 0 || size > kMaxVoiceBytes)
    return std::nullopt;
  record.capture_us = capture_near(ticks, to_ticks(now_us)) * kTick_us;
  record.level_dbfs = static_cast<std::int8_t>(-below_full);
  return record;
}

bool are_voices(std::int64_t now_us, Bytes body) {
  if (body.empty()) return false;
  for (ByteReader in(body); in.remaining() > 0;)
    if (!parse_voice(now_us, in)) return false;
  return true;
}

}  // namespace dance::wire
