// Under which names servers of a cluster tell each other what: subjects of messages, and keys of
// values that last. docs/wire-format.md lists them.
//
// Units/frames: none.
// Ownership:    plain values; nothing here allocates.
// Threads:      none inside.
// Failure:      parse functions give nullopt for anything that is never made here.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "core/base/fixed_string.h"
#include "tunnel/server/core/cluster_port.h"

namespace dance::cluster {

// Subjects: all servers hear beats; each hears what is for it, and the poses that its
// links want.
using Text = FixedString<96>;
Text beat_subject();
Text server_subject(ServerId server);
Text pose_subject(const wire::RoomName& room, const GuestId& guest);
// One of its own: where a server is behind, no voice makes a pose the older one.
Text voice_subject(const wire::RoomName& room, const GuestId& guest);
// All that a server hears of a guest whom its links want.
std::array<Text, 2> subjects_of(const wire::RoomName& room, const GuestId& guest);
struct PoseSubject {
  wire::RoomName room;
  GuestId guest;
};
std::optional<PoseSubject> parse_pose_subject(std::string_view subject);
std::optional<PoseSubject> parse_voice_subject(std::string_view subject);

// Keys, all of which begin with the room.
enum class KeyKind : std::uint8_t { kPresence, kGuest, kGuestState, kRoomState };
struct Key {
  KeyKind kind = KeyKind::kPresence;
  wire::RoomName room;
  ServerId server = 0;    // kPresence
  GuestId guest;          // kGuest, kGuestState
  std::size_t place = 0;  // of a state: wire::place_of()
};
Text text_of(const Key& key);
// Of all keys of a room.
Text keys_of(const wire::RoomName& room);
std::optional<Key> parse_key(std::string_view text);

}  // namespace dance::cluster
