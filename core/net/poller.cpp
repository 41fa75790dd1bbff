#include "core/net/poller.h"

#include <poll.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/syscall.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "core/base/assert.h"
#include "core/base/deadline.h"
#include "core/base/text/errno_text.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr int kEventsPerTurn = 16;

// Kernel id of the thread in which the poller of this process receives signals; that of an ended
// thread matches none.
std::atomic<pid_t> signal_thread{0};

std::string reason(const char* call) { return std::string(call) + ": " + errno_text(errno); }

void add_to_epoll(int epoll_fd, int fd) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.fd = fd;
  const int added = epoll_ctl(epoll_fd, EPOLL_CTL_ADD, fd, &event);
  DANCE_ASSERT(added == 0, fd, errno);
}

}  // namespace

Result<std::unique_ptr<Poller>> Poller::create() {
  std::unique_ptr<Poller> poller(new Poller);
  poller->epoll_fd_ = epoll_create1(EPOLL_CLOEXEC);
  if (poller->epoll_fd_ < 0) return fail(reason("epoll_create1"));
  poller->timer_fd_ = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  if (poller->timer_fd_ < 0) return fail(reason("timerfd_create"));
  add_to_epoll(poller->epoll_fd_, poller->timer_fd_);
  prctl(PR_SET_TIMERSLACK, 1UL);  // the default lets every deadline slip by 50 µs
  return poller;
}

Poller::~Poller() {
  for (const int fd : {signal_fd_, timer_fd_, epoll_fd_})
    if (fd >= 0) close(fd);
}

void Poller::watch(int fd, OnReadable on_readable) {
  add_to_epoll(epoll_fd_, fd);
  watches_.push_back(std::make_unique<Watch>(Watch{fd, std::move(on_readable)}));
}

void Poller::unwatch(int fd) {
  epoll_ctl(epoll_fd_, EPOLL_CTL_DEL, fd, nullptr);
  // Only emptied here, as this may be called from inside its own handler; swept at the next watch.
  for (auto& watch : watches_)
    if (watch->fd == fd) watch->fd = -1;
}

Poller::TimerId Poller::add_timer(MonoTime first, OnDue on_due) {
  if (free_timers_.empty()) {
    timers_.push_back({first, std::move(on_due)});
    return timers_.size() - 1;
  }
  const TimerId timer = free_timers_.back();
  free_timers_.pop_back();
  timers_[timer] = {first, std::move(on_due)};
  return timer;
}

void Poller::remove_timer(TimerId timer) {
  DANCE_ASSERT(timer < timers_.size(), timer, timers_.size());
  timers_[timer].deadline = MonoTime();
  removed_timers_.push_back(timer);
}

void Poller::set_deadline(TimerId timer, MonoTime deadline) {
  DANCE_ASSERT(timer < timers_.size(), timer, timers_.size());
  timers_[timer].deadline = deadline;
}

Result<void> Poller::stop_on_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  // A program that nohup started outlives its terminal. A signal that is blocked and
  // ignored would still be read below.
  struct sigaction on_hangup {};
  if (sigaction(SIGHUP, nullptr, &on_hangup) != 0) return fail(reason("sigaction"));
  if (on_hangup.sa_handler != SIG_IGN) sigaddset(&signals, SIGHUP);
  if (pthread_sigmask(SIG_BLOCK, &signals, nullptr) != 0) return fail(reason("pthread_sigmask"));
  // Libraries may have started threads before main (OpenBLAS does), in which no signal is blocked:
  // these forward signals.
  signal_thread = static_cast<pid_t>(syscall(SYS_gettid));
  struct sigaction handing_on {};
  handing_on.sa_handler = [](int signal) {
    const int before = errno;
    syscall(SYS_tgkill, getpid(), signal_thread.load(), signal);
    errno = before;
  };
  handing_on.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction inherited {};
    if (sigaction(signal, nullptr, &inherited) != 0) return fail(reason("sigaction"));
    // A program started in the background of a script may inherit an ignored SIGINT.
    if (inherited.sa_handler == SIG_IGN) continue;
    if (sigaction(signal, &handing_on, nullptr) != 0) return fail(reason("sigaction"));
  }
  signal_fd_ = signalfd(-1, &signals, SFD_NONBLOCK | SFD_CLOEXEC);
  if (signal_fd_ < 0) return fail(reason("signalfd"));
  add_to_epoll(epoll_fd_, signal_fd_);
  return {};
}

MonoTime Poller::earliest_deadline() const {
  MonoTime earliest;
  for (const Timer& timer : timers_) earliest = earlier(earliest, timer.deadline);
  return earliest;
}

// A timer that is armed for an earlier moment stays so: deadlines move on with each message, and
// one wake-up in vain costs less than to tell the kernel each time.
void Poller::arm(MonoTime deadline) {
  if (!deadline.is_set() || (armed_.is_set() && armed_ <= deadline)) return;
  itimerspec spec{};
  spec.it_value.tv_sec = deadline.since_zero_ns() / 1'000'000'000;
  spec.it_value.tv_nsec = deadline.since_zero_ns() % 1'000'000'000;
  timerfd_settime(timer_fd_, TFD_TIMER_ABSTIME, &spec, nullptr);
  armed_ = deadline;
}

void Poller::fire_due_timers(MonoTime now) {
  // By index: a handler may add timers.
  for (std::size_t i = 0; i < timers_.size(); ++i) {
    if (!timers_[i].deadline.is_set() || timers_[i].deadline > now) continue;
    timers_[i].deadline = MonoTime();
    const OnDue& on_due = timers_[i].on_due;
    const MonoTime next = on_due(now);
    const bool is_removed =
        std::find(removed_timers_.begin(), removed_timers_.end(), i) != removed_timers_.end();
    if (!timers_[i].deadline.is_set() && !is_removed) timers_[i].deadline = next;
  }
}

void Poller::run_once(Duration longest) {
  std::erase_if(watches_, [](const auto& watch) { return watch->fd < 0; });
  free_timers_.insert(free_timers_.end(), removed_timers_.begin(), removed_timers_.end());
  removed_timers_.clear();
  arm(earliest_deadline());
  std::array<epoll_event, kEventsPerTurn> events{};
  const auto timeout_ms = static_cast<int>(std::min<std::int64_t>(longest.count_ms(), 60'000));
  const int count = epoll_wait(epoll_fd_, events.data(), kEventsPerTurn, timeout_ms);
  const MonoTime now = mono_now();
  for (int i = 0; i < count; ++i) {
    const int fd = events[static_cast<std::size_t>(i)].data.fd;
    if (fd == timer_fd_) {
      std::uint64_t expirations = 0;
      [[maybe_unused]] const auto n = read(timer_fd_, &expirations, sizeof expirations);
      armed_ = MonoTime();
    } else if (fd == signal_fd_) {
      signalfd_siginfo info{};
      [[maybe_unused]] const auto n = read(signal_fd_, &info, sizeof info);
      stopped_ = true;
    } else {
      for (std::size_t w = 0; w < watches_.size(); ++w)
        if (watches_[w]->fd == fd) {
          watches_[w]->on_readable(now);
          break;
        }
    }
  }
  fire_due_timers(now);
  if (count > 0 && turn_end_) turn_end_(now);
}

bool Poller::wait_for(int fd, Duration longest) {
  const MonoTime end = mono_now() + longest;
  while (!stopped_) {
    const Duration left = end - mono_now();
    if (left <= Duration()) return false;
    std::array<pollfd, 2> watched{pollfd{fd, POLLIN, 0}, pollfd{signal_fd_, POLLIN, 0}};
    const auto timeout_ms = static_cast<int>(std::min<std::int64_t>(left.count_ms() + 1, 60'000));
    if (poll(watched.data(), watched.size(), timeout_ms) <= 0) continue;
    if (watched[1].revents != 0) {
      signalfd_siginfo info{};
      [[maybe_unused]] const auto n = read(signal_fd_, &info, sizeof info);
      stopped_ = true;
    } else if (watched[0].revents != 0) {
      return true;
    }
  }
  return false;
}

void Poller::run() {
  while (!stopped_) run_once(Duration::s(60));
}

}  // namespace dance
