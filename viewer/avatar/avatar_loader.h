// AvatarLoader: the thread in which avatars are made and read, beside the drawing and at low
// priority, as one takes a tenth of a second and more.
//
// Ownership: shares its jobs; drops one that nobody else holds any more. Its end stops the one that
//            runs and forgets those that wait.
// Threads:   starts one. start() and done() may be called from the drawing thread and wait for
//            nothing longer than the copy of a pointer; wait() waits.
// Failure:   of a job: its error(). Without a thread every job fails, and says so.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "core/base/result.h"
#include "formats/avatar/avatar_reader.h"

namespace dance {

class AvatarJob {
 public:
  // nullopt: what it is made of is not here yet.
  using Made = std::optional<Result<AvatarModel>>;
  // Asks `stop` often where it takes long: true when nobody waits for the model any more.
  using Make = std::function<Made(const AvatarStop& stop)>;

  explicit AvatarJob(Make make) : make_(std::move(make)) {}
  bool is_done() const { return is_done_.load(std::memory_order_acquire); }
  // Once it is done: the model, or null and the error.
  const std::shared_ptr<const AvatarModel>& model() const { return model_; }
  std::shared_ptr<const AvatarModel> model_if_done() const { return is_done() ? model_ : nullptr; }
  const std::string& error() const { return error_; }
  bool is_missing() const { return is_missing_; }
  std::size_t size_bytes() const { return size_bytes_; }
  // Done, without a model.
  static std::shared_ptr<AvatarJob> empty();

 private:
  friend class AvatarLoader;
  void run(const AvatarStop& stop);
  void give_up(std::string why);

  Make make_;
  std::shared_ptr<const AvatarModel> model_;
  std::string error_;
  std::size_t size_bytes_ = 0;
  bool is_missing_ = false;
  std::atomic<bool> is_done_{false};
};

class AvatarLoader {
 public:
  AvatarLoader();
  ~AvatarLoader();
  AvatarLoader(const AvatarLoader&) = delete;
  AvatarLoader& operator=(const AvatarLoader&) = delete;

  std::shared_ptr<AvatarJob> start(AvatarJob::Make make);
  // Until everything that was started is done.
  void wait();

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable wakes_;
  std::condition_variable is_idle_;
  std::deque<std::shared_ptr<AvatarJob>> queue_;  // guarded
  bool is_busy_ = false;                          // guarded
  std::atomic<bool> ends_{false};                 // set guarded; what is being made looks at it
  std::thread thread_;
};

// The memory that a model takes.
std::size_t size_bytes(const AvatarModel& model);

}  // namespace dance
