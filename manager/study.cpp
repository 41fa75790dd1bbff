#include "manager/study.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <system_error>

namespace dance {
namespace {

constexpr std::chrono::milliseconds kBetweenLessons(250);
constexpr int kNice = 10;

}  // namespace

Study::Study() {
  try {
    thread_ = std::thread([this] { run(); });
  } catch (const std::system_error& error) {
    failure_ = std::string("no thread to learn in: ") + error.what();
  }
}

Study::~Study() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  wakes_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Study::add(std::shared_ptr<Learner> learner) {
  const std::scoped_lock lock(mutex_);
  learners_.push_back(std::move(learner));
}

void Study::run() {
  // Of this thread only, on Linux; where it is not allowed, the poses still come first by their sleep being short.
  setpriority(PRIO_PROCESS, 0, kNice);
  std::vector<std::shared_ptr<Learner>> lesson;
  std::unique_lock lock(mutex_);
  while (!ends_) {
    // The last one to hold a learner is this thread: its transformer has gone.
    std::erase_if(learners_, [](const auto& learner) { return learner.use_count() == 1; });
    lesson = learners_;
    lock.unlock();
    for (const auto& learner : lesson) learner->learn();
    lesson.clear();
    lock.lock();
    wakes_.wait_for(lock, kBetweenLessons, [this] { return ends_; });
  }
}

}  // namespace dance
