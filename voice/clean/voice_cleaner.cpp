#include "voice/clean/voice_cleaner.h"

#if __has_include(<webrtc/modules/audio_processing/include/audio_processing.h>)
#include <webrtc/modules/audio_processing/include/audio_processing.h>
#define DANCE_WEBRTC_0
#else
#include <modules/audio_processing/include/audio_processing.h>
#endif

#include <algorithm>
#include <array>

namespace dance {
namespace {

using Processing = webrtc::AudioProcessing;
constexpr int kRate_hz = 48'000;
// What the library takes.
constexpr std::int64_t kMostDelay_ms = 500;
// Speech is brought to about this; louder is limited.
constexpr int kTargetBelowFullScale_db = 12;
constexpr int kMostGain_db = 9;

const webrtc::StreamConfig& mono() {
  static const webrtc::StreamConfig config(kRate_hz, 1);
  return config;
}

#ifdef DANCE_WEBRTC_0
// Version 0.3: a setting function for each part.
std::unique_ptr<Processing> make_processor() {
  webrtc::Config config;
  // A filter as long as a room, which finds an echo wherever it is, as sound servers do not always
  // know how late it comes.
  config.Set<webrtc::ExtendedFilter>(new webrtc::ExtendedFilter(true));
  config.Set<webrtc::DelayAgnostic>(new webrtc::DelayAgnostic(true));
  return std::unique_ptr<Processing>(Processing::Create(config));
}

bool configure(Processing& processor, const VoiceCleanerOptions& options) {
  int wrong = processor.high_pass_filter()->Enable(true);
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
  return wrong == Processing::kNoError;
}
#else
// Version 1.3: one struct of settings. Its echo canceller finds the delay of the echo by itself.
std::unique_ptr<Processing> make_processor() {
  return std::unique_ptr<Processing>(webrtc::AudioProcessingBuilder().Create());
}

bool configure(Processing& processor, const VoiceCleanerOptions& options) {
  Processing::Config config;
  config.high_pass_filter.enabled = true;
  config.echo_canceller.enabled = options.takes_out_echo;
  config.noise_suppression.enabled = options.takes_out_noise;
  config.noise_suppression.level = Processing::Config::NoiseSuppression::kHigh;
  config.gain_controller1.enabled = options.levels_loudness;
  config.gain_controller1.mode = Processing::Config::GainController1::kAdaptiveDigital;
  config.gain_controller1.target_level_dbfs = kTargetBelowFullScale_db;
  config.gain_controller1.compression_gain_db = kMostGain_db;
  config.gain_controller1.enable_limiter = true;
  config.gain_controller1.analog_gain_controller.enabled = false;
  config.residual_echo_detector.enabled = false;
  processor.ApplyConfig(config);
  return true;
}
#endif

}  // namespace

Result<std::unique_ptr<VoiceCleaner>> VoiceCleaner::create(const VoiceCleanerOptions& options) {
  std::unique_ptr<VoiceCleaner> made(new VoiceCleaner);
  made->processor_ = make_processor();
  if (!made->processor_) return fail("no memory for the echo canceller");
  Processing& processor = *made->processor_;
  if (processor.Initialize({{mono(), mono(), mono(), mono()}}) != Processing::kNoError ||
      !configure(processor, options))
    return fail("the echo canceller refuses its settings");
  return made;
}

VoiceCleaner::VoiceCleaner() = default;
VoiceCleaner::~VoiceCleaner() = default;

void VoiceCleaner::hear_loudspeaker(std::span<const float, kFrame> frame) {
  const float* channel = frame.data();
  // Version 0.3 and 1.3 both have this call, which also copies the frame; the copy is not used.
  std::array<float, kFrame> unused;
  float* returned = unused.data();
  if (processor_->ProcessReverseStream(&channel, mono(), mono(), &returned) != Processing::kNoError)
    ++refused_;
}

void VoiceCleaner::clean(std::span<float, kFrame> frame, Duration echo_delay) {
  const auto delay_ms = std::clamp<std::int64_t>(echo_delay.count_ms(), 0, kMostDelay_ms);
  processor_->set_stream_delay_ms(static_cast<int>(delay_ms));
  float* channel = frame.data();
  if (processor_->ProcessStream(&channel, mono(), mono(), &channel) != Processing::kNoError)
    ++refused_;
}

}  // namespace dance
