// A song of drums with the list of its beats, in a folder of a test.
//
// Threads: one.
// Failure: none; a test that cannot write fails where it reads.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "tests/apps/run_program.h"
#include "tests/producers/music/drum_music.h"

namespace dance {

inline void write_wav(const std::string& path, const std::vector<float>& samples,
                      std::uint32_t rate_hz) {
  static_assert(std::endian::native == std::endian::little);
  std::string out = "RIFF";
  const auto put = [&](auto value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto bytes = static_cast<std::uint32_t>(2 * samples.size());
  put(36 + bytes);
  out += "WAVEfmt ";
  put(std::uint32_t{16});
  put(std::uint16_t{1});
  put(std::uint16_t{1});
  put(rate_hz);
  put(2 * rate_hz);
  put(std::uint16_t{2});
  put(std::uint16_t{16});
  out += "data";
  put(bytes);
  for (const float x : samples)
    put(static_cast<std::int16_t>(std::lround(32767.0f * std::clamp(x, -1.0f, 1.0f))));
  std::ofstream(path, std::ios::binary) << out;
}

struct SongOnDisk {
  SongOnDisk() : folder("music-eval") { add("song", 14.0, 148.0); }
  void add(const std::string& name, double seconds, double bpm) const {
    const auto beats = DrumMusic::steady(seconds, bpm);
    write_wav(folder.path(name + ".wav"), DrumMusic(22050.0).play(beats, seconds), 22050);
    std::ofstream file(folder.path(name + ".beats"));
    for (std::size_t i = 0; i < beats.size(); ++i) file << beats[i] << "\t" << i % 4 + 1 << "\n";
  }
  TestFolder folder;
};

}  // namespace dance
