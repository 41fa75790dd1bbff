#include "research/beats/music_samples.h"

#include <cmath>

#include "producers/music/decode/audio_file.h"
#include "producers/music/tracker/beat_tracker.h"

namespace dance {
namespace {

constexpr double kLongestSong_s = 3600.0;

}  // namespace

float gain_of_db(double db) { return static_cast<float>(std::pow(10.0, db / 20.0)); }

Result<MusicSamples> read_music_samples(const std::string& path) {
  DANCE_TRY(AudioFile file, AudioFile::open(path));
  MusicSamples music{.rate_hz = file.rate_hz(), .samples = {}};
  if (music.rate_hz < BeatTracker::kLeastRate_hz || music.rate_hz > BeatTracker::kMostRate_hz)
    return fail(path + ": has " + std::to_string(static_cast<int>(music.rate_hz)) +
                " samples a second; the tracker wants 8000 to 200000");
  std::vector<float> block(65536);
  while (static_cast<double>(music.samples.size()) < kLongestSong_s * music.rate_hz) {
    DANCE_TRY(const std::size_t n, file.read(block));
    if (n == 0) break;
    music.samples.insert(music.samples.end(), block.begin(),
                         block.begin() + static_cast<std::ptrdiff_t>(n));
  }
  return music;
}

std::vector<float> turned(const std::vector<float>& samples, double speed, double from) {
  std::vector<float> out;
  for (double at = from; at + 1.0 < static_cast<double>(samples.size()); at += speed) {
    const auto i = static_cast<std::size_t>(at);
    const auto part = static_cast<float>(at - static_cast<double>(i));
    out.push_back(samples[i] + part * (samples[i + 1] - samples[i]));
  }
  return out;
}

}  // namespace dance
