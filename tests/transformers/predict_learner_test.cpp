// The personal model, learned in a thread of its own while poses come.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/transformers/predicted_dances.h"
#include "transformers/predict/dance_predictor.h"

namespace dance {
namespace {

TEST(PredictLearner, LearnsBesideThePosePath) {
  auto predictor = std::make_unique<DancePredictor>(built_in_predict_model());
  std::shared_ptr<Learner> learner = predictor->personal();
  std::atomic<bool> ends{false};
  std::atomic<int> turns{0};
  std::thread thread([&] {
    while (!ends.load()) {
      learner->learn();
      ++turns;
      std::this_thread::yield();
    }
  });
  const auto dance = shaken(salsa(600), 0.004);
  Pose out;
  bool has_weights = false;
  MonoTime time = dance[0].capture_time;
  // As long as it takes: a slow machine is no slow learner.
  for (int round = 0; round < 40 && !has_weights; ++round)
    for (Pose pose : dance) {
      time += Duration::ns(kDanceStep_ns);
      pose.capture_time = time;
      predictor->observe(pose);
      predictor->predict(time + Duration::ms(200), out);
      ASSERT_TRUE(is_valid(out));
      bool is_new = false;
      has_weights = has_weights || predictor->personal()->weights(is_new) != nullptr;
    }
  EXPECT_TRUE(has_weights);
  // The dancer goes; what is being learned of them may still be.
  predictor.reset();
  for (const int before = turns; turns < before + 3;) std::this_thread::yield();
  ends = true;
  thread.join();
}

}  // namespace
}  // namespace dance
