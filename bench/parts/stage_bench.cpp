// What does the stage cost per pose and picture of one remote dancer, by the words of the route,
// against handing the newest pose through? And each of its frames, of which one in a hundred takes
// longer than most?
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <memory>

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

// One dancer and what comes of them; the partner stands opposite, hands near the dancer's, and
// dances the same.
class StagedDance {
 public:
  StagedDance(const std::vector<Pose>& poses, const std::vector<std::string>& through,
              bool has_partner)
      : poses_(poses), flow_(*Flow::make(through)), has_partner_(has_partner) {
    if (has_partner) {
      dancers_.take(here_, poses[0]);
      flow_.set_dancers(&dancers_);
    }
    beat_.tempo_bpm = SalsaStyle().tempo_bpm;
    beat_.confidence = 1.0f;
    beat_.playing = true;
    // With fifteen seconds behind it and a personal model, as after that for ever.
    const auto learner = flow_.learner();
    for (int warm = 0; warm < 900; ++warm) {
      dance_on();
      show();
      if (learner && warm % 15 == 0) learner->learn();
    }
  }

  // What comes next: the guest's pose, the partner's, the music.
  void dance_on() {
    pose_ = poses_[i_ % poses_.size()];
    const auto round = static_cast<std::int64_t>(i_ / poses_.size());
    ++i_;
    now_ = arrival_of(pose_, round);
    pose_.capture_time += Duration::s(60 * round);
    const double s = (pose_.capture_time - poses_[0].capture_time).as_seconds();
    pose_.music_beats = beat_.tempo_bpm / 60.0 * s;
    beat_.time = beat_.beat_time = now_;
    beat_.beat = pose_.music_beats;
    partner_ = pose_;
    const Eigen::Quaternionf about(0.0f, 0.0f, 1.0f, 0.0f);  // half a turn about the vertical
    partner_.R_PB[0] = about * pose_.R_PB[0];
    partner_.p_WH_m = about * pose_.p_WH_m + Eigen::Vector3f(0.0f, 0.0f, 0.7f);
  }

  // What a frame costs.
  void show() {
    if (i_ % 6 == 0) flow_.hear(beat_);
    if (has_partner_) dancers_.take(here_, partner_);
    flow_.observe(pose_, now_);
    flow_.sample(now_ + Duration::ms(8), shown_);
    benchmark::DoNotOptimize(shown_);
  }

 private:
  const std::vector<Pose>& poses_;
  PartnerTracks dancers_;
  Flow flow_;
  const GuestId here_ = *GuestId::parse("here");
  const bool has_partner_;
  Beat beat_;
  Pose pose_, partner_, shown_;
  MonoTime now_;
  std::size_t i_ = 0;
};

using Words = std::vector<std::string>;
const Words kUsualRoute{"predict", "bridge", "rhythm", "stylize"};

void stage(benchmark::State& state, const Words& through, bool has_partner = false) {
  const std::vector<Pose> poses = salsa_poses();
  StagedDance dance(poses, through, has_partner);
  for (auto _ : state) {
    dance.dance_on();
    dance.show();
  }
}
BENCHMARK_CAPTURE(stage, hold, Words{"hold 20ms"})
    ->Name("stage: one pose in, one picture out/hold 20ms");
BENCHMARK_CAPTURE(stage, hold_bridge, Words{"hold 20ms", "bridge"})
    ->Name("stage: one pose in, one picture out/hold 20ms, bridge");
BENCHMARK_CAPTURE(stage, predict, Words{"predict"})
    ->Name("stage: one pose in, one picture out/predict");
BENCHMARK_CAPTURE(stage, predict_bridge, Words{"predict", "bridge"})
    ->Name("stage: one pose in, one picture out/predict, bridge");
BENCHMARK_CAPTURE(stage, usual, kUsualRoute)
    ->Name("stage: one pose in, one picture out/predict, bridge, rhythm, stylize");
BENCHMARK_CAPTURE(stage, beside_partner, kUsualRoute, true)
    ->Name("stage: one pose in, one picture out/the same beside a partner");

// How much each frame of the same dance takes, by the thread's own clock; the least of kPasses, so
// that what else the machine does counts in none.
class FrameCosts {
 public:
  static constexpr std::size_t kFrames = 1800, kPasses = 9;

  template <class Frame>
  void time(std::size_t i, Frame frame) {
    const double before_us = thread_us();
    frame();
    costs_us_[i] = std::min(costs_us_[i], thread_us() - before_us);
  }
  // Half of the frames take no more, and 99 of 100.
  void report(benchmark::State& state) {
    std::sort(costs_us_.begin(), costs_us_.end());
    state.counters["p50_us"] = costs_us_[kFrames / 2];
    state.counters["p99_us"] = costs_us_[kFrames - 1 - kFrames / 100];
  }

 private:
  static double thread_us() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
  }
  std::vector<double> costs_us_ = std::vector<double>(kFrames, 1e9);
};

void frames_of(benchmark::State& state, const Words& through) {
  const std::vector<Pose> poses = salsa_poses();
  FrameCosts costs;
  while (state.KeepRunningBatch(FrameCosts::kFrames)) {
    state.PauseTiming();
    auto dance = std::make_unique<StagedDance>(poses, through, true);
    state.ResumeTiming();
    for (std::size_t i = 0; i < FrameCosts::kFrames; ++i) {
      dance->dance_on();
      costs.time(i, [&] { dance->show(); });
    }
  }
  costs.report(state);
}
constexpr auto kTimedFrames =
    static_cast<benchmark::IterationCount>(FrameCosts::kFrames * FrameCosts::kPasses);
// Both hand over the same poses: what is more is the route.
BENCHMARK_CAPTURE(frames_of, newest, Words{"hold 0ms"})
    ->Name("stage: each frame beside a partner/baseline")
    ->Iterations(kTimedFrames);
BENCHMARK_CAPTURE(frames_of, usual, kUsualRoute)
    ->Name("stage: each frame beside a partner/predict, bridge, rhythm, stylize")
    ->Iterations(kTimedFrames);

}  // namespace
}  // namespace dance
