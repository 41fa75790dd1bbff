// An entry of the server's audit log: a join, a refusal or a removal.
//
// Ownership: views are valid during the call that passes the event.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "tunnel/wire/wire.h"

namespace dance {

enum class AuditKind : std::uint8_t { kJoined, kRefused, kRemoved };
constexpr std::array<std::string_view, 3> kAuditKindNames{"joined", "refused", "removed"};

struct AuditEvent {
  AuditKind kind = AuditKind::kJoined;
  // Name of the key. Of a refused stranger it is whatever bytes the stranger sent.
  std::string_view key{};
  wire::RoomName room{};
  FixedList<GuestId, wire::kMaxGuestsPerLink> guests{};
  // Why a link was refused or removed; empty for a join.
  std::string_view cause{};
  // Name of the host's key that removed the guest; not set where no host of this server did.
  GuestId by{};
};

// Names of wire::Refusal in the log, by number.
constexpr std::array<std::string_view, 16> kRefusalNames{"",
                                                         "version",
                                                         "bad_name",
                                                         "name_taken",
                                                         "room_full",
                                                         "server_full",
                                                         "codec",
                                                         "room_not_allowed",
                                                         "name_not_allowed",
                                                         "only_listens",
                                                         "listeners_full",
                                                         "removed_before",
                                                         "key_sessions",
                                                         "key_rooms",
                                                         "key_expired",
                                                         "key_guests"};
static_assert(kRefusalNames.size() == static_cast<std::size_t>(wire::Refusal::kKeyGuests) + 1);

}  // namespace dance
