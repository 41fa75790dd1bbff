// What encode.cpp and encode_state.cpp share: a generated type to bytes and back, and times.
//
// Units/frames: microseconds on the bus.
// Ownership:    allocates nothing.
// Threads:      none inside.
// Failure:      unpack() is false for another type or size; is_time() for what cannot be computed
//               with.
#pragma once

#include "core/base/assert.h"
#include "core/base/time.h"
#include "core/bus/encode.h"

namespace dance {

template <class Message>
std::size_t pack(const Message& message, MessageBuffer& buffer) {
  const int size = message.encode(buffer.data(), 0, static_cast<int>(buffer.size()));
  DANCE_ASSERT(size > 0, size);
  return static_cast<std::size_t>(size);
}

template <class Message>
bool unpack(const void* data, std::size_t size, Message& message) {
  // Ours have one size each: anything longer or shorter is somebody else's.
  return size <= kMaxMessageBytes &&
         message.decode(data, 0, static_cast<int>(size)) == static_cast<int>(size);
}

inline std::int64_t to_us(MonoTime t) { return t.since_zero_us(); }
inline MonoTime from_us(std::int64_t us) { return MonoTime::from_us(us); }

// A time that can be computed with: within 100 years of its clock's zero.
inline bool is_time(std::int64_t us) {
  constexpr std::int64_t kCentury_us = 100LL * 366 * 24 * 3600 * 1'000'000;
  return us > -kCentury_us && us < kCentury_us;
}

}  // namespace dance
