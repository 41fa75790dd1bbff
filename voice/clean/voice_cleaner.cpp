#include "voice/clean/voice_cleaner.h"

#include <webrtc/modules/audio_processing/include/audio_processing.h>

#include <algorithm>

namespace dance {
namespace {

using Processing = webrtc::AudioProcessing;
constexpr int kRate_hz = 48'000;
// What the library takes.
constexpr std::int64_t kMostDelay_ms = 500;
// Speech is brought to about this; louder is limited.
constexpr int kTargetBelowFullScale_db = 12;
constexpr int kMostGain_db = 9;

}  // namespace

Result<std::unique_ptr<VoiceCleaner>> VoiceCleaner::create(const VoiceCleanerOptions& options) {
  std::unique_ptr<VoiceCleaner> made(new VoiceCleaner);
  webrtc::Config config;
  // A filter as long as a room, which finds an echo wherever it is, as sound servers do not always
  // know how late it comes.
  config.Set<webrtc::ExtendedFilter>(new webrtc::ExtendedFilter(true));
  config.Set<webrtc::DelayAgnostic>(new webrtc::DelayAgnostic(true));
  made->processor_.reset(Processing::Create(config));
  if (!made->processor_) return fail("no memory for the echo canceller");
  Processing& processor = *made->processor_;
  int wrong = processor.Initialize(kRate_hz, kRate_hz, kRate_hz, Processing::kMono,
                                   Processing::kMono, Processing::kMono);
  wrong |= processor.high_pass_filter()->Enable(true);
  wrong |= processor.echo_cancellation()->enable_drift_compensation(false);
  wrong |= processor.echo_cancellation()->set_suppression_level(
      webrtc::EchoCancellation::kHighSuppression);
  wrong |= processor.echo_cancellation()->Enable(options.takes_out_echo);
  wrong |= processor.noise_suppression()->set_level(webrtc::NoiseSuppression::kHigh);
  wrong |= processor.noise_suppression()->Enable(options.takes_out_noise);
  wrong |= processor.gain_control()->set_mode(webrtc::GainControl::kAdaptiveDigital);
  wrong |= processor.gain_control()->set_target_level_dbfs(kTargetBelowFullScale_db);
  wrong |= processor.gain_control()->set_compression_gain_db(kMostGain_db);
  wrong |= processor.gain_control()->enable_limiter(true);
  wrong |= processor.gain_control()->Enable(options.levels_loudness);
  if (wrong != Processing::kNoError) return fail("the echo canceller refuses its settings");
  return made;
}

VoiceCleaner::VoiceCleaner() = default;
VoiceCleaner::~VoiceCleaner() = default;

void VoiceCleaner::hear_loudspeaker(std::span<const float, kFrame> frame) {
  const float* channel = frame.data();
  if (processor_->AnalyzeReverseStream(&channel, frame.size(), kRate_hz, Processing::kMono) !=
      Processing::kNoError)
    ++refused_;
}

void VoiceCleaner::clean(std::span<float, kFrame> frame, Duration echo_delay) {
  const auto delay_ms = std::clamp<std::int64_t>(echo_delay.count_ms(), 0, kMostDelay_ms);
  processor_->set_stream_delay_ms(static_cast<int>(delay_ms));
  float* channel = frame.data();
  if (processor_->ProcessStream(&channel, frame.size(), kRate_hz, Processing::kMono, kRate_hz,
                                Processing::kMono, &channel) != Processing::kNoError)
    ++refused_;
}

}  // namespace dance
