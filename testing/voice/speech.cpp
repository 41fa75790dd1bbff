#include "testing/voice/speech.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/program/child_process.h"
#include "producers/music/decode/audio_file.h"

namespace dance {
namespace {

constexpr const char* kSpeechMaker = "/usr/bin/espeak-ng";
constexpr double kSpeech_hz = 48'000.0;
constexpr Duration kMostSpeaking = Duration::s(60);
constexpr const char* kSentences =
    "Step forward on one, and back on five. Keep your weight over the standing foot, and let the "
    "hips follow. Now a cross body lead: open on two, she walks past on five, six, seven. "
    "Lovely! Once more, a little smaller, and listen for the bell. Ready? Five, six, seven, eight. "
    "Could you turn the music up? I hear you well. Shall we try the double turn again? ";

// Windowed sinc over eight samples to each side.
std::vector<float> resampled(const std::vector<float>& in, double from_hz) {
  constexpr double pi = std::numbers::pi;
  constexpr int kSide = 8;
  const double step = from_hz / kSpeech_hz;
  const double cut = std::min(1.0, 1.0 / step);
  std::vector<float> out(static_cast<std::size_t>(static_cast<double>(in.size()) / step));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double at = static_cast<double>(i) * step;
    const auto middle = static_cast<std::ptrdiff_t>(at);
    double sum = 0.0;
    for (std::ptrdiff_t k = middle - kSide + 1; k <= middle + kSide; ++k) {
      if (k < 0 || k >= static_cast<std::ptrdiff_t>(in.size())) continue;
      const double x = static_cast<double>(k) - at;
      const double sinc = std::abs(x) < 1e-9 ? cut : std::sin(pi * cut * x) / (pi * x);
      sum += sinc * (0.5 + 0.5 * std::cos(pi * x / (kSide + 1))) *
             static_cast<double>(in[static_cast<std::size_t>(k)]);
    }
    out[i] = static_cast<float>(sum);
  }
  return out;
}

}  // namespace

bool has_speech_maker() { return std::filesystem::exists(kSpeechMaker); }

Result<std::vector<float>> read_speech(const std::string& file) {
  DANCE_TRY(AudioFile audio, AudioFile::open(file));
  std::vector<float> all;
  std::array<float, 4096> block{};
  constexpr std::size_t kMost = 48'000 * 600;
  for (;;) {
    DANCE_TRY(const std::size_t read, audio.read(block));
    if (read == 0 || all.size() > kMost) break;
    all.insert(all.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(read));
  }
  if (all.empty()) return fail(file + ": holds no sound");
  return audio.rate_hz() == kSpeech_hz ? all : resampled(all, audio.rate_hz());
}

Result<std::vector<float>> make_speech(double seconds, int speaker, const std::string& scratch) {
  if (!has_speech_maker())
    return fail("there is no espeak-ng to speak: apt-get install espeak-ng, or give a file");
  DANCE_TRY(ChildProcess maker, ChildProcess::start({kSpeechMaker,
                                                     {"-v", speaker % 2 == 0 ? "en+m3" : "en+f3",
                                                      "-s", "150", "--stdout", kSentences},
                                                     scratch,
                                                     ""}));
  if (!maker.wait(kMostSpeaking) || !maker.ended_well())
    return fail("espeak-ng " + (maker.has_ended() ? maker.exit_text() : "does not end"));
  auto once = read_speech(scratch);
  std::error_code ignored;
  std::filesystem::remove(scratch, ignored);
  if (!once) return once;
  std::vector<float> all;
  // Another speaker says the same at another time.
  std::size_t at = static_cast<std::size_t>(speaker) * 77'777 % once->size();
  while (static_cast<double>(all.size()) < seconds * kSpeech_hz) {
    all.push_back((*once)[at]);
    at = (at + 1) % once->size();
  }
  return all;
}

}  // namespace dance
