#include "tunnel/server/core/key_quota.h"

#include "tunnel/server/core/server_state.h"

namespace dance {
namespace {

// One person: a house with two links and some room to restart them.
constexpr double kTrafficOfPerson = 2.0;
constexpr double kTrafficOfRoom = 32.0;
// Below these a server is too small to be shared in halves.
constexpr std::size_t kSmallServerSessions = 16, kSmallServerRooms = 4;
constexpr std::size_t kSmallRoom = 16;
constexpr std::size_t kRoomsOfCluster = wire::kMaxGuestsPerRoom / wire::kSlotsPerPage;

std::size_t half_of(std::size_t all, std::size_t small) {
  return std::max(all / 2, std::min(all, small));
}

}  // namespace

KeyQuota quota_of(const Access& access, const ServerLimits& limits) {
  KeyQuota quota;
  if (access.is_local) {
    quota.sessions = limits.sessions;
    quota.rooms = limits.rooms;
    quota.guests = limits.guests_per_room;
    quota.guests_of_cluster = wire::kMaxGuestsPerRoom;
    quota.listeners = limits.listeners_per_room;
    quota.files = limits.files;
    quota.file_bytes = limits.file_bytes;
  } else if (access.any_name) {
    quota.sessions = half_of(limits.sessions, kSmallServerSessions);
    quota.rooms = half_of(limits.rooms, kSmallServerRooms);
    quota.guests = half_of(limits.guests_per_room, kSmallRoom);
    quota.guests_of_cluster = quota.guests * kRoomsOfCluster;
    quota.listeners = half_of(limits.listeners_per_room, kSmallRoom);
    quota.files = limits.files / 2;
    quota.file_bytes = std::max(limits.file_bytes / 2, limits.file_bytes_per_session);
    quota.traffic = kTrafficOfRoom;
  } else {
    quota.sessions = limits.sessions_per_key;
    quota.rooms = limits.rooms_per_key;
    quota.guests = quota.guests_of_cluster = limits.guests_per_key;
    quota.listeners = limits.sessions_per_key;
    quota.files = limits.files_per_key;
    quota.file_bytes = limits.file_bytes_per_session;
    quota.traffic = kTrafficOfPerson;
  }
  return quota;
}

std::size_t KeyUses::join(const Access& access, const ServerLimits& limits) {
  auto found = std::ranges::find_if(
      uses_, [&](const Use& use) { return use.was_used && use.key == access.name; });
  if (found == uses_.end()) {
    found = std::ranges::min_element(
        uses_, {}, [](const Use& use) { return use.sessions > 0 ? UINT64_MAX : use.left; });
    DANCE_ASSERT(found != uses_.end() && found->sessions == 0);
    const double traffic = quota_of(access, limits).traffic;
    *found = {};
    found->key = access.name;
    found->was_used = true;
    found->datagrams =
        TokenBucket(traffic * limits.datagrams_per_second, traffic * limits.datagram_burst);
    found->bytes = TokenBucket(traffic * limits.bytes_per_second, traffic * limits.byte_burst);
  }
  ++found->sessions;
  return static_cast<std::size_t>(found - uses_.begin());
}

}  // namespace dance
