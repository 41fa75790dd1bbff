#include "viewer/feed/stage_feed.h"

#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/net/mono_clock.h"

namespace dance {

namespace {

bool is_shown(const FeedOptions& options, Where where) {
  switch (options.shown) {
    case Shown::kBest:
      return where == Where::kStage || (where == Where::kCapture && !options.stage_only);
    case Shown::kCapture:
      return where == Where::kCapture;
    case Shown::kGuest:
      return where == Where::kGuest;
    case Shown::kStage:
      return where == Where::kStage;
  }
  return false;
}

}  // namespace

StageFeed::StageFeed(const FeedOptions& options)
    : board_(this_clock_id(), options.stage_only || options.shown == Shown::kStage) {}

Result<std::unique_ptr<StageFeed>> StageFeed::create(const FeedOptions& options) {
  std::unique_ptr<StageFeed> feed(new StageFeed(options));
  DANCE_TRY(feed->poller_, Poller::create());
  if (auto stops = feed->poller_->stop_on_signals(); !stops) return fail(stops.error().what);
  DANCE_TRY(feed->bus_, Bus::open(options.bus_url));
  feed->wake_fd_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (feed->wake_fd_ < 0) return fail(std::string("no eventfd: ") + std::strerror(errno));
  feed->subscribe(options);
  feed->thread_ = std::thread([raw = feed.get()] { raw->run(); });
  return feed;
}

StageFeed::~StageFeed() {
  if (thread_.joinable()) {
    asked_to_end_.store(true, std::memory_order_release);
    wake();
    thread_.join();
  }
  if (wake_fd_ >= 0) close(wake_fd_);
}

void StageFeed::subscribe(const FeedOptions& options) {
  for (const Where where : {Where::kCapture, Where::kGuest, Where::kStage}) {
    if (!is_shown(options, where)) continue;
    // Every pose is taken, so that rates and losses are right; the board's slots keep the newest.
    bus_->subscribe<Pose>(where, [this](const Channel& channel, const Pose& pose, MonoTime now) {
      board_.on_pose(channel.where(), channel.guest(), pose, now);
    });
    bus_->subscribe<Hands>(
        where,
        [this](const Channel& channel, const Hands& hands, MonoTime now) {
          board_.on_hands(channel.where(), channel.guest(), hands, now);
        },
        Delivery::kNewest);
    bus_->subscribe<TimedSkeleton>(
        where, [this](const Channel& channel, const TimedSkeleton& skeleton, MonoTime now) {
          board_.on_skeleton(channel.guest(), skeleton.skeleton, now);
        });
  }
  bus_->subscribe<Beat>(
      Where::kLocal, [this](const Channel&, const Beat& beat, MonoTime) { board_.on_beat(beat); });
  bus_->subscribe<GuestStatus>(
      Where::kStage, [this](const Channel& channel, const GuestStatus& status, MonoTime now) {
        board_.on_status(channel.guest(), status, now);
      });
}

void StageFeed::run() {
  pthread_setname_np(pthread_self(), "view-bus");
  poller_->watch(bus_->fd(), [this](MonoTime now) { bus_->drain(now); });
  poller_->watch(wake_fd_, [this](MonoTime) { on_wake(); });
  poller_->run();
  over_.store(true, std::memory_order_release);
}

void StageFeed::wake() {
  const std::uint64_t one = 1;
  // Fails only when it is already awake 2^64 times over.
  [[maybe_unused]] const auto written = write(wake_fd_, &one, sizeof(one));
}

void StageFeed::on_wake() {
  std::uint64_t times = 0;
  [[maybe_unused]] const auto taken = read(wake_fd_, &times, sizeof(times));
  while (const auto shown = shown_.pop())
    bus_->publish(Channel::of(Signal::kStageTime, Where::kView, shown->guest), shown->time);
  if (asked_to_end_.load(std::memory_order_acquire)) poller_->stop();
}

}  // namespace dance
