// What does a remote dancer's play-out cost per pose shown, against handing the newest pose
// through?
#include <benchmark/benchmark.h>

#include "bench/parts/salsa_poses.h"
#include "transformers/flow.h"

namespace dance {
namespace {

// Each pose comes 30 to 40 ms after it was danced; the stage asks once for each, half a frame
// later.
MonoTime arrival_of(const Pose& pose, std::int64_t round) {
  return pose.capture_time + Duration::us(30'000 + (pose.sequence * 7919 % 10'000)) +
         Duration::s(60 * round);
}

void pass_through(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  Pose newest, shown;
  std::size_t i = 0;
  for (auto _ : state) {
    newest = poses[i++ % poses.size()];
    benchmark::DoNotOptimize(newest);
    shown = newest;
    benchmark::DoNotOptimize(shown);
  }
}
BENCHMARK(pass_through)->Name("hold: one pose in, one out/baseline");

void hold(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  Flow flow = *Flow::make({"hold 20ms"});
  Pose shown;
  std::size_t i = 0;
  for (auto _ : state) {
    Pose pose = poses[i % poses.size()];
    const auto round = static_cast<std::int64_t>(i / poses.size());
    ++i;
    pose.capture_time = pose.capture_time + Duration::s(60 * round);
    const MonoTime now = arrival_of(poses[pose.sequence], round);
    flow.observe(pose, now);
    flow.sample(now + Duration::ms(8), shown);
    benchmark::DoNotOptimize(shown);
  }
}
BENCHMARK(hold)->Name("hold: one pose in, one out/hold 20ms");

}  // namespace
}  // namespace dance
