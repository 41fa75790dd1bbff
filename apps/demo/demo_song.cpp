#include "apps/demo/demo_song.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/program/whole_file.h"

namespace dance {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;
constexpr int kClave_beats = 8;

class Band {
 public:
  explicit Band(double tempo_bpm)
      : samples_per_beat_(kDemoSong_hz * 60.0 / tempo_bpm),
        sound_(static_cast<std::size_t>(std::llround(samples_per_beat_ * kDemoSong_beats))) {}

  // f(seconds since the stroke), at a beat of the song.
  template <class Sound>
  void stroke(double beat, double length_s, const Sound& sound) {
    const auto begin = static_cast<std::size_t>(std::llround(beat * samples_per_beat_));
    const auto length = static_cast<std::size_t>(length_s * kDemoSong_hz);
    for (std::size_t i = 0; i < length; ++i)
      // What rings over the end is heard at the begin of the next round.
      sound_[(begin + i) % sound_.size()] += sound(static_cast<double>(i) / kDemoSong_hz);
  }
  void clave(double beat) {
    stroke(beat, 0.08,
           [](double t) { return 0.5 * std::exp(-60.0 * t) * std::sin(kTau * 2500 * t); });
  }
  void cowbell(double beat, double loudness) {
    stroke(beat, 0.2, [loudness](double t) {
      return 0.16 * loudness * std::exp(-18.0 * t) *
             (std::copysign(1.0, std::sin(kTau * 587 * t)) +
              std::copysign(1.0, std::sin(kTau * 845 * t)));
    });
  }
  void open_tone(double beat, double hz) {
    stroke(beat, 0.3, [hz](double t) {
      return 0.6 * std::exp(-18.0 * t) *
             std::sin(kTau * (hz * t + 1.2 * (1.0 - std::exp(-30.0 * t))));
    });
  }
  void slap(double beat) {
    stroke(beat, 0.08, [this](double t) {
      return 0.35 * std::exp(-50.0 * t) * (random_.uniform(-1.0, 1.0) + std::sin(kTau * 900 * t));
    });
  }
  void maracas(double beat, double loudness) {
    stroke(beat, 0.05, [this, loudness](double t) {
      return 0.12 * loudness * std::exp(-70.0 * t) * random_.uniform(-1.0, 1.0);
    });
  }

  std::vector<std::int16_t> samples() const {
    std::vector<std::int16_t> samples;
    samples.reserve(sound_.size());
    for (const double s : sound_)
      samples.push_back(static_cast<std::int16_t>(std::lround(32000.0 * std::tanh(0.8 * s))));
    return samples;
  }

 private:
  double samples_per_beat_;
  std::vector<double> sound_;
  Random random_{7};
};

void put_word(std::string& bytes, std::uint32_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<char>((value >> (8 * i)) & 0xff));
}

// RIFF, PCM.
std::string wav_of(const std::vector<std::int16_t>& samples) {
  const auto data_bytes = static_cast<std::uint32_t>(2 * samples.size());
  std::string bytes = "RIFF";
  put_word(bytes, 36 + data_bytes, 4);
  bytes += "WAVEfmt ";
  put_word(bytes, 16, 4);
  put_word(bytes, 1, 2);
  put_word(bytes, 1, 2);
  put_word(bytes, kDemoSong_hz, 4);
  put_word(bytes, 2 * kDemoSong_hz, 4);
  put_word(bytes, 2, 2);
  put_word(bytes, 16, 2);
  bytes += "data";
  put_word(bytes, data_bytes, 4);
  for (const std::int16_t sample : samples) put_word(bytes, static_cast<std::uint16_t>(sample), 2);
  return bytes;
}

}  // namespace

std::vector<std::int16_t> demo_song(double tempo_bpm) {
  Band band(tempo_bpm);
  for (int bar = 0; bar < kDemoSong_beats / kClave_beats; ++bar) {
    const double begin = bar * kClave_beats;
    for (const double beat : {0.0, 1.5, 3.0, 5.0, 6.0}) band.clave(begin + beat);
    for (int beat = 0; beat < kClave_beats; beat += 2)
      band.cowbell(begin + beat, beat % 4 == 0 ? 1.0 : 0.6);
    for (const double half : {0.0, 4.0}) {
      band.slap(begin + half + 1.0);
      band.open_tone(begin + half + 3.0, 190.0);
      band.open_tone(begin + half + 3.5, half == 0.0 ? 190.0 : 130.0);
    }
    for (int eighth = 0; eighth < 2 * kClave_beats; ++eighth)
      band.maracas(begin + 0.5 * eighth, eighth % 2 == 0 ? 1.0 : 0.5);
  }
  return band.samples();
}

Result<void> write_demo_song(const std::string& wav, double tempo_bpm) {
  if (auto written = write_whole_file(wav, wav_of(demo_song(tempo_bpm))); !written) return written;
  std::string beats;
  for (int beat = 0; beat < kDemoSong_beats; ++beat)
    beats += fmt::format("{:.6f}\t{}\n", beat * 60.0 / tempo_bpm, beat % 4 + 1);
  return write_whole_file(wav.substr(0, wav.rfind('.')) + ".beats", beats);
}

}  // namespace dance
