#include "apps/demo/demo_monitor.h"

#include "core/base/raw_twin.h"
#include "core/base/sequence.h"
#include "core/net/mono_clock.h"
#include "manager/roster.h"

namespace dance {
namespace {

void add_ages(DancerAccount& account, const Pose& pose, std::size_t from, std::size_t to) {
  for (std::size_t hop = from; hop < to; ++hop)
    if (pose.hops[hop].is_set()) account.age_at_hop[hop].add(pose.hops[hop] - pose.capture_time);
}

}  // namespace

bool SequenceSet::insert(std::uint32_t sequence) {
  const auto bit = [&](std::uint32_t s) -> std::pair<std::uint64_t&, std::uint64_t> {
    return {bits_[(s % kSize) / 64], std::uint64_t{1} << (s % 64)};
  };
  const std::int32_t ahead = any_ ? sequence_ahead(newest_, sequence) : 1;
  if (!any_ || ahead > static_cast<std::int32_t>(kSize / 2) ||
      ahead < -static_cast<std::int32_t>(kSize / 2)) {
    std::fill(bits_.begin(), bits_.end(), 0);  // the first, or so far off that it is a new count
    newest_ = sequence;
    any_ = true;
  } else if (ahead > 0) {
    for (std::uint32_t s = newest_ + 1; s != sequence + 1; ++s) {
      auto [word, mask] = bit(s);
      word &= ~mask;
    }
    newest_ = sequence;
  }
  auto [word, mask] = bit(sequence);
  if (word & mask) return false;
  word |= mask;
  return true;
}

DemoMonitor::DemoMonitor(SignalPort& bus_a, SignalPort& bus_b) {
  accounts_.reserve(kMaxGuests);
  listen(bus_a, 0);
  listen(bus_b, 1);
}

DancerAccount* DemoMonitor::account_of(const GuestId& guest) {
  for (DancerAccount& account : accounts_)
    if (account.guest == guest) return &account;
  if (accounts_.size() == kMaxGuests) return nullptr;
  accounts_.emplace_back();
  accounts_.back().guest = guest;
  return &accounts_.back();
}

void DemoMonitor::listen(SignalPort& bus, int house) {
  bus.subscribe<Pose>(Where::kCapture,
                      [this, house](const Channel& channel, const Pose& pose, MonoTime) {
                        DancerAccount* account = account_of(channel.guest());
                        if (!account) return;
                        account->house = house;
                        account->sent += account->sent_set.insert(pose.sequence) ? 1 : 0;
                      });
  bus.subscribe<Pose>(Where::kGuest,
                      [this, house](const Channel& channel, const Pose& pose, MonoTime) {
                        DancerAccount* account = account_of(channel.guest());
                        if (!account) return;
                        account->delivered += account->delivered_set.insert(pose.sequence) ? 1 : 0;
                        on_arrived(*account, house, pose);
                      });
  bus.subscribe<Pose>(Where::kStage,
                      [this, house](const Channel& channel, const Pose& pose, MonoTime) {
                        if (twin_of_whom(channel.guest())) return;
                        if (DancerAccount* account = account_of(channel.guest()))
                          on_staged(*account, house, pose);
                      });
  bus.subscribe<Beat>(Where::kLocal, [this, house](const Channel&, const Beat& beat, MonoTime) {
    has_music_[static_cast<std::size_t>(house)] = beat.playing;
  });
  bus.subscribe<Stats>(Where::kProgram,
                       [this, house](const Channel& channel, const Stats& stats, MonoTime) {
                         if (channel.program() != "link") return;
                         connected_[static_cast<std::size_t>(house)] = stats.sessions > 0;
                       });
}

void DemoMonitor::on_staged(DancerAccount& account, int house, const Pose& pose) {
  if (!timing_ || pose.clock_id != this_clock_id()) return;
  if (house == account.house) {
    ++account.staged_at_home;
    account.age_at_home.add(pose.stamped(Hop::kStaged) - pose.capture_time);
    return;
  }
  ++account.staged;
  add_ages(account, pose, kFirstOfStage, kHopCount);
}

// The way here, before a transformer makes other poses of it: `predict` moves their stamps along
// with them.
void DemoMonitor::on_arrived(DancerAccount& account, int house, const Pose& pose) {
  if (!timing_ || house == account.house || pose.clock_id != this_clock_id()) return;
  add_ages(account, pose, 0, kFirstOfStage);
}

}  // namespace dance
