// One thread of a crowd and the guests in it: they join at the crowd's rate, dance at their
// moments, leave and come back; each second what they did is handed on.
//
// Units/frames: MonoTime of this process.
// Ownership:    owns its guests and their poller, both in its thread; the shared setting must
//               outlive it.
// Threads:      start() to trouble() from the thread that owns it.
// Failure:      what keeps a guest from having a socket ends the thread, and is told by fault().
#pragma once

#include <array>
#include <atomic>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "apps/crowd/crowd_guest.h"
#include "core/base/random.h"

namespace dance {

// What all threads of a crowd share.
struct CrowdShared {
  const CrowdPlan& plan;
  const CrowdDances& dances;
  const std::vector<CrowdDoor>& doors;  // by server and room: door_of()
  CrowdBoard& board;
  MonoTime begin;

  const CrowdDoor& door_of(std::size_t guest) const {
    return doors[plan.server_of(guest) * plan.rooms + plan.room_of(guest)];
  }
};

class CrowdWorker {
 public:
  // Guests worker, worker + threads, worker + 2 threads …
  CrowdWorker(const CrowdShared& shared, std::size_t worker);
  ~CrowdWorker() { stop(); }
  CrowdWorker(const CrowdWorker&) = delete;
  CrowdWorker& operator=(const CrowdWorker&) = delete;

  void start();
  // From now on guests leave and come back, where the plan says so.
  void begin_churn() { is_churning_ = true; }
  // Its guests say goodbye.
  void stop();
  // Of the oldest second that was not taken yet, if it is over.
  std::optional<CrowdTally> take();
  // Set once the thread has given up.
  std::optional<std::string> fault() const;
  // Why a guest of those who are not in is not, if anything was said.
  std::string trouble() const;

 private:
  static constexpr std::size_t kMostSeconds = 16;  // not taken yet; then the oldest go

  Result<void> run();
  Result<void> make_guests();
  Result<MonoTime> move_guests(MonoTime now);
  MonoTime dance_due(MonoTime now);
  MonoTime end_second(MonoTime now);
  MonoTime frame_at(std::uint64_t step) const;

  CrowdShared shared_;
  std::size_t worker_;
  Random random_;
  std::atomic<bool> is_stopping_ = false;
  std::atomic<bool> is_churning_ = false;
  mutable std::mutex mutex_;  // of the next three
  std::deque<CrowdTally> seconds_;
  std::optional<std::string> fault_;
  std::string trouble_;

  // Of its thread.
  std::unique_ptr<Poller> poller_;
  CrowdTally tally_;
  std::vector<std::unique_ptr<CrowdGuest>> guests_;
  std::size_t joined_ = 0;  // of them, for the first time
  struct Return {
    MonoTime at;
    std::size_t guest;  // place in guests_
  };
  std::vector<Return> returns_;
  MonoTime next_leave_;
  std::uint64_t step_ = 0;  // frames of its guests, one after the other
  std::int64_t second_ = 0;
  std::vector<std::uint32_t> newest_, before_;  // sequences, at the last second and the one before
  std::thread thread_;
};

}  // namespace dance
