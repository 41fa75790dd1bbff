// Writes 16 bit WAV files for tests: sounds whose every sample is known.
//
// Units/frames: samples -1 to 1; frames are interleaved.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; a sample beyond is clipped.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace dance {

inline std::string wav_bytes(std::span<const float> interleaved, int channels, int rate_hz) {
  std::string bytes;
  const auto put = [&](std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
  };
  const auto data_bytes = static_cast<std::uint32_t>(2 * interleaved.size());
  bytes += "RIFF";
  put(36 + data_bytes, 4);
  bytes += "WAVEfmt ";
  put(16, 4);
  put(1, 2);
  put(static_cast<std::uint32_t>(channels), 2);
  put(static_cast<std::uint32_t>(rate_hz), 4);
  put(static_cast<std::uint32_t>(rate_hz * channels * 2), 4);
  put(static_cast<std::uint32_t>(channels * 2), 2);
  put(16, 2);
  bytes += "data";
  put(data_bytes, 4);
  for (const float sample : interleaved)
    put(static_cast<std::uint16_t>(
            static_cast<std::int16_t>(std::lround(std::clamp(sample, -1.0f, 1.0f) * 32767.0f))),
        2);
  return bytes;
}

inline void write_wav(const std::string& path, std::span<const float> interleaved, int channels,
                      int rate_hz) {
  std::ofstream(path, std::ios::binary) << wav_bytes(interleaved, channels, rate_hz);
}

// A click of 5 ms at each of the times, on one channel.
inline std::vector<float> click_track(std::span<const double> times_s, double length_s,
                                      int rate_hz) {
  std::vector<float> samples(static_cast<std::size_t>(length_s * rate_hz), 0.0f);
  for (const double time_s : times_s) {
    const auto begin = static_cast<std::size_t>(std::lround(time_s * rate_hz));
    for (std::size_t i = 0; i < static_cast<std::size_t>(rate_hz / 200); ++i)
      if (begin + i < samples.size()) samples[begin + i] = i / 12 % 2 ? -0.8f : 0.8f;
  }
  return samples;
}

}  // namespace dance
