// A build without PulseAudio: says so, and music is played without sound.
#include "producers/music/loudspeaker.h"
#include "producers/music/sound/microphone_beats.h"
#include "producers/music/sound/pulse_player.h"

namespace dance {
namespace {

constexpr const char* kNoSound =
    "this dance was built without sound: install libpulse-dev and build again";

}  // namespace

Result<std::unique_ptr<PulsePlayer>> PulsePlayer::open(std::unique_ptr<MusicSource>,
                                                       const PulsePlayerOptions&) {
  return fail(kNoSound);
}

std::optional<double> PulsePlayer::heard_s(MonoTime) const { return std::nullopt; }
Result<void> PulsePlayer::work(MonoTime) { return {}; }
std::string PulsePlayer::summary() const { return {}; }

Result<std::unique_ptr<MicrophoneBeats>> MicrophoneBeats::open(const std::string&, Duration) {
  return fail(kNoSound);
}
Result<void> MicrophoneBeats::work(MonoTime) { return {}; }
std::optional<Beat> MicrophoneBeats::beat(MonoTime) const { return std::nullopt; }

Result<Loudspeaker> default_loudspeaker(const std::string&) { return fail(kNoSound); }

PulseInput::~PulseInput() = default;
PulseServer::~PulseServer() = default;
PulseOutput::~PulseOutput() = default;
PulseTiming::~PulseTiming() = default;

}  // namespace dance
