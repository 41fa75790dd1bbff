#include "manager/training_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>

namespace dance {
namespace {

struct Counting : Learner {
  explicit Counting(std::atomic<int>& left) : gone(left) {}
  ~Counting() override { ++gone; }
  void learn() override { ++lessons; }
  std::atomic<int>& gone;
  std::atomic<int> lessons{0};
};

template <class Condition>
bool comes_true(Condition condition) {
  for (int i = 0; i < 6000 && !condition(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

TEST(TrainingThread, TeachesEachLearnerAgainAndAgain) {
  std::atomic<int> gone{0};
  const auto a = std::make_shared<Counting>(gone), b = std::make_shared<Counting>(gone);
  TrainingThread training;
  EXPECT_EQ(training.failure(), "");
  training.add(a);
  EXPECT_TRUE(comes_true([&] { return a->lessons > 1; }));
  training.add(b);
  EXPECT_TRUE(comes_true([&] { return b->lessons > 1; }));
}

TEST(TrainingThread, ReleasesALearnerWhoseTransformerHasGone) {
  std::atomic<int> gone{0};
  TrainingThread training;
  training.add(std::make_shared<Counting>(gone));
  EXPECT_TRUE(comes_true([&] { return gone == 1; }));
}

TEST(TrainingThread, EndsWithoutWaitingForATrainingRun) {
  std::atomic<int> gone{0};
  for (int i = 0; i < 20; ++i) {
    TrainingThread training;
    training.add(std::make_shared<Counting>(gone));
  }
  EXPECT_EQ(gone, 20);
}

}  // namespace
}  // namespace dance
