#include "producers/music/band/band_file.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "core/base/assert.h"
#include "core/base/byte_writer.h"
#include "core/program/whole_file.h"

namespace dance {
namespace {

// RIFF, PCM. Not by libsndfile, as a demo makes its song in builds without it too.
std::vector<std::uint8_t> wav_of(const std::vector<std::int16_t>& samples, int channels) {
  constexpr std::uint32_t kHeader_bytes = 44;
  const auto data_bytes = static_cast<std::uint32_t>(2 * samples.size());
  const auto frame_bytes = static_cast<std::uint16_t>(2 * channels);
  std::vector<std::uint8_t> bytes(kHeader_bytes + data_bytes);
  ByteWriter out(bytes);
  const auto put_text = [&out](std::string_view text) {
    for (const char c : text) out.u8(static_cast<std::uint8_t>(c));
  };
  put_text("RIFF");
  out.u32(kHeader_bytes - 8 + data_bytes);
  put_text("WAVEfmt ");
  out.u32(16);
  out.u16(1);
  out.u16(static_cast<std::uint16_t>(channels));
  out.u32(kBandRate_hz);
  out.u32(std::uint32_t{frame_bytes} * kBandRate_hz);
  out.u16(frame_bytes);
  out.u16(16);
  put_text("data");
  out.u32(data_bytes);
  for (const std::int16_t sample : samples) out.i16(sample);
  return bytes;
}

std::int16_t sample_of(float value) {
  return static_cast<std::int16_t>(std::lround(32000.0f * value));
}

}  // namespace

Result<void> write_band_file(const std::string& wav, BandAudio& audio, const BandExcerpt& excerpt) {
  const BandScore& score = audio.score();
  const int end_bar = excerpt.first_bar + excerpt.bars;
  DANCE_ASSERT(excerpt.channels == 1 || excerpt.channels == 2, excerpt.channels);
  const std::int64_t begin = score.bar_begin_frame(excerpt.first_bar);
  std::vector<float> stereo(static_cast<std::size_t>(2 * (score.bar_begin_frame(end_bar) - begin)));
  audio.read_stereo(begin, stereo);
  std::vector<std::int16_t> samples;
  samples.reserve(stereo.size());
  for (std::size_t i = 0; i < stereo.size(); i += 2) {
    if (excerpt.channels == 1) {
      samples.push_back(sample_of(0.5f * (stereo[i] + stereo[i + 1])));
    } else {
      samples.push_back(sample_of(stereo[i]));
      samples.push_back(sample_of(stereo[i + 1]));
    }
  }
  if (auto written = write_whole_file(wav, wav_of(samples, excerpt.channels)); !written)
    return written;
  const int bar_beats = beats_per_bar(score.song().style);
  const double first_s = score.grid().time_of(excerpt.first_bar * bar_beats);
  std::string beats;
  for (int beat = excerpt.first_bar * bar_beats; beat < end_bar * bar_beats; ++beat)
    beats +=
        fmt::format("{:.6f}\t{}\n", score.grid().time_of(beat) - first_s, beat % bar_beats + 1);
  return write_whole_file(wav.substr(0, wav.rfind('.')) + ".beats", beats);
}

}  // namespace dance
