#include "viewer/replay/sound/recorded_voices.h"

#include <algorithm>
#include <array>

#include "voice/mix/spatial_voice.h"
#include "voice/playout/voice_playout.h"

namespace dance {
namespace {

// The house band of a live house uses the same values (producers/music/room/band_program.cpp).
constexpr Duration kSpeechPause = Duration::ms(700);
constexpr int kSpeech_dbfs = -50;
// The play-out of a guest is skipped when no packet has arrived for this long.
constexpr Duration kLeft = Duration::s(5);

class DecodedVoices final : public RecordedVoices {
 public:
  void put(const GuestId& guest, const Voice& voice, MonoTime arrival) override {
    Speaker* const speaker = speaker_of(guest);
    if (speaker == nullptr) return;
    speaker->arrival = arrival;
    speaker->playout->put(voice, arrival);
    if (voice.level_dbfs > kSpeech_dbfs) speech_ = arrival;
  }

  void add_to(MonoTime at, std::span<float> stereo) override {
    std::array<float, kVoiceFrameSamples> mono{};
    for (Speaker& speaker : speakers_) {
      if (speaker.playout == nullptr || at - speaker.arrival > kLeft) continue;
      speaker.playout->pull(at, at, mono);
      speaker.place.mix(mono, stereo);
      if (speaker.playout->is_speaking()) heard_.emplace(speaker.guest.view());
    }
  }

  bool is_speech(MonoTime at) const override {
    return speech_.is_set() && at - speech_ < kSpeechPause;
  }
  const std::set<std::string>& heard() const override { return heard_; }

 private:
  struct Speaker {
    GuestId guest;
    MonoTime arrival;
    std::unique_ptr<VoicePlayout> playout;  // nullptr: this place is free
    SpatialVoice place;
  };

  // A free place, or that of the guest who was silent longest.
  Speaker* speaker_of(const GuestId& guest) {
    const auto known = std::find_if(speakers_.begin(), speakers_.end(), [&](const Speaker& each) {
      return each.playout != nullptr && each.guest == guest;
    });
    if (known != speakers_.end()) return &*known;
    auto decoder = VoiceDecoder::create();
    if (!decoder) return nullptr;
    Speaker& longest =
        *std::min_element(speakers_.begin(), speakers_.end(),
                          [](const Speaker& a, const Speaker& b) { return a.arrival < b.arrival; });
    longest = {guest, MonoTime(), std::make_unique<VoicePlayout>(std::move(*decoder)),
               SpatialVoice()};
    return &longest;
  }

  std::array<Speaker, kMostGuests> speakers_;
  std::set<std::string> heard_;
  MonoTime speech_;
};

}  // namespace

Result<std::unique_ptr<RecordedVoices>> RecordedVoices::create() {
  return std::make_unique<DecodedVoices>();
}

}  // namespace dance
