#include "manager/manager.h"

#include <algorithm>
#include <string_view>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr Duration kSecond = Duration::s(1);
constexpr Duration kStepsPeriod = Duration::ms(250);
constexpr double kTouch_hz = 60.0;
constexpr std::string_view kProgram = "manager";  // STATS/manager

// Of two that were rounded to microseconds on the way.
bool is_same_moment(MonoTime a, MonoTime b) {
  constexpr Duration kRounding = Duration::us(10);
  return a - b < kRounding && b - a < kRounding;
}

}  // namespace

Manager::Manager(const std::vector<Route>& routes, SignalPort& port, Poller& poller)
    : port_(port), router_(routes, this_clock_id(), *this), begin_(mono_now()) {
  router_.on_learner(
      [this](std::shared_ptr<Learner> learner) { training_.add(std::move(learner)); });
  listen(Where::kCapture);
  listen(Where::kGuest);
  port_.subscribe<Beat>(Where::kLocal, [this](const Channel&, const Beat& beat, MonoTime) {
    // Of another machine's clock it says nothing about the music here.
    if (beat.clock_id != this_clock_id()) return;
    router_.hear(beat);
    steps_.hear(beat);
  });
  port_.subscribe<FlowSetting>(
      Where::kCapture, [this](const Channel& channel, const FlowSetting& setting, MonoTime now) {
        router_.set(channel.guest(), setting);
        tell_settings(now, channel.guest());
      });
  port_.subscribe<Steps>(Where::kCapture,
                         [this](const Channel& channel, const Steps& steps, MonoTime now) {
                           steps_.tell(channel.guest(), steps, now);
                         });
  start_timers(poller);
}

// Dancers of this house are watched even where the stage does not show them: they may tell the
// tempo.
void Manager::listen(Where where) {
  const bool is_routed = router_.wants(where);
  if (!is_routed && where != Where::kCapture) return;
  const auto whose = where == Where::kCapture ? RoomSteps::Whose::kOwn : RoomSteps::Whose::kRemote;
  port_.subscribe<Pose>(where, [this, where, whose, is_routed](const Channel& channel,
                                                               const Pose& pose, MonoTime now) {
    if (is_routed) router_.take(where, channel.guest(), pose, now);
    steps_.observe(whose, channel.guest(), pose, now);
  });
  port_.subscribe<TimedSkeleton>(
      where,
      [this, where, whose, is_routed](const Channel& channel, const TimedSkeleton& body, MonoTime) {
        if (is_routed) router_.take(where, channel.guest(), body);
        steps_.set_body(whose, channel.guest(), body.skeleton);
      });
  if (!is_routed) return;
  const auto take = [this, where](const Channel& channel, const auto& message, MonoTime) {
    router_.take(where, channel.guest(), message);
  };
  port_.subscribe<Hands>(where, take);
  port_.subscribe<Style>(where, take);
}

void Manager::start_timers(Poller& poller) {
  for (std::size_t route = 0; route < router_.route_count(); ++route) {
    const double hz = router_.rate_hz(route);
    pacers_.emplace_back(begin_, hz > 0.0 ? hz : 1.0);
    if (hz <= 0.0) continue;
    poller.add_timer(begin_, [this, route](MonoTime now) {
      router_.tick(route, now);
      lateness_.add(pacers_[route].advance(now));
      return pacers_[route].deadline();
    });
  }
  poller.add_timer(begin_, [this, pacer = Pacer(begin_, kTouch_hz)](MonoTime now) mutable {
    touch_.update(now, this_clock_id(), router_.holds(), *this);
    pacer.advance(now);
    return pacer.deadline();
  });
  poller.add_timer(begin_ + kStepsPeriod, [this](MonoTime now) {
    tell_steps(now);
    return now + kStepsPeriod;
  });
  poller.add_timer(begin_ + kSecond, [this](MonoTime now) {
    end_second(now);
    return now + kSecond;
  });
}

void Manager::on_other_manager(std::function<void()> tell) {
  port_.subscribe<Stats>(
      Where::kProgram,
      [this, tell = std::move(tell)](const Channel& channel, const Stats& stats, MonoTime now) {
        // What another machine or a log says is of another clock or another time.
        if (channel.program() != kProgram || stats.clock_id != this_clock_id()) return;
        if (now - stats.time > kSecond || stats.time - now > kSecond) return;
        const MonoTime begin = stats.time - stats.uptime;
        if (is_same_moment(begin, begin_)) return;
        for (const MonoTime told : others_begun_)
          if (is_same_moment(begin, told)) return;
        others_begun_[others_++ % others_begun_.size()] = begin;
        tell();
      });
}

void Manager::on_touch(const GuestId& guest, const Touch& touch) {
  port_.publish(Where::kStage, guest, touch);
}

void Manager::stage(const GuestId& guest, Pose& pose, MonoTime) {
  const MonoTime now = mono_now();
  pose.stamp(Hop::kStaged, now);
  port_.publish(Where::kStage, guest, pose);
  touch_.show(guest, pose, now,
              router_.holds().is_of_this_house(guest) ? DancerOf::kThisHouse : DancerOf::kAnother);
}

void Manager::stage(const GuestId& guest, const Hands& hands) {
  port_.publish(Where::kStage, guest, hands);
}

void Manager::stage(const GuestId& guest, const TimedSkeleton& skeleton) {
  touch_.set_body(guest, skeleton.skeleton);
  port_.publish(Where::kStage, guest, skeleton);
  const auto known = std::find_if(skeletons_.begin(), skeletons_.end(),
                                  [&](const StagedSkeleton& s) { return s.guest == guest; });
  if (known != skeletons_.end()) {
    *known = {guest, skeleton, mono_now()};
    return;
  }
  if (skeletons_.size() == kMaxGuests) skeletons_.erase(skeletons_.begin());  // who came first
  skeletons_.push_back({guest, skeleton, mono_now()});
}

void Manager::repeat_skeletons(MonoTime now) {
  for (StagedSkeleton& staged : skeletons_) {
    const RosterEntry* entry = router_.roster().find(staged.guest);
    if (!entry || !entry->alive || now - staged.published < kSecond) continue;
    port_.publish(Where::kStage, staged.guest, staged.skeleton);
    staged.published = now;
  }
}

// Of all guests where `only` is not set.
void Manager::tell_settings(MonoTime now, const GuestId& only) {
  router_.tell_settings(now, [&](const GuestId& guest, FlowSetting setting) {
    if (only.is_set() && guest != only) return;
    setting.time = now;
    setting.clock_id = this_clock_id();
    port_.publish(Where::kStage, guest, setting);
  });
}

void Manager::tell_steps(MonoTime now) {
  std::optional<Steps> steps = steps_.pass(now);
  if (!steps) return;
  steps->time = now;
  steps->clock_id = this_clock_id();
  port_.publish(Channel::of_house(Signal::kSteps), *steps);
}

Stats Manager::stats(MonoTime now) {
  Stats stats = router_.stats();
  stats.time = now;
  stats.clock_id = this_clock_id();
  stats.uptime = now - begin_;
  stats.dropped_invalid = static_cast<std::int64_t>(port_.counters().refused());
  stats.lateness_p99 = lateness_p99_;
  return stats;
}

void Manager::end_second(MonoTime now) {
  lateness_p99_ = lateness_.percentile(0.99);
  lateness_.clear();
  router_.roster().end_second(now, this_clock_id(),
                              [this](const RosterEntry& entry, const GuestStatus& status) {
                                port_.publish(Where::kStage, entry.guest, status);
                              });
  port_.publish(Channel::of_program(Signal::kStats, kProgram), stats(now));
  tell_settings(now, GuestId());
  router_.tell_playouts(now, [&](const GuestId& guest, Playout playout) {
    playout.time = now;
    playout.clock_id = this_clock_id();
    port_.publish(Where::kStage, guest, playout);
  });
  repeat_skeletons(now);
  router_.evict_gone(now);
}

}  // namespace dance
