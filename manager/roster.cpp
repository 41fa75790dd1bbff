#include "manager/roster.h"

#include "core/base/sequence.h"

namespace dance {
namespace {

// A jump of the sequence beyond this is a producer that began again, not a loss.
constexpr std::int32_t kLargestGap = 600;
constexpr Duration kOldestLiveAge = Duration::s(10);

}  // namespace

RosterEntry* Roster::find(const GuestId& guest) {
  for (std::size_t i = 0; i < size_; ++i)
    if (entries_[i].guest == guest) return &entries_[i];
  return nullptr;
}

RosterEntry* Roster::find_or_add(const GuestId& guest) {
  if (RosterEntry* entry = find(guest)) return entry;
  RosterEntry* free_entry = nullptr;
  for (std::size_t i = 0; i < size_ && !free_entry; ++i)
    if (!entries_[i].alive) free_entry = &entries_[i];
  if (size_ < entries_.size()) free_entry = &entries_[size_++];
  if (!free_entry) return nullptr;
  *free_entry = RosterEntry();
  free_entry->guest = guest;
  return free_entry;
}

RosterEntry* Roster::heard(const GuestId& guest, bool remote, const Pose& pose, MonoTime now) {
  RosterEntry* entry = find_or_add(guest);
  if (!entry) return nullptr;
  if (entry->received > 0) {
    const std::int32_t ahead = sequence_ahead(entry->last_sequence, pose.sequence);
    if (ahead > 1 && ahead <= kLargestGap) entry->lost += ahead - 1;
  }
  entry->last_sequence = pose.sequence;
  entry->remote = remote;
  entry->alive = true;
  entry->last_heard = now;
  ++entry->received;
  ++entry->received_this_second;
  return entry;
}

void Roster::staged(RosterEntry& entry, const Pose& pose, MonoTime now,
                    std::uint64_t our_clock_id) {
  ++entry.staged_this_second;
  const Duration age = now - pose.capture_time;
  if (pose.clock_id == our_clock_id && age < kOldestLiveAge) entry.age.add(age);
}

GuestStatus Roster::status_of(const RosterEntry& entry, MonoTime now, std::uint64_t our_clock_id) {
  GuestStatus status;
  status.time = now;
  status.clock_id = our_clock_id;
  status.alive = entry.alive;
  status.remote = entry.remote;
  status.arrival_hz = static_cast<float>(entry.received_this_second);
  status.stage_hz = static_cast<float>(entry.staged_this_second);
  status.age_p50_ms = static_cast<float>(entry.age.percentile(0.5).as_ms());
  status.age_p99_ms = static_cast<float>(entry.age.percentile(0.99).as_ms());
  status.received = entry.received;
  status.lost = entry.lost;
  return status;
}

std::int64_t Roster::alive_count() const {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < size_; ++i) count += entries_[i].alive ? 1 : 0;
  return count;
}

}  // namespace dance
