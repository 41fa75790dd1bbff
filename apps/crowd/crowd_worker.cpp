#include "apps/crowd/crowd_worker.h"

#include <pthread.h>

#include <algorithm>

#include "core/base/assert.h"
#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr Duration kLooksForStop = Duration::ms(20);
constexpr double kShortestAway_s = 1.0, kLongestAway_s = 3.0;
// Later than this a pose is skipped: the next one is due.
constexpr double kLatestFrames = 1.0;
// Then the sockets have their turn.
constexpr int kPosesPerTurn = 32;

}  // namespace

CrowdWorker::CrowdWorker(const CrowdShared& shared, std::size_t worker)
    : shared_(shared), worker_(worker), random_(worker + 1) {}

void CrowdWorker::start() {
  thread_ = std::thread([this] {
    pthread_setname_np(pthread_self(), ("crowd-" + std::to_string(worker_ + 1)).c_str());
    const auto ran = run();
    guests_.clear();
    if (ran) return;
    const std::scoped_lock lock(mutex_);
    fault_ = ran.error().what;
  });
}

void CrowdWorker::stop() {
  is_stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

std::optional<CrowdTally> CrowdWorker::take() {
  const std::scoped_lock lock(mutex_);
  if (seconds_.empty()) return std::nullopt;
  CrowdTally oldest = seconds_.front();
  seconds_.pop_front();
  return oldest;
}

std::optional<std::string> CrowdWorker::fault() const {
  const std::scoped_lock lock(mutex_);
  return fault_;
}

std::string CrowdWorker::trouble() const {
  const std::scoped_lock lock(mutex_);
  return trouble_;
}

Result<void> CrowdWorker::make_guests() {
  const CrowdPlan& plan = shared_.plan;
  for (std::size_t number = worker_; number < plan.guests; number += plan.threads) {
    const auto place = CrowdDances::place_of(plan.place_of(number), plan.guests_per_room());
    guests_.push_back(std::make_unique<CrowdGuest>(
        number, CrowdGuest::Setting{plan, shared_.board, shared_.door_of(number)},
        shared_.dances.make(number), place, tally_));
  }
  newest_.assign(plan.guests, 0);
  before_.assign(plan.guests, 0);
  return {};
}

Result<void> CrowdWorker::run() {
  DANCE_TRY(poller_, Poller::create());
  if (auto made = make_guests(); !made) return made;
  Result<void> moved;
  poller_->add_timer(shared_.begin, [this](MonoTime now) { return dance_due(now); });
  poller_->add_timer(shared_.begin + Duration::s(1),
                     [this](MonoTime now) { return end_second(now); });
  // After the poses, which must not wait for a newcomer.
  poller_->add_timer(shared_.begin, [this, &moved](MonoTime now) {
    auto next = move_guests(now);
    if (next) return *next;
    moved = tl::make_unexpected(next.error());
    poller_->stop();
    return MonoTime();
  });
  while (!is_stopping_ && !poller_->is_stopped()) poller_->run_once(kLooksForStop);
  return moved;
}

// Who joins, leaves and comes back; returns when the next one does.
Result<MonoTime> CrowdWorker::move_guests(MonoTime now) {
  const CrowdPlan& plan = shared_.plan;
  const auto joins_at = [&](std::size_t nth) {
    const std::size_t number = worker_ + nth * plan.threads;
    return shared_.begin + Duration::seconds(static_cast<double>(number) / plan.join_rate);
  };
  for (; joined_ < guests_.size() && joins_at(joined_) <= now; ++joined_)
    if (auto joined = guests_[joined_]->join(*poller_); !joined)
      return tl::make_unexpected(joined.error());
  if (joined_ < guests_.size()) return joins_at(joined_);
  if (plan.churn <= 0.0 || guests_.empty()) return MonoTime();
  if (!is_churning_) return now + kLooksForStop;
  for (std::size_t i = 0; i < returns_.size();) {
    if (returns_[i].at > now) {
      ++i;
      continue;
    }
    if (auto joined = guests_[returns_[i].guest]->join(*poller_); !joined)
      return tl::make_unexpected(joined.error());
    returns_[i] = returns_.back();
    returns_.pop_back();
  }
  const Duration each = Duration::seconds(static_cast<double>(plan.threads) / plan.churn);
  if (!next_leave_.is_set()) next_leave_ = now + each;
  for (; next_leave_ <= now; next_leave_ += each) {
    const auto who = static_cast<std::size_t>(random_.below(guests_.size()));
    if (!guests_[who]->is_present()) continue;
    guests_[who]->leave();
    ++tally_.left;
    returns_.push_back(
        {now + Duration::seconds(random_.uniform(kShortestAway_s, kLongestAway_s)), who});
  }
  MonoTime next = next_leave_;
  for (const Return& each_return : returns_) next = std::min(next, each_return.at);
  return next;
}

// Guest after guest of this thread, frame after frame.
MonoTime CrowdWorker::frame_at(std::uint64_t step) const {
  const CrowdPlan& plan = shared_.plan;
  const std::uint64_t frame = step / guests_.size();
  const std::size_t number = worker_ + (step % guests_.size()) * plan.threads;
  const double phase =
      plan.is_together ? 0.0 : static_cast<double>(number) / static_cast<double>(plan.guests);
  return shared_.begin + Duration::seconds((static_cast<double>(frame) + phase) / plan.hz);
}

MonoTime CrowdWorker::dance_due(MonoTime) {
  if (guests_.empty()) return MonoTime();
  const Duration latest = Duration::seconds(kLatestFrames / shared_.plan.hz);
  for (int danced = 0; danced < kPosesPerTurn; ++step_) {
    const MonoTime at = frame_at(step_), now = mono_now();
    if (at > now) break;
    CrowdGuest& guest = *guests_[step_ % guests_.size()];
    if (now - at <= latest) {
      guest.dance(now);
      ++danced;
    } else if (guest.has_joined()) {
      ++tally_.skipped;
    }
  }
  return frame_at(step_);
}

MonoTime CrowdWorker::end_second(MonoTime now) {
  std::string trouble;
  for (const auto& guest : guests_) {
    guest->settle(before_, now);
    if (guest->has_joined() && !guest->is_present() && trouble.empty()) trouble = guest->trouble();
  }
  before_ = newest_;
  for (std::size_t i = 0; i < newest_.size(); ++i) newest_[i] = shared_.board.newest(i);
  ++second_;
  {
    const std::scoped_lock lock(mutex_);
    if (seconds_.size() == kMostSeconds) seconds_.pop_front();
    seconds_.push_back(tally_);
    trouble_ = std::move(trouble);
  }
  tally_ = CrowdTally();
  return shared_.begin + Duration::s(second_ + 1);
}

}  // namespace dance
