#include "voice/room/room_voices.h"

#include <algorithm>
#include <cmath>

namespace dance {

Result<std::unique_ptr<RoomVoices>> RoomVoices::create() {
  std::unique_ptr<RoomVoices> voices(new RoomVoices);
  for (Guest& guest : voices->guests_) {
    DANCE_TRY(auto decoder, VoiceDecoder::create());
    guest.playout = std::make_unique<VoicePlayout>(std::move(decoder));
  }
  return voices;
}

RoomVoices::Guest* RoomVoices::find(const GuestId& guest) {
  const auto found = std::find_if(guests_.begin(), guests_.end(),
                                  [&](const Guest& known) { return known.guest == guest; });
  return found == guests_.end() ? nullptr : &*found;
}

void RoomVoices::hear(const GuestId& guest, const Voice& voice, MonoTime now) {
  Guest* known = find(guest);
  if (known == nullptr) {
    // A free one, or the one that was silent longest: never heard is longest of all.
    known = std::min_element(guests_.begin(), guests_.end(),
                             [](const Guest& a, const Guest& b) { return a.heard < b.heard; });
    known->guest = guest;
    known->playout->forget();
    known->place = SpatialVoice();
    known->picture_delay.reset();
  }
  known->heard = now;
  known->level_dbfs = voice.level_dbfs;
  known->playout->put(voice, now);
}

void RoomVoices::know_picture(const GuestId& guest, const Playout& playout) {
  Guest* known = find(guest);
  if (known == nullptr) return;
  known->picture_delay.reset();
  if (std::isfinite(playout.delay_ms) && playout.delay_ms > 0.0f)
    known->picture_delay = Duration::seconds(static_cast<double>(playout.delay_ms) * 1e-3);
}

void RoomVoices::mix(std::span<float> stereo, MonoTime now, MonoTime heard, const GuestId& listener,
                     const VoiceSettings& settings) {
  constexpr std::size_t kBlock = kVoiceFrameSamples;
  std::array<float, kBlock> mono;
  for (std::size_t at = 0; at < stereo.size() / 2; at += kBlock) {
    const auto part = stereo.subspan(2 * at, std::min(2 * kBlock, stereo.size() - 2 * at));
    const Duration later =
        Duration::seconds(static_cast<double>(at) / static_cast<double>(kVoiceRate_hz));
    for (Guest& guest : guests_) {
      if (!guest.guest.is_set() || now - guest.heard > kLeft) continue;
      if (const auto place = places_.place_of(guest.guest, listener))
        guest.place.set_place(place->azimuth_rad, place->distance_m);
      guest.place.set_volume(settings.is_deafened ? 0.0f : settings.volume_of(guest.guest));
      guest.playout->set_delay(settings.follows_picture ? guest.picture_delay : std::nullopt);
      const auto samples = std::span(mono).first(part.size() / 2);
      guest.playout->pull(now, heard + later, samples);
      guest.place.mix(samples, part);
    }
    limiter_.limit(part);
  }
}

}  // namespace dance
