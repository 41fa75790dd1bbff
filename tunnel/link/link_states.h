// What a link keeps of the states that it tells and hears: its own until the server has them, the
// room's that it wishes for and that hold, and the further channels of its house and of the others.
//
// Units/frames: as in tunnel/wire/wire_state.h; music in the server's clock.
// Ownership:    plain values; rules are the link's.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/base/assert.h"
#include "core/base/token_bucket.h"
#include "core/bus/state_messages.h"
#include "tunnel/session/state_replicator.h"

namespace dance {

// What a guest of this house wants the room's music or scene to be. It stands until somebody else
// has set it.
struct RoomWish {
  GuestId setter;  // not set: no wish
  bool is_alive = false;
  // It was wished before the room's was known: its version may have to be raised, once.
  bool is_blind = false;
  bool is_refused = false;  // until it changes
  ReplicatedState state;
};

// What the room's music or scene is.
struct RoomHeld {
  GuestId setter;
  std::uint32_t version = 0;  // of this session; 0 = not heard yet
};

// Of all guests of a house together.
constexpr std::size_t kMaxHouseChannels = 32;

// One further channel of this house.
struct HouseChannel {
  ForeignName name;
  const ChannelRule* rule = nullptr;
  TokenBucket changes;
  // Whose it is at the server, once that guest has a slot there.
  bool is_bound = false;
  wire::Slot slot;
  std::uint8_t index = 0;
  ReplicatedState state;  // of class newest: its name
  std::uint32_t sent_version = 0;
  std::uint32_t sequence = 0;
};

// One further channel of a guest of another house; without a rule its records go no further.
struct RemoteChannel {
  bool is_named = false;
  ForeignName name;
  const ChannelRule* rule = nullptr;
  TokenBucket messages;
  bool has_any = false;
  std::uint32_t sequence = 0;
};

}  // namespace dance
