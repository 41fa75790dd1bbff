#include "tunnel/link/core/link_guests.h"

#include <algorithm>

namespace dance {
namespace {

// A gap this long (100 s at 60 Hz) is a producer with another count, not a loss.
constexpr std::int32_t kLongestGap = 6000;
constexpr Duration kStillDancing = Duration::ms(100);
constexpr Duration kSilentGuestStays = Duration::s(10);
constexpr std::size_t kMostDeparted = 64;

RemoteGuestStats stats_of(const RemoteGuest& remote) {
  RemoteGuestStats stats = remote.counts;
  const StreamGate::Counters& c = remote.heard.poses.counters();
  stats.guest = remote.id;
  stats.received = c.received;
  stats.lost = c.lost;
  stats.late = c.late;
  stats.duplicate = c.duplicate;
  return stats;
}

void add(const RemoteGuestStats& more, RemoteGuestStats& sum) {
  sum.bytes += more.bytes;
  sum.received += more.received;
  sum.lost += more.lost;
  sum.late += more.late;
  sum.duplicate += more.duplicate;
  sum.invalid += more.invalid;
  sum.reference_missing += more.reference_missing;
  sum.skeleton_missing += more.skeleton_missing;
  sum.intra_frames_asked += more.intra_frames_asked;
  sum.voices += more.voices;
  sum.voice_bytes += more.voice_bytes;
}

}  // namespace

bool StreamTag::advance(std::uint32_t sequence, MonoTime capture, std::uint64_t clock_id) {
  if (has_any_) {
    if (clock_id == clock_id_ && capture < capture_) return false;
    const std::int32_t ahead = sequence_ahead(sequence_, sequence);
    const bool is_same_count = ahead > 0 && ahead <= kLongestGap && clock_id == clock_id_;
    if (!is_same_count) {
      if (clock_id == clock_id_ && capture <= capture_) return false;
      ++stream_;
      ++restarts_;
    }
  }
  has_any_ = true;
  sequence_ = sequence;
  capture_ = capture;
  clock_id_ = clock_id;
  return true;
}

LocalGuest& LocalGuests::add(const GuestId& id, const QualityByRate& quality) {
  LocalGuest& guest = guests_.emplace_back();
  guest.id = id;
  guest.quality = quality;
  return guest;
}

bool LocalGuests::evict_silent(MonoTime now) {
  return std::erase_if(guests_, [&](const LocalGuest& guest) {
           return guest.came_with_pose &&
                  now - std::max(guest.last_pose, guest.last_voice) > kSilentGuestStays;
         }) > 0;
}

LocalGuest* LocalGuests::find(const GuestId& id) {
  const auto found = std::find_if(begin(), end(), [&](const auto& g) { return g.id == id; });
  return found == end() ? nullptr : &*found;
}

LocalGuest* LocalGuests::find_slot(std::uint8_t slot) {
  const auto found = std::find_if(begin(), end(), [&](const LocalGuest& guest) {
    return guest.has_slot && guest.slot.slot == slot;
  });
  return found == end() ? nullptr : &*found;
}

std::size_t LocalGuests::count_dancing(MonoTime now) const {
  return static_cast<std::size_t>(std::count_if(begin(), end(), [&](const LocalGuest& guest) {
    return guest.has_slot && now - guest.last_pose < kStillDancing;
  }));
}

// By the slot where we have one; by the name only while our own hello for it is under way, as
// another link may have a guest of the same name, which is then not ours.
bool LocalGuests::is_ours(const wire::RosterEntry& entry) const {
  return std::any_of(guests_.begin(), guests_.end(), [&](const LocalGuest& guest) {
    if (guest.has_slot)
      return guest.slot.slot == entry.slot.slot && guest.slot.generation == entry.slot.generation;
    return guest.id == entry.guest && !guest.refused_until.is_set();
  });
}

std::vector<LocalGuestStats> LocalGuests::stats() const {
  std::vector<LocalGuestStats> all;
  for (const LocalGuest& guest : guests_)
    all.push_back(
        {guest.id, guest.references.references(), guest.references.sent(), guest.references.acked(),
         guest.references.intra_asked(),
         guest.encoded_quality_m > 0.0 ? guest.encoded_quality_m : guest.quality.quality_m()});
  return all;
}

RemoteGuests::RemoteGuests() : guests_(wire::kMaxGuestsPerRoom) {
  departed_.reserve(kMostDeparted);
}

bool RemoteGuests::is_present(const GuestId& id) const {
  return std::any_of(begin(), end(), [&](const RemoteGuest& guest) {
    return guest.in_use && !guest.is_ours && guest.id == id;
  });
}

wire::InterestList RemoteGuests::interest_list(const Interest& interest,
                                               const Hearing& hearing) const {
  wire::InterestList list;
  list.default_divider = interest.others;
  list.voices.hears_others = hearing.others;
  for (const RemoteGuest& guest : guests_) {
    if (!guest.in_use || guest.is_ours) continue;
    if (hearing.hears(guest.id) != hearing.others)
      (void)list.voices.exceptions.try_push({slot_of(guest), guest.generation});
    if (!interest.names(guest.id)) continue;
    (void)list.entries.try_push(  // as many as there are slots
        {{slot_of(guest), guest.generation}, interest.divider_of(guest.id)});
  }
  return list;
}

void RemoteGuests::keep_counts(const RemoteGuest& remote) {
  if (!remote.in_use || remote.is_ours) return;
  RemoteGuestStats counts = stats_of(remote);
  counts.is_here = false;
  for (RemoteGuestStats& known : departed_)
    if (known.guest == counts.guest) return add(counts, known);
  if (departed_.size() == kMostDeparted) departed_.erase(departed_.begin());
  departed_.push_back(counts);
}

std::vector<RemoteGuestStats> RemoteGuests::stats() const {
  std::vector<RemoteGuestStats> all = departed_;
  for (const RemoteGuest& remote : guests_) {
    if (!remote.in_use || remote.is_ours) continue;
    const auto known = std::find_if(all.begin(), all.end(), [&](const RemoteGuestStats& stats) {
      return stats.guest == remote.id;
    });
    if (known == all.end()) {
      all.push_back(stats_of(remote));
    } else {
      add(stats_of(remote), *known);
      known->is_here = true;
    }
  }
  return all;
}

bool RosterAssembly::take(const wire::RosterPart& part) {
  if (version_ != 0 && sequence_ahead(version_, part.version) < 0) return false;
  if (part.version != version_) {
    version_ = part.version;
    parts_seen_ = 0;
  }
  parts_seen_ |= 1u << part.part;
  const std::uint32_t all = part.parts >= 32 ? ~0u : (1u << part.parts) - 1;
  if ((parts_seen_ & all) == all) whole_ = version_;
  return true;
}

}  // namespace dance
