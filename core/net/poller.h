// Poller: the one loop of a process, over the bus, the sockets and timers with absolute deadlines.
// Sleeps in epoll when nothing is due; SIGINT, SIGTERM and SIGHUP end it gracefully when asked to.
//
// Units/frames: deadlines are MonoTime of this process's clock (core/net/mono_clock.h); each turn
//               reads the clock once and passes it on.
// Ownership:    owns its epoll, timer and signal descriptors; watched descriptors stay their
//               owner's, who must unwatch them before closing. Allocates in watch() and
//               add_timer(), not while running.
// Threads:      one; stop() may be called from handlers.
// Failure:      create() names what the kernel refused.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

class Poller {
 public:
  using OnReadable = std::function<void(MonoTime now)>;
  // Does the work that is due and returns its next deadline; MonoTime() = never again.
  using OnDue = std::function<MonoTime(MonoTime now)>;
  using TimerId = std::size_t;

  static Result<std::unique_ptr<Poller>> create();
  ~Poller();
  Poller(const Poller&) = delete;
  Poller& operator=(const Poller&) = delete;

  void watch(int fd, OnReadable on_readable);
  void unwatch(int fd);
  TimerId add_timer(MonoTime first, OnDue on_due);
  // Moves a timer's next deadline; MonoTime() stops it.
  void set_deadline(TimerId timer, MonoTime deadline);
  // Its number may be another timer's from the next turn on.
  void remove_timer(TimerId timer);
  // Runs after the handlers of every turn that did something.
  void at_turn_end(OnReadable work) { turn_end_ = std::move(work); }

  // SIGINT, SIGTERM and SIGHUP, unless nohup ignores it, end run() instead of the process. Call
  // before threads are started, as these inherit the blocked signals; threads that libraries
  // started before main forward them.
  Result<void> stop_on_signals();
  // Waits until a descriptor is readable, a signal stops the loop, or `longest` is over. Runs no
  // handlers: for programs that are still starting. Returns whether the descriptor is readable.
  bool wait_for(int fd, Duration longest);
  void stop() { stopped_ = true; }
  bool is_stopped() const { return stopped_; }

  // Turns until stop().
  void run();
  // One turn: waits for an event, a deadline or `longest`, whichever is first.
  void run_once(Duration longest);

 private:
  struct Watch {
    int fd;
    OnReadable on_readable;
  };
  struct Timer {
    MonoTime deadline;
    OnDue on_due;
  };

  Poller() = default;
  MonoTime earliest_deadline() const;
  void arm(MonoTime deadline);
  void fire_due_timers(MonoTime now);

  int epoll_fd_ = -1;
  int timer_fd_ = -1;
  int signal_fd_ = -1;
  MonoTime armed_;
  bool stopped_ = false;
  std::vector<std::unique_ptr<Watch>> watches_;
  std::deque<Timer> timers_;             // grows while handlers run: references must hold
  std::vector<TimerId> removed_timers_;  // in this turn: one may be running
  std::vector<TimerId> free_timers_;
  OnReadable turn_end_;
};

}  // namespace dance
