#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "bench/voice/bench_voice.h"
#include "core/base/random.h"
#include "core/program/figures.h"
#include "voice/codec/voice_decoder.h"
#include "voice/codec/voice_encoder.h"
#include "voice/codec/voice_packet.h"

namespace dance {
namespace {

constexpr double kLoss = 0.05;
constexpr std::size_t kBands = 24;

struct CodecCase {
  const char* name;
  VoiceEncoderOptions options;
};

// Energies of a frame in 24 bands of 250 Hz, by direct transform: what an ear tells apart, roughly.
std::array<double, kBands> bands_of(std::span<const float> frame) {
  std::array<double, kBands> bands{};
  for (std::size_t b = 0; b < kBands; ++b) {
    const double step =
        2.0 * std::numbers::pi * (125.0 + 250.0 * static_cast<double>(b)) / 48'000.0;
    const std::complex<double> turn(std::cos(step), -std::sin(step));
    std::complex<double> sum, phase(1.0, 0.0);
    for (std::size_t i = 0; i < frame.size(); ++i) {
      const double w = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) /
                                            static_cast<double>(frame.size()));
      sum += w * static_cast<double>(frame[i]) * phase;
      phase *= turn;
    }
    bands[b] = 10.0 * std::log10(std::norm(sum) + 1e-4);
  }
  return bands;
}

double distance_db(std::span<const float> a, std::span<const float> b) {
  const auto x = bands_of(a), y = bands_of(b);
  double sum = 0.0;
  for (std::size_t i = 0; i < kBands; ++i) sum += (x[i] - y[i]) * (x[i] - y[i]);
  return std::sqrt(sum / kBands);
}

struct CodecFigures {
  double kbit_per_s = 0.0, packets_per_s = 0.0, copies_percent = 0.0;
  double encode_us = 0.0, decode_us = 0.0, look_ahead_ms = 0.0;
  double distance_lost_db = 0.0;  // of frames that were lost, against the same codec without loss
  double recovered_percent = 0.0;
};

Result<CodecFigures> measure(const Speech& speech, const VoiceEncoderOptions& options) {
  DANCE_TRY(auto encoder, VoiceEncoder::create(options));
  DANCE_TRY(auto whole, VoiceDecoder::create());
  DANCE_TRY(auto lossy, VoiceDecoder::create());
  const std::size_t frames = speech.size() / kVoiceFrameSamples;
  std::vector<std::vector<std::uint8_t>> packets;
  CodecFigures figures;
  figures.look_ahead_ms = encoder->look_ahead().as_ms();
  double begin = cpu_us();
  for (std::size_t i = 0; i < frames; ++i) {
    const auto packet = encoder->encode(
        std::span(speech).subspan(i * kVoiceFrameSamples).first<kVoiceFrameSamples>());
    packets.emplace_back(packet.begin(), packet.end());
  }
  figures.encode_us = (cpu_us() - begin) / static_cast<double>(frames);
  std::size_t bytes = 0, sent = 0, copies = 0;
  for (const auto& packet : packets) {
    bytes += packet.size();
    sent += packet.empty() ? 0 : 1;
    copies += has_error_correction(packet) ? 1 : 0;
  }
  const double seconds = static_cast<double>(frames) * 0.01;
  figures.kbit_per_s = static_cast<double>(bytes) * 8e-3 / seconds;
  figures.packets_per_s = static_cast<double>(sent) / seconds;
  figures.copies_percent = 100.0 * static_cast<double>(copies) / static_cast<double>(sent);
  begin = cpu_us();
  std::vector<VoiceFrame> reference(frames);
  for (std::size_t i = 0; i < frames; ++i)
    packets[i].empty() ? whole->conceal(reference[i])
                       : static_cast<void>(whole->decode(packets[i], reference[i]));
  figures.decode_us = (cpu_us() - begin) / static_cast<double>(frames);
  Random random(7);
  std::size_t lost = 0, recovered = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    VoiceFrame frame;
    const bool is_lost = !packets[i].empty() && random.uniform() < kLoss;
    if (packets[i].empty()) {
      lossy->conceal(frame);
    } else if (!is_lost) {
      lossy->decode(packets[i], frame);
    } else {
      const bool has_next = i + 1 < frames && !packets[i + 1].empty();
      if (has_next && lossy->decode_lost(packets[i + 1], frame)) ++recovered;
      if (!has_next) lossy->conceal(frame);
      // What silence sounds like does not matter.
      if (level_dbfs(reference[i]) < -45) continue;
      ++lost;
      figures.distance_lost_db += distance_db(reference[i], frame);
    }
  }
  figures.distance_lost_db /= static_cast<double>(std::max<std::size_t>(lost, 1));
  figures.recovered_percent =
      100.0 * static_cast<double>(recovered) / static_cast<double>(std::max<std::size_t>(lost, 1));
  return figures;
}

}  // namespace

Result<BenchReport> bench_voice_codec(const Speech& speech) {
  VoiceEncoderOptions speech_mode, without, low_delay, loss20;
  without.has_error_correction = false;
  low_delay.mode = VoiceMode::kLowDelay;
  low_delay.has_error_correction = false;
  VoiceEncoderOptions speech24 = speech_mode, low24 = low_delay;
  speech24.bits_per_second = low24.bits_per_second = 24'000;
  loss20.expected_loss_percent = 20;
  const std::array cases{CodecCase{"speech 32 kbit/s, copies", speech_mode},
                         CodecCase{"speech 32, copies for 20 %", loss20},
                         CodecCase{"speech 32, none", without},
                         CodecCase{"speech 24, copies", speech24},
                         CodecCase{"low delay 32", low_delay},
                         CodecCase{"low delay 24", low24}};
  BenchReport report;
  report.text = fmt::format(
      "off: frames lost at random (5 %), as they are heard, against the same frames not lost, in "
      "bands of 250 Hz\n{:<28} {:>9} {:>8} {:>10} {:>7} {:>9} {:>9} {:>8}\n",
      "Opus, frames of 10 ms", "kbit/s", "packets", "look-ahead", "copies", "encode", "decode",
      "off");
  for (const CodecCase& one : cases) {
    DANCE_TRY(const CodecFigures f, measure(speech, one.options));
    report.text += fmt::format(
        "{:<28} {:>9.1f} {:>6.0f}/s {:>7.1f} ms {:>6.0f}% {:>6.0f} µs {:>6.0f} µs {:>5.1f} dB\n",
        one.name, f.kbit_per_s, f.packets_per_s, f.look_ahead_ms, f.copies_percent, f.encode_us,
        f.decode_us, f.distance_lost_db);
    report.json.push_back({{"mode", one.name},
                           {"kbit_per_s", rounded(f.kbit_per_s, 10.0)},
                           {"packets_per_s", rounded(f.packets_per_s, 10.0)},
                           {"look_ahead_ms", f.look_ahead_ms},
                           {"copies_percent", rounded(f.copies_percent, 10.0)},
                           {"encode_us", rounded(f.encode_us, 10.0)},
                           {"decode_us", rounded(f.decode_us, 10.0)},
                           {"lost_off_db", rounded(f.distance_lost_db, 100.0)},
                           {"recovered_percent", rounded(f.recovered_percent, 10.0)}});
  }
  return report;
}

}  // namespace dance
