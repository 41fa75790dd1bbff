// The demo's own music: strokes where its list of beats says, and a round that joins its own begin.
#include "apps/demo/demo_song.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <vector>

#include "producers/music/beats_file.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

double energy(const std::vector<std::int16_t>& samples, double from_s, double to_s) {
  double sum = 0.0;
  const auto n = static_cast<std::ptrdiff_t>(samples.size());
  const auto end = static_cast<std::ptrdiff_t>(to_s * kDemoSong_hz);
  for (auto i = static_cast<std::ptrdiff_t>(from_s * kDemoSong_hz); i < end; ++i) {
    const double s = samples[static_cast<std::size_t>(((i % n) + n) % n)];
    sum += s * s;
  }
  return sum / (to_s - from_s);
}

// The samples, which follow the 44 bytes of a WAV's header.
std::vector<std::int16_t> samples_of(const std::string& wav) {
  std::ifstream file(wav, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  std::vector<std::int16_t> samples((bytes.size() - 44) / 2);
  std::memcpy(samples.data(), bytes.data() + 44, 2 * samples.size());
  return samples;
}

TEST(DemoSong, IsLoudFromTheBeatOnAndLessBefore) {
  const TestFolder folder("song");
  for (const double tempo_bpm : {120.0, 180.0, 220.0}) {
    ASSERT_TRUE(write_demo_song(folder.path("song.wav"), tempo_bpm));
    const auto samples = samples_of(folder.path("song.wav"));
    const double beat_s = 60.0 / tempo_bpm;
    EXPECT_NEAR(static_cast<double>(samples.size()) / kDemoSong_hz, kDemoSong_beats * beat_s, 2e-3);
    for (int beat = 0; beat < kDemoSong_beats; ++beat) {
      const double at = beat * beat_s;
      EXPECT_GT(energy(samples, at, at + 0.03), 1.2 * energy(samples, at - 0.03, at - 0.002))
          << tempo_bpm << " beat " << beat;
    }
  }
}

TEST(DemoSong, ItsListOfBeatsIsOneThatMusicIsPlayedBy) {
  const TestFolder folder("song");
  const std::string wav = folder.path("song.wav");
  ASSERT_TRUE(write_demo_song(wav, 190.0));
  const auto grid = read_beats_file(beats_path_beside(wav));
  ASSERT_TRUE(grid) << grid.error().what;
  EXPECT_EQ(grid->size(), static_cast<std::size_t>(kDemoSong_beats));
  EXPECT_EQ(grid->beats_per_bar(), 4);
  EXPECT_NEAR(grid->tempo_bpm(8.0), 190.0, 0.2);
  EXPECT_NEAR(grid->beat_at(0.0), 0.0, 1e-9);
  EXPECT_FALSE(write_demo_song("/no/such/folder/song.wav", 190.0));
}

}  // namespace
}  // namespace dance
