#include "viewer/replay/sound/sound_log.h"

#include "core/bus/encode.h"

namespace dance {
namespace {

template <BusMessage T>
void set_event(std::span<const std::uint8_t> bytes, SoundEvent& event, bool& is_fine) {
  T message;
  is_fine = decode(bytes.data(), bytes.size(), message) == Decoded::kFine;
  if (is_fine) event.message = message;
}

bool decode_sound(std::span<const std::uint8_t> bytes, SoundEvent& event) {
  bool is_fine = false;
  switch (event.channel.signal()) {
    case Signal::kSong:
      set_event<RoomSong>(bytes, event, is_fine);
      break;
    case Signal::kMusic:
      set_event<Music>(bytes, event, is_fine);
      break;
    case Signal::kBeat:
      set_event<Beat>(bytes, event, is_fine);
      break;
    case Signal::kVoice:
      set_event<Voice>(bytes, event, is_fine);
      break;
    default:
      break;
  }
  return is_fine;
}

// Most messages of a log are poses: their channels are not parsed.
bool may_be_sound(std::string_view channel) {
  return channel.starts_with("SONG/") || channel.starts_with("MUSIC/") ||
         channel.starts_with("BEAT/") || channel.starts_with("VOICE/");
}

}  // namespace

Result<SoundLog> SoundLog::open(const std::string& path, const ReplayIndex& index, MonoTime from) {
  DANCE_TRY(LogReader reader, LogReader::open(path));
  reader.seek(index.checkpoint_for(from).at_bytes);
  return SoundLog(std::move(reader), index.wall_ahead_us);
}

SoundLog::Step SoundLog::step(MonoTime until, std::optional<SoundEvent>& event) {
  event.reset();
  const auto next = reader_.next();
  if (!next) return Step::kEnd;
  const MonoTime time = MonoTime::from_us(next->time_us - wall_ahead_us_);
  if (time > until) {
    reader_.again();
    return Step::kEnd;
  }
  if (!may_be_sound(next->channel)) return Step::kOther;
  const auto channel = Channel::parse(next->channel);
  if (!channel) return Step::kOther;
  SoundEvent sound{time, *channel, {}};
  if (!decode_sound(next->data, sound)) return Step::kOther;
  event = sound;
  return Step::kSound;
}

}  // namespace dance
