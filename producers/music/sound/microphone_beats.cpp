#include "producers/music/sound/microphone_beats.h"

#include <algorithm>
#include <cmath>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr double kMicrophone_hz = 44100.0;
constexpr Duration kMicrophoneTimingRequests = Duration::ms(100);

}  // namespace

MicrophoneBeats::MicrophoneBeats(Duration trim) : trim_(trim), tracker_(kMicrophone_hz) {}

Result<std::unique_ptr<MicrophoneBeats>> MicrophoneBeats::open(const std::string& source,
                                                               Duration trim) {
  std::unique_ptr<MicrophoneBeats> beats(new MicrophoneBeats(trim));
  DANCE_TRY(beats->server_, PulseServer::connect("music"));
  BeatTracker* tracker = &beats->tracker_;
  DANCE_TRY(beats->input_, PulseInput::open(*beats->server_, {source, kMicrophone_hz},
                                            [tracker](std::span<const float> samples) {
                                              tracker->push(samples);
                                            }));
  return beats;
}

Result<void> MicrophoneBeats::work(MonoTime now) {
  server_->iterate();
  if (!server_->is_alive() || !input_->is_alive())
    return fail("the connection to the sound server is lost (" + server_->error_text() + ")");
  if (now >= next_timing_request_) {
    input_->request_timing();
    next_timing_request_ = now + kMicrophoneTimingRequests;
  }
  return {};
}

std::optional<Beat> MicrophoneBeats::beat(MonoTime now) const {
  if (!input_->is_timed()) return std::nullopt;
  Beat heard = tracker_.beat();
  if (!heard.playing) return std::nullopt;
  const double frame = (heard.beat_time - MonoTime()).as_seconds() * kMicrophone_hz;
  heard.beat_time = input_->time_of(static_cast<std::int64_t>(std::llround(frame))) - trim_;
  // The next beat at the time of the samples may be over by now.
  const double period_s = 60.0 / heard.tempo_bpm;
  const double passed = std::floor((now - heard.beat_time).as_seconds() / period_s) + 1.0;
  if (passed > 0.0) {
    heard.beat += passed;
    heard.beat_time += Duration::seconds(passed * period_s);
  }
  heard.time = now;
  heard.clock_id = this_clock_id();
  return heard;
}

}  // namespace dance
