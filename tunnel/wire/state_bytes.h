// States as they travel through the tunnel: the messages of the bus, without who
// said them when.
//
// Units/frames: times as the caller mapped them.
// Ownership:    allocates nothing.
// Threads:      none inside.
// Failure:      decode_from_tunnel() is false for another type or size, and impossible values.
#pragma once

#include "core/bus/encode.h"
#include "tunnel/wire/wire.h"

namespace dance {

// The time of saying it, and whose clock that was, are nobody's concern elsewhere.
template <class Message>
std::size_t encode_for_tunnel(Message message, MessageBuffer& buffer) {
  message.time = MonoTime();
  message.clock_id = 0;
  return encode(message, buffer);
}

template <class Message>
bool decode_from_tunnel(wire::Bytes payload, Message& message) {
  return decode(payload.data(), payload.size(), message) == Decoded::kFine;
}

}  // namespace dance
