// TrainingThread: the thread in which predictors train on their dancers, beside the pose path and
// at idle priority.
//
// Ownership:    shares the learners; releases one when its transformer is gone.
// Threads:      starts one. add() may be called from another and waits for nothing longer than the
//               copy of a pointer.
// Failure:      where no thread can be had nothing is learned, and failure() says why.
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "transformers/predict/learner.h"

namespace dance {

class TrainingThread {
 public:
  TrainingThread();
  ~TrainingThread();
  TrainingThread(const TrainingThread&) = delete;
  TrainingThread& operator=(const TrainingThread&) = delete;

  void add(std::shared_ptr<Learner> learner);
  const std::string& failure() const { return failure_; }

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable wakes_;
  std::vector<std::shared_ptr<Learner>> learners_;  // guarded
  std::atomic<bool> ends_{false};
  std::string failure_;
  std::thread thread_;
};

}  // namespace dance
