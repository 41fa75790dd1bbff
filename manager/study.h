// Study: the thread in which transformers learn of their dancers, beside the pose path and below
// it: the machine gives it time only when nobody else wants any.
//
// Ownership:    shares the learners; lets go of one when its transformer has gone.
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

class Study {
 public:
  Study();
  ~Study();
  Study(const Study&) = delete;
  Study& operator=(const Study&) = delete;

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
