// What do styles, and finding the dance's own beat, cost per pose, against a copy of the pose?
#include <benchmark/benchmark.h>

#include "bench/parts/salsa_poses.h"
#include "transformers/style/stylize.h"
#include "transformers/tempo/period.h"

namespace dance {
namespace {

Pose next_pose(const std::vector<Pose>& poses, std::size_t i, bool with_music) {
  Pose pose = poses[i % poses.size()];
  pose.capture_time += Duration::s(60 * static_cast<std::int64_t>(i / poses.size()));
  if (!with_music) pose.music_beats = kNoMusic;
  return pose;
}

void copied(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  std::size_t i = 0;
  for (auto _ : state) {
    Pose pose = next_pose(poses, i++, true);
    benchmark::DoNotOptimize(pose);
  }
}
BENCHMARK(copied)->Name("style: one pose in, one out/baseline");

void stylized(benchmark::State& state, float gain, bool with_music) {
  const std::vector<Pose> poses = salsa_poses();
  Style style;
  style.gain.fill(gain);
  Stylize filter(style);
  std::size_t i = 0;
  for (auto _ : state) {
    Pose pose = next_pose(poses, i++, with_music);
    filter.observe(pose, pose.capture_time);
    filter.apply(pose.capture_time, pose);
    benchmark::DoNotOptimize(pose);
  }
}
BENCHMARK_CAPTURE(stylized, as_danced, 1.0f, true)
    ->Name("style: one pose in, one out/stylize, all gains 1");
BENCHMARK_CAPTURE(stylized, larger, 1.5f, true)
    ->Name("style: one pose in, one out/stylize, all gains 1.5");
BENCHMARK_CAPTURE(stylized, without_music, 1.5f, false)
    ->Name("style: one pose in, one out/stylize, no music");

void period(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  Period period;
  std::size_t i = 0;
  for (auto _ : state) {
    const Pose pose = next_pose(poses, i++, false);
    period.observe(pose, pose.capture_time);
  }
  benchmark::DoNotOptimize(period.coherence());
}
BENCHMARK(period)->Name("style: one pose in, one out/period alone");

}  // namespace
}  // namespace dance
