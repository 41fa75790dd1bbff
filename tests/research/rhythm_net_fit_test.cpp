#include "research/beats/rhythm_net_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace dance {
namespace {

constexpr std::size_t kSteps = 100;
constexpr int kBeat_steps = 8;

// Strokes on beats and on halves, all alike; tones on each second beat alone tell which are which,
// so that the others are known by memory only.
RhythmSong song_of(Random& random, float tempo) {
  RhythmSong song;
  song.features.assign(kSteps * RhythmFeatures::kCount, 0.0f);
  const auto begin = static_cast<int>(random.below(kBeat_steps));
  for (std::size_t k = 0; k < kSteps; ++k) {
    const int at = static_cast<int>(k) - begin;
    const bool is_beat = at >= 0 && at % kBeat_steps == 0;
    const bool is_half = at >= 0 && at % kBeat_steps == kBeat_steps / 2;
    float* row = &song.features[k * RhythmFeatures::kCount];
    for (int i = 0; i < 12; ++i) {
      if (is_beat || is_half) row[i] = 1.0f;
      if (is_beat && at % (2 * kBeat_steps) == 0) row[20 + i] = 1.0f;
      row[40 + i] = tempo > 20.0f ? 1.0f : 0.0f;
    }
    song.classes.push_back(is_beat ? 0 : is_half ? 1 : 2);
    song.weights.push_back(at < 0 ? 0.0f : is_beat || is_half ? 4.0f : 0.5f);
    song.tempi.push_back(tempo);
  }
  return song;
}

TEST(RhythmNetFit, LearnsWhatOnlyMemoryTells) {
  Random random(11);
  std::vector<RhythmSong> songs;
  for (int i = 0; i < 30; ++i) songs.push_back(song_of(random, i % 2 == 0 ? 10.0f : 30.0f));
  std::vector<WeightedRhythm> taught;
  for (std::size_t i = 0; i + 4 < songs.size(); ++i) taught.push_back({&songs[i]});
  const RhythmNet net = fit_rhythm_net(taught, {.rounds = 80, .seed = 3});
  int right = 0, moments = 0, tempi = 0;
  for (std::size_t i = songs.size() - 4; i < songs.size(); ++i) {
    RhythmState state;
    for (std::size_t k = 0; k < kSteps; ++k) {
      const StrokeMeaning meaning =
          net.step(std::span<const float, RhythmFeatures::kCount>(
                       &songs[i].features[k * RhythmFeatures::kCount], RhythmFeatures::kCount),
                   state);
      if (k < 20 || songs[i].classes[k] == 2) continue;
      right += (meaning.beat > meaning.half) == (songs[i].classes[k] == 0);
      Eigen::Index likeliest = 0;
      state.tempi.maxCoeff(&likeliest);
      tempi += std::abs(static_cast<float>(likeliest) - songs[i].tempi[k]) < 1.5f;
      ++moments;
    }
  }
  ASSERT_GT(moments, 60);
  EXPECT_GT(right, moments * 7 / 10) << "by chance it were half";
  EXPECT_GT(tempi, moments * 9 / 10);
}

TEST(RhythmNetFit, ALostBeatInAListIsNoTempoAndHarmsNothing) {
  Random random(13);
  const RhythmSong song = song_of(random, 10.0f);
  RhythmSong lost = song_of(random, 10.0f);
  for (std::size_t k = 40; k < 60; ++k) lost.tempi[k] = k % 2 == 0 ? -30.0f : 400.0f;
  const RhythmNet net = fit_rhythm_net({{&song}, {&lost}}, {.rounds = 3, .seed = 1});
  EXPECT_TRUE(net.out.allFinite());
  EXPECT_TRUE(net.layers[0].in.allFinite());
}

TEST(RhythmNetFit, TheSameSeedGivesTheSameNetworkAndAnotherAnother) {
  Random random(12);
  const RhythmSong song = song_of(random, 10.0f);
  const auto weights = [&](std::uint64_t seed) {
    return fit_rhythm_net({{&song}}, {.rounds = 2, .seed = seed}).layers[1].again;
  };
  EXPECT_EQ(weights(1), weights(1));
  EXPECT_NE(weights(1), weights(2));
}

}  // namespace
}  // namespace dance
