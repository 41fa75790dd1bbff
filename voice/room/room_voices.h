// RoomVoices: the voices of the others, each with its own play-out, mixed where their dancers
// stand.
//
// Units/frames: stereo, interleaved, 48 kHz; times of this house's clock; levels in dBFS.
// Ownership:    kMostVoices play-outs, made at the begin (about 110 kB each); the guest who was
//               silent longest makes room for another.
// Threads:      none inside; one owner.
// Failure:      create() passes on what Opus refuses; bad packets are counted by guest.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "core/bus/voice.h"
#include "core/signal/playout.h"
#include "voice/mix/limiter.h"
#include "voice/mix/spatial_voice.h"
#include "voice/playout/voice_playout.h"
#include "voice/room/stage_places.h"
#include "voice/room/voice_settings.h"

namespace dance {

class RoomVoices {
 public:
  static constexpr std::size_t kMostVoices = 16;
  static constexpr Duration kLeft = Duration::s(30);

  struct Guest {
    GuestId guest;
    std::unique_ptr<VoicePlayout> playout;
    SpatialVoice place;
    std::optional<Duration> picture_delay;
    MonoTime heard;  // its last packet
    int level_dbfs = kSilence_dbfs;
  };

  static Result<std::unique_ptr<RoomVoices>> create();

  void hear(const GuestId& guest, const Voice& voice, MonoTime now);
  void see(const GuestId& guest, const Pose& pose) { places_.see(guest, pose); }
  // What the guest's stage says of its picture.
  void know_picture(const GuestId& guest, const Playout& playout);
  // Adds all voices, and limits.
  void mix(std::span<float> stereo, MonoTime now, MonoTime heard, const GuestId& listener,
           const VoiceSettings& settings);

  // Those with a guest.
  template <class See>
  void each(See see) const {
    for (const Guest& guest : guests_)
      if (guest.guest.is_set()) see(guest);
  }

 private:
  RoomVoices() = default;
  Guest* find(const GuestId& guest);

  std::array<Guest, kMostVoices> guests_;
  StagePlaces places_;
  Limiter limiter_;
};

}  // namespace dance
