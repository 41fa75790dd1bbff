// A build without PulseAudio: says so, and music is played without sound.
#include "producers/music/pulse_player.h"

namespace dance {

Result<std::unique_ptr<PulsePlayer>> PulsePlayer::open(AudioFile, const PulsePlayerOptions&) {
  return fail("this dance was built without sound: install libpulse-dev and build again");
}

std::optional<double> PulsePlayer::heard_s(MonoTime) const { return std::nullopt; }
Result<void> PulsePlayer::work(MonoTime) { return {}; }
std::string PulsePlayer::summary() const { return {}; }

PulseServer::~PulseServer() = default;
PulseOutput::~PulseOutput() = default;

}  // namespace dance
