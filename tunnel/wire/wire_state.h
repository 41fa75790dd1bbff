// The datagrams of states, built and parsed: states and their acknowledgements,
// several to a datagram. docs/wire-format.md says them byte by byte.
//
// Units/frames: little-endian.
// Ownership:    payloads are views of the caller's bytes.
// Threads:      none inside.
// Failure:      as in tunnel/wire/wire.h; nothing here allocates.
#pragma once

#include "tunnel/policy/channel_rule.h"
#include "tunnel/wire/wire.h"

namespace dance::wire {

enum class StateKind : std::uint8_t {
  kSkeleton = 1,
  // Of the room: who may set it sets it for all.
  kMusic = 2,
  kScene = 3,
  // Of a guest.
  kAvatar = 4,
  kStyle = 5,
  kPlacement = 6,
  kChannel = 7,     // a further channel: its class and name, then its last message
  kAvatarFile = 8,  // of a guest; only to who has said file terms (tunnel/wire/wire_files.h)
  kSong = 9,        // of the room
  kChat = 10,       // a guest's newest lines and signs (tunnel/wire/wire_chat.h)
};
constexpr bool is_of_room(StateKind kind) {
  return kind == StateKind::kMusic || kind == StateKind::kScene || kind == StateKind::kSong;
}

// Which state of a guest, or of the room.
struct StateName {
  StateKind kind = StateKind::kSkeleton;
  std::uint8_t index = 0;  // of a channel, 0 to 7
  bool operator==(const StateName&) const = default;
};
// States have their places in tables: of a guest the skeleton, avatar, style, placement, avatar
// file, chat and then the channels; of the room music, scene and song.
constexpr std::size_t kFirstChannelPlace = 6;
constexpr std::size_t kGuestStates = kFirstChannelPlace + kMaxChannelsPerGuest;
constexpr std::size_t kRoomStates = 3;
std::size_t place_of(const StateName& name);
StateName guest_state_at(std::size_t place);
StateName room_state_at(std::size_t place);

// A channel's payload: class 1, name 1 + n, message.
constexpr std::size_t kMaxStatePayload = 1 + 1 + kMaxForeignName + kMaxChannelStateBytes;

struct State {
  StateName name;
  Slot slot;                  // of a guest's state; the link may leave the generation 0
  GuestId setter;             // of a room's state: who sets it, or has set it
  std::uint32_t version = 0;  // grows with each change; 0 = nothing yet
  Bytes payload;
};

enum class StateVerdict : std::uint8_t {
  kAccepted = 0,    // the receiver has this version
  kOverruled = 1,   // somebody else has set the room's state; `version` is that of theirs
  kNotAllowed = 2,  // the sender may not set it
};
struct StateAck {
  StateName name;
  Slot slot;
  std::uint32_t version = 0;
  StateVerdict verdict = StateVerdict::kAccepted;
};

// At most this many bytes: what add_state() takes for it.
std::size_t size_of(const State& state);
constexpr std::size_t kMaxStateAckBytes = 9;

// The opening; states, or acknowledgements, follow.
void begin_states(Type type, ByteWriter& out);
void add_state(const State& state, ByteWriter& out);
void add_state_ack(const StateAck& ack, ByteWriter& out);
// One; call until the reader is_exhausted().
std::optional<State> parse_state(ByteReader& in);
std::optional<StateAck> parse_state_ack(ByteReader& in);

// The payload of a channel's state. A channel of class newest has no message here: its name alone
// is told.
struct ChannelPayload {
  ChannelClass kind = ChannelClass::kState;
  ForeignName name;
  Bytes message;
};
std::size_t build(const ChannelPayload& channel, std::span<std::uint8_t> out);
std::optional<ChannelPayload> parse_channel(Bytes payload);

}  // namespace dance::wire
