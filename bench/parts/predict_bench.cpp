// What does forward prediction cost a frame and dancer, against handing the newest pose through? 50
// us are allowed, 100 with a personal model.
#include <benchmark/benchmark.h>

#include "bench/parts/salsa_poses.h"
#include "transformers/predict/dance_predictor.h"

namespace dance {
namespace {

void newest_pose(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  Pose shown;
  std::size_t i = 0;
  for (auto _ : state) {
    shown = poses[i++ % poses.size()];
    benchmark::DoNotOptimize(shown);
  }
}
BENCHMARK(newest_pose)->Name("predict: one pose in, one out/baseline");

void predict_frames(benchmark::State& state, bool has_personal) {
  const std::vector<Pose> poses = salsa_poses();
  DancePredictor predictor(built_in_predict_model());
  Pose shown;
  MonoTime time = poses[0].capture_time;
  std::size_t i = 0;
  const auto step = [&] {
    Pose pose = poses[i++ % poses.size()];
    time += Duration::ns(16'666'667);
    pose.capture_time = time;
    predictor.observe(pose);
    predictor.predict(time + Duration::ms(100), shown);
    benchmark::DoNotOptimize(shown);
  };
  // With twelve seconds behind it, as after that for ever.
  for (int warm = 0; warm < 900; ++warm) {
    step();
    if (has_personal && warm % 15 == 0) predictor.personal()->learn();
  }
  for (auto _ : state) step();
}
BENCHMARK_CAPTURE(predict_frames, alone, false)->Name("predict: one pose in, one out/predict");
BENCHMARK_CAPTURE(predict_frames, personal, true)
    ->Name("predict: one pose in, one out/predict with a personal model");

void ask_again(benchmark::State& state) {
  const std::vector<Pose> poses = salsa_poses();
  DancePredictor predictor(built_in_predict_model());
  for (std::size_t i = 0; i < 900; ++i) predictor.observe(poses[i]);
  Pose shown;
  for (auto _ : state) {
    predictor.predict(poses[899].capture_time + Duration::ms(130), shown);
    benchmark::DoNotOptimize(shown);
  }
}
BENCHMARK(ask_again)->Name("predict: one pose in, one out/another moment");

}  // namespace
}  // namespace dance
