#include "tunnel/link/signals/link_voice.h"

namespace dance {
namespace {

// Twice the server's limits, so that a slow path does not count.
constexpr std::int64_t kOldestHeard_us = 10'000'000;
constexpr std::int64_t kFarthestHeard_us = 2'000'000;
constexpr Duration kOldestSpoken = Duration::s(2);

}  // namespace

void LinkVoice::send(LocalGuest& guest, const Voice& voice, MonoTime now) {
  LinkCounters& counters = link_.counters;
  LinkSender::Stamp times{};
  const bool is_ours = voice.clock_id == link_.options.clock_id && voice.capture_time.is_set();
  if (!is_valid(voice) || (is_ours && now - voice.capture_time > kOldestSpoken) ||
      !sender_.stamp(voice.capture_time, voice.clock_id, MonoTime(), now, times)) {
    ++counters.voices_invalid;
    return;
  }
  // The server would drop it, and with a flood of them our poses.
  if (!guest.voice_budget.take(1.0, now)) {
    ++counters.voices_limited;
    return;
  }
  const wire::VoiceRecord record{guest.slot, voice.sequence, times.capture_us,
                                 static_cast<std::int8_t>(voice.level_dbfs), voice.packet()};
  if (size_ + wire::kVoiceRecordHeader + record.packet.size() > bytes_.size()) flush();
  ByteWriter out(std::span<std::uint8_t>(bytes_).subspan(size_));
  if (size_ == 0) {
    wire::begin_voices(out);
    due_ = now;
  }
  wire::add_voice(record, out);
  DANCE_ASSERT(out.ok());
  size_ += out.size();
  ++counters.voices_sent;
}

void LinkVoice::flush() {
  ++link_.counters.voice_datagrams_out;
  link_.counters.voice_bytes_out += size_ + wire::kSealOverhead;
  link_.send({bytes_.data(), size_});
  size_ = 0;
}

void LinkVoice::flush_due(MonoTime now) {
  if (size_ > 0 && now >= due_) flush();
}

bool LinkVoice::on_voices(wire::Bytes body, MonoTime now) {
  const std::int64_t server_now_us = link_.clock.to_theirs_us(now);
  if (!wire::are_voices(server_now_us, body)) return false;
  ++link_.counters.voice_datagrams_in;
  link_.counters.voice_bytes_in += body.size() + wire::kVoiceOpening + wire::kSealOverhead;
  for (ByteReader in(body); in.remaining() > 0;)
    on_voice(*wire::parse_voice(server_now_us, in), now);
  return true;
}

void LinkVoice::on_voice(const wire::VoiceRecord& record, MonoTime now) {
  LinkCounters& counters = link_.counters;
  RemoteGuest& remote = link_.remotes[record.slot.slot];
  if (!remote.in_use || remote.is_ours || remote.generation != record.slot.generation ||
      !link_.options.hearing.hears(remote.id)) {
    ++counters.voices_unrouted;
    return;
  }
  const std::int64_t ahead_us = record.capture_us - link_.clock.to_theirs_us(now);
  if (ahead_us < -kOldestHeard_us || ahead_us > kFarthestHeard_us ||
      !heard_.set_packet(record.packet)) {
    ++counters.voices_invalid;
    return;
  }
  heard_.capture_time = link_.clock.to_ours(record.capture_us);
  heard_.clock_id = link_.options.clock_id;
  heard_.sequence = record.sequence;
  heard_.level_dbfs = record.level_dbfs;
  ++counters.voices_delivered;
  ++remote.counts.voices;
  remote.counts.voice_bytes += wire::kVoiceRecordHeader + record.packet.size();
  if (link_.handlers.on_voice) link_.handlers.on_voice(remote.id, heard_, now);
}

}  // namespace dance
