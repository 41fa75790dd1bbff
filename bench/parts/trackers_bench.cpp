// What does a whole body from few tracked points cost a frame, by rules and by the network? 500 us
// are allowed.
#include <benchmark/benchmark.h>

#include "bench/parts/salsa_poses.h"
#include "core/pose/kinematics.h"
#include "producers/trackers/tracker_body.h"

namespace dance {
namespace {

// Devices on an average body, as they are worn by the book.
std::vector<TrackerFrame> tracked_dance(std::uint32_t points) {
  const std::vector<Pose> poses = salsa_poses();
  const Skeleton body = average_skeleton();
  std::vector<TrackerFrame> frames;
  BodyFrames at;
  for (const Pose& pose : poses) {
    forward_kinematics(body, pose, at);
    TrackerFrame frame;
    frame.time = pose.capture_time;
    for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
      if ((points >> i & 1u) == 0) continue;
      const auto point = static_cast<TrackedPoint>(i);
      const std::size_t b = index_of(kPointBones[i]);
      const Place device =
          device_place(nominal_mount(point, standing_height_m(body)), {at.p_WB_m[b], at.R_WB[b]});
      frame.put(point, device.p_W_m, device.R_W);
    }
    frames.push_back(frame);
  }
  return frames;
}

void tracked_body(benchmark::State& state, TrackerGuide guide, std::uint32_t points) {
  std::vector<TrackerFrame> frames = tracked_dance(points);
  TrackerBody solver({.guide = guide});
  MonoTime time = frames[0].time;
  Pose pose;
  std::size_t i = 0;
  const auto step = [&] {
    TrackerFrame& frame = frames[i++ % frames.size()];
    time += Duration::us(11'111);
    frame.time = time;
    solver.solve(frame, pose);
    benchmark::DoNotOptimize(pose);
  };
  // Until the worn trackers are calibrated from the dance.
  for (int warm = 0; warm < 1000; ++warm) step();
  for (auto _ : state) step();
}
BENCHMARK_CAPTURE(tracked_body, rules3, TrackerGuide::kGeometric, 0b111u)
    ->Name("trackers: 3 points in, one pose out/baseline");
BENCHMARK_CAPTURE(tracked_body, learned3, TrackerGuide::kLearned, 0b111u)
    ->Name("trackers: 3 points in, one pose out/learned");
BENCHMARK_CAPTURE(tracked_body, rules10, TrackerGuide::kGeometric, 0b1111111111u)
    ->Name("trackers: 10 points in, one pose out/baseline");
BENCHMARK_CAPTURE(tracked_body, learned10, TrackerGuide::kLearned, 0b1111111111u)
    ->Name("trackers: 10 points in, one pose out/learned");

}  // namespace
}  // namespace dance
