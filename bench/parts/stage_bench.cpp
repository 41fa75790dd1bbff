// What does the stage cost per pose and picture of one remote dancer, by the words of the route,
// against handing the newest pose through?
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
BENCHMARK(pass_through)->Name("stage: one pose in, one picture out/baseline");

void stage(benchmark::State& state, const std::vector<std::string>& through,
           bool has_partner = false) {
  const std::vector<Pose> poses = salsa_poses();
  Flow flow = *Flow::make(through);
  // The partner stands opposite, hands near the dancer's, and dances the same.
  const GuestId here = *GuestId::parse("here");
  PartnerTracks dancers;
  if (has_partner) {
    dancers.take(here, poses[0]);
    flow.set_dancers(&dancers);
  }
  Beat beat;
  beat.tempo_bpm = SalsaStyle().tempo_bpm;
  beat.confidence = 1.0f;
  beat.playing = true;
  Pose shown;
  std::size_t i = 0;
  for (auto _ : state) {
    Pose pose = poses[i % poses.size()];
    const auto round = static_cast<std::int64_t>(i / poses.size());
    ++i;
    const MonoTime now = arrival_of(pose, round);
    pose.capture_time += Duration::s(60 * round);
    const double s = (pose.capture_time - poses[0].capture_time).as_seconds();
    pose.music_beats = beat.tempo_bpm / 60.0 * s;
    if (i % 6 == 0) {
      beat.time = beat.beat_time = now;
      beat.beat = pose.music_beats;
      flow.hear(beat);
    }
    if (has_partner) {
      Pose partner = pose;
      const Eigen::Quaternionf about(0.0f, 0.0f, 1.0f, 0.0f);  // half a turn about the vertical
      partner.R_PB[0] = about * pose.R_PB[0];
      partner.p_WH_m = about * pose.p_WH_m + Eigen::Vector3f(0.0f, 0.0f, 0.7f);
      dancers.take(here, partner);
    }
    flow.observe(pose, now);
    flow.sample(now + Duration::ms(8), shown);
    benchmark::DoNotOptimize(shown);
  }
}
using Words = std::vector<std::string>;
BENCHMARK_CAPTURE(stage, hold, Words{"hold 20ms"})
    ->Name("stage: one pose in, one picture out/hold 20ms");
BENCHMARK_CAPTURE(stage, hold_bridge, Words{"hold 20ms", "bridge"})
    ->Name("stage: one pose in, one picture out/hold 20ms, bridge");
BENCHMARK_CAPTURE(stage, predict, Words{"predict"})
    ->Name("stage: one pose in, one picture out/predict");
BENCHMARK_CAPTURE(stage, predict_bridge, Words{"predict", "bridge"})
    ->Name("stage: one pose in, one picture out/predict, bridge");
BENCHMARK_CAPTURE(stage, usual, Words{"predict", "bridge", "rhythm", "stylize"})
    ->Name("stage: one pose in, one picture out/predict, bridge, rhythm, stylize");
BENCHMARK_CAPTURE(stage, beside_partner, Words{"predict", "bridge", "rhythm", "stylize"}, true)
    ->Name("stage: one pose in, one picture out/the same beside a partner");

}  // namespace
}  // namespace dance
