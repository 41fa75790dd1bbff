#include "manager/training_thread.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <system_error>

namespace dance {
namespace {

constexpr std::chrono::milliseconds kBetweenLessons(250);
constexpr int kNice = 10;

}  // namespace

TrainingThread::TrainingThread() {
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error&) {
    failure_ = "no thread to learn in; end other programs, or raise the limit of `ulimit -u`";
  }
}

TrainingThread::~TrainingThread() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  wakes_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void TrainingThread::add(std::shared_ptr<Learner> learner) {
  const std::scoped_lock lock(mutex_);
  learners_.push_back(std::move(learner));
}

void TrainingThread::run() {
  // Of this thread only, on Linux; where it is not allowed, the poses still come first by their
  // sleep being short.
  setpriority(PRIO_PROCESS, 0, kNice);
  std::vector<std::shared_ptr<Learner>> lesson, gone;
  std::unique_lock lock(mutex_);
  while (!ends_) {
    // The last one to hold a learner is this thread: its transformer has gone.
    const auto first_gone =
        std::stable_partition(learners_.begin(), learners_.end(),
                              [](const auto& learner) { return learner.use_count() > 1; });
    // They are large: freed when nobody waits for the lock.
    gone.assign(std::make_move_iterator(first_gone), std::make_move_iterator(learners_.end()));
    learners_.erase(first_gone, learners_.end());
    lesson = learners_;
    lock.unlock();
    gone.clear();
    for (const auto& learner : lesson)
      if (!ends_) learner->learn();
    lesson.clear();
    lock.lock();
    wakes_.wait_for(lock, kBetweenLessons, [this] { return ends_.load(); });
  }
}

}  // namespace dance
